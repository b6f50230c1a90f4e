/** Where the vehicle is, in words and figures; for the main estimator. */

import type { Translate } from '../i18n/translate';
import { mainEstimator, type Context, type Panel } from '../model/context';
import { metres, placeWords } from '../model/words';
import type { EstimatorNow, PlaceNow } from '../protocol/messages';
import { h, setText } from '../ui/dom';

const kTwoAxes95 = Math.sqrt(5.991);

export function positionPanel(context: Context): Panel {
  const { t } = context;
  const place = h('p', { class: 'place', 'aria-live': 'off', 'data-testid': 'place' });
  const detail = h('p', { class: 'faint' });
  const rows = ['E, N', t('height'), t('heading'), t('speed'), t('errorNow')].map((name) => {
    const value = h('dd');
    return { name: h('dt', {}, name), value };
  });
  const list = h('dl', { class: 'figures' }, ...rows.flatMap((row) => [row.name, row.value]));
  const element = h('section', { class: 'card', 'aria-label': t('position') }, h('h2', {}, t('position')), place, detail, list);

  function update(): void {
    const now = mainEstimator(context);
    setText(place, mainWords(t, now));
    setText(detail, now ? detailWords(t, now) : '');
    figuresOf(now).forEach((figure, index) => setText(rows[index]!.value, figure));
  }
  return { element, update };
}

function mainWords(t: Translate, now: EstimatorNow | null): string {
  if (!now?.pose) return t('noEstimate');
  if (!now.place) return `E ${now.pose.x_m.toFixed(2)} m, N ${now.pose.y_m.toFixed(2)} m`;
  return placeWords(t, now.place);
}

function detailWords(t: Translate, now: EstimatorNow): string {
  const parts: string[] = [];
  if (now.place) parts.push(t(now.place.state), ...sideWords(t, now.place));
  if (now.ellipse) {
    const [major, minor] = [now.ellipse.major_m, now.ellipse.minor_m].map((axis) => (kTwoAxes95 * axis).toFixed(2));
    parts.push(t('sigmas', { major: major!, minor: minor! }));
  }
  return parts.join(t('comma'));
}

function sideWords(t: Translate, place: PlaceNow): string[] {
  const words: string[] = [];
  if (place.offset_m !== null)
    words.push(t(place.offset_m >= 0 ? 'offsetLeft' : 'offsetRight', { metres: Math.abs(place.offset_m).toFixed(1) }));
  if (place.next?.in_s !== null && place.next !== null)
    words.push(t(place.next.entry ? 'nextEntry' : 'nextExit', { interval: place.next.label, seconds: place.next.in_s.toFixed(0) }));
  return words;
}

function figuresOf(now: EstimatorNow | null): string[] {
  const pose = now?.pose;
  if (!now || !pose) return ['–', '–', '–', '–', '–'];
  const heading = pose.yaw_rad === null ? '–' : `${bearing(pose.yaw_rad).toFixed(1)}°`;
  return [
    `${pose.x_m.toFixed(2)}, ${pose.y_m.toFixed(2)} m`,
    metres(pose.z_m),
    heading,
    now.speed_m_per_s === null ? '–' : `${now.speed_m_per_s.toFixed(2)} m/s`,
    metres(now.error_m),
  ];
}

/** Degrees clockwise from the map's north, 0 to 360, from a yaw that counts counter-clockwise from east. */
export function bearing(yaw: number): number {
  const degrees = 90 - (yaw * 180) / Math.PI;
  return ((degrees % 360) + 360) % 360;
}
