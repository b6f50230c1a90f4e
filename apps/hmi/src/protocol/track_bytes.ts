/** The binary form of a track (docs/formats/serve.md, "tracks"). */

import { ProtocolError } from './check';

export interface TrackRows {
  stamp: Float64Array;
  columns: Map<string, Float32Array>;
  /** Rows of the window before thinning. */
  total: number;
}

const kHeaderBytes = 24;

export function trackRows(bytes: ArrayBuffer, columnNames: string[]): TrackRows {
  const magic = new TextDecoder().decode(bytes.slice(0, 8));
  if (bytes.byteLength < kHeaderBytes || magic !== 'POSTRK01') throw new ProtocolError('track', magic, 'POSTRK01');
  const view = new DataView(bytes);
  const rows = view.getUint32(8, true);
  const total = view.getUint32(12, true);
  const count = view.getUint32(16, true);
  const wanted = kHeaderBytes + rows * (8 + 4 * count);
  if (bytes.byteLength !== wanted) throw new ProtocolError('track', `${bytes.byteLength} bytes`, `${wanted} bytes`);
  if (columnNames.length !== count) throw new ProtocolError('track', columnNames.join(','), `${count} column names`);
  const columns = new Map<string, Float32Array>();
  columnNames.forEach((name, index) => {
    columns.set(name, new Float32Array(bytes, kHeaderBytes + rows * (8 + 4 * index), rows));
  });
  return { stamp: new Float64Array(bytes, kHeaderBytes, rows), columns, total };
}

/** The bytes of rows; the other direction, for tests and for runs that are put into a page. */
export function trackBytes(stamp: ArrayLike<number>, columns: ArrayLike<number>[]): ArrayBuffer {
  const rows = stamp.length;
  const bytes = new ArrayBuffer(kHeaderBytes + rows * (8 + 4 * columns.length));
  new Uint8Array(bytes).set(new TextEncoder().encode('POSTRK01'));
  const view = new DataView(bytes);
  view.setUint32(8, rows, true);
  view.setUint32(12, rows, true);
  view.setUint32(16, columns.length, true);
  new Float64Array(bytes, kHeaderBytes, rows).set(stamp);
  columns.forEach((column, index) => new Float32Array(bytes, kHeaderBytes + rows * (8 + 4 * index), rows).set(column));
  return bytes;
}
