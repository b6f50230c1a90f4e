/** The plan of the editor: objects that can be drawn, picked and dragged, with snapping. */

import Collection from 'ol/Collection';
import Feature from 'ol/Feature';
import type OlMap from 'ol/Map';
import { LineString, Point, type Geometry } from 'ol/geom';
import { primaryAction } from 'ol/events/condition';
import Draw from 'ol/interaction/Draw';
import Modify from 'ol/interaction/Modify';
import Snap from 'ol/interaction/Snap';
import Translate from 'ol/interaction/Translate';
import VectorLayer from 'ol/layer/Vector';
import VectorSource from 'ol/source/Vector';
import { Circle, Fill, RegularShape, Stroke, Style } from 'ol/style';
import type { Translate as Words } from '../i18n/translate';
import { footOf, placeAt, type Centreline, type Point3 } from '../model/centreline';
import { idOf, pointOf, type MapDocument } from '../model/map_document';
import { extentOf, mineOf, roadwayOf } from '../model/mine';
import { Background } from '../plan/background_layer';
import { fit, planeMap } from '../plan/base_map';
import { mineFeatures } from '../plan/mine_features';
import { mineStyle, type Look } from '../plan/mine_styles';
import type { Paint } from '../ui/theme';
import { found, moved, newAnchor, newChamber, added, keyOf, redrawn, roadwayNear, withRoadway, type ObjectKey } from './edits';
import { withPickedPixel } from './control_points';
import type { Editing } from './editing';

const kSnapPx = 12;

export class EditPlan {
  readonly map: OlMap;
  readonly background: Background;
  private readonly mine = new VectorSource<Feature<Geometry>>();
  private readonly handles = new VectorSource<Feature<Geometry>>();
  private readonly marks = new VectorSource<Feature<Geometry>>();
  /** The selected roadway: its corners can be dragged. */
  private readonly shaped = new Collection<Feature<Geometry>>();
  private readonly snap = new Snap({ source: this.handles, pixelTolerance: kSnapPx });
  private readonly look: Look;
  private draw: Draw | null = null;

  constructor(
    host: HTMLElement,
    private readonly editing: Editing,
    private readonly paint: Paint,
    t: Words,
    backgroundAddress: string,
  ) {
    this.look = { paint, t, anchors: new Map(), locks: new Map() };
    this.background = new Background(editing.map, backgroundAddress);
    const layer = (source: VectorSource<Feature<Geometry>>, zIndex: number, style: (feature: Feature<Geometry>, resolution: number) => Style[]) =>
      new VectorLayer({ source, zIndex, style: (feature, resolution) => style(feature as Feature<Geometry>, resolution) });
    this.map = planeMap(host, [
      this.background.layer,
      layer(this.mine, 1, (feature, resolution) => mineStyle(feature, resolution, this.look)),
      layer(this.handles, 6, (feature) => this.handleStyle(feature)),
      layer(this.marks, 7, (feature) => this.markStyle(feature)),
    ]);
    this.addInteractions();
    this.rebuild();
    editing.on('map', () => this.rebuild());
    editing.on('selection', () => this.rebuildHandles());
    editing.on('tool', () => this.changeTool());
    editing.on('answers', () => this.showFindings());
  }

  showAll(): void {
    fit(this.map, extentOf(mineOf(this.editing.map, [])) ?? [-100, -60, 100, 60]);
  }

  showPlace(x: number, y: number): void {
    const view = this.map.getView();
    view.animate({ center: [x, y], resolution: Math.min(view.getResolution() ?? 1, 0.25), duration: 200 });
  }

  centre(): [number, number] {
    const centre = this.map.getView().getCenter() ?? [0, 0];
    return [centre[0]!, centre[1]!];
  }

  private rebuild(): void {
    const mine = mineOf(this.editing.map, []);
    this.mine.clear();
    this.mine.addFeatures(mineFeatures(mine));
    this.background.show(this.editing.map);
    this.rebuildHandles();
  }

  /** Corners of the selected roadway, and a point for every anchor and chamber. */
  private rebuildHandles(): void {
    const mine = mineOf(this.editing.map, []);
    this.handles.clear();
    this.shaped.clear();
    for (const feature of this.editing.map.features) {
      const key = keyOf(feature);
      const geometry = handleOf(feature, key);
      if (!geometry) continue;
      const handle = new Feature<Geometry>({ geometry, key });
      this.handles.addFeature(handle);
      if (isSelectedRoadway(key, this.editing.selection)) this.shaped.push(handle);
    }
    for (const chamber of mine.chambers)
      this.handles.addFeature(new Feature({ geometry: new Point(chamber.place), key: { object: 'chamber', id: chamber.id } }));
  }

