/** Events in words. Kinds that the table does not know are shown as they come. */

import type { TextKey, Translate } from '../i18n/translate';
import type { RunEvent } from '../protocol/messages';

const kKinds: Record<string, TextKey> = {
  interval_entry: 'eventEntry',
  interval_exit: 'eventExit',
  branch_open: 'eventBranchOpen',
  branch_decided: 'eventBranchDecided',
  road_lost: 'eventRoadLost',
  road_found: 'eventRoadFound',
  passage_refused: 'eventPassageRefused',
  passage_missed: 'eventPassageMissed',
  bad_line: 'eventBadLine',
  source_stale: 'eventStale',
  source_lost: 'eventLost',
  source_back: 'eventBack',
  recording_on: 'eventRecordingOn',
  recording_off: 'eventRecordingOff',
  log_damaged: 'eventDamaged',
};

const kTroubles = new Set(['road_lost', 'passage_refused', 'passage_missed', 'bad_line', 'source_stale', 'source_lost', 'log_damaged']);

export function isTrouble(event: RunEvent): boolean {
  return kTroubles.has(event.kind);
}

export function eventWords(t: Translate, event: RunEvent): string {
  const key = kKinds[event.kind];
  return [key ? t(key) : event.kind, event.sensor, detailWords(t, event)].filter(Boolean).join(' · ');
}

/** An interval by its name, a silence with a tenth of a second; the whole of it stands in events.csv. */
function detailWords(t: Translate, event: RunEvent): string {
  const silence = /^silent for ([0-9.]+) s$/.exec(event.detail);
  if (silence) return t('silentFor', { seconds: Number(silence[1]).toFixed(1) });
  if (event.kind === 'interval_entry' || event.kind === 'interval_exit') return event.detail.split(' ')[0] ?? '';
  return event.detail;
}
