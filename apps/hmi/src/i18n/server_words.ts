/** What the server says, in the reader's language: by the code that comes with it; its own English words where the table has none. */

import { Refusal } from '../protocol/client';
import { texts } from './texts';
import type { TextKey, Translate } from './translate';

/** Where the table knows the code, the server's own words follow in brackets: they name the object and the number. */
export function serverWords(t: Translate, kind: 'error' | 'check', code: string, said: string): string {
  const key = `${kind}_${code}`;
  const known = key in texts ? t(key as TextKey) : '';
  return known === '' ? said : `${known}（${said}）`;
}

export function errorWords(t: Translate, error: unknown): string {
  if (error instanceof Refusal) return serverWords(t, 'error', error.failure.code, error.message);
  return error instanceof Error ? error.message : String(error);
}
