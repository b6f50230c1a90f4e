/** The page that carries its run inside: one file to send or to keep. */

import 'ol/ol.css';
import 'uplot/dist/uPlot.min.css';
import './style/base.css';
import './style/parts.css';
import { embeddedFeed } from './model/embedded_feed';
import { Session } from './model/session';
import { Page } from './page';
import { viewer } from './panels/viewer';
import { h } from './ui/dom';

const root = document.getElementById('app')!;
try {
  const session = new Session(embeddedFeed(document.getElementById('pos-run')!.textContent ?? ''));
  new Page(root, session, { view: viewer, edit: null }).show();
  void session.start();
} catch (error) {
  root.replaceChildren(h('p', { class: 'warnings', role: 'alert' }, error instanceof Error ? error.message : String(error)));
}
