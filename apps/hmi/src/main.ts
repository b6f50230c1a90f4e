/** The page that `pos serve` hands out. */

import 'ol/ol.css';
import 'uplot/dist/uPlot.min.css';
import './style/base.css';
import './style/parts.css';
import { serverFeed } from './model/server_feed';
import { Session } from './model/session';
import { Page } from './page';
import { viewer } from './panels/viewer';
import { Client } from './protocol/client';
import { h } from './ui/dom';

async function start(root: HTMLElement): Promise<void> {
  const client = new Client('');
  const session = new Session(await serverFeed(client));
  new Page(root, session, { view: viewer, edit: null }).show();
  await session.start();
}

const root = document.getElementById('app')!;
start(root).catch((error: unknown) => {
  root.replaceChildren(h('p', { class: 'warnings', role: 'alert' }, error instanceof Error ? error.message : String(error)));
});
