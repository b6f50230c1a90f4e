/** Numbers and places in words. */

import type { Translate } from '../i18n/translate';
import type { LinkState, LockState, PlaceNow } from '../protocol/messages';
import type { TextKey } from '../i18n/translate';

const lockKeys: Record<LockState, TextKey> = { held: 'lockHeld', doubtful: 'lockDoubtful', free: 'lockFree', unknown: 'lockUnknown' };
const linkKeys: Record<LinkState, TextKey> = {
  waiting: 'linkWaiting',
  connected: 'connected',
  stale: 'stale',
  lost: 'linkLost',
  invalid: 'invalid',
  event: 'linkEvent',
};

export const lockWords = (t: Translate, state: LockState): string => t(lockKeys[state]);
export const linkWords = (t: Translate, state: LinkState): string => t(linkKeys[state]);

/** "R12, 345.2 m, interval j_2, lock held". */
export function placeWords(t: Translate, place: PlaceNow): string {
  if (place.roadway === null || place.chainage_m === null) return t('noPlace');
  const parts = [t('placeWords', { roadway: place.roadway, chainage: place.chainage_m.toFixed(1) })];
  if (place.interval !== null) parts.push(t('intervalWords', { interval: place.interval }));
  if (place.lock !== null) parts.push(lockWords(t, place.lock));
  return parts.join(t('comma'));
}

export function metres(value: number | null, digits = 2): string {
  return value === null ? '–' : `${value.toFixed(digits)} m`;
}

export function percent(share: number | null): string {
  return share === null ? '–' : `${(100 * share).toFixed(share < 0.1 && share > 0 ? 1 : 0)} %`;
}

/** Seconds as 1:02:03.4 */
export function clock(seconds: number): string {
  const sign = seconds < 0 ? '-' : '';
  const tenths = Math.round(Math.abs(seconds) * 10);
  const hours = Math.floor(tenths / 36000);
  const minutes = Math.floor(tenths / 600) % 60;
  const rest = ((tenths % 600) / 10).toFixed(1).padStart(4, '0');
  return sign + (hours > 0 ? `${hours}:${String(minutes).padStart(2, '0')}:${rest}` : `${minutes}:${rest}`);
}

export function age(seconds: number | null): string {
  if (seconds === null) return '–';
  if (seconds < 1) return `${Math.round(seconds * 1000)} ms`;
  return seconds < 100 ? `${seconds.toFixed(1)} s` : `${Math.round(seconds)} s`;
}

export function bytes(count: number): string {
  if (count < 1000) return `${count} B`;
  return count < 1e6 ? `${(count / 1000).toFixed(0)} kB` : `${(count / 1e6).toFixed(1)} MB`;
}
