/** The charts under the plan: one at a time, chosen by tabs. */

import type { TextKey } from '../i18n/translate';
import { mainEstimator, type Context, type Panel } from '../model/context';
import { h, replaceChildren } from '../ui/dom';
import { tabs } from '../ui/tabs';
import { Chart } from './chart';
import { dataOf, roadwayIds, type ChartKind, type Range } from './chart_data';

const kKinds: { kind: ChartKind; tab: TextKey; axis: TextKey; missing: TextKey }[] = [
  { kind: 'error', tab: 'chartError', axis: 'axisError', missing: 'noTruth' },
  { kind: 'sigma', tab: 'chartSigma', axis: 'axisSigma', missing: 'noEstimate' },
  { kind: 'nis', tab: 'chartNis', axis: 'axisNis', missing: 'noNis' },
  { kind: 'distance', tab: 'chartDistance', axis: 'axisChainage', missing: 'noChainage' },
];

export interface ChartsPanel extends Panel {
  /** The tracks changed: take their figures again. */
  refresh(): void;
}

export function chartsPanel(context: Context, seek: (stamp: number) => void): ChartsPanel {
  const { t, session } = context;
  let shown = kKinds[0]!;
  let chosen: Range | null = null;
  const host = h('div', { class: 'chart' });
  const note = h('p', { class: 'faint', hidden: true });
  const roadway = h('select', { 'aria-label': t('roadway'), hidden: true, onchange: () => refresh() });
  replaceChildren(roadway, ...roadwayIds(context).map((id, index) => h('option', { value: index }, id)));
  let chart = newChart();

  function newChart(): Chart {
    return new Chart(host, context.paint, {
      axisX: t('axisTime'),
      axisY: t(shown.axis),
      startsAtZero: shown.kind !== 'distance',
      onMoment: (x) => seek(originOf() + x),
      onRange: (range) => {
        chosen = range && { from: range[0], to: range[1] };
        refresh();
      },
    });
  }

  const originOf = (): number => session.state?.first_s ?? session.feed.info.first_s ?? firstStamp(context);
  const wholeRange = (): Range => ({ from: 0, to: Math.max(1e-3, lastStampOf(context) - originOf()) });

  function refresh(): void {
    if (element.hidden) return;
    const data = dataOf(context, shown.kind, originOf(), chosen ?? wholeRange(), Number(roadway.value || 0));
    const empty = data.series.length === 0;
    note.hidden = !empty;
    host.hidden = empty;
    if (empty) {
      const kept = shown.kind !== 'nis' || session.feed.info.mode !== 'run';
      note.textContent = t('noChart', { why: t(kept ? shown.missing : 'noNisKept') });
      chart.clear();
    } else {
      chart.show(data);
      update();
    }
  }

  function update(): void {
    const stamp = session.state?.stamp_s ?? null;
    chart.showNow(stamp === null ? null : stamp - originOf());
  }

  function choose(index: number): void {
    shown = kKinds[index]!;
    chart.clear();
    chart = newChart();
    roadway.hidden = shown.kind !== 'distance' || roadway.options.length < 2;
    if (shown.kind === 'distance') followRoadway(context, roadway);
    refresh();
  }

  const choice = tabs(t('charts'), kKinds.map((one) => t(one.tab)), choose);
  const element = h('section', { class: 'charts card', 'aria-label': t('charts') }, h('div', { class: 'row' }, choice, roadway), note, host);
  return { element, update, refresh };
}

function followRoadway(context: Context, select: HTMLSelectElement): void {
  const index = roadwayIds(context).indexOf(mainEstimator(context)?.place?.roadway ?? '');
  if (index >= 0) select.value = String(index);
}

function firstStamp(context: Context): number {
  const stamps = [...context.session.tracks.values()].flatMap((track) => (track.stamp.length > 0 ? [track.stamp[0]!] : []));
  return stamps.length > 0 ? Math.min(...stamps) : 0;
}

function lastStampOf(context: Context): number {
  const stamps = [...context.session.tracks.values()].flatMap((track) => (track.stamp.length > 0 ? [track.stamp.at(-1)!] : []));
  return stamps.length > 0 ? Math.max(...stamps) : 0;
}
