// The fields of the forms: where each stands in the file, how it is called, what to type.

import type { Form, Pair, Text } from '../api/types';

export type Step = 'maps' | 'channel' | 'calibration' | 'runs' | 'check' | 'measure' | 'results';

export const STEPS: { name: Step; words: string }[] = [
  { name: 'maps', words: 'Maps' },
  { name: 'channel', words: 'Channel' },
  { name: 'calibration', words: 'Calibration' },
  { name: 'runs', words: 'Runs' },
  { name: 'check', words: 'Check' },
  { name: 'measure', words: 'Measure' },
  { name: 'results', words: 'Results' },
];

export interface FieldKind {
  path: string;
  label: string;
  hint?: string;
  example?: string;
  choices?: [string, string][]; // value and words
}

const field = (path: string, label: string, example: string, hint = ''): FieldKind => ({ path, label, example, hint });
const choice = (path: string, label: string, choices: [string, string][], hint = ''): FieldKind => ({ path, label, choices, hint });

export const NAME = field('name', 'Experiment’s name', 'S1');

export const SIZES = [
  field('channel.length', 'Length', '15.5 mm', 'along the flow'),
  field('channel.width', 'Width', '1.7 mm', 'across the flow'),
  field('channel.height', 'Height', '175 um', 'the gap under the undeflected wall'),
  field('channel.height_uncertainty', 'Height’s uncertainty', '0.5 um', 'standard'),
];

export const PLACE = [
  choice('channel.flow', 'The flow runs', [
    ['+columns', 'right (+columns)'],
    ['-columns', 'left (-columns)'],
    ['+rows', 'down (+rows)'],
    ['-rows', 'up (-rows)'],
  ]),
  field('channel.rotation', 'Rotation', '0 deg', 'clockwise in the map'),
  choice('channel.outward', 'Bulging out reads', [
    ['+height', 'higher (+height)'],
    ['-height', 'lower (-height)'],
  ]),
];

export const INLET = [
  choice('inlet.profile', 'The flow enters', [
    ['developed', 'developed, out of a long duct'],
    ['uniform', 'uniform, out of a chamber'],
  ]),
  field('inlet.spread', 'How far from that it may be', '0.3', '0 to 1; not known when empty'),
  field('inlet.developing_length', 'Duct before x = 0', '2 mm', 'with a uniform profile'),
];

export const WALL = [
  field('wall.material', 'Material', 'SiN'),
  field('wall.thickness', 'Thickness', '0.2 um'),
  field('wall.youngs_modulus', 'Young’s modulus', '250 GPa'),
  field('wall.poisson_ratio', 'Poisson’s ratio', '0.23'),
  field('wall.prestress', 'Prestress', '100 MPa'),
];

export const GAUGE = [
  field('instrument.pressure_noise', 'Noise of one reading', '10 Pa', 'standard; “0 Pa” claims an exact gauge'),
  field('instrument.pressure_zero_uncertainty', 'Uncertainty of its zero', '5 Pa', 'common to all levels not vented'),
  field('instrument.pressure_gain_uncertainty', 'Uncertainty of its gain', '0.002', 'relative, common to all levels'),
];

export const FLUID = [
  field('fluid.name', 'Fluid', 'water'),
  field('fluid.viscosity', 'Viscosity', '1.0 mPa s'),
  field('fluid.viscosity_uncertainty', 'Viscosity’s uncertainty', '0.01 mPa s', 'standard'),
  field('fluid.density', 'Density', '998 kg/m3'),
];

export const FLOW_READINGS = [
  field('instrument.flow_rate_uncertainty', 'Flow rate’s uncertainty', '0.01', 'relative, common to all runs'),
  field('instrument.pressure_drop_uncertainty', 'Uncertainty of one drop', '5 Pa', 'standard, of the transducer'),
];

export const INSTRUMENT = [
  field('instrument.height_noise', 'Noise of one pixel', '20 nm', 'else measured on the rim'),
  field('instrument.wavelength', 'Wavelength', '600 nm', 'of the interferometer'),
  field('instrument.reference', 'Flat reference', 'flat.gsf', 'map subtracted from every map'),
  field('instrument.height_unit', 'Unit of heights', 'nm', 'where the files name none'),
  field('instrument.channel', 'Channel of the files', 'Height', 'where they hold several'),
];

/** Fields of two texts: along columns, along rows. */
export const ORIGIN = field('channel.origin', 'Inlet-side corner', '0.4 mm', 'from the first pixel’s outer corner');
export const PITCH = field('instrument.pixel_pitch', 'Distance of pixels', '1.5 um', 'where the files have no scale');

const OF_STEP: [Step, FieldKind[]][] = [
  ['maps', [NAME, ...INSTRUMENT, PITCH]],
  ['channel', [...SIZES, ...PLACE, ...INLET, ...WALL, ORIGIN]],
  ['calibration', GAUGE],
  ['runs', [...FLUID, ...FLOW_READINGS]],
];

/** The step that a fault is mended in; the text itself where no form has its key. */
export function stepOf(key: string | null): Step | null {
  if (key === null) return null;
  if (key.startsWith('hydrostatic')) return 'calibration';
  if (key.startsWith('flow')) return 'runs';
  return OF_STEP.find(([, fields]) => fields.some(({ path }) => path === key))?.[0] ?? null;
}

/** Name of the element that holds the field of a key. */
export const idOf = (key: string) => `field-${key.replace('.', '-')}`;

/** A value of a form by its path. */
export function fieldOf(form: Form, path: string): Text | Pair {
  const [section, key] = path.split('.');
  if (key === undefined) return section === 'name' ? form.name : null;
  return (form as unknown as Record<string, Record<string, Text | Pair>>)[section]?.[key] ?? null;
}

export function setField(form: Form, path: string, value: Text | Pair): void {
  const [section, key] = path.split('.');
  if (key === undefined) form.name = value as Text;
  else (form as unknown as Record<string, Record<string, Text | Pair>>)[section][key] = value;
}

/** What a draft has where only the user knows: "? mm". */
export const isPlaceholder = (value: Text) => value !== null && /^\s*\?/.test(value);
