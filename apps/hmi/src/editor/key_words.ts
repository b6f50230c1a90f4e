/** Keys and choices of the map file in words; what the table does not know is shown as the file has it. */

import { texts } from '../i18n/texts';
import type { TextKey, Translate } from '../i18n/translate';

export const keyWords = (t: Translate, key: string): string => words(t, 'key_', key);
export const choiceWords = (t: Translate, choice: string): string => words(t, 'choice_', choice);

function words(t: Translate, prefix: string, name: string): string {
  const known = `${prefix}${name}`;
  return known in texts ? t(known as TextKey) : name.replaceAll('_', ' ');
}
