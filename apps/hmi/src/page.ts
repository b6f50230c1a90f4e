/** The page around the views: name, badge, language, theme, keys, warnings. */

import { errorWords } from './i18n/server_words';
import { chosenLanguage, translator, type Language } from './i18n/translate';
import type { Context } from './model/context';
import type { Session } from './model/session';
import { ViewOptions } from './model/view_options';
import type { View } from './panels/viewer';
import { h, replaceChildren, setText } from './ui/dom';
import { bindKeys, keysDialog, type KeyBinding } from './ui/keys';
import { applyTheme, browserStorage, chosenTheme, currentPaint, type Theme } from './ui/theme';

/** Makes a view; the page calls it again when language or theme change. */
export type ViewMaker = (context: Context) => View;

export interface NamedViews {
  view: ViewMaker;
  edit: ViewMaker | null;
}

const kBadges = { live: 'badgeLive', replay: 'badgeReplay', run: 'badgeRun', map: 'editMap' } as const;

export class Page {
  private readonly storage = browserStorage();
  private readonly options = new ViewOptions();
  private language: Language;
  private theme: Theme;
  private editing: boolean;
  private endKeys = (): void => undefined;
  private view: View | null = null;

  constructor(
    private readonly root: HTMLElement,
    private readonly session: Session,
    private readonly views: NamedViews,
  ) {
    this.language = chosenLanguage(this.storage?.getItem('pos.language'), navigator.language);
    this.theme = chosenTheme(this.storage, matchMedia('(prefers-color-scheme: dark)').matches);
    this.editing = session.feed.info.mode === 'map' && views.edit !== null;
    this.session.on('link', () => this.showWarnings());
    this.session.on('failure', () => this.showWarnings());
  }

  private readonly warnings = h('div', { class: 'warnings', role: 'alert' });

  show(): void {
    applyTheme(this.theme, this.storage);
    document.documentElement.lang = this.language === 'zh' ? 'zh-CN' : 'en';
    const t = translator(this.language);
    const context: Context = { session: this.session, options: this.options, t, paint: currentPaint() };
    document.title = `${this.session.feed.info.name || this.session.feed.info.map} · pos`;
    this.view?.close();
    const maker = this.editing && this.views.edit ? this.views.edit : this.views.view;
    this.view = maker(context);
    const bindings = [...this.view.keys, ...this.pageKeys()];
    const dialog = keysDialog(t, bindings, [{ shown: '← → ↑ ↓', text: 'keyPan' }]);
    bindings.push({ keys: ['?'], shown: '?', text: 'keyHelp', run: () => dialog.showModal() });
    const header = this.header(context, () => dialog.showModal());
    replaceChildren(this.root, header, this.warnings, h('main', { id: 'main' }, this.view.element), dialog);
    this.endKeys();
    this.endKeys = bindKeys(bindings);
    this.showWarnings();
  }

  private header(context: Context, help: () => void): HTMLElement {
    const { t } = context;
    const { info } = this.session.feed;
    const badge = h('span', { class: `badge badge-${info.mode}`, 'data-testid': 'badge' }, t(kBadges[info.mode]));
    const button = (words: string, run: () => void, testId: string): HTMLElement =>
      h('button', { type: 'button', onclick: run, 'data-testid': testId }, words);
    const edit = this.views.edit ? button(this.editing ? t('view') : t('editMap'), () => this.toggleEdit(), 'edit') : null;
    return h(
      'header',
      { class: 'top' },
      h('h1', {}, info.name || info.map || t('title')),
      badge,
      h('span', { class: 'gap' }),
      info.mode === 'map' ? null : edit,
      button(this.theme === 'dark' ? `☀ ${t('themeLight')}` : `☾ ${t('themeDark')}`, () => this.toggleTheme(), 'theme'),
      button(t('language'), () => this.toggleLanguage(), 'language'),
      button(t('keys'), help, 'keys'),
    );
  }

  private pageKeys(): KeyBinding[] {
    const keys: KeyBinding[] = [
      { keys: ['t'], shown: 'T', text: 'keyTheme', run: () => this.toggleTheme() },
      { keys: ['l'], shown: 'L', text: 'keyLanguage', run: () => this.toggleLanguage() },
    ];
    if (this.views.edit && this.session.feed.info.mode !== 'map')
      keys.push({ keys: ['e'], shown: 'E', text: 'keyEdit', run: () => this.toggleEdit() });
    return keys;
  }

  private toggleEdit(): void {
    this.editing = !this.editing;
    this.show();
  }

  private toggleTheme(): void {
    this.theme = this.theme === 'dark' ? 'light' : 'dark';
    this.show();
  }

  private toggleLanguage(): void {
    this.language = this.language === 'en' ? 'zh' : 'en';
    this.storage?.setItem('pos.language', this.language);
    this.show();
  }

  private showWarnings(): void {
    const t = translator(this.language);
    const { silentFor, failure } = this.session;
    const words = [
      silentFor === null ? '' : t('serverGone', { seconds: silentFor }),
      failure === null ? '' : t('failed', { why: errorWords(t, failure) }),
    ].filter(Boolean);
    setText(this.warnings, words.map((one) => `⚠ ${one}`).join('  '));
    this.warnings.hidden = words.length === 0;
  }
}
