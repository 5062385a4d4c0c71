// Numbers as the tables of the report write them.

const NONE = '–';

function withMinus(text: string): string {
  return text.replace('-', '−');
}

export function fixed(value: number, decimals: number): string {
  const scale = 10 ** Math.max(0, -decimals);
  const text = (Math.round(value / scale) * scale).toFixed(0);
  const written = decimals > 0 ? value.toFixed(decimals) : text;
  return withMinus(Number(written) === 0 ? written.replace('-', '') : written);
}

/** Exponent of the leading digit after rounding to so many significant digits. */
function exponent(value: number, digits: number): number {
  return Number(Math.abs(value).toExponential(digits - 1).split('e')[1]);
}

/** With so many significant digits; "–" for none. */
export function number(value: number | null, digits = 4): string {
  if (value === null || !Number.isFinite(value)) return NONE;
  if (value === 0) return '0';
  return fixed(value, digits - 1 - exponent(value, digits));
}

/** At most so many significant digits, no zeros behind the point. */
export function shortNumber(value: number, digits = 4): string {
  return withMinus(String(Number(value.toPrecision(digits))));
}

/** "14.23 ± 0.12": the uncertainty with two digits, the value to the same decimal. */
export function withUncertainty(value: number | null, uncertainty: number | null): string {
  if (value === null || !Number.isFinite(value)) return NONE;
  if (uncertainty === null || !(uncertainty > 0)) return number(value, 4);
  const decimals = 1 - exponent(uncertainty, 2);
  return `${fixed(value, decimals)} ± ${fixed(uncertainty, decimals)}`;
}
