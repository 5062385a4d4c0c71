// What stands at one place of one run, in words.

import { type Report, flagWords, nearest } from '../data/report';
import { fixed, withUncertainty } from '../format/numbers';

export function placeText(report: Report, x: number): string {
  return `x = ${fixed(x / report.units.x.si, 3)} ${report.units.x.name}`;
}

/** "p = 1234 ± 12 Pa" with the expanded uncertainty, or why there is no number. */
export function pressureText(report: Report, run: number, x: number): string {
  const { pressure, u, flags } = report.runs[run];
  const at = nearest(report.x, x);
  const unit = report.units.pressure;
  const words = flagWords(report, flags[at] ?? 0).join('; ');
  const value = pressure[at];
  if (value === null) return `no pressure: ${words || 'the result holds none here'}`;
  const bar = u[at] === null ? null : (report.expansion * u[at]!) / unit.si;
  const text = `p = ${withUncertainty(value / unit.si, bar)} ${unit.name}`;
  return words ? `${text} (${words})` : text;
}

export function deflectionText(report: Report, value: number | null): string {
  const unit = report.units.deflection;
  return value === null ? 'no deflection' : `ζ = ${fixed(value / unit.si, 3)} ${unit.name}`;
}
