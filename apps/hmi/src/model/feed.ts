/** Where everything comes from: a server, or a run that lies in the page itself. */

import type { Command } from '../protocol/client';
import type { Info, LockInterval, RunEvent, State } from '../protocol/messages';
import type { TrackRows } from '../protocol/track_bytes';
import type { MapDocument } from './map_document';

export interface FeedListener {
  state(state: State): void;
  event(event: RunEvent): void;
  /** Tracks and events no longer hold and have to be loaded again. */
  reset(): void;
  /** Something came, whatever it was: the source of all this is alive. */
  alive(): void;
}

export interface Feed {
  info: Info;
  map: MapDocument | null;
  intervals: LockInterval[];
  /** Address of the background picture, null when the map has none. */
  background: string | null;
  track(name: string, from_s: number | null): Promise<TrackRows>;
  events(after: number): Promise<RunEvent[]>;
  command(command: Command): Promise<void>;
  /** Begins to tell; what comes back ends it. */
  listen(listener: FeedListener): () => void;
}
