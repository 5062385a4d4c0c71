// p(x) of one run or all, with bands, crossings and flow models (paper fig. 3).

import { type Theme, modelStyle, ordered } from '../chart/colours';
import { points, stretch } from '../chart/layers';
import type { ChartSpec, SeriesSpec } from '../chart/spec';
import { type Report, type Run, type Value, extent, fromZero, largest, runOrder, widened } from '../data/report';
import { shortNumber } from '../format/numbers';
import { pressureUnit } from '../format/units';

export interface PressureChoice {
  run: number; // -1: all
  models: string[];
  base: string; // the model that is subtracted, "" for none
  band: boolean;
  crossings: boolean;
}

export function flowLabel(report: Report, run: number): string {
  const { flow_rate: rate, name } = report.runs[run];
  const unit = report.units.flow_rate;
  return rate === null ? name : `${shortNumber(rate / unit.si)} ${unit.name}`;
}

/** Flow rates of all runs, told apart by their names where two are the same. */
function runLabels(report: Report): string[] {
  const rates = report.runs.map((_, run) => flowLabel(report, run));
  return rates.map((rate, run) =>
    rates.filter((other) => other === rate).length > 1 ? `${rate} (${report.runs[run].name})` : rate,
  );
}

const minus = (values: Value[], base: Value[] | null) =>
  base === null
    ? values
    : values.map((v, i) => (v === null || base[i] === null ? null : v - (base[i] as number)));

interface Line {
  style: SeriesSpec;
  values: Value[];
}

/** Reading and interval of a run. */
function readingLines(run: Run, base: Value[] | null, style: SeriesSpec, band: boolean): Line[] {
  const hidden = { colour: 'transparent', width: 0, legend: false };
  const lines = [{ style, values: minus(run.pressure, base) }];
  if (!band) return lines;
  return [
    ...lines,
    { style: { ...hidden, label: `${style.label}, lower end` }, values: minus(run.lower, base) },
    { style: { ...hidden, label: `${style.label}, upper end` }, values: minus(run.upper, base) },
  ];
}

function modelLines(report: Report, run: Run, choice: PressureChoice, theme: Theme): Line[] {
  const base = run.models[choice.base] ?? null;
  return report.models
    .filter(({ name }) => choice.models.includes(name) && run.models[name])
    .map(({ name, words }) => {
      const { colour, dash } = modelStyle(name, theme);
      return { style: { label: words, colour, dash, width: 1.8 }, values: minus(run.models[name], base) };
    });
}

function insideOf(report: Report, run: Run) {
  const [from, to] = run.test_section;
  return (i: number) => from !== null && to !== null && report.x[i] >= from && report.x[i] <= to;
}

function specOf(report: Report, lines: Line[], unit: { name: string; si: number }, label: string): ChartSpec {
  const along = report.units.x;
  return {
    x: { label: `x (${along.name})`, range: [0, report.channel.length / along.si] },
    y: { label: `${label} (${unit.name})`, range: [0, 1] },
    places: report.x.map((x) => x / along.si),
    columns: lines.map(({ values }) => values.map((v) => (v === null ? null : v / unit.si))),
    series: lines.map(({ style }) => style),
  };
}

function oneRun(report: Report, choice: PressureChoice, theme: Theme): ChartSpec {
  const run = report.runs[choice.run];
  const base = run.models[choice.base] ?? null;
  const words = report.models.find(({ name }) => name === choice.base)?.words ?? '';
  const coverage = `${shortNumber(100 * report.coverage, 3)} %`;
  const style = { label: 'p(x) read off the wall', colour: theme.reading, width: 2.4 };
  const lines = [
    ...readingLines(run, base, style, choice.band),
    ...modelLines(report, run, choice, theme),
  ];
  const inside = insideOf(report, run);
  const found = extent(lines.map((l) => l.values), inside) ?? extent(lines.map((l) => l.values)) ?? [0, 1];
  const unit = base === null ? report.units.pressure : pressureUnit(largest(found));
  const spec = specOf(report, lines, unit, base === null ? 'p' : `p − ${words}`);
  const range = base === null ? fromZero(found) : widened(found, 0.1);
  const along = report.units.x.si;
  const [from, to] = run.test_section.map((v) => (v === null ? null : v / along));
  const crossings = run.crossings
    .filter(([x, p]) => x !== null && p !== null)
    .map(([x, p, u]) => ({ x: x! / along, y: p! / unit.si, ux: (report.expansion * (u ?? 0)) / along }));
  const marked = choice.crossings && base === null && crossings.length > 0;
  return {
    ...spec,
    y: { ...spec.y, range: range.map((v) => v / unit.si) as [number, number] },
    bands: choice.band ? [{ upper: 2, lower: 1, fill: theme.reading + '4d' }] : [],
    under: [stretch(from, to, theme.shade)],
    over: marked ? [points(crossings, theme.ink, 'circle', 3.5)] : [],
    legend: [
      ...(choice.band ? [{ label: `${coverage} interval`, colour: theme.reading + '4d', area: true }] : []),
      ...(marked ? [{ label: 'crossings with profiles of known pressure', colour: theme.ink, symbol: 'circle' as const }] : []),
      { label: 'test section', colour: theme.shade, area: true },
    ],
  };
}

function allRuns(report: Report, choice: PressureChoice, theme: Theme): ChartSpec {
  const order = runOrder(report);
  const labels = runLabels(report);
  const lines = order.flatMap((run, i) =>
    readingLines(
      report.runs[run],
      null,
      { label: labels[run], colour: ordered(i, order.length, theme) },
      choice.band,
    ),
  );
  const found = extent(
    order.flatMap((run) => {
      const inside = insideOf(report, report.runs[run]);
      return [report.runs[run].lower, report.runs[run].upper].map((list) =>
        list.map((v, i) => (inside(i) ? v : null)),
      );
    }),
  ) ?? [0, 1];
  const unit = report.units.pressure;
  const spec = specOf(report, lines, unit, 'p');
  const range = fromZero(found as [number, number]).map((v) => v / unit.si);
  return {
    ...spec,
    y: { ...spec.y, range: range as [number, number] },
    bands: choice.band
      ? order.map((_, i) => ({
          upper: 3 * i + 2,
          lower: 3 * i + 1,
          fill: ordered(i, order.length, theme).replace('rgb', 'rgba').replace(')', ',0.3)'),
        }))
      : [],
  };
}

export function pressureSpec(report: Report, choice: PressureChoice, theme: Theme): ChartSpec {
  return choice.run < 0 ? allRuns(report, choice, theme) : oneRun(report, choice, theme);
}
