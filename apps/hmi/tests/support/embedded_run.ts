/** The scene as the JSON of a page that carries its run. */

import { trackBytes } from '../../src/protocol/track_bytes';
import { sceneInfo, sceneIntervals, sceneMap, trackColumns } from './scene';

export function embeddedRun(): string {
  const info = sceneInfo('run');
  const tracks = info.tracks.map((name) => {
    const rows = trackColumns(name, info.columns, 0, Infinity);
    const base64 = Buffer.from(trackBytes(rows.stamp, rows.columns)).toString('base64');
    return { name, columns: info.columns, base64 };
  });
  const first = sceneIntervals().map((_, index) => (index === 0 ? 'held' : 'free'));
  const later = first.map((_, index) => (index === 1 ? 'doubtful' : 'free'));
  const locks = [{ stamp_s: 0, states: first }, { stamp_s: 40, states: later }];
  const run = { format: 'pos.viewer/1', info, map: sceneMap(), intervals: sceneIntervals(), events: [], tracks, locks, background: null };
  return JSON.stringify(run).replaceAll('<', '\\u003c');
}
