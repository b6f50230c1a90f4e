/** An OpenLayers map of a plane in metres: east to the right, north up, no rotation. */

import OlMap from 'ol/Map';
import View from 'ol/View';
import { Projection } from 'ol/proj';
import { defaults as defaultInteractions } from 'ol/interaction/defaults';
import ScaleLine from 'ol/control/ScaleLine';
import type BaseLayer from 'ol/layer/Base';

export const plane = new Projection({ code: 'POS:PLANE', units: 'm', metersPerUnit: 1 });

export type Extent = [number, number, number, number];

export function planeMap(target: HTMLElement, layers: BaseLayer[]): OlMap {
  const view = new View({
    projection: plane,
    center: [0, 0],
    resolution: 1,
    minResolution: 0.002,
    maxResolution: 200,
    enableRotation: false,
    constrainResolution: false,
  });
  return new OlMap({
    target,
    layers,
    view,
    controls: [new ScaleLine({ minWidth: 80 })],
    interactions: defaultInteractions({ altShiftDragRotate: false, pinchRotate: false, doubleClickZoom: false, zoomDuration: 120 }),
    moveTolerance: 3,
  });
}

export function fit(map: OlMap, extent: Extent | null): void {
  if (extent === null) return;
  map.updateSize();
  map.getView().fit(extent, { padding: [60, 40, 70, 40], minResolution: 0.02 });
}

export function zoomBy(map: OlMap, factor: number): void {
  const view = map.getView();
  const resolution = view.getResolution();
  if (resolution !== undefined) view.animate({ resolution: resolution / factor, duration: 120 });
}
