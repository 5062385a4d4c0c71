// The tables of an experiment: levels of the calibration, runs under flow.

import type { List } from '../api/types';
import { FLOW_RATES, PRESSURES, TIMES, cellIn } from './quantity';

export type ListName = 'hydrostatic' | 'flow';

export interface ColumnKind {
  name: string;
  words: string; // what a table's head says
  units: Record<string, number> | null;
  unit: string; // of a new column
  hint: string;
  also: RegExp; // heads of a spreadsheet that mean it
}

const kind = (
  name: string, words: string, units: Record<string, number> | null, unit: string, hint: string, also: RegExp,
): ColumnKind => ({ name, words, units, unit, hint, also });

const MAP = kind('map', 'Map', null, '', 'the file', /^(map|file|file ?name|name|datei)$/);

export const COLUMNS: Record<ListName, ColumnKind[]> = {
  hydrostatic: [
    MAP,
    kind('pressure', 'Pressure', PRESSURES, 'Pa', 'gauge pressure; 0 with an uncertainty of 0: vented to air',
      /^(p|pressure|gauge pressure|druck|level)$/),
    kind('pressure_uncertainty', 'its uncertainty', PRESSURES, 'Pa', 'standard, of this one reading; empty: the gauge’s noise',
      /^(u|u ?\(?p\)?|dp|pressure uncertainty|uncertainty|error|sigma)$/),
    kind('sequence', 'Order taken', null, '', '0, 1, 2 ...', /^(sequence|order|no|nr|#|n)$/),
    kind('direction', 'Direction', null, '', 'up or down', /^(direction|sweep)$/),
  ],
  flow: [
    MAP,
    kind('flow_rate', 'Flow rate', FLOW_RATES, 'mL/min', 'set or read', /^(q|flow|flow ?rate|rate|fluss)$/),
    kind('pressure_drop', 'Pressure drop', PRESSURES, 'Pa', 'of the transducer, inlet minus outlet',
      /^(dp|Δp|∆p|drop|pressure drop|pressure)$/),
    kind('pressure_drop_uncertainty', 'its uncertainty', PRESSURES, 'Pa', 'standard, of this one reading',
      /^(u ?\(?dp\)?|pressure drop uncertainty|uncertainty|error|sigma)$/),
    kind('outlet_pressure', 'Outlet pressure', PRESSURES, 'Pa', 'gauge pressure at the outlet', /^(outlet|outlet pressure|p ?out)$/),
    kind('time', 'Time', TIMES, 's', 'when the map was taken', /^(t|time|zeit)$/),
    kind('run', 'Run', null, '', 'maps of one run share its name', /^(run|series)$/),
  ],
};

/** "pressure [Pa]" -> name and unit. */
export function headOf(column: string): { name: string; unit: string } {
  const parts = /^\s*([^[\]]*?)\s*\[([^\]]*)\]\s*$/.exec(column);
  return parts ? { name: parts[1], unit: parts[2].trim() } : { name: column.trim(), unit: '' };
}

export const headText = (name: string, unit: string) => (unit === '' ? name : `${name} [${unit}]`);

export const indexOf = (list: List, name: string) =>
  list.columns.findIndex((column) => headOf(column).name === name);

export const kindOf = (which: ListName, column: string): ColumnKind | undefined =>
  COLUMNS[which].find(({ name }) => name === headOf(column).name);

export function emptyList(which: ListName): List {
  const columns = COLUMNS[which].slice(0, 2).map(({ name, unit }) => headText(name, unit));
  return { file: `${which}.csv`, columns, rows: [], locked: null };
}

/** Gives the list a column that it lacks; returns its position. */
export function withColumn(list: List, kind: ColumnKind): number {
  const known = indexOf(list, kind.name);
  if (known >= 0) return known;
  list.columns.push(headText(kind.name, list.file === null ? '' : kind.unit));
  for (const row of list.rows) row.push('');
  return list.columns.length - 1;
}

export function addRow(list: List, map = ''): string[] {
  const at = indexOf(list, 'map');
  list.rows.push(list.columns.map((_, i) => (i === at ? map : '')));
  return list.rows[list.rows.length - 1];
}

/** What the cell holds once `text` was typed: a number with a unit of its own becomes one in the column's. */
export function typedCell(which: ListName, column: string, text: string): string {
  const kind = kindOf(which, column);
  const { unit } = headOf(column);
  return kind?.units && unit !== '' ? cellIn(text, unit, kind.units) : text.trim();
}

/** Name of a map in a list without the page of its file: "stack.tif#3" -> "stack.tif". */
export const fileOfMap = (map: string) => map.replace(/#\d+$/, '');

/** Maps that no list names. */
export function unlisted(maps: string[], lists: (List | null)[]): string[] {
  const listed = new Set<string>();
  for (const list of lists) {
    if (list === null) continue;
    const at = indexOf(list, 'map');
    for (const row of list.rows) listed.add(fileOfMap(row[at] ?? ''));
  }
  return maps.filter((map) => !listed.has(map));
}

export const isEmptyRow = (row: string[]) => row.every((cell) => cell.trim() === '');

/** The list as it is sent, without rows that hold nothing, and where each of its rows stands here. */
export function sentList(list: List): { list: List; rows: number[] } {
  const rows = list.rows.map((_, i) => i).filter((i) => !isEmptyRow(list.rows[i]));
  return { list: { ...list, rows: rows.map((i) => [...list.rows[i]]) }, rows };
}
