/** Centrelines of roadways: arcs become short lines, every point knows its chainage (length in space along the floor, m). */

export type Point3 = readonly [number, number, number];

export interface Centreline {
  points: Point3[];
  /** Chainage of each point, growing. */
  chainage: number[];
}

export interface Place {
  point: Point3;
  /** Direction of growing chainage in plan, unit length. */
  along: readonly [number, number];
}

const kArcStepRad = Math.PI / 36; // 5 degrees: 1 mm of sagitta at a radius of 1 m, 1 cm at 10 m

/** `arcs[i]` is the sweep in degrees (counter-clockwise positive) of the leg from point i to the next; null for a straight one. */
export function centrelineOf(corners: Point3[], arcs: readonly (number | null)[] = [], start = 0): Centreline {
  const line: Centreline = { points: [], chainage: [] };
  if (corners.length === 0) return line;
  line.points.push(corners[0]!);
  line.chainage.push(start);
  for (let i = 0; i + 1 < corners.length; ++i) addLeg(line, corners[i]!, corners[i + 1]!, arcs[i] ?? 0);
  return line;
}

function addLeg(line: Centreline, from: Point3, to: Point3, sweepDeg: number): void {
  const before = line.chainage[line.chainage.length - 1]!;
  const chord = Math.hypot(to[0] - from[0], to[1] - from[1]);
  const rise = to[2] - from[2];
  if (sweepDeg === 0 || chord === 0) {
    line.points.push(to);
    line.chainage.push(before + Math.hypot(chord, rise));
    return;
  }
  const sweep = (sweepDeg * Math.PI) / 180;
  const radius = chord / (2 * Math.sin(Math.abs(sweep) / 2));
  const length = Math.hypot(radius * Math.abs(sweep), rise);
  const reach = 0.5 / Math.tan(sweep / 2); // centre: left of the chord's middle by this share of the chord
  const centreX = (from[0] + to[0]) / 2 - reach * (to[1] - from[1]);
  const centreY = (from[1] + to[1]) / 2 + reach * (to[0] - from[0]);
  const steps = Math.max(2, Math.ceil(Math.abs(sweep) / kArcStepRad));
  for (let step = 1; step <= steps; ++step) {
    const share = step / steps;
    const [c, s] = [Math.cos(sweep * share), Math.sin(sweep * share)];
    const [dx, dy] = [from[0] - centreX, from[1] - centreY];
    line.points.push(
      step === steps ? to : [centreX + c * dx - s * dy, centreY + s * dx + c * dy, from[2] + share * rise],
    );
    line.chainage.push(before + share * length);
  }
}

export function startOf(line: Centreline): number {
  return line.chainage[0] ?? 0;
}

export function endOf(line: Centreline): number {
  return line.chainage[line.chainage.length - 1] ?? 0;
}

/** The place at a chainage; before the start and past the end, the end itself. */
export function placeAt(line: Centreline, chainage: number): Place {
  const last = line.points.length - 1;
  let leg = 1;
  while (leg < last && line.chainage[leg]! < chainage) ++leg;
  const [a, b] = [line.points[leg - 1]!, line.points[leg]!];
  const [from, to] = [line.chainage[leg - 1]!, line.chainage[leg]!];
  const share = to > from ? Math.min(1, Math.max(0, (chainage - from) / (to - from))) : 0;
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
  return {
    point: [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])],
    along: [(b[0] - a[0]) / length, (b[1] - a[1]) / length],
  };
}

export interface Foot {
  chainage: number;
  /** Positive to the left of growing chainage, m. */
  offset: number;
  distance: number;
}

/** The nearest place of the line to a point in plan. */
export function footOf(line: Centreline, x: number, y: number): Foot {
  let best: Foot = { chainage: startOf(line), offset: 0, distance: Infinity };
  for (let leg = 1; leg < line.points.length; ++leg) {
    const [a, b] = [line.points[leg - 1]!, line.points[leg]!];
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const square = dx * dx + dy * dy;
    const share = square > 0 ? Math.min(1, Math.max(0, ((x - a[0]) * dx + (y - a[1]) * dy) / square)) : 0;
    const [ex, ey] = [x - a[0] - share * dx, y - a[1] - share * dy];
    const distance = Math.hypot(ex, ey);
    if (distance >= best.distance) continue;
    const [from, to] = [line.chainage[leg - 1]!, line.chainage[leg]!];
    const offset = Math.sign(dx * ey - dy * ex) * distance;
    best = { chainage: from + share * (to - from), offset, distance };
  }
  return best;
}

/** The points from one chainage to another (either way), moved sideways by `offset` (positive left of growing chainage). */
export function stretch(line: Centreline, from: number, to: number, offset = 0): [number, number][] {
  const [low, high] = from <= to ? [from, to] : [to, from];
  const inside = line.chainage.filter((chainage) => chainage > low && chainage < high);
  const points = [low, ...inside, high].map((chainage) => shifted(placeAt(line, chainage), offset));
  return from <= to ? points : points.reverse();
}

export function shifted(place: Place, offset: number): [number, number] {
  return [place.point[0] - offset * place.along[1], place.point[1] + offset * place.along[0]];
}
