/** The plan of the viewer: the mine below, tracks and vehicles above. */

import type OlMap from 'ol/Map';
import type Feature from 'ol/Feature';
import type { Geometry } from 'ol/geom';
import VectorLayer from 'ol/layer/Vector';
import VectorSource from 'ol/source/Vector';
import { lineOf, mainEstimator, trackNames, type Context } from '../model/context';
import { extentOf } from '../model/mine';
import type { Track } from '../model/track';
import { lowerBound } from '../model/levels';
import { fit, planeMap, type Extent } from './base_map';
import { Background } from './background_layer';
import { CanvasLayer } from './canvas_layer';
import { KeptPicture } from './kept_picture';
import { mineFeatures } from './mine_features';
import { mineStyle, type Look } from './mine_styles';
import { classesOf } from './track_classes';
import { paintTrack, type TrackStyle, type Window } from './track_painter';
import { pixelColour, plotTrack, type Pixels } from './track_pixels';
import { partsOf, type Part } from './track_parts';
import { paintTruth, paintVehicle } from './vehicle_painter';

interface DrawnPart {
  name: string;
  track: Track;
  part: Part;
}

export class PlanView {
  readonly map: OlMap;
  private readonly look: Look;
  private readonly mine = new VectorSource<Feature<Geometry>>();
  private readonly overlay = new CanvasLayer((context, window) => this.paint(context, window), 5);
  private readonly kept = new KeptPicture(() => this.overlay.changed());
  private readonly classes = new WeakMap<Track, { key: string; classOf: Uint8Array | null }>();
  private lookKey = '';

  constructor(
    target: HTMLElement,
    private readonly context: Context,
  ) {
    this.look = { paint: context.paint, t: context.t, anchors: new Map(), locks: new Map() };
    this.mine.addFeatures(mineFeatures(context.session.mine));
    const mineLayer = new VectorLayer({
      source: this.mine,
      zIndex: 1,
      declutter: true,
      style: (feature, resolution) => mineStyle(feature as Feature<Geometry>, resolution, this.look),
    });
    const { feed } = context.session;
    const layers = [mineLayer, this.overlay];
    this.map = planeMap(target, feed.map && feed.background ? [new Background(feed.map, feed.background).layer, ...layers] : layers);
    this.map.on('pointerdrag', () => context.options.set({ follow: false }));
    this.showAll();
  }

  showAll(): void {
    const { mine, tracks } = this.context.session;
    fit(this.map, joined(extentOf(mine), trackExtent([...tracks.values()])));
  }

  /** Shows what is known now. */
  update(): void {
    this.followVehicle();
    this.updateLook();
    this.overlay.changed();
  }

  private followVehicle(): void {
    const pose = mainEstimator(this.context)?.pose;
    if (!this.context.options.now.follow || !pose) return;
    const view = this.map.getView();
    view.setCenter([pose.x_m, pose.y_m]);
    if ((view.getResolution() ?? 0) > 0.5) view.setResolution(0.15);
  }

  /** The mine is drawn anew only when the state of an anchor or lock is another one. */
  private updateLook(): void {
    const state = this.context.session.state;
    if (!state) return;
    const live = state.mode === 'live' || state.mode === 'replay';
    const key = state.anchors.map((anchor) => anchor.seen).join() + state.locks.map((lock) => lock.state).join();
    if (key === this.lookKey) return;
    this.lookKey = key;
    this.look.anchors = new Map(live ? state.anchors.map((anchor) => [String(anchor.id), anchor.seen]) : []);
    this.look.locks = new Map(state.locks.map((lock) => [lock.id, lock.state]));
    this.mine.changed();
  }

  private paint(context: CanvasRenderingContext2D, window: Window): void {
    const { session, options } = this.context;
    const { hidden } = options.now;
    this.paintTracks(context, window);
    const state = session.state;
    if (!state) return;
    if (state.truth && !hidden.has('truth')) paintTruth(context, window, state.truth, this.context.paint.text);
    const main = mainEstimator(this.context);
    for (const estimator of [...state.estimators].reverse()) {
      if (hidden.has(estimator.name)) continue;
      const colour = lineOf(this.context, estimator.name).colour;
      paintVehicle(context, window, estimator, { colour, edge: this.context.paint.surface, main: estimator === main });
    }
  }

  private paintTracks(context: CanvasRenderingContext2D, window: Window): void {
    const drawn = this.drawnParts();
    const kept = drawn.filter(({ part }) => part.kept);
    const key = this.context.options.now.colourBy + kept.map(({ name, part }) => `${name} ${part.first} ${part.end}`).join();
    if (kept.length > 0) this.kept.draw(context, window, key, (pixels) => kept.forEach((one) => this.plotPart(pixels, one)));
    for (const one of drawn) if (!one.part.kept) this.paintPart(context, window, one);
  }

  private drawnParts(): DrawnPart[] {
    const { session, options } = this.context;
    const { hidden, trailMinutes } = options.now;
    const now = session.state?.stamp_s ?? Infinity;
    return trackNames(this.context).flatMap((name) => {
      const track = session.tracks.get(name);
      if (!track || hidden.has(name)) return [];
      const end = lowerBound(track.stamp, now + 1e-6);
      const first = trailMinutes === null ? 0 : lowerBound(track.stamp, now - 60 * trailMinutes);
      const showFuture = session.state?.mode === 'run' && name !== 'truth';
      return partsOf(track.stamp.length, first, end, showFuture).map((part) => ({ name, track, part }));
    });
  }

  private paintPart(context: CanvasRenderingContext2D, window: Window, { name, track, part }: DrawnPart): void {
    context.globalAlpha = part.future ? 0.25 : 1;
    paintTrack(context, track, track.levels, part, window, this.trackStyle(name, track));
    context.globalAlpha = 1;
  }

  private plotPart(pixels: Pixels, { name, track, part }: DrawnPart): void {
    const style = this.trackStyle(name, track);
    const colours = Uint32Array.from(style.colours, (colour) => pixelColour(colour, part.future ? 0.25 : 1));
    plotTrack(pixels, track, track.levels, part, { colours, classOf: style.classOf ?? null });
  }

  private trackStyle(name: string, track: Track): TrackStyle {
    const { paint, options } = this.context;
    const line = lineOf(this.context, name);
    const { colourBy } = options.now;
    const plain: TrackStyle = { colours: [line.colour], widthPx: name === 'truth' ? 1 : 2, dash: [] };
    if (name === 'truth') return plain;
    const colours = colourBy === 'error' ? paint.scale : [...paint.tracks.slice(0, 5), paint.faint];
    const kept = this.classes.get(track);
    const classOf = kept?.key === colourBy ? kept.classOf : classesOf(track, colourBy, colours.length);
    this.classes.set(track, { key: colourBy, classOf });
    return classOf ? { colours, classOf, widthPx: 2.5, dash: [] } : plain;
  }
}

function joined(a: Extent | null, b: Extent | null): Extent | null {
  if (!a || !b) return a ?? b;
  return [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[2], b[2]), Math.max(a[3], b[3])];
}

function trackExtent(tracks: Track[]): Extent | null {
  const boxes = tracks.flatMap((track) => Array.from(track.levels[track.levels.length - 1]?.boxes ?? []));
  if (boxes.length === 0) return null;
  const pick = (offset: number): number[] => boxes.filter((_, index) => index % 4 === offset);
  return [Math.min(...pick(0)), Math.min(...pick(1)), Math.max(...pick(2)), Math.max(...pick(3))];
}
