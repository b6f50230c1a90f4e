/** Start and stop of the recording of a live feed. */

import type { Context, Panel } from '../model/context';
import { bytes } from '../model/words';
import { h, setText } from '../ui/dom';

export function recordingPanel(context: Context): Panel {
  const { t, session } = context;
  const button = h('button', { type: 'button', 'data-testid': 'record', onclick: () => toggle() });
  const words = h('p', { class: 'faint', 'data-testid': 'recording' });
  const element = h('section', { class: 'card', 'aria-label': t('recording'), hidden: true }, h('h2', {}, t('recording')), button, words);

  function toggle(): void {
    void session.command({ do: 'record', on: !(session.state?.recording?.on ?? false) });
  }

  function update(): void {
    const recording = session.state?.recording ?? null;
    element.hidden = recording === null;
    if (!recording) return;
    setText(button, recording.on ? `■ ${t('recordStop')}` : `● ${t('recordStart')}`);
    const size = bytes(recording.bytes);
    const refused = session.state?.refused_lines ?? 0;
    const told = recording.on
      ? t('recordingTo', { file: recording.file ?? '', count: recording.measurements, size })
      : t('notRecording');
    setText(words, refused > 0 ? `${told} ${t('refusedLines', { count: refused })}` : told);
  }
  return { element, update };
}
