/** The state of the editor: the map with its history, what is selected, what the server says about it. */

import type { MapDocument } from '../model/map_document';
import { Refusal, type Client } from '../protocol/client';
import type { Change, Coverage, Finding, LockInterval } from '../protocol/messages';
import { found, roadwayNear, sameKey, type ObjectKey } from './edits';
import { History } from './history';
import { Latest } from './latest';
import { pointOf, textOf } from '../model/map_document';

export type Tool = 'select' | 'roadway' | 'chamber' | 'anchor' | 'control';
export type EditTopic = 'map' | 'selection' | 'tool' | 'answers' | 'saving';

export interface Saving {
  /** Version that this map began from. */
  version: string;
  state: 'clean' | 'changed' | 'saving' | 'saved' | 'conflict' | 'refused';
  /** What was refused; null where nothing was. */
  why: unknown;
}

export class Editing {
  selection: ObjectKey | null = null;
  tool: Tool = 'select';
  findings: Finding[] = [];
  remarks: string[] = [];
  changes: Change[] = [];
  coverage: Coverage | null = null;
  intervals: LockInterval[] = [];
  /** What the last check refused as no map at all; null when it is one. */
  refusal: unknown = null;
  saving: Saving;

  private history: History<MapDocument>;
  private readonly listeners = new Map<EditTopic, Set<() => void>>();
  private readonly checks: Latest<MapDocument, void>;
  private readonly coverages: Latest<{ map: MapDocument; roadway: string }, Coverage | null>;

  constructor(
    private readonly client: Client,
    map: MapDocument,
    version: string,
  ) {
    this.history = new History(map);
    this.saving = { version, state: 'clean', why: null };
    const fail = (error: unknown): void => this.refused(error);
    this.checks = new Latest((asked) => this.ask(asked), () => this.tell('answers'), fail);
    this.coverages = new Latest(
      async ({ map: asked, roadway }) => (await client.coverage(asked, roadway)).roadways[0] ?? null,
      (coverage) => ((this.coverage = coverage), this.tell('answers')),
      () => ((this.coverage = null), this.tell('answers')),
    );
  }

  get map(): MapDocument {
    return this.history.now;
  }

  get canUndo(): boolean {
    return this.history.canUndo;
  }

  get canRedo(): boolean {
    return this.history.canRedo;
  }

  on(topic: EditTopic, listener: () => void): void {
    const set = this.listeners.get(topic) ?? new Set();
    this.listeners.set(topic, set.add(listener));
  }

  /** Nobody listens any more: the page is made anew, in another language or theme. */
  forget(): void {
    this.listeners.clear();
  }

  change(next: MapDocument, selection: ObjectKey | null = this.selection): void {
    this.history.push(next);
    this.selection = selection;
    this.changed();
  }

  undo(): void {
    this.history.undo();
    this.changed();
  }

  redo(): void {
    this.history.redo();
    this.changed();
  }

  select(key: ObjectKey | null): void {
    if (sameKey(key, this.selection) || key === this.selection) return;
    this.selection = key;
    this.tell('selection');
    this.askCoverage(this.map);
  }

  setTool(tool: Tool): void {
    this.tool = tool;
    this.tell('tool');
  }

  /** Asks the server again about everything; after each change and at the beginning. */
  check(): void {
    this.checks.put(this.map);
    this.askCoverage(this.map);
  }

  /** The strip follows while something is dragged: only its coverage is asked for. */
  preview(map: MapDocument): void {
    this.askCoverage(map);
  }

  async save(): Promise<void> {
    this.setSaving('saving');
    try {
      const version = await this.client.save(this.map, this.saving.version);
      this.saving = { version, state: 'saved', why: null };
      this.tell('saving');
      this.checks.put(this.map);
    } catch (error) {
      const conflict = error instanceof Refusal && error.failure.status === 412;
      this.setSaving(conflict ? 'conflict' : 'refused', error);
    }
  }

  /** Throws away what was drawn and takes the map as it is saved now. */
  async reload(): Promise<void> {
    const { map, version } = await this.client.map();
    this.history = new History(map);
    this.saving = { version, state: 'clean', why: null };
    this.changed();
    this.setSaving('clean');
  }

  /** Keeps what was drawn and takes over the newest version's name, so that the next save replaces it; the diff shows against what. */
  async rebase(): Promise<void> {
    const { version } = await this.client.map();
    this.saving = { version, state: 'changed', why: null };
    this.tell('saving');
    this.checks.put(this.map);
  }

  private changed(): void {
    if (this.selection && !found(this.map, this.selection)) this.selection = null;
    if (this.saving.state !== 'conflict') this.setSaving('changed');
    this.tell('map');
    this.check();
  }

  private setSaving(state: Saving['state'], why: unknown = null): void {
    this.saving = { ...this.saving, state, why };
    this.tell('saving');
  }

  private async ask(map: MapDocument): Promise<void> {
    const [checked, diff, intervals] = await Promise.all([this.client.check(map), this.client.diff(map), this.client.intervalsOf(map)]);
    this.findings = checked.findings;
    this.remarks = checked.remarks;
    this.changes = diff.changes;
    this.intervals = intervals.intervals;
    this.refusal = null;
    if (this.changes.length === 0 && this.saving.state === 'changed') this.setSaving('clean');
  }

  private refused(error: unknown): void {
    this.refusal = error;
    this.tell('answers');
  }

  private askCoverage(map: MapDocument): void {
    const roadway = this.roadwayOfSelection(map);
    if (roadway !== null) this.coverages.put({ map, roadway });
  }

  /** The roadway that the strip shows: the selected one, or the one of the selected object, or the first. */
  private roadwayOfSelection(map: MapDocument): string | null {
    const feature = found(map, this.selection);
    if (feature && this.selection?.object === 'roadway') return this.selection.id;
    const named = feature ? textOf(feature, 'roadway') : '';
    if (named) return named;
    const point = feature ? pointOf(feature) : null;
    const near = point ? roadwayNear(map, point[0], point[1]) : null;
    if (near) return near.roadway.id;
    const first = map.features.find((one) => one.properties.object === 'roadway');
    return this.coverage?.roadway ?? (first ? String(first.properties['id']) : null);
  }

  private tell(topic: EditTopic): void {
    this.listeners.get(topic)?.forEach((listener) => listener());
  }
}
