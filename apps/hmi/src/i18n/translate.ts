import { texts } from './texts';

export type Language = 'en' | 'zh';
export type TextKey = keyof typeof texts;
export type Values = Record<string, string | number>;
export type Translate = (key: TextKey, values?: Values) => string;

export function translator(language: Language): Translate {
  const column = language === 'en' ? 0 : 1;
  return (key, values = {}) => filled(texts[key][column], values);
}

function filled(pattern: string, values: Values): string {
  return pattern.replace(/\{(\w+)\}/g, (whole, name: string) => (name in values ? String(values[name]) : whole));
}

export function isLanguage(value: string | null | undefined): value is Language {
  return value === 'en' || value === 'zh';
}

/** The language kept from last time, else the browser's. */
export function chosenLanguage(kept: string | null | undefined, browser: string): Language {
  if (isLanguage(kept)) return kept;
  return browser.toLowerCase().startsWith('zh') ? 'zh' : 'en';
}
