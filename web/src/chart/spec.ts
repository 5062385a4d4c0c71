// What a chart shows, free of size and screen: the same spec is drawn on the page and exported.

import type uPlot from 'uplot';
import type { Value } from '../data/report';

export interface AxisSpec {
  label: string;
  range: [number, number];
  log?: boolean;
}

export interface SeriesSpec {
  label: string;
  colour: string;
  width?: number;
  dash?: number[];
  legend?: boolean; // default: yes
}

/** Draws on the canvas of a chart, in its pixels. */
export type Layer = (plot: uPlot) => void;

export interface LegendEntry {
  label: string;
  colour: string;
  dash?: number[];
  symbol?: Symbol;
  area?: boolean;
}

export type Symbol = 'circle' | 'square' | 'triangle' | 'diamond';

export interface ChartSpec {
  x: AxisSpec;
  y: AxisSpec;
  places: number[];
  columns: Value[][]; // one a series
  series: SeriesSpec[];
  bands?: { upper: number; lower: number; fill: string }[]; // indices into series
  under?: Layer[];
  over?: Layer[];
  legend?: LegendEntry[]; // beside those of the series
  grid?: boolean; // default: yes
  table?: string[][]; // the numbers behind, where they are no lines
  right?: number; // room on the right, px
}

export function legendOf(spec: ChartSpec): LegendEntry[] {
  const lines = spec.series
    .filter((series) => series.legend !== false)
    .map(({ label, colour, dash }) => ({ label, colour, dash }));
  return [...lines, ...(spec.legend ?? [])];
}

/** A number as a table for programs has it: seven digits, nothing for none. */
export const plain = (value: Value | undefined) =>
  value === null || value === undefined ? '' : String(Number(value.toPrecision(7)));

/** The numbers behind a chart as a table; of lines the x of the chart, then one column each. */
export function tableOf(spec: ChartSpec): string[][] {
  if (spec.table) return spec.table;
  const head = [spec.x.label, ...spec.series.map((series) => series.label)];
  const rows = spec.places.map((x, i) =>
    [x, ...spec.columns.map((column) => column[i])].map(plain),
  );
  return [head, ...rows];
}
