import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { launched, opened } from '../support/browser';
import { kEnd, mainLine } from '../support/scene';
import { placeAt } from '../../src/model/centreline';
import { trackBytes } from '../../src/protocol/track_bytes';

const kPoints = 1_000_000;
const kWanted = 30;
let browser: Browser;
beforeAll(async () => void (browser = await launched()));
afterAll(() => browser.close());


/** 23 laps of the roadway, there and back, with a scatter of 0.5 m from point to point. */
function longTrack(): ArrayBuffer {
  const length = mainLine.chainage.at(-1)!;
  const [stamp, x, y, error] = [new Float64Array(kPoints), new Float32Array(kPoints), new Float32Array(kPoints), new Float32Array(kPoints)];
  let noise = 1;
  const next = (): number => (noise = (noise * 16807) % 2147483647) / 2147483647 - 0.5;
  for (let i = 0; i < kPoints; ++i) {
    const lap = (i / kPoints) * 23;
    const share = lap % 2 < 1 ? lap % 1 : 1 - (lap % 1);
    const { point } = placeAt(mainLine, share * length);
    stamp[i] = (i * kEnd) / kPoints;
    x[i] = point[0] + next();
    y[i] = point[1] + next();
    error[i] = 3 * Math.abs(next());
  }
  return trackBytes(stamp, [x, y, error]);
}

test(`a million points pan and zoom at ${kWanted} frames a second or more, without a graphics card`, async () => {
  const here = await opened(browser, 'run', (server) => {
    server.bigTrack = longTrack();
    server.stamp = kEnd;
  });
  const { page } = here;
  await page.waitForFunction(() => document.querySelector('.u-legend')?.textContent?.includes('imm'), undefined, { timeout: 60000 });
  await page.locator('.plan-bar select').first().selectOption('error');
  await page.waitForTimeout(1000);

  /** Moves the plan in every frame, with the events that a mouse makes, and counts the frames. */
  const measured = (kind: 'pan' | 'zoom'): Promise<number> =>
    page.evaluate(async (what) => {
      const viewport = document.querySelector('.ol-viewport')!;
      const box = viewport.getBoundingClientRect();
      const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
      const pointer = (type: string, dx: number, dy: number): void => {
        const place = { clientX: x + dx, clientY: y + dy, pointerId: 1, isPrimary: true, pointerType: 'mouse', button: 0, buttons: 1 };
        viewport.dispatchEvent(new PointerEvent(type, { ...place, bubbles: true }));
      };
      const wheel = (step: number): boolean =>
        viewport.dispatchEvent(new WheelEvent('wheel', { clientX: x, clientY: y, deltaY: step, bubbles: true, cancelable: true }));
      if (what === 'pan') pointer('pointerdown', 0, 0);
      const frames = 90;
      const begin = performance.now();
      for (let frame = 0; frame < frames; ++frame) {
        if (what === 'pan') pointer('pointermove', 120 * Math.sin(frame / 8), 80 * Math.sin(frame / 11));
        else wheel(frame % 60 < 30 ? -25 : 25);
        await new Promise(requestAnimationFrame);
      }
      const seconds = (performance.now() - begin) / 1000;
      if (what === 'pan') pointer('pointerup', 0, 0);
      return frames / seconds;
    }, kind);

  const pan = await measured('pan');
  const zoom = await measured('zoom');
  console.log(`${kPoints} points: pan ${pan.toFixed(1)} frames/s, zoom ${zoom.toFixed(1)} frames/s`);
  expect(here.errors).toEqual([]);
  expect(pan).toBeGreaterThanOrEqual(kWanted);
  expect(zoom).toBeGreaterThanOrEqual(kWanted);
  await here.close();
});
