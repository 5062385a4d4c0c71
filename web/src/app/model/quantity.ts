// "2.5 kPa": a number and its unit as people type them. The program itself knows every unit; here
// are those that tables and rectangles need to turn into one another.

export interface Quantity {
  number: number;
  unit: string; // '' where there is none
}

type Scale = Record<string, number>;

export const PRESSURES: Scale = {
  Pa: 1, hPa: 100, kPa: 1e3, MPa: 1e6, mbar: 100, bar: 1e5, psi: 6894.757293168, Torr: 133.3223684211,
  mmHg: 133.322387415, mmH2O: 9.80665,
};
export const FLOW_RATES: Scale = {
  'mL/min': 1e-6 / 60, 'ml/min': 1e-6 / 60, 'uL/min': 1e-9 / 60, 'µL/min': 1e-9 / 60, 'L/min': 1e-3 / 60,
  'mL/s': 1e-6, 'uL/s': 1e-9, 'mL/h': 1e-6 / 3600, 'uL/h': 1e-9 / 3600, 'L/h': 1e-3 / 3600, 'm3/s': 1,
};
export const TIMES: Scale = { s: 1, ms: 1e-3, min: 60, h: 3600 };
export const LENGTHS: Scale = { m: 1, cm: 1e-2, mm: 1e-3, um: 1e-6, 'µm': 1e-6, 'μm': 1e-6, micron: 1e-6, nm: 1e-9 };
export const ANGLES: Scale = { rad: 1, mrad: 1e-3, deg: Math.PI / 180, degree: Math.PI / 180, '°': Math.PI / 180 };

/** A number with a decimal point or comma; null for anything else. */
export function numberOf(text: string): number | null {
  const plain = text.trim().replace('−', '-');
  const point = /^[+-]?\d*,\d+(?:[eE][+-]?\d+)?$/.test(plain) ? plain.replace(',', '.') : plain;
  return /^[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?$/.test(point) ? Number(point) : null;
}

/** Number and unit; null where the text does not begin with a number. */
export function quantityOf(text: string): Quantity | null {
  const parts = /^\s*([+\-−]?[\d.,]+(?:[eE][+-]?\d+)?)\s*(.*?)\s*$/.exec(text);
  const number = parts && numberOf(parts[1]);
  return number === null ? null : { number, unit: parts![2] };
}

/** The quantity in the base unit of the scale; null if it is none, or of a unit that is not in it. */
export function siOf(text: string, scale: Scale): number | null {
  const quantity = quantityOf(text);
  const factor = quantity && Object.hasOwn(scale, quantity.unit) ? scale[quantity.unit] : null;
  return factor === null ? null : quantity!.number * factor;
}

/** Without the round-off of a conversion: 2300, not 2299.9999999999995. */
export const cleanNumber = (value: number) => String(Number(value.toPrecision(10)));

/**
 * A cell of a column in some unit: the number as typed, or of a quantity with a unit of its own the
 * number in that of the column. What is neither stays as it is, for the program to tell what is wrong.
 */
export function cellIn(text: string, unit: string, scale: Scale): string {
  const quantity = quantityOf(text);
  if (quantity === null) return text.trim();
  if (quantity.unit === '' || quantity.unit === unit) return String(quantity.number);
  const [from, to] = [quantity.unit, unit].map((u) => (Object.hasOwn(scale, u) ? scale[u] : null));
  return from === null || to === null ? text.trim() : cleanNumber((quantity.number * from) / to);
}

/** A length as the forms write it, to 0.1 um, in the unit of what stood there before. */
export function lengthText(metres: number, like: string | undefined): string {
  const unit = like === undefined ? 'mm' : (quantityOf(like)?.unit ?? 'mm');
  const factor = Object.hasOwn(LENGTHS, unit) ? LENGTHS[unit] : 1e-3;
  const named = Object.hasOwn(LENGTHS, unit) ? unit : 'mm';
  return `${cleanNumber(Math.round(metres * 1e7) / 1e7 / factor)} ${named}`;
}
