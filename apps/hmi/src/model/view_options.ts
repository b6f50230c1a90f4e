/** What the reader chose to see. */

export type ColourBy = 'estimator' | 'error' | 'zone';

export interface Choices {
  follow: boolean;
  colourBy: ColourBy;
  /** Minutes of track shown before now; null for all of it. */
  trailMinutes: number | null;
  hidden: ReadonlySet<string>;
  main: string | null;
}

export class ViewOptions {
  private choices: Choices = { follow: false, colourBy: 'estimator', trailMinutes: null, hidden: new Set(), main: null };
  private readonly listeners = new Set<() => void>();

  get now(): Choices {
    return this.choices;
  }

  set(change: Partial<Choices>): void {
    const keys = Object.keys(change) as (keyof Choices)[];
    if (keys.every((key) => this.choices[key] === change[key])) return;
    this.choices = { ...this.choices, ...change };
    this.listeners.forEach((listener) => listener());
  }

  toggle(name: string): void {
    const hidden = new Set(this.choices.hidden);
    if (!hidden.delete(name)) hidden.add(name);
    this.set({ hidden });
  }

  on(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }
}
