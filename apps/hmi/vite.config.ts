import { defineConfig } from 'vitest/config';
import { commonHead } from './vite.head';

/** The page that `pos serve` hands out; during development it asks a server on the usual port. */
export default defineConfig({
  base: './',
  plugins: [commonHead()],
  build: { outDir: 'dist', target: 'es2022', modulePreload: false, chunkSizeWarningLimit: 900 },
  server: { proxy: { '/api': 'http://127.0.0.1:8765' } },
  test: {
    projects: [
      { test: { name: 'unit', include: ['tests/unit/**/*.test.ts'] } },
      ...['browser', 'speed'].map((name) => ({
        test: {
          name,
          include: [`tests/${name}/**/*.test.ts`],
          testTimeout: 120000,
          hookTimeout: 120000,
          expect: { poll: { timeout: 15000 } },
          poolOptions: { forks: { singleFork: true } },
        },
      })),
    ],
  },
});
