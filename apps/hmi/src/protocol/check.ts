/** Reads values that came over the wire. What does not fit is refused with its path, what was got and what was expected. */

export class ProtocolError extends Error {
  constructor(path: string, got: unknown, expected: string) {
    super(`${path || 'answer'}: got ${shown(got)}, expected ${expected}`);
    this.name = 'ProtocolError';
  }
}

function shown(value: unknown): string {
  const text = value === undefined ? 'nothing' : JSON.stringify(value);
  return text.length > 60 ? `${text.slice(0, 57)}...` : text;
}

export type Reader<T> = (value: unknown, path: string) => T;
export type Fields = Record<string, unknown>;

export const number: Reader<number> = (value, path) => {
  if (typeof value !== 'number' || !Number.isFinite(value)) throw new ProtocolError(path, value, 'a number');
  return value;
};

export const text: Reader<string> = (value, path) => {
  if (typeof value !== 'string') throw new ProtocolError(path, value, 'a text');
  return value;
};

export const truth: Reader<boolean> = (value, path) => {
  if (typeof value !== 'boolean') throw new ProtocolError(path, value, 'true or false');
  return value;
};

export const fields: Reader<Fields> = (value, path) => {
  if (typeof value !== 'object' || value === null || Array.isArray(value)) throw new ProtocolError(path, value, 'an object');
  return value as Fields;
};

export function list<T>(item: Reader<T>): Reader<T[]> {
  return (value, path) => {
    if (!Array.isArray(value)) throw new ProtocolError(path, value, 'a list');
    return value.map((one, index) => item(one, `${path}[${index}]`));
  };
}

export function orNull<T>(reader: Reader<T>): Reader<T | null> {
  return (value, path) => (value === null || value === undefined ? null : reader(value, path));
}

export function oneOf<T extends string>(...values: T[]): Reader<T> {
  return (value, path) => {
    const found = values.find((candidate) => candidate === value);
    if (found === undefined) throw new ProtocolError(path, value, `one of ${values.join(', ')}`);
    return found;
  };
}

/** Reads an object: every key of the shape by its reader. Keys that the shape does not name are left alone. */
export function shape<T>(readers: { [K in keyof T]: Reader<T[K]> }): Reader<T> {
  return (value, path) => {
    const object = fields(value, path);
    const result = {} as T;
    for (const key in readers) result[key] = readers[key](object[key], path ? `${path}.${key}` : key);
    return result;
  };
}
