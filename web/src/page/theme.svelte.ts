import { DARK, LIGHT, type Theme } from '../chart/colours';

const wish = window.matchMedia('(prefers-color-scheme: dark)');
let dark = $state(wish.matches);
wish.addEventListener('change', (event) => (dark = event.matches));

/** The colours that the reader's system asks for. */
export function theme(): Theme {
  return dark ? DARK : LIGHT;
}
