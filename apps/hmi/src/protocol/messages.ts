/** What `pos serve` says, as docs/formats/serve.md has it. One reader for each message; its type follows from the reader. */

import { list, number, oneOf, orNull, shape, text, truth, type Reader } from './check';

type Read<R> = R extends Reader<infer T> ? T : never;

export const readInfo = shape({
  protocol: number,
  pos_version: text,
  mode: oneOf('run', 'replay', 'live', 'map'),
  name: text,
  map: text,
  map_editable: truth,
  first_s: orNull(number),
  last_s: orNull(number),
  truth,
  estimators: list(shape({ name: text, type: text })),
  tracks: list(text),
  columns: list(text),
  stale_after_s: orNull(number),
  lost_after_s: orNull(number),
});
export type Info = Read<typeof readInfo>;

const readPose = shape({ x_m: number, y_m: number, z_m: orNull(number), yaw_rad: orNull(number) });
export type Pose = Read<typeof readPose>;

const lockStates = ['held', 'doubtful', 'free', 'unknown'] as const;
export type LockState = (typeof lockStates)[number];
export const readLockState = oneOf<LockState>(...lockStates);

const readPlace = shape({
  state: oneOf('waiting', 'decided', 'branching', 'lost'),
  roadway: orNull(text),
  chainage_m: orNull(number),
  offset_m: orNull(number),
  sigma_along_m: orNull(number),
  interval: orNull(text),
  interval_id: orNull(text),
  lock: orNull(readLockState),
  next: orNull(
    shape({ id: text, label: text, entry: truth, distance_m: orNull(number), in_s: orNull(number) }),
  ),
});
export type PlaceNow = Read<typeof readPlace>;

const readEstimator = shape({
  name: text,
  type: text,
  stamp_s: orNull(number),
  age_s: orNull(number),
  pose: orNull(readPose),
  sigma: orNull(shape({ x_m: number, y_m: number, yaw_rad: orNull(number), corr_x_y: orNull(number) })),
  ellipse: orNull(shape({ major_m: number, minor_m: number, angle_rad: number })),
  speed_m_per_s: orNull(number),
  error_m: orNull(number),
  nis: orNull(number),
  verdicts: orNull(shape({ applied: number, gated: number })),
  modes: list(shape({ name: text, probability: number })),
  mode: orNull(text),
  place: orNull(readPlace),
});
export type EstimatorNow = Read<typeof readEstimator>;

const linkStates = ['waiting', 'connected', 'stale', 'lost', 'invalid', 'event'] as const;
export type LinkState = (typeof linkStates)[number];
const readLinkState = oneOf<LinkState>(...linkStates);

const readSource = shape({
  name: text,
  kind: text,
  state: readLinkState,
  age_s: orNull(number),
  period_s: orNull(number),
  count: number,
  gated_ratio: orNull(number),
  refused: orNull(number),
  why: orNull(text),
});
export type SourceNow = Read<typeof readSource>;

const readAnchor = shape({
  period_s: orNull(number),
  id: number,
  state: readLinkState,
  age_s: orNull(number),
  count: orNull(number),
  gated_ratio: orNull(number),
  seen: oneOf('seen', 'rejected', 'not_seen'),
});
export type AnchorNow = Read<typeof readAnchor>;

export const readState = shape({
  seq: number,
  mode: oneOf('run', 'replay', 'live', 'map'),
  playing: truth,
  seeking: truth,
  ended: truth,
  speed: number,
  stamp_s: orNull(number),
  first_s: orNull(number),
  last_s: orNull(number),
  truth: orNull(readPose),
  estimators: list(readEstimator),
  sources: list(readSource),
  anchors: list(readAnchor),
  locks: list(shape({ id: text, label: text, state: readLockState, probability: orNull(number) })),
  recording: orNull(shape({ on: truth, file: orNull(text), measurements: number, bytes: number })),
  refused_lines: orNull(number),
});
export type State = Read<typeof readState>;

export const readEvent = shape({
  n: number,
  stamp_s: orNull(number),
  estimator: text,
  kind: text,
  sensor: text,
  detail: text,
});
export type RunEvent = Read<typeof readEvent>;
export const readEvents = shape({ events: list(readEvent), total: number });

export const readIntervals = shape({
  intervals: list(
    shape({
      id: text,
      label: text,
      length_m: number,
      spans: list(shape({ roadway: text, from_m: number, to_m: number, lane: orNull(text) })),
    }),
  ),
});
export type LockInterval = Read<typeof readIntervals>['intervals'][number];

export const readFindings = shape({
  findings: list(
    shape({
      severity: oneOf('error', 'warning', 'note'),
      check: text,
      what: text,
      remedy: text,
      objects: list(text),
      place: orNull(shape({ x_m: number, y_m: number, z_m: orNull(number) })),
    }),
  ),
  remarks: list(text),
});
export type Finding = Read<typeof readFindings>['findings'][number];

export const readCoverage = shape({
  roadways: list(
    shape({
      roadway: text,
      chainage_m: list(number),
      anchors: list(number),
      along_m: list(orNull(number)),
      across_m: list(orNull(number)),
    }),
  ),
});
export type Coverage = Read<typeof readCoverage>['roadways'][number];

export const readDiff = shape({ changes: list(shape({ kind: text, object: text, key: text, words: text })) });
export type Change = Read<typeof readDiff>['changes'][number];

export const readSaved = shape({ version: text });

export const readFailure = shape({
  error: shape({ status: number, code: text, what: text, place: text, key: text, got: text, expected: text, suggestion: text }),
});
export type Failure = Read<typeof readFailure>['error'];
