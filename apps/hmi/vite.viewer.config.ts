import { defineConfig, type Plugin } from 'vite';
import { commonHead } from './vite.head';

/** One file: scripts and styles are put into the page, so that it opens from disk and needs no other file. */
function insideThePage(): Plugin {
  return {
    name: 'inside-the-page',
    enforce: 'post',
    generateBundle(_, bundle) {
      const page = bundle['viewer.html'];
      if (page?.type !== 'asset') throw new Error('viewer.html is not among what was built');
      let html = String(page.source);
      for (const [name, part] of Object.entries(bundle)) {
        const text = part.type === 'chunk' ? part.code : String(part.source);
        const file = name.replaceAll('.', '\\.');
        const script = new RegExp(`<script[^>]*src="[^"]*${file}"[^>]*></script>`);
        const style = new RegExp(`<link[^>]*href="[^"]*${file}"[^>]*>`);
        if (name.endsWith('.js')) html = moved(html, script, '', `<script type="module">${text.replaceAll('</script', '<\\/script')}</script>`);
        else if (name.endsWith('.css')) html = html.replace(style, () => `<style>${text}</style>`);
        else continue;
        delete bundle[name];
      }
      page.source = html;
    },
  };
}

/** A script in the page runs at once, so it goes to the end of the body. */
function moved(html: string, from: RegExp, left: string, script: string): string {
  return html.replace(from, left).replace('</body>', () => `${script}\n</body>`);
}

export default defineConfig({
  base: './',
  plugins: [commonHead(), insideThePage()],
  build: {
    outDir: 'dist',
    emptyOutDir: false,
    target: 'es2022',
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: 1e7,
    rollupOptions: { input: 'viewer.html', output: { inlineDynamicImports: true } },
  },
});
