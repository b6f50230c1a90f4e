/** What every part of the page is given. */

import type { Translate } from '../i18n/translate';
import type { EstimatorNow } from '../protocol/messages';
import type { Paint } from '../ui/theme';
import type { Session } from './session';
import type { ViewOptions } from './view_options';

export interface Context {
  session: Session;
  options: ViewOptions;
  t: Translate;
  paint: Paint;
}

/** A part of the page; `update` shows what is known now. */
export interface Panel {
  element: HTMLElement;
  update(): void;
}

/** The estimator whose place, models and errors are told in words. */
export function mainEstimator(context: Context): EstimatorNow | null {
  const all = context.session.state?.estimators ?? [];
  return all.find((estimator) => estimator.name === context.options.now.main) ?? all[0] ?? null;
}

/** Names of all tracks that may be drawn, the truth first; their order gives colour and dash. */
export function trackNames(context: Context): string[] {
  return context.session.feed.info.tracks;
}

const kDashes = [[], [9, 4], [3, 3], [12, 3, 3, 3], [6, 6], [2, 5]];

export interface Line {
  colour: string;
  dash: number[];
}

export function lineOf(context: Context, name: string): Line {
  if (name === 'truth') return { colour: context.paint.text, dash: [] };
  const index = Math.max(0, context.session.feed.info.estimators.findIndex((estimator) => estimator.name === name));
  const { tracks } = context.paint;
  return { colour: tracks[index % tracks.length]!, dash: kDashes[index % kDashes.length]! };
}
