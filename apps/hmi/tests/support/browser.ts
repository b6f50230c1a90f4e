/** Debian's Chromium without a window. Nothing is ever downloaded. */

import { execFileSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { chromium, type Browser, type Page } from 'playwright-core';
import { FakeServer } from './fake_server';
import type { SceneMode } from './scene';

export const pages = fileURLToPath(new URL('../../dist', import.meta.url));

export async function launched(): Promise<Browser> {
  const named = process.env['POS_CHROMIUM'];
  const executablePath = named ?? execFileSync('sh', ['-c', 'command -v chromium']).toString().trim();
  return chromium.launch({ executablePath, args: ['--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage'] });
}

export interface Opened {
  page: Page;
  server: FakeServer;
  /** Errors of the page's scripts; a test that ends with any has failed. */
  errors: string[];
  close(): Promise<void>;
}

/** A page in front of a fake server. */
export async function opened(browser: Browser, mode: SceneMode, prepare?: (server: FakeServer) => void): Promise<Opened> {
  const server = new FakeServer(mode, pages);
  prepare?.(server);
  const address = await server.start();
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, locale: 'en-GB' });
  const page = await context.newPage();
  const errors: string[] = [];
  page.on('pageerror', (error) => errors.push(String(error)));
  await page.goto(address);
  await page.waitForSelector('header.top');
  const close = async (): Promise<void> => {
    await context.close();
    await server.stop();
  };
  return { page, server, errors, close };
}
