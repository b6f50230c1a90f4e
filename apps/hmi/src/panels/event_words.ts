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
  return [key ? t(key) : event.kind, event.sensor, event.detail].filter(Boolean).join(' · ');
}
