/** Light and dark. The choice is kept in the browser; without one the system's wish counts. */

export type Theme = 'light' | 'dark';

const kKey = 'pos.theme';

export function chosenTheme(storage: Storage | null, systemIsDark: boolean): Theme {
  const kept = storage?.getItem(kKey);
  if (kept === 'light' || kept === 'dark') return kept;
  return systemIsDark ? 'dark' : 'light';
}

export function applyTheme(theme: Theme, storage: Storage | null): void {
  document.documentElement.dataset['theme'] = theme;
  storage?.setItem(kKey, theme);
}

/** Browser storage, or null where the page may not use it (a file opened from disk). */
export function browserStorage(): Storage | null {
  try {
    return window.localStorage;
  } catch {
    return null;
  }
}

/** What canvases are painted with, read from the style sheet so that colours have one home. */
export interface Paint {
  text: string;
  faint: string;
  rock: string;
  road: string;
  roadEdge: string;
  surface: string;
  accent: string;
  warning: string;
  bad: string;
  good: string;
  free: string;
  locked: string;
  tracks: string[];
  scale: string[];
}

export function currentPaint(): Paint {
  const style = getComputedStyle(document.documentElement);
  const one = (name: string): string => style.getPropertyValue(`--${name}`).trim();
  const several = (name: string, count: number): string[] =>
    Array.from({ length: count }, (_, index) => one(`${name}-${index + 1}`));
  return {
    text: one('text'),
    faint: one('faint'),
    rock: one('rock'),
    road: one('road'),
    roadEdge: one('road-edge'),
    surface: one('surface'),
    accent: one('accent'),
    warning: one('warning'),
    bad: one('bad'),
    good: one('good'),
    free: one('free'),
    locked: one('locked'),
    tracks: several('track', 6),
    scale: several('scale', 6),
  };
}
