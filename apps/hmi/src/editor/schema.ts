/** The properties that the panel offers for each kind of object; keys, units and choices are those of the map file. */

export type Field =
  | { key: string; type: 'number'; unit: string; needed?: true }
  | { key: string; type: 'text'; needed?: true }
  | { key: string; type: 'flag' }
  | { key: string; type: 'choice'; choices: readonly string[]; needed?: true };

const id: Field = { key: 'id', type: 'text', needed: true };
const name: Field = { key: 'name', type: 'text' };
const metres = (key: string, needed?: true): Field => ({ key, type: 'number', unit: 'm', ...(needed ? { needed } : {}) });
const choice = (key: string, ...choices: string[]): Field => ({ key, type: 'choice', choices });
const onRoadway: Field[] = [{ key: 'roadway', type: 'text', needed: true }, metres('chainage_m', true)];

export const kFields: Record<string, Field[]> = {
  roadway: [
    id,
    name,
    { key: 'level', type: 'text' },
    metres('width_m', true),
    metres('height_m', true),
    choice('section', 'rectangle', 'arch'),
    { key: 'lanes', type: 'number', unit: '' },
    choice('traffic', 'both_ways', 'forward_only', 'backward_only'),
    { key: 'speed_limit_m_per_s', type: 'number', unit: 'm/s' },
    { key: 'locked', type: 'flag' },
    metres('chainage_start_m'),
  ],
  chamber: [
    id,
    name,
    ...onRoadway,
    { key: 'side', type: 'choice', choices: ['left', 'right'], needed: true },
    choice('kind', 'passing', 'refuge'),
    metres('length_m', true),
    metres('depth_m'),
    { key: 'capacity', type: 'number', unit: '' },
    metres('detection_sigma_m'),
  ],
  anchor: [
    { key: 'id', type: 'number', unit: '', needed: true },
    name,
    metres('survey_sigma_m'),
    { key: 'survey_date', type: 'text' },
    choice('wall', 'left', 'right', 'roof', 'floor', 'post'),
    metres('range_bias_m'),
    { key: 'antenna_delay_s', type: 'number', unit: 's' },
  ],
  junction: [id, name],
  bend: [id, name, { key: 'roadway', type: 'text', needed: true }, metres('from_m', true), metres('to_m', true)],
  portal: [id, name, ...onRoadway, metres('handover_from_m', true), metres('handover_to_m', true)],
  light: [id, ...onRoadway, choice('side', 'left', 'right'), choice('controls', 'forward', 'backward')],
  stop_line: [id, ...onRoadway, choice('controls', 'forward', 'backward'), { key: 'light', type: 'text' }],
  zone: [
    id,
    name,
    { key: 'roadway', type: 'text', needed: true },
    metres('from_m', true),
    metres('to_m', true),
    choice('kind', 'no_entry', 'no_meeting', 'speed_limit'),
    { key: 'speed_limit_m_per_s', type: 'number', unit: 'm/s' },
  ],
  map: [{ key: 'name', type: 'text', needed: true }, choice('driving_side', 'left', 'right')],
};

/** Kinds whose objects the list shows first; others follow as they are in the map. */
export const kKinds = ['roadway', 'chamber', 'anchor', 'junction', 'portal', 'light', 'stop_line', 'bend', 'zone', 'crossing', 'route', 'map'];
