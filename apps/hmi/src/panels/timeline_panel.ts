/** Play, pause, seek, speed, and where on the time axis something happened. */

import type { Context, Panel } from '../model/context';
import { clock } from '../model/words';
import type { RunEvent } from '../protocol/messages';
import { h, replaceChildren, setText } from '../ui/dom';
import { isTrouble } from './event_words';

const kSpeeds = [0.25, 0.5, 1, 2, 5, 10, 50, 200];

export interface TimelinePanel extends Panel {
  toggle(): void;
  step(seconds: number): void;
  faster(steps: number): void;
  seek(stamp: number): void;
  showEvents(): void;
}

export function timelinePanel(context: Context): TimelinePanel {
  const { t, session, paint } = context;
  const play = h('button', { type: 'button', class: 'primary', 'data-testid': 'play', onclick: () => toggle() });
  const slider = h('input', { type: 'range', min: 0, max: 1000, step: 1, value: 0, 'aria-label': t('seek'), 'data-testid': 'seek' });
  const now = h('output', { class: 'clock', 'data-testid': 'clock' });
  const speed = h('select', { 'aria-label': t('playSpeed'), onchange: () => setSpeed(Number(speed.value)) });
  replaceChildren(speed, ...kSpeeds.map((value) => h('option', { value }, `${value}×`)));
  const marks = h('canvas', { class: 'marks', 'aria-hidden': 'true' });
  const track = h('div', { class: 'track' }, marks, slider);
  const element = h('footer', { class: 'timeline', 'aria-label': t('timeline') }, play, speed, track, now);
  let dragging = false;

  const first = (): number | null => session.state?.first_s ?? session.feed.info.first_s;
  const last = (): number | null => session.state?.last_s ?? session.feed.info.last_s ?? session.state?.stamp_s ?? null;

  slider.addEventListener('input', () => {
    dragging = true;
    const [from, to] = [first(), last()];
    if (from !== null && to !== null) seek(from + ((to - from) * Number(slider.value)) / 1000);
  });
  slider.addEventListener('change', () => (dragging = false));
  new ResizeObserver(() => showEvents()).observe(marks);

  function toggle(): void {
    void session.command({ do: session.state?.playing ? 'pause' : 'play' });
  }

  function seek(stamp: number): void {
    const [from, to] = [first(), last()];
    if (from === null || to === null || session.state?.mode === 'live') return;
    void session.command({ do: 'seek', stamp_s: Math.min(to, Math.max(from, stamp)) });
  }

  function step(seconds: number): void {
    const stamp = session.state?.stamp_s;
    if (stamp !== null && stamp !== undefined) seek(stamp + seconds);
  }

  function setSpeed(value: number): void {
    void session.command({ do: 'speed', speed: value });
  }

  function faster(steps: number): void {
    const at = kSpeeds.findIndex((value) => value >= (session.state?.speed ?? 1));
    setSpeed(kSpeeds[Math.min(kSpeeds.length - 1, Math.max(0, at + steps))]!);
  }

  function update(): void {
    const state = session.state;
    const fixed = state?.mode === 'live' || state?.mode === 'map';
    for (const control of [play, speed, slider]) control.hidden = fixed;
    setText(play, state?.playing ? `❚❚ ${t('pause')}` : `▶ ${t('play')}`);
    if (state && document.activeElement !== speed) speed.value = String(state.speed);
    const [from, to, stamp] = [first(), last(), state?.stamp_s ?? null];
    if (from === null || to === null || stamp === null) return;
    const words = state?.mode === 'live' ? clock(stamp - from) : `${clock(stamp - from)} / ${clock(to - from)}`;
    setText(now, state?.seeking ? `${words} …` : words);
    slider.setAttribute('aria-valuetext', words);
    if (!dragging && to > from) slider.value = String(Math.round((1000 * (stamp - from)) / (to - from)));
  }

  function showEvents(): void {
    const [from, to] = [first(), last()];
    marks.width = marks.clientWidth * devicePixelRatio;
    marks.height = marks.clientHeight * devicePixelRatio;
    const pen = marks.getContext('2d');
    if (!pen || from === null || to === null || to <= from) return;
    for (const event of session.events) paintMark(pen, marks, event, (x) => (x - from) / (to - from));
  }

  /** Trouble reaches over the whole height, other events over the lower half. */
  function paintMark(pen: CanvasRenderingContext2D, canvas: HTMLCanvasElement, event: RunEvent, share: (x: number) => number): void {
    if (event.stamp_s === null) return;
    const trouble = isTrouble(event);
    pen.fillStyle = trouble ? paint.bad : paint.faint;
    const height = trouble ? canvas.height : canvas.height / 2;
    pen.fillRect(share(event.stamp_s) * canvas.width, canvas.height - height, trouble ? 2 * devicePixelRatio : devicePixelRatio, height);
  }

  return { element, update, toggle, step, faster, seek, showEvents };
}
