// Colours that people with any colour vision tell apart: Okabe and Ito (2008) for kinds, viridis
// and cividis for magnitudes.

export interface Theme {
  dark: boolean;
  ink: string;
  soft: string;
  line: string;
  ground: string;
  shade: string; // the test section
  reading: string;
  wall: string;
  mark: string;
}

export const LIGHT: Theme = {
  dark: false,
  ink: '#1c2430',
  soft: '#5a6675',
  line: '#dfe4ea',
  ground: '#ffffff',
  shade: '#e9eef3',
  reading: '#0072b2',
  wall: '#d55e00',
  mark: '#1c2430',
};

export const DARK: Theme = {
  dark: true,
  ink: '#e4e9ef',
  soft: '#a3afbd',
  line: '#333d49',
  ground: '#1d242d',
  shade: '#262f3a',
  reading: '#56b4e9',
  wall: '#f0884a',
  mark: '#e4e9ef',
};

type Rgb = [number, number, number];

const hex = (text: string): Rgb[] =>
  text.split(' ').map((c) => [0, 2, 4].map((i) => parseInt(c.slice(i, i + 2), 16)) as Rgb);

/** Nine entries each of the tables of 256 (matplotlib); linear between them. */
const TABLES: Record<string, Rgb[]> = {
  viridis: hex('440154 472d7b 3b528b 2c728e 21918c 28ae80 5ec962 addc30 fde725'),
  cividis: hex('00224e 123570 3b496c 575d6d 707173 8a8678 a59c74 c3b369 fee838'),
};

export type MapName = 'viridis' | 'cividis';

export function colourAt(map: MapName, place: number): Rgb {
  const table = TABLES[map];
  const at = Math.min(Math.max(place, 0), 1) * (table.length - 1);
  const i = Math.min(Math.floor(at), table.length - 2);
  return table[i].map((from, c) => Math.round(from + (at - i) * (table[i + 1][c] - from))) as Rgb;
}

export const css = ([r, g, b]: Rgb) => `rgb(${r},${g},${b})`;

/** Colour of the i-th of n things in order; away from the end that the ground swallows. */
export function ordered(i: number, n: number, theme: Theme): string {
  const t = n > 1 ? i / (n - 1) : 0.5;
  return css(colourAt('viridis', theme.dark ? 0.3 + 0.7 * t : 0.85 * t));
}

const MODELS: Record<string, [string, string, number[]]> = {
  paper: ['#6b6b6b', '#b3b3b3', [2, 4]],
  creeping: ['#9a5586', '#d99cc4', [8, 4]],
  momentum: ['#b87a00', '#e69f00', [10, 3, 2, 3]],
  energy: ['#2f86ba', '#7cc8f5', [6, 3]],
  developing: ['#c04f00', '#f0884a', [12, 4]],
  'plane-march': ['#1c2430', '#e4e9ef', [3, 3]],
  'section-march': ['#00805e', '#2fcf9f', []],
};

export function modelStyle(name: string, theme: Theme): { colour: string; dash: number[] } {
  const [light, dark, dash] = MODELS[name] ?? MODELS.paper;
  return { colour: theme.dark ? dark : light, dash };
}

const KINDS_LIGHT = '#0072b2 #e69f00 #009e73 #cc79a7 #56b4e9 #d55e00 #8a8a8a #f0e442 #332288 #117733';
const KINDS_DARK = '#56b4e9 #e69f00 #2fcf9f #d99cc4 #3d7fd0 #f0884a #9a9a9a #f0e442 #a79af0 #7ac77a';

/** Colour of the i-th of some kinds. */
export function kind(i: number, theme: Theme): string {
  const list = (theme.dark ? KINDS_DARK : KINDS_LIGHT).split(' ');
  return list[i % list.length];
}
