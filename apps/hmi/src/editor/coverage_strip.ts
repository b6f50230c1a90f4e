/** How well anchors cover a roadway, along its chainage: how many are seen, and what that gives along and across. */

import type { Translate } from '../i18n/translate';
import type { Coverage } from '../protocol/messages';
import { h, setText } from '../ui/dom';
import type { Paint } from '../ui/theme';
import type { Editing } from './editing';

const kScales = [0.1, 0.2, 0.5, 1, 2]; // m; what lies above the last is drawn at the border

export function coverageStrip(editing: Editing, t: Translate, paint: Paint): { element: HTMLElement; update(): void } {
  const canvas = h('canvas', { class: 'strip', 'aria-hidden': 'true' });
  const words = h('p', { class: 'faint', 'data-testid': 'coverage' });
  const element = h('section', { class: 'card coverage', 'aria-label': t('coverage') }, h('h2', {}, t('coverage')), words, canvas);
  editing.on('answers', () => update());
  new ResizeObserver(() => update()).observe(canvas);

  function update(): void {
    const { coverage } = editing;
    canvas.hidden = coverage === null;
    setText(words, coverage ? coverageWords(t, coverage, requiredOf(editing)) : t('noCoverage'));
    if (coverage) paintStrip(canvas, coverage, requiredOf(editing), paint, t);
  }
  return { element, update };
}

function requiredOf(editing: Editing): number {
  const site = editing.map.features.find((feature) => feature.properties.object === 'map');
  const requirements = site?.properties['requirements'];
  if (typeof requirements !== 'object' || requirements === null) return 0;
  const visible = (requirements as Record<string, unknown>)['anchors_visible'];
  return typeof visible === 'number' ? visible : 0;
}

/** "R1: from 1 to 4 anchors; fewer than 2 on 12.0 m, first at 340.0 m". */
export function coverageWords(t: Translate, coverage: Coverage, required: number): string {
  const { anchors, chainage_m: chainage } = coverage;
  if (anchors.length === 0) return t('noCoverage');
  const range = { roadway: coverage.roadway, least: Math.min(...anchors), most: Math.max(...anchors) };
  const step = chainage.length > 1 ? (chainage[chainage.length - 1]! - chainage[0]!) / (chainage.length - 1) : 0;
  const short = anchors.filter((count) => count < required).length;
  const first = anchors.findIndex((count) => count < required);
  const enough = short === 0 ? t('coverageEnough') : t('coverageShort', { required, metres: (short * step).toFixed(0), first: chainage[first]!.toFixed(0) });
  return t('coverageRange', range) + enough;
}

function paintStrip(canvas: HTMLCanvasElement, coverage: Coverage, required: number, paint: Paint, t: Translate): void {
  const ratio = devicePixelRatio;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const pen = canvas.getContext('2d');
  const { chainage_m: chainage, anchors } = coverage;
  if (!pen || chainage.length < 2) return;
  pen.scale(ratio, ratio);
  pen.font = '11px system-ui, sans-serif';
  const [left, right] = [110, width - 8];
  const [from, to] = [chainage[0]!, chainage[chainage.length - 1]!];
  const x = (at: number): number => left + ((at - from) / (to - from)) * (right - left);
  const half = height / 2 - 10;

  const most = Math.max(4, required + 1, ...anchors);
  const barWidth = Math.max(1, (right - left) / anchors.length);
  anchors.forEach((count, index) => {
    const few = count < required;
    pen.fillStyle = few ? paint.bad : paint.good;
    const bar = Math.max(few ? 4 : 1, (count / most) * half);
    pen.globalAlpha = few && index % 4 >= 2 ? 0.35 : 0.85; // hatched where there are too few
    pen.fillRect(x(chainage[index]!) - barWidth / 2, half - bar, barWidth + 0.5, bar);
  });
  pen.globalAlpha = 1;
  pen.fillStyle = paint.text;
  pen.fillText(`${t('anchors')}: 0–${most}`, 4, half - 4);
  if (required > 0) rule(pen, left, right, half - (required / most) * half, paint.text, [5, 4], `≥ ${required}`);

  const largest = Math.max(0, ...[...coverage.along_m, ...coverage.across_m].map((sigma) => sigma ?? 0));
  const worst = kScales.find((scale) => scale >= largest) ?? kScales[kScales.length - 1]!;
  const base = height - 16;
  const y = (sigma: number | null): number => base - (Math.min(sigma ?? worst, worst) / worst) * (half - 8);
  curve(pen, chainage, coverage.along_m, x, y, paint.tracks[0]!, []);
  curve(pen, chainage, coverage.across_m, x, y, paint.tracks[1]!, [5, 3]);
  pen.fillStyle = paint.tracks[0]!;
  pen.fillText(`━ ${t('sigmaAlong')}`, 4, base - 26);
  pen.fillStyle = paint.tracks[1]!;
  pen.fillText(`╍ ${t('sigmaAcross')}`, 4, base - 12);
  pen.fillStyle = paint.text;
  pen.fillText(`0–${worst} m`, 4, base + 2);
  for (let tick = 0; tick <= 8; ++tick) {
    const at = from + ((to - from) * tick) / 8;
    pen.textAlign = tick === 0 ? 'left' : tick === 8 ? 'right' : 'center';
    pen.fillText(`${at.toFixed(0)} m`, x(at), height - 3);
  }
  pen.textAlign = 'left';
}

function rule(pen: CanvasRenderingContext2D, left: number, right: number, y: number, colour: string, dash: number[], words: string): void {
  pen.strokeStyle = colour;
  pen.setLineDash(dash);
  pen.beginPath();
  pen.moveTo(left, y);
  pen.lineTo(right, y);
  pen.stroke();
  pen.setLineDash([]);
  pen.fillText(words, left - 28, y + 4);
}

/** Interrupted where nothing can be said. */
function curve(
  pen: CanvasRenderingContext2D,
  chainage: number[],
  sigma: (number | null)[],
  x: (at: number) => number,
  y: (sigma: number | null) => number,
  colour: string,
  dash: number[],
): void {
  pen.strokeStyle = colour;
  pen.lineWidth = 1.8;
  pen.setLineDash(dash);
  pen.beginPath();
  let pendown = false;
  sigma.forEach((value, index) => {
    if (value === null) return void (pendown = false);
    if (pendown) pen.lineTo(x(chainage[index]!), y(value));
    else pen.moveTo(x(chainage[index]!), y(value));
    pendown = true;
  });
  pen.stroke();
  pen.setLineDash([]);
}
