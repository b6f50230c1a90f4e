import { createRequire } from 'node:module';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { launched, opened } from '../support/browser';
import type { SceneMode } from '../support/scene';

const axe = createRequire(import.meta.url).resolve('axe-core/axe.min.js');
let browser: Browser;
beforeAll(async () => void (browser = await launched()));
afterAll(() => browser.close());

interface Violation {
  id: string;
  impact: string;
  nodes: { html: string }[];
}

for (const mode of ['run', 'live', 'map'] as SceneMode[]) {
  test(`axe-core finds no serious fault in mode ${mode}, light and dark`, async () => {
    const here = await opened(browser, mode, (server) => server.rejected.add(1));
    const { page } = here;
    if (mode === 'map') await page.getByTestId('object').selectOption('roadway main');
    await page.waitForTimeout(800);
    for (const theme of ['light', 'dark']) {
      await page.addScriptTag({ path: axe });
      const violations = await page.evaluate(async () => {
        const runner = (window as unknown as { axe: { run(): Promise<{ violations: Violation[] }> } }).axe;
        return (await runner.run()).violations;
      });
      const serious = violations.filter((one) => one.impact === 'serious' || one.impact === 'critical');
      const told = serious.map((one) => `${theme}: ${one.id} (${one.impact}): ${one.nodes.map((node) => node.html.slice(0, 140)).join(' | ')}`);
      console.log(`${mode}, ${theme}: ${violations.length} findings, ${serious.length} serious`);
      expect(told).toEqual([]);
      await page.getByTestId('theme').click();
      await page.waitForTimeout(300);
    }
    await here.close();
  });
}