  private addInteractions(): void {
    const modify = new Modify({
      features: this.shaped,
      pixelTolerance: kSnapPx,
      condition: (event) => this.editing.tool === 'select' && primaryAction(event),
    });
    modify.on('modifyend', () => this.takeRoadway(this.shaped.item(0)));
    const translate = new Translate({
      hitTolerance: 6,
      layers: (layer) => layer.getZIndex() === 6,
      filter: (feature) => this.editing.tool === 'select' && feature.getGeometry()?.getType() === 'Point',
    });
    translate.on('translatestart', (event) => this.pick(event.features.item(0)));
    translate.on('translating', (event) => this.dragged(event.features.item(0)));
    translate.on('translateend', (event) => this.dropped(event.features.item(0)));
    this.map.addInteraction(modify);
    this.map.addInteraction(translate);
    this.map.addInteraction(this.snap);
    this.map.on('click', (event) => this.click(event.pixel, event.coordinate));
  }

  private click(pixel: number[], coordinate: number[]): void {
    if (this.editing.tool === 'control') {
      const [x, y] = [coordinate[0]!, coordinate[1]!];
      const spot = this.background.pixelAt(x, y);
      if (spot) withPickedPixel(this.editing, spot.column, spot.row, x, y);
      this.editing.setTool('select');
      return;
    }
    if (this.editing.tool !== 'select') return;
    const hits = this.map.getFeaturesAtPixel(pixel, { hitTolerance: 6 }) as Feature<Geometry>[];
    const handle = hits.find((hit) => hit.get('key') !== undefined && hit.getGeometry()?.getType() === 'Point');
    const shape = hits.find((hit) => ['roadway', 'chamber', 'anchor', 'junction', 'portal', 'light', 'stop_line'].includes(String(hit.get('kind'))));
    if (handle) return this.pick(handle);
    this.editing.select(shape ? { object: String(shape.get('kind')), id: String(shape.get('name')) } : null);
  }

  private pick(feature: Feature<Geometry> | undefined): void {
    const key = feature?.get('key') as ObjectKey | undefined;
    if (key) this.editing.select(key);
  }

  private dragged(feature: Feature<Geometry> | undefined): void {
    const next = feature ? this.afterDrag(feature) : null;
    if (next) this.editing.preview(next);
  }

  private dropped(feature: Feature<Geometry> | undefined): void {
    const next = feature ? this.afterDrag(feature) : null;
    if (next) this.editing.change(next);
  }

  private afterDrag(feature: Feature<Geometry>): MapDocument | null {
    const geometry = feature.getGeometry();
    if (!(geometry instanceof Point)) return null;
    const [x, y] = geometry.getCoordinates();
    return moved(this.editing.map, feature.get('key') as ObjectKey, x!, y!);
  }

  /** OpenLayers keeps x, y, z of corners that were there; new ones get their height from their neighbours. */
  private takeRoadway(feature: Feature<Geometry> | undefined): void {
    const geometry = feature?.getGeometry();
    if (!feature || !(geometry instanceof LineString)) return;
    const key = feature.get('key') as ObjectKey;
    const before = found(this.editing.map, key);
    if (!before) return;
    const line = roadwayOf(before).line;
    const coordinates = geometry.getCoordinates().map((c) => [c[0]!, c[1]!, c[2] || heightNear(line, c[0]!, c[1]!)]);
    this.editing.change(redrawn(this.editing.map, key, coordinates));
  }

  private changeTool(): void {
    if (this.draw) this.map.removeInteraction(this.draw);
    this.draw = null;
    const { tool } = this.editing;
    if (tool === 'select' || tool === 'control') return;
    this.draw = new Draw({ type: tool === 'roadway' ? 'LineString' : 'Point', source: new VectorSource(), style: this.drawStyle() });
    this.draw.on('drawend', (event) => this.drawn(event.feature.getGeometry()));
    this.map.removeInteraction(this.snap); // it has to be the last one
    this.map.addInteraction(this.draw);
    this.map.addInteraction(this.snap);
  }

  abortDrawing(): void {
    this.draw?.abortDrawing();
  }

