/** The page that `pos serve` hands out. */

import 'ol/ol.css';
import 'uplot/dist/uPlot.min.css';
import './style/base.css';
import './style/parts.css';
import { Editing } from './editor/editing';
import { editor } from './editor/editor';
import { serverFeed } from './model/server_feed';
import { Session } from './model/session';
import { Page, type ViewMaker } from './page';
import { viewer } from './panels/viewer';
import { Client, Refusal } from './protocol/client';
import { h } from './ui/dom';

async function start(root: HTMLElement): Promise<void> {
  const client = new Client('');
  const session = new Session(await serverFeed(client));
  const edit = await editMaker(client);
  new Page(root, session, { view: viewer, edit }).show();
  await session.start();
}

/** The editor, where there is a map. */
async function editMaker(client: Client): Promise<ViewMaker | null> {
  try {
    const { map, version } = await client.map();
    const editing = new Editing(client, map, version);
    return (context) => editor(context, editing, client.backgroundAddress());
  } catch (error) {
    if (error instanceof Refusal && error.failure.status === 404) return null;
    throw error;
  }
}

const root = document.getElementById('app')!;
start(root).catch((error: unknown) => {
  root.replaceChildren(h('p', { class: 'warnings', role: 'alert' }, error instanceof Error ? error.message : String(error)));
});
