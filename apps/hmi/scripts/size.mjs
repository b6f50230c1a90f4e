// Prints the gzipped size of what the browser loads, and fails above the limit.
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

const kLimitKiB = 300;
const dist = fileURLToPath(new URL('../dist/', import.meta.url));
const size = (file) => gzipSync(readFileSync(join(dist, file)), { level: 9 }).length / 1024;
const pages = { 'index.html and assets': ['index.html', ...readdirSync(join(dist, 'assets')).map((name) => join('assets', name))], 'viewer.html': ['viewer.html'] };
for (const [name, files] of Object.entries(pages)) {
  const total = files.reduce((sum, file) => sum + size(file), 0);
  console.log(`${name}: ${total.toFixed(1)} KiB gzipped (at most ${kLimitKiB})`);
  if (total > kLimitKiB) process.exitCode = 1;
}
