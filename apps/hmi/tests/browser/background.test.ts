/** The background plan: drawn where its control points say, in viewer and editor, and moved with them. */

import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, test } from 'vitest';
import { launched, opened, type Opened } from '../support/browser';
import type { FakeServer } from '../support/fake_server';

let browser: Browser;
let here: Opened;
beforeAll(async () => void (browser = await launched()));
afterAll(() => browser.close());
afterEach(async () => {
  expect(here.errors).toEqual([]);
  await here.close();
});

/** A red sheet of 100 x 50 pixels, each 2 m wide and 1 m high: from `x` 200 m to the east, from -100 m 50 m to the south. */
function withRedSheet(server: FakeServer, x = 40): void {
  server.background = '<svg xmlns="http://www.w3.org/2000/svg" width="100" height="50"><rect width="100" height="50" fill="#f00"/></svg>';
  const corner = (column: number, row: number) => ({ column, row, x_m: x + 2 * column, y_m: -100 - row });
  const site = server.map.features.find((feature) => feature.properties.object === 'map')!;
  site.properties['background'] = { file: 'plan.svg', control_points: [corner(0, 0), corner(100, 0), corner(0, 50)] };
}

/** Pixels between the first and the last red one, right and down; null while nothing is red. */
async function redBox(page: Page): Promise<{ left: number; width: number; height: number } | null> {
  return page.evaluate(() => {
    const box = { left: Infinity, right: -1, top: Infinity, bottom: -1 };
    for (const canvas of document.querySelectorAll<HTMLCanvasElement>('.plan canvas')) {
      const { data, width } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
      for (let at = 0; at < data.length; at += 4) {
        if (data[at]! < 200 || data[at + 1]! > 20 || data[at + 2]! > 20 || data[at + 3]! < 100 || data[at + 3]! > 200) continue;
        const [column, row] = [(at / 4) % width, Math.floor(at / 4 / width)];
        box.left = Math.min(box.left, column);
        box.right = Math.max(box.right, column);
        box.top = Math.min(box.top, row);
        box.bottom = Math.max(box.bottom, row);
      }
    }
    return box.right < 0 ? null : { left: box.left, width: box.right - box.left + 1, height: box.bottom - box.top + 1 };
  });
}

async function shape(page: Page): Promise<number | null> {
  const box = await redBox(page);
  return box ? box.width / box.height : null;
}

test('the picture lies under the plan where its control points say', async () => {
  here = await opened(browser, 'run', withRedSheet);
  await expect.poll(() => shape(here.page)).toBeGreaterThan(3.8); // 200 m by 50 m
  expect(await shape(here.page)).toBeLessThan(4.2);
});

test('without a picture nothing is drawn and nothing is asked for', async () => {
  here = await opened(browser, 'run');
  await here.page.waitForTimeout(300);
  expect(await redBox(here.page)).toBeNull();
});

test('typing another place of a control point moves the picture and tells the misfit', async () => {
  here = await opened(browser, 'map', withRedSheet);
  const { page } = here;
  await expect.poll(() => shape(page)).toBeGreaterThan(3.8);
  await page.getByTestId('object').selectOption('map ');
  await expect.poll(() => page.locator('.points').innerText()).toContain('0.00 m');
  // The upper right corner of the sheet 100 m nearer: it is half as wide now.
  const east = page.locator('.points tbody tr').nth(1).locator('input').nth(2);
  await east.fill('140');
  await east.press('Enter');
  await expect.poll(() => shape(page)).toBeLessThan(2.2);
  expect(await shape(page)).toBeGreaterThan(1.8);
});
