// Charts of the map viewer: the map, zeta(x), the constitutive curve, p(x) of one frame.

import { type Theme, ordered } from '../chart/colours';
import { box, line, points } from '../chart/layers';
import type { ChartSpec } from '../chart/spec';
import type { Frame } from '../data/frames';
import { type Report, type Value, extent, fromZero, nearest, widened } from '../data/report';

const scaled = (values: Value[], by: number) => values.map((v) => (v === null ? null : v / by));

/** The stretch of x, in the display unit, that map and profiles share. */
export function stretchOf(report: Report): [number, number] {
  const { si } = report.units.x;
  const { maps, channel } = report;
  if (maps === null) return [0, channel.length / si];
  return [Math.min(0, maps.x.first) / si, Math.max(channel.length, maps.x.last) / si];
}

export function profileOf(report: Report, frame: Frame): Value[] {
  if (frame.run >= 0) return report.runs[frame.run].deflection;
  return report.levels.deflection[frame.level] ?? [];
}

/** Fig. 1(d): every level, and the frame that is shown. */
export function profileSpec(report: Report, frame: Frame, theme: Theme): ChartSpec {
  const { x: along, deflection: unit } = report.units;
  const levels = report.levels.deflection.map((values) => scaled(values, unit.si));
  const runs = report.runs.map((run) => scaled(run.deflection, unit.si));
  const range = widened(extent([...levels, ...runs]) ?? [0, 1]);
  const all = levels.length + report.runs.length;
  return {
    x: { label: `x (${along.name})`, range: stretchOf(report) },
    y: { label: `ζ (${unit.name})`, range },
    places: report.x.map((x) => x / along.si),
    columns: [...levels, scaled(profileOf(report, frame), unit.si)],
    series: [
      ...levels.map((_, k) => ({
        label: k === 0 ? 'at known pressures, from low (dark) to high' : `level ${k + 1}`,
        colour: ordered(k, Math.max(2, levels.length), theme),
        width: 1,
        legend: k === 0,
      })),
      {
        label: frame.label,
        colour: frame.run >= 0 ? theme.wall : theme.ink,
        width: all > 0 ? 2.6 : 2,
      },
    ],
    right: 74,
  };
}

/** Fig. 1(e), (f): zeta against p at one place, and where the frame stands on it. */
export function curveSpec(report: Report, frame: Frame, x: number, theme: Theme): ChartSpec {
  const { pressure: unit, deflection } = report.units;
  const ix = nearest(report.x, x);
  const { levels } = report;
  const known = levels.pressure
    .map((p, k) => ({
      x: p === null ? NaN : p / unit.si,
      y: levels.deflection[k]?.[ix] ?? null,
      ux: (report.expansion * (levels.pressure_uncertainty[k] ?? 0)) / unit.si,
    }))
    .filter((point) => Number.isFinite(point.x) && point.y !== null)
    .map((point) => ({ ...point, y: (point.y as number) / deflection.si }));
  const run = frame.run >= 0 ? report.runs[frame.run] : null;
  const zeta = profileOf(report, frame)[ix] ?? null;
  const p = run ? run.pressure[ix] : (levels.pressure[frame.level] ?? null);
  const range = widened(extent([levels.pressure]) ?? [0, 1], 0.04).map((v) => v / unit.si);
  const over = [points(known, theme.soft, 'circle', 3.5)];
  if (zeta !== null) {
    const height = zeta / deflection.si;
    over.push(line([[range[0], height], [range[1], height]], theme.wall, [6, 4]));
    if (p !== null) {
      const ux = run ? (report.expansion * (run.u[ix] ?? 0)) / unit.si : 0;
      over.push(points([{ x: p / unit.si, y: height, ux }], theme.reading, 'diamond', 5.5));
    }
  }
  const heights = known.map((point) => point.y);
  return {
    x: { label: `p (${unit.name})`, range: range as [number, number] },
    y: {
      label: `ζ (${deflection.name})`,
      range: widened(extent([heights, zeta === null ? [] : [zeta / deflection.si]]) ?? [0, 1], 0.08),
    },
    places: known.map((point) => point.x),
    columns: [heights],
    series: [{ label: 'levels at this place', colour: theme.soft, width: 1, legend: false }],
    over,
    legend: [
      { label: 'levels at this place, label ± U', colour: theme.soft, symbol: 'circle' },
      { label: 'deflection of the map shown', colour: theme.wall, dash: [6, 4] },
      { label: run ? 'pressure read, ± U' : 'pressure applied', colour: theme.reading, symbol: 'diamond' },
    ],
  };
}

/** p(x) of the frame: the reading of a run, or the level's uniform pressure. */
export function framePressureSpec(report: Report, frame: Frame, theme: Theme): ChartSpec {
  const { x: along, pressure: unit } = report.units;
  const run = frame.run >= 0 ? report.runs[frame.run] : null;
  const level = report.levels.pressure[frame.level] ?? null;
  const p = run ? run.pressure : report.x.map(() => level);
  const [lower, upper] = run ? [run.lower, run.upper] : [p, p];
  const columns = [p, lower, upper].map((values) => scaled(values, unit.si));
  const inside = (i: number) =>
    !run || (report.x[i] >= (run.test_section[0] ?? 0) && report.x[i] <= (run.test_section[1] ?? Infinity));
  const found = extent(columns.slice(1), inside) ?? extent(columns) ?? ([0, 1] as [number, number]);
  return {
    x: { label: `x (${along.name})`, range: [0, report.channel.length / along.si] },
    y: { label: `p (${unit.name})`, range: fromZero(found) },
    places: report.x.map((x) => x / along.si),
    columns,
    series: [
      { label: run ? 'p(x) read off the wall' : 'uniform pressure', colour: theme.reading },
      { label: 'lower', colour: 'transparent', width: 0, legend: false },
      { label: 'upper', colour: 'transparent', width: 0, legend: false },
    ],
    bands: run ? [{ upper: 2, lower: 1, fill: theme.reading + '4d' }] : [],
  };
}

/** The map itself; what is drawn under it comes from the viewer. */
export function mapSpec(report: Report, layers: ChartSpec['under']): ChartSpec {
  const { maps, channel } = report;
  const { si, name } = report.units.x;
  const half = (0.5 * channel.width) / si;
  const reach = maps ? Math.max(Math.abs(maps.z.first), Math.abs(maps.z.last)) / si : half;
  return {
    x: { label: `x (${name})`, range: stretchOf(report) },
    y: { label: `z (${name})`, range: [-reach, reach] },
    places: [],
    columns: [],
    series: [],
    grid: false,
    under: layers,
    over: [box([0, channel.length / si], [-half, half], '#ffffff', false)],
    right: 74,
  };
}
