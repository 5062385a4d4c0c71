// A ChartSpec as options and data of uPlot.

import uPlot from 'uplot';
import { shortNumber } from '../format/numbers';
import type { Theme } from './colours';
import { type ChartSpec, legendOf } from './spec';
import { drawLegend, legendRows } from './legend';

export interface View {
  x: [number, number] | null; // null: the range of the spec
  y: [number, number] | null;
}

const FONT = '13px system-ui, "Segoe UI", Roboto, Helvetica, Arial, sans-serif';

/** Ticks of a logarithmic axis that need a number: powers of ten, and 2 and 5 where there is room. */
function logValues(_: uPlot, splits: number[]): (string | null)[] {
  const decades = Math.log10(splits[splits.length - 1] / splits[0]);
  return splits.map((value) => {
    const lead = Number(value.toExponential(3).split('e')[0]);
    const named = lead === 1 || (decades < 2.5 && (lead === 2 || lead === 5));
    return named ? String(Number(value.toPrecision(4))) : null;
  });
}

function axis(
  theme: Theme,
  label: string,
  log: boolean | undefined,
  size: number,
  grid = true,
): uPlot.Axis {
  return {
    label,
    stroke: theme.ink,
    font: FONT,
    labelFont: FONT,
    labelSize: 22,
    size,
    gap: 4,
    grid: { show: grid, stroke: theme.line, width: 1 },
    ticks: { stroke: theme.line, width: 1, size: 5 },
    values: log ? logValues : (_, splits) => splits.map((value) => shortNumber(value, 6)),
    ...(log ? { filter: (_: uPlot, splits: number[]) => splits } : {}),
  };
}

export function dataOf(spec: ChartSpec): uPlot.AlignedData {
  return [spec.places, ...spec.columns] as uPlot.AlignedData;
}

/** Options of a plot that always shows what `current` gives at the time. */
export function optionsOf(
  current: () => ChartSpec,
  view: View,
  theme: Theme,
  size: { width: number; height: number },
  exported = false,
): uPlot.Options {
  const spec = current();
  const legend = exported ? legendOf(spec) : [];
  const rows = legendRows(legend, size.width - 80);
  const scale = (name: 'x' | 'y'): uPlot.Scale => ({
    time: false,
    distr: spec[name].log ? 3 : 1,
    range: () => view[name] ?? current()[name].range,
  });
  return {
    ...size,
    padding: [10 + 20 * rows.length, spec.right ?? 14, 0, 4],
    scales: { x: scale('x'), y: scale('y') },
    axes: [
      axis(theme, spec.x.label, spec.x.log, 32, spec.grid),
      axis(theme, spec.y.label, spec.y.log, 50, spec.grid),
    ],
    series: [
      {},
      ...spec.series.map((series) => ({
        label: series.label,
        stroke: series.colour,
        width: series.width ?? 2,
        dash: series.dash,
        points: { show: false },
        pxAlign: 0,
        spanGaps: false,
      })),
    ],
    bands: (spec.bands ?? []).map(({ upper, lower, fill }) => ({
      series: [upper + 1, lower + 1] as [number, number],
      fill,
    })),
    legend: { show: false },
    cursor: {
      x: false,
      y: false,
      points: { show: false },
      drag: { x: true, y: true, uni: 24, setScale: false },
    },
    hooks: {
      drawClear: [(plot) => (current().under ?? []).forEach((layer) => clipped(plot, layer))],
      draw: [
        (plot) => (current().over ?? []).forEach((layer) => layer(plot)),
        (plot) => drawLegend(plot, rows, theme, FONT),
      ],
    },
  };
}

function clipped(plot: uPlot, layer: (plot: uPlot) => void): void {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  layer(plot);
  ctx.restore();
}

export { clipped };
