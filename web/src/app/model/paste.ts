// Cells pasted from a spreadsheet into a table of the experiment.

import type { List } from '../api/types';
import { COLUMNS, type ColumnKind, type ListName, addRow, fileOfMap, headText, indexOf, typedCell, withColumn } from './lists';
import { quantityOf } from './quantity';

export interface Pasted {
  cells: number; // how many were filled
  rows: number;
  unknown: string[]; // names that no map of the folder has
}

/** The cells of a pasted text; null where it is a single one, to be pasted as any text is. */
export function pastedCells(text: string): string[][] | null {
  const lines = text.replace(/\r\n?/g, '\n').replace(/\n+$/, '').split('\n');
  const mark = ['\t', ';', ','].find((m) => lines.some((line) => line.includes(m)) && (m !== ',' || !decimalCommas(lines)));
  if (lines.length === 1 && mark !== '\t') return null;
  return lines.map((line) => (mark === undefined ? [line] : line.split(mark)).map(unquoted));
}

const decimalCommas = (lines: string[]) => lines.every((line) => /^\s*[+-]?\d+,\d+\s*$/.test(line) || !line.includes(','));
const unquoted = (cell: string) => cell.trim().replace(/^"(.*)"$/, '$1').replaceAll('""', '"');

/** "Pressure (kPa)" of a spreadsheet's head -> the column that it means, and its unit. */
function headMeant(which: ListName, text: string): { kind: ColumnKind; unit: string } | null {
  const parts = /^(.*?)\s*(?:[[(]\s*(.*?)\s*[\])]|\/\s*(\S+)|,\s*(\S+))?\s*$/.exec(text.trim());
  if (!parts) return null;
  const name = parts[1].toLowerCase().replace(/[_\s]+/g, ' ').trim();
  const kind = COLUMNS[which].find((k) => k.name.replaceAll('_', ' ') === name || k.also.test(name));
  return kind ? { kind, unit: parts[2] ?? parts[3] ?? parts[4] ?? '' } : null;
}

const plainName = (name: string) => fileOfMap(name).replace(/^.*[/\\]/, '').toLowerCase();
const stem = (name: string) => plainName(name).replace(/\.[a-z0-9]{1,5}$/, '');

/** The map that a cell names, with or without folder and ending; null if none does, or several. */
export function mapNamed(cell: string, maps: string[]): string | null {
  if (cell.trim() === '') return null;
  for (const same of [(a: string, b: string) => a === b, byPlainName, byStem]) {
    const found = maps.filter((map) => same(map, cell.trim()));
    if (found.length === 1) return found[0];
  }
  return null;
}

const byPlainName = (a: string, b: string) => plainName(a) === plainName(b);
const byStem = (a: string, b: string) => stem(a) === stem(b);

interface Column {
  from: number; // of the pasted cells
  to: number; // of the list
  unit: string; // that a pasted head names; '' if none
}

/**
 * Fills a list with pasted cells. Where a pasted column names maps, its rows go to the rows of these
 * maps, wherever they stand, and rows that the list lacks are added; else they go down from the cell
 * (row, column) that has the cursor. A pasted head tells which column is which.
 *
 * @param maps  names of the maps in the folder.
 */
export function paste(which: ListName, list: List, cells: string[][], row: number, column: number, maps: string[]): Pasted {
  const known = [...new Set([...maps, ...list.rows.map((r) => r[indexOf(list, 'map')]).filter(Boolean)])];
  const heads = cells[0].map((cell) => headMeant(which, cell));
  const headed = heads.some((head) => head !== null) && cells[0].every((cell) => quantityOf(cell) === null);
  const body = headed ? cells.slice(1) : cells;
  const named = mapColumn(body, known, headed ? heads.findIndex((head) => head?.kind.name === 'map') : -1);
  const columns = headed ? columnsByHead(list, heads) : columnsInOrder(list, cells[0].length, named, column);
  const result: Pasted = { cells: 0, rows: 0, unknown: [] };
  body.forEach((line, i) => {
    const target = named < 0 ? rowAt(list, row + i) : rowOfMap(list, line[named] ?? '', known, result);
    if (target === null) return;
    result.rows += 1;
    for (const { from, to, unit } of columns) {
      if (from === named || line[from] === undefined) continue;
      const text = line[from] === '' || unit === '' || quantityOf(line[from])?.unit !== '' ? line[from] : `${line[from]} ${unit}`;
      target[to] = typedCell(which, list.columns[to], text);
      result.cells += 1;
    }
  });
  return result;

  function columnsByHead(into: List, meant: typeof heads): Column[] {
    return meant.flatMap((head, from) => {
      if (head === null) return [];
      const fresh = indexOf(into, head.kind.name) < 0;
      const to = withColumn(into, head.kind);
      const unit = head.kind.units && Object.hasOwn(head.kind.units, head.unit) ? head.unit : '';
      if (fresh && unit !== '' && into.file !== null) into.columns[to] = headText(head.kind.name, unit);
      return [{ from, to, unit }];
    });
  }
}

/** Which pasted column names maps: more than half of its cells do; -1 if none. */
function mapColumn(body: string[][], maps: string[], byHead: number): number {
  if (byHead >= 0) return byHead;
  const width = Math.max(0, ...body.map((line) => line.length));
  for (let c = 0; c < width; ++c) {
    const hits = body.filter((line) => mapNamed(line[c] ?? '', maps) !== null).length;
    if (hits > 0 && 2 * hits > body.length) return c;
  }
  return -1;
}

/** One after the other from the cell with the cursor; beside names of maps, from the first value on. */
function columnsInOrder(list: List, width: number, named: number, column: number): Column[] {
  const map = indexOf(list, 'map');
  const order = list.columns.map((_, i) => i).filter((i) => named < 0 || i !== map);
  const start = Math.max(0, order.indexOf(column));
  const values = Array.from({ length: width }, (_, from) => from).filter((from) => from !== named);
  return values
    .map((from, i) => ({ from, to: order[start + i], unit: '' }))
    .filter(({ to }) => to !== undefined);
}

function rowAt(list: List, at: number): string[] {
  while (list.rows.length <= at) addRow(list);
  return list.rows[at];
}

function rowOfMap(list: List, cell: string, maps: string[], result: Pasted): string[] | null {
  const map = mapNamed(cell, maps);
  if (map === null) {
    if (cell.trim() !== '') result.unknown.push(cell.trim());
    return null;
  }
  const at = indexOf(list, 'map');
  return list.rows.find((row) => row[at] === map) ?? addRow(list, map);
}

/** What was done, in words. */
export function pastedWords({ cells, rows, unknown }: Pasted): string {
  const done = `Pasted ${cells} ${cells === 1 ? 'value' : 'values'} into ${rows} ${rows === 1 ? 'row' : 'rows'}.`;
  if (unknown.length === 0) return done;
  const some = unknown.slice(0, 4).join(', ') + (unknown.length > 4 ? ` and ${unknown.length - 4} more` : '');
  return `${done} No map of the folder is called ${some}: left out.`;
}