  private drawn(geometry: Geometry | undefined): void {
    if (geometry instanceof LineString) this.addRoadway(geometry.getCoordinates().map((c): Point3 => [c[0]!, c[1]!, this.floorAt(c[0]!, c[1]!)]));
    else if (geometry instanceof Point) this.addPoint(this.editing.tool, geometry.getCoordinates()[0]!, geometry.getCoordinates()[1]!);
    this.editing.setTool('select');
  }

  private addRoadway(points: Point3[]): void {
    const { map, key } = withRoadway(this.editing.map, points);
    this.editing.change(map, key);
  }

  /** Adds an anchor or a chamber; false where a chamber has no roadway near. */
  addPoint(tool: string, x: number, y: number): boolean {
    const feature = tool === 'anchor' ? newAnchor(this.editing.map, x, y) : newChamber(this.editing.map, x, y);
    if (!feature) return false;
    this.editing.change(added(this.editing.map, feature), keyOf(feature));
    return true;
  }

  /** For a chamber whose place is typed later. */
  addPointOnFirstRoadway(): void {
    const first = this.editing.map.features.find((feature) => feature.properties.object === 'roadway');
    const start = first ? roadwayOf(first).line.points[0] : undefined;
    if (start) this.addPoint('chamber', start[0], start[1]);
  }

  private floorAt(x: number, y: number): number {
    const near = roadwayNear(this.editing.map, x, y, 200);
    return near ? placeAt(near.roadway.line, near.chainage).point[2] : 0;
  }

  private showFindings(): void {
    this.marks.clear();
    for (const finding of this.editing.findings)
      if (finding.place) this.marks.addFeature(new Feature({ geometry: new Point([finding.place.x_m, finding.place.y_m]), severity: finding.severity }));
  }

  private handleStyle(feature: Feature<Geometry>): Style[] {
    const key = feature.get('key') as ObjectKey;
    const selected = key.object === this.editing.selection?.object && key.id === this.editing.selection.id;
    const stroke = new Stroke({ color: this.paint.accent, width: 2 });
    if (key.object !== 'roadway') {
      const radius = selected ? 11 : 6;
      const fill = new Fill({ color: 'rgba(0,0,0,0.01)' }); // can be hit, cannot be seen
      return [new Style({ image: new Circle({ radius, fill, ...(selected ? { stroke } : {}) }) })];
    }
    if (!selected) return [];
    const corners = (feature.getGeometry() as LineString).getCoordinates();
    const fill = new Fill({ color: this.paint.surface });
    return [
      new Style({ stroke: new Stroke({ color: this.paint.accent, width: 2, lineDash: [6, 4] }) }),
      ...corners.map((corner) => new Style({ geometry: new Point(corner), image: new RegularShape({ points: 4, radius: 7, angle: Math.PI / 4, fill, stroke }) })),
    ];
  }

  private markStyle(feature: Feature<Geometry>): Style[] {
    const severity = String(feature.get('severity'));
    const colour = severity === 'error' ? this.paint.bad : severity === 'warning' ? this.paint.warning : this.paint.faint;
    const stroke = new Stroke({ color: colour, width: 3 });
    const shape = severity === 'error' ? { points: 4, radius2: 0, radius: 10, angle: Math.PI / 4 } : { points: severity === 'warning' ? 3 : 4, radius: 12 };
    return [new Style({ image: new RegularShape({ ...shape, stroke }) })];
  }

  private drawStyle(): Style {
    const stroke = new Stroke({ color: this.paint.accent, width: 3 });
    return new Style({ stroke, image: new Circle({ radius: 6, stroke, fill: new Fill({ color: this.paint.surface }) }) });
  }
}

function handleOf(feature: Parameters<typeof idOf>[0], key: ObjectKey): Geometry | null {
  if (key.object === 'roadway' && feature.geometry?.type === 'LineString') return new LineString(feature.geometry.coordinates, 'XYZ');
  if (key.object !== 'anchor') return null;
  const point = pointOf(feature);
  return point ? new Point([point[0], point[1]]) : null;
}

function isSelectedRoadway(key: ObjectKey | undefined, selection: ObjectKey | null): boolean {
  return key?.object === 'roadway' && selection?.object === 'roadway' && key.id === selection.id;
}

function heightNear(line: Centreline, x: number, y: number): number {
  return placeAt(line, footOf(line, x, y).chainage).point[2];
}
