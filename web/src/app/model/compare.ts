// Two results side by side: runs of the same name, their drops and their p(x).

import type { Theme } from '../../chart/colours';
import type { ChartSpec, SeriesSpec } from '../../chart/spec';
import { type Value, extent, fromZero } from '../../data/report';
import { pressureUnit } from '../../format/units';
import type { Result, ResultRun } from '../api/types';

export const EXPANSION = 2; // k of what is shown

export interface RunPair {
  run: string;
  first: ResultRun | null;
  second: ResultRun | null;
}

/** Runs of both by name, in the order of the first. */
export function pairs(first: Result, second: Result | null): RunPair[] {
  const other = new Map((second?.runs ?? []).map((run) => [run.run, run]));
  const list: RunPair[] = first.runs.map((run) => ({ run: run.run, first: run, second: other.get(run.run) ?? null }));
  const known = new Set(first.runs.map(({ run }) => run));
  for (const run of second?.runs ?? []) if (!known.has(run.run)) list.push({ run: run.run, first: null, second: run });
  return list;
}

/** Difference of the drops read off the wall, second less first; null where one has none. */
export function dropDifference({ first, second }: RunPair): Value {
  const [a, b] = [first?.extracted_drop_Pa ?? null, second?.extracted_drop_Pa ?? null];
  return a === null || b === null ? null : b - a;
}

/** Values at other places: linear between two that are there, nothing beside one that is not. */
export function atPlaces(x: number[], values: Value[], places: number[]): Value[] {
  let i = 0;
  return places.map((place) => {
    while (i < x.length - 2 && x[i + 1] < place) i += 1;
    const [a, b] = [values[i] ?? null, values[i + 1] ?? null];
    if (place === x[i]) return a;
    if (place === x[i + 1]) return b;
    if (a === null || b === null || place < x[i] || place > x[i + 1]) return null;
    return a + ((b - a) * (place - x[i])) / (x[i + 1] - x[i]);
  });
}

interface Side {
  result: Result;
  run: ResultRun;
  style: SeriesSpec;
}

/** p(x) of one run in one or two results, with expanded uncertainty. */
export function compareSpec(first: Result, second: Result | null, { first: a, second: b }: RunPair, theme: Theme): ChartSpec {
  const sides: Side[] = [];
  if (a) sides.push({ result: first, run: a, style: { label: first.output, colour: theme.reading, width: 2.4 } });
  if (b && second) sides.push({ result: second, run: b, style: { label: second.output, colour: theme.wall, width: 2, dash: [8, 4] } });
  const places = first.x_m.length > 0 ? first.x_m : (second?.x_m ?? []);
  const hidden = { colour: 'transparent', width: 0, legend: false };
  const series: SeriesSpec[] = [];
  const columns: Value[][] = [];
  for (const { result, run, style } of sides) {
    const shift = (k: number) => run.pressure_Pa.map((p, i) => {
      const u = run.pressure_uncertainty_Pa[i];
      return p === null ? null : k === 0 ? p : u === null ? null : p + k * u;
    });
    series.push(style, { ...hidden, label: `${style.label}, lower end` }, { ...hidden, label: `${style.label}, upper end` });
    columns.push(...[0, -EXPANSION, EXPANSION].map((k) => atPlaces(result.x_m, shift(k), places)));
  }
  // By the readings alone: bars grow without bound at the ends of a channel.
  const found = extent(columns.filter((_, i) => i % 3 === 0)) ?? [0, 1];
  const unit = pressureUnit(Math.max(...found.map(Math.abs)));
  return {
    x: { label: 'x (mm)', range: [0, ((places[places.length - 1] ?? 1e-3) + (places[0] ?? 0)) * 1e3] },
    y: { label: `p (${unit.name})`, range: fromZero(found, 0.15).map((v) => v / unit.si) as [number, number] },
    places: places.map((x) => x * 1e3),
    columns: columns.map((column) => column.map((v) => (v === null ? null : v / unit.si))),
    series,
    bands: sides.map(({ style }, i) => ({ upper: 3 * i + 2, lower: 3 * i + 1, fill: style.colour + '40' })),
  };
}
