import { readFileSync } from 'node:fs';
import type { Plugin } from 'vite';

/** The head that both pages have, in the place of `<!-- head.html -->`. */
export function commonHead(): Plugin {
  const head = readFileSync(new URL('./head.html', import.meta.url), 'utf8');
  return {
    name: 'common-head',
    transformIndexHtml: { order: 'pre', handler: (page) => page.replace('<!-- head.html -->', () => head) },
  };
}
