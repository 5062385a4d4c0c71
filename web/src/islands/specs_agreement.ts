// Does the flow agree: model drops against the extracted drop (fig. 4), drops against Q (fig. 2a).

import { type Theme, kind, modelStyle } from '../chart/colours';
import { type Point, line, points } from '../chart/layers';
import { type ChartSpec, type Layer, type LegendEntry, type Symbol, plain } from '../chart/spec';
import { type Estimate, type Report, type Run, extent, widened } from '../data/report';

const SYMBOLS: Symbol[] = ['circle', 'square', 'triangle', 'diamond'];

/** Value and half bar of an estimate in a unit; null where there is no number. */
function bar(report: Report, estimate: Estimate, si: number): { value: number; U: number } | null {
  if (estimate.value === null) return null;
  return { value: estimate.value / si, U: (report.expansion * (estimate.u ?? 0)) / si };
}

function reach(list: Point[], axis: 'x' | 'y'): number[] {
  return list.flatMap((point) => {
    const half = (axis === 'x' ? point.ux : point.uy) ?? 0;
    return [point[axis] - half, point[axis] + half];
  });
}

/** Points of one model: dp_e against its drop, or against the difference in percent. */
function modelPoints(report: Report, name: string, percent: boolean): Point[] {
  const { si } = report.units.drop;
  return report.runs.flatMap((run) => {
    const read = bar(report, run.drops.extracted, si);
    const model = run.drops.models[name] && bar(report, run.drops.models[name], si);
    if (!read || !model) return [];
    if (!percent) return [{ x: read.value, y: model.value, ux: read.U, uy: model.U }];
    if (read.value === 0) return [];
    const share = 100 / Math.abs(read.value);
    const both = Math.hypot(read.U, model.U); // as if independent
    return [{ x: read.value, y: (model.value - read.value) * share, ux: read.U, uy: both * share }];
  });
}

export function agreementSpec(report: Report, models: string[], percent: boolean, theme: Theme): ChartSpec {
  const shown = report.models.filter(({ name }) => models.includes(name));
  const lists = shown.map(({ name }) => modelPoints(report, name, percent));
  const xs = lists.flatMap((list) => reach(list, 'x'));
  const ys = lists.flatMap((list) => reach(list, 'y'));
  const unit = report.units.drop.name;
  const across = extent([[0, ...xs]]) ?? [0, 1];
  const range = widened(across, 0.05);
  const upright = percent ? widened(extent([[0, ...ys]]) ?? [-1, 1], 0.1) : widened(extent([[0, ...ys, ...xs]]) ?? [0, 1], 0.05);
  const unity: [number, number][] = percent ? [[range[0], 0], [range[1], 0]] : [[range[0], range[0]], [range[1], range[1]]];
  return {
    x: { label: `Δp read off the wall (${unit})`, range },
    y: { label: percent ? 'model less reading (%)' : `Δp of the flow (${unit})`, range: upright },
    places: [],
    columns: [],
    series: [],
    table: dropTable(report, [
      READ,
      ...shown.map(({ name, words }) => ({ label: words, of: (run: Run) => run.drops.models[name] })),
    ]),
    under: [line(unity, theme.soft, [6, 4])],
    over: lists.map((list, i) => points(list, modelStyle(shown[i].name, theme).colour, SYMBOLS[i % 4], 4.5)),
    legend: [
      ...shown.map(({ name, words }, i) => ({
        label: name === 'paper' ? 'QR by eq. (4)' : words,
        colour: modelStyle(name, theme).colour,
        symbol: SYMBOLS[i % 4],
      })),
      { label: percent ? 'no difference' : 'equal', colour: theme.soft, dash: [6, 4] },
    ],
  };
}

/** Drops and expanded uncertainties of every run: a column each. */
function dropTable(report: Report, columns: { label: string; of: (run: Run) => Estimate | undefined }[]): string[][] {
  const { drop, flow_rate: rate } = report.units;
  const head = ['run', `Q (${rate.name})`];
  for (const { label } of columns) head.push(`${label} (${drop.name})`, `U of it (${drop.name})`);
  const rows = report.runs.map((run) => [
    run.name,
    plain(run.flow_rate === null ? null : run.flow_rate / rate.si),
    ...columns.flatMap(({ of }) => {
      const estimate = of(run);
      const U = estimate?.u == null ? null : (report.expansion * estimate.u) / drop.si;
      return [plain(estimate?.value == null ? null : estimate.value / drop.si), plain(U)];
    }),
  ]);
  return [head, ...rows];
}

const READ = { label: 'read off the wall', of: (run: Run) => run.drops.extracted };

const DROPS: { key: 'extracted' | 'channel_resistance' | 'transducer' | 'compliant' | 'predicted'; label: string }[] = [
  { key: 'extracted', label: 'read off the wall, test section' },
  { key: 'channel_resistance', label: 'QR, whole channel' },
  { key: 'transducer', label: 'transducer' },
  { key: 'compliant', label: 'transducer less passages' },
  { key: 'predicted', label: 'predicted by the calibration' },
];

/** dp = a Q + b Q^2, at 60 places. */
function fitted(report: Report, low: number, high: number, log: boolean): [number, number][] {
  const { linear: a, quadratic: b } = report.drop_fit;
  if (a === null || b === null) return [];
  const { drop, flow_rate } = report.units;
  return Array.from({ length: 60 }, (_, i) => {
    const t = i / 59;
    const rate = log ? low * (high / low) ** t : low + t * (high - low);
    const Q = rate * flow_rate.si;
    return [rate, (a * Q + b * Q * Q) / drop.si] as [number, number];
  }).filter(([, drop]) => !log || drop > 0);
}

export function dropSpec(report: Report, log: boolean, theme: Theme): ChartSpec {
  const { drop, flow_rate: unit } = report.units;
  const over: Layer[] = [];
  const legend: LegendEntry[] = [];
  const all: Point[] = [];
  DROPS.forEach(({ key, label }, i) => {
    const list = report.runs.flatMap((run) => {
      const value = bar(report, run.drops[key], drop.si);
      if (run.flow_rate === null || !value) return [];
      const point = { x: run.flow_rate / unit.si, y: value.value, uy: value.U };
      return log && !(point.x > 0 && point.y > 0) ? [] : [point];
    });
    if (list.length === 0) return;
    all.push(...list);
    const symbol = SYMBOLS[legend.length % 4];
    over.push(points(list, kind(i, theme), symbol, 4.5));
    legend.push({ label, colour: kind(i, theme), symbol });
  });
  const xs = all.map((p) => p.x);
  const ys = log ? all.map((p) => p.y) : reach(all, 'y');
  const low = log ? Math.min(...xs) : 0;
  const curve = all.length > 0 ? fitted(report, low, Math.max(...xs), log) : [];
  if (curve.length > 1) legend.push({ label: 'aQ + bQ² through the drops of the channel', colour: theme.soft, dash: [6, 4] });
  const range = (values: number[]): [number, number] =>
    values.length === 0 ? [1, 10]
    : log ? [Math.min(...values) / 1.4, Math.max(...values) * 1.4]
    : widened([Math.min(0, ...values), Math.max(0, ...values)], 0.05);
  return {
    x: { label: `Q (${unit.name})`, range: range(xs), log },
    y: { label: `Δp (${drop.name})`, range: range(ys), log },
    places: [],
    columns: [],
    series: [],
    table: dropTable(report, DROPS.map(({ key, label }) => ({ label, of: (run: Run) => run.drops[key] }))),
    under: curve.length > 1 ? [line(curve, theme.soft, [6, 4])] : [],
    over,
    legend,
  };
}
