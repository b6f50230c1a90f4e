import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, test } from 'vitest';
import { launched, opened, type Opened } from '../support/browser';

let browser: Browser;
let here: Opened;
beforeAll(async () => void (browser = await launched()));
afterAll(() => browser.close());
afterEach(async () => {
  expect(here.errors).toEqual([]);
  await here.close();
});

const byId = (page: Page, id: string) => page.getByTestId(id);
const count = (kind: string): number => here.server.map.features.filter((feature) => feature.properties.object === kind).length;

/** Clicks in the plan, in shares of its width and height. */
async function clickPlan(page: Page, ...places: [number, number][]): Promise<void> {
  const box = (await page.locator('.plan canvas').first().boundingBox())!;
  for (const [x, y] of places) {
    await page.mouse.move(box.x + x * box.width, box.y + y * box.height, { steps: 3 });
    await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
    await page.waitForTimeout(300); // two clicks in a row would be a double click
  }
}

async function changes(page: Page): Promise<string> {
  return byId(page, 'changes').innerText();
}

test('roadway, chamber and anchor are drawn, undone, redone, saved and there again after a reload', async () => {
  here = await opened(browser, 'map');
  const { page, server } = here;
  await expect.poll(() => byId(page, 'saving').innerText()).toContain('As saved');

  await page.locator('[data-tool=roadway]').click();
  await clickPlan(page, [0.1, 0.7], [0.3, 0.7]);
  const box = (await page.locator('.plan canvas').first().boundingBox())!;
  await page.mouse.dblclick(box.x + 0.35 * box.width, box.y + 0.85 * box.height);
  await expect.poll(() => changes(page)).toContain('added roadway R1');
  await page.locator('[data-tool=chamber]').click();
  await clickPlan(page, [0.2, 0.71]);
  await expect.poll(() => changes(page)).toContain('added chamber C1');
  await page.locator('[data-tool=anchor]').click();
  await clickPlan(page, [0.22, 0.69]);
  await expect.poll(() => changes(page)).toContain('added anchor 7');

  await byId(page, 'undo').click();
  await expect.poll(() => changes(page)).not.toContain('anchor 7');
  await byId(page, 'undo').click();
  await expect.poll(() => changes(page)).not.toContain('C1');
  await byId(page, 'redo').click();
  await byId(page, 'redo').click();
  await expect.poll(() => changes(page)).toContain('added anchor 7');

  await byId(page, 'save').click();
  await expect.poll(() => byId(page, 'saving').innerText()).toContain('Saved as version v2');
  expect([count('roadway'), count('chamber'), count('anchor')]).toEqual([3, 4, 7]);
  const chamber = server.map.features.find((feature) => feature.properties['id'] === 'C1')!;
  expect(chamber.properties['roadway']).toBe('R1');

  await page.reload();
  await expect.poll(() => page.locator('[data-testid=object] option').allInnerTexts()).toContain('Chamber C1');
  await expect.poll(() => changes(page)).toContain('No difference');
});

test('a map that somebody else saved in the meantime is not overwritten', async () => {
  here = await opened(browser, 'map');
  const { page, server } = here;
  await byId(page, 'add-typed').selectOption('anchor');
  await expect.poll(() => changes(page)).toContain('added anchor 7');
  server.version += 1;
  await byId(page, 'save').click();
  await expect.poll(() => byId(page, 'saving').innerText()).toContain('somebody else saved');
  expect(count('anchor')).toBe(6);
  expect(await byId(page, 'save').isDisabled()).toBe(true);

  await byId(page, 'rebase').click();
  await byId(page, 'save').click();
  await expect.poll(() => byId(page, 'saving').innerText()).toContain('Saved as version v3');
  expect(count('anchor')).toBe(7);
});

test('typed coordinates move an anchor; a bad place is found by the check and shown', async () => {
  here = await opened(browser, 'map');
  const { page } = here;
  await byId(page, 'object').selectOption('anchor 3');
  await page.locator('input[name="point-0-N"]').fill('900');
  await page.keyboard.press('Tab');
  await expect.poll(() => byId(page, 'findings').innerText()).toContain('anchor 3 is in the rock');
  await expect.poll(() => byId(page, 'finding-count').innerText()).toContain('1 errors');
  await page.keyboard.press('u');
  await page.locator('.plan').focus();
  await page.keyboard.press('u');
  await expect.poll(() => byId(page, 'finding-count').innerText()).toContain('finds nothing');
});

test('the strip of coverage follows an anchor while it is dragged', async () => {
  here = await opened(browser, 'map');
  const { page } = here;
  await byId(page, 'object').selectOption('anchor 1');
  await expect.poll(() => byId(page, 'coverage').innerText()).toContain('main: 1 to 3');
  const before = await byId(page, 'coverage').innerText();
  const place = await page.evaluate(() => {
    const canvas = document.querySelector('.plan canvas')!.getBoundingClientRect();
    return { x: canvas.x, y: canvas.y, width: canvas.width, height: canvas.height };
  });
  // The first anchor lies at E 20, N 2.5; the plan shows E 0 to 322 and N -220 to 104 with its borders.
  const resolution = Math.max(322 / (place.width - 80), 324 / (place.height - 130));
  const x = place.x + place.width / 2 + (20 - 161) / resolution;
  const y = place.y + place.height / 2 + 5 - (2.5 + 58) / resolution;
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y, { steps: 4 });
  await page.mouse.move(x + 90, y, { steps: 4 });
  await expect.poll(() => byId(page, 'coverage').innerText()).not.toBe(before);
  expect(await changes(page)).toContain('No difference'); // still in the hand
  await page.mouse.up();
  await expect.poll(() => changes(page)).toContain('changed anchor 1');
});

test('a roadway, a chamber and an anchor are made with the keyboard alone', async () => {
  here = await opened(browser, 'map');
  const { page } = here;
  await byId(page, 'add-typed').focus();
  for (const word of ['Roadway', 'Chamber', 'Anchor']) {
    await byId(page, 'add-typed').focus();
    await page.keyboard.type(word);
    await page.keyboard.press('Enter');
  }
  await expect.poll(() => changes(page)).toContain('added anchor 7');
  expect(await page.evaluate(() => document.activeElement?.getAttribute('name'))).toBe('id');
  const place = page.locator('input[name="point-0-E"]');
  await place.focus();
  await page.keyboard.press('ControlOrMeta+A');
  await page.keyboard.type('123.4');
  await page.keyboard.press('Enter');
  await byId(page, 'save').focus();
  await page.keyboard.press('Enter');
  await expect.poll(() => byId(page, 'saving').innerText()).toContain('Saved as version');
  expect([count('roadway'), count('chamber'), count('anchor')]).toEqual([3, 4, 7]);
  const anchor = here.server.map.features.find((feature) => feature.properties['id'] === 7)!;
  expect((anchor.geometry!.coordinates as number[])[0]).toBe(123.4);
});
