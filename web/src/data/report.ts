// The data block of report.html, as src/manoscope/report/page_data.cpp writes it. SI units; null
// where there is no number.

import { unpackText } from './maps';

export type Value = number | null;

export interface Unit {
  name: string;
  si: number;
}

export interface Estimate {
  value: Value;
  u: Value; // standard uncertainty
}

export interface Run {
  name: string;
  flow_rate: Value;
  flow_rate_uncertainty: Value;
  test_section: Value[];
  deflection: Value[];
  pressure: Value[];
  u: Value[];
  lower: Value[];
  upper: Value[];
  flags: number[];
  crossings: Value[][]; // x, pressure, standard uncertainty of x
  models: Record<string, Value[]>;
  budget: Value[][]; // variance by source, along x
  drops: {
    extracted: Estimate;
    models: Record<string, Estimate>;
    channel_resistance: Estimate;
    transducer: Estimate;
    compliant: Estimate;
    predicted: Estimate;
  };
}

export interface Axis {
  n: number;
  first: number;
  last: number;
}

export interface MapEntry {
  name: string;
  run: number; // -1: a map at known pressure
  pressure: Value;
  step: number; // m per count
  low: number; // counts that all but one pixel in a thousand exceed
  high: number;
}

export interface Report {
  title: string;
  coverage: number;
  expansion: number;
  channel: { length: number; width: number };
  units: { x: Unit; deflection: Unit; pressure: Unit; drop: Unit; flow_rate: Unit };
  flags: { bit: number; meaning: string; answer: boolean }[];
  x: number[];
  levels: { pressure: Value[]; pressure_uncertainty: Value[]; deflection: Value[][] };
  models: { name: string; words: string; verdict: boolean }[];
  budget_sources: string[];
  runs: Run[];
  drop_fit: { linear: Value; quadratic: Value };
  maps: { x: Axis; z: Axis; list: MapEntry[] } | null;
}

export async function readReport(page: Document): Promise<Report | null> {
  const text = page.getElementById('report-data')?.textContent;
  return text ? (JSON.parse(await unpackText(text)) as Report) : null;
}

/** Index of the station nearest to x. */
export function nearest(x: number[], place: number): number {
  let low = 0;
  let high = x.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle] <= place) low = middle;
    else high = middle;
  }
  return Math.abs(x[high] - place) < Math.abs(place - x[low]) ? high : low;
}

/** What the flags of a station say, in words. */
export function flagWords(report: Report, bits: number): string[] {
  return report.flags.filter((flag) => (bits & flag.bit) !== 0).map((flag) => flag.meaning);
}

/** Runs by ascending flow rate; those without one last. */
export function runOrder(report: Report): number[] {
  const rate = (run: number) => report.runs[run].flow_rate ?? Infinity;
  return report.runs.map((_, run) => run).sort((a, b) => rate(a) - rate(b) || a - b);
}

/** Names of the flow models that the views begin with: eq. (4) and that of the verdict. */
export function modelsAtFirst(report: Report): string[] {
  return report.models.filter((m) => m.verdict || m.name === 'paper').map((m) => m.name);
}

export function largest(values: Value[]): number {
  let most = 0;
  for (const value of values) if (value !== null && Math.abs(value) > most) most = Math.abs(value);
  return most;
}

/** Lowest and highest of the values that exist; null if there is none. */
export function extent(lists: Value[][], keep: (i: number) => boolean = () => true) {
  let low = Infinity;
  let high = -Infinity;
  for (const list of lists) {
    list.forEach((value, i) => {
      if (value === null || !keep(i)) return;
      if (value < low) low = value;
      if (value > high) high = value;
    });
  }
  return low <= high ? ([low, high] as [number, number]) : null;
}

/** From zero, or below where there is something, to above the largest. */
export function fromZero([low, high]: [number, number], share = 0.08): [number, number] {
  const [below, above] = widened([Math.min(0, low), Math.max(0, high)], share);
  return [low < 0 ? below : 0, above];
}

/** The range widened by a share of its width on both sides. */
export function widened([low, high]: [number, number], share = 0.06): [number, number] {
  const room = high > low ? share * (high - low) : 0.05 * Math.abs(high) || 1;
  return [low - room, high + room];
}
