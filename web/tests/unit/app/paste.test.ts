import { describe, expect, it } from 'vitest';
import type { List } from '../../../src/app/api/types';
import { addRow, emptyList, headOf, sentList, typedCell, unlisted, withColumn, COLUMNS } from '../../../src/app/model/lists';
import { mapNamed, paste, pastedCells, pastedWords } from '../../../src/app/model/paste';

const MAPS = ['h00.gsf', 'h01.gsf', 'h02.gsf', 'f00.gsf'];

function levels(): List {
  const list = emptyList('hydrostatic');
  for (const map of MAPS.slice(0, 3)) addRow(list, map);
  return list;
}
const sheet = (text: string) => pastedCells(text)!;
const put = (list: List, text: string, row = 0, column = 1) => paste('hydrostatic', list, sheet(text), row, column, MAPS);

describe('what is pasted', () => {
  it('is rows of cells, by tabs, semicolons or commas', () => {
    expect(pastedCells('a\tb\r\nc\td\r\n')).toEqual([['a', 'b'], ['c', 'd']]);
    expect(pastedCells('a;1,5\nb;2,5')).toEqual([['a', '1,5'], ['b', '2,5']]);
    expect(pastedCells('a,1\nb,2')).toEqual([['a', '1'], ['b', '2']]);
    expect(pastedCells('"a ""x"""\t1\n')).toEqual([['a "x"', '1']]);
  });

  it('is one column of numbers with decimal commas', () => {
    expect(pastedCells('0,5\n1,5\n')).toEqual([['0,5'], ['1,5']]);
  });

  it('is left to the cell itself if it is a single one', () => {
    expect([pastedCells('12.5'), pastedCells('1,5'), pastedCells('12.5\n')]).toEqual([null, null, null]);
  });
});

describe('pasting', () => {
  it('goes down from the cell with the cursor, and on into new rows', () => {
    const list = levels();
    put(list, '100\n200\n300', 1);
    expect(list.rows).toEqual([['h00.gsf', ''], ['h01.gsf', '100'], ['h02.gsf', '200'], ['', '300']]);
  });

  it('finds the rows by the names of the maps, in any order', () => {
    const list = levels();
    const done = put(list, 'h02.gsf\t200\nH01\t100\nh00.gsf\t0\n');
    expect(list.rows).toEqual([['h00.gsf', '0'], ['h01.gsf', '100'], ['h02.gsf', '200']]);
    expect(done).toEqual({ cells: 3, rows: 3, unknown: [] });
  });

  it('takes the values before the names as well', () => {
    const list = levels();
    put(list, '200\th02\n100\th01');
    expect(list.rows.map((row) => row[1])).toEqual(['', '100', '200']);
  });

  it('heeds a head: columns, their units, columns that are not there yet', () => {
    const list = levels();
    const done = put(list, 'File\tPressure (kPa)\tuncertainty [Pa]\tremark\nh01\t0,5\t2\tgood\nh02\t1,25\t3\t\n');
    expect(list.columns).toEqual(['map', 'pressure [Pa]', 'pressure_uncertainty [Pa]']);
    expect(list.rows).toEqual([['h00.gsf', '', ''], ['h01.gsf', '500', '2'], ['h02.gsf', '1250', '3']]);
    expect(done.cells).toBe(4);
  });

  it('gives a new column the unit of its head', () => {
    const list = levels();
    put(list, 'map\tp [Pa]\tu [mbar]\nh00\t0\t0.1');
    expect(list.columns[2]).toBe('pressure_uncertainty [mbar]');
    expect(list.rows[0]).toEqual(['h00.gsf', '0', '0.1']);
  });

  it('tells names that no map has, and adds rows for maps that the list lacks', () => {
    const list = levels();
    const done = put(list, 'h00\t5\nh77\t6\nf00\t7');
    expect(list.rows[0]).toEqual(['h00.gsf', '5']);
    expect(list.rows[3]).toEqual(['f00.gsf', '7']);
    expect(list.rows).toHaveLength(4);
    expect(done.unknown).toEqual(['h77']);
    expect(pastedWords(done)).toBe('Pasted 2 values into 2 rows. No map of the folder is called h77: left out.');
  });

  it('leaves out columns beyond the last one', () => {
    const list = levels();
    put(list, '1\t2\t3');
    expect(list.rows[0]).toEqual(['h00.gsf', '1']);
  });
});

describe('a map', () => {
  it('is known without folder and ending, if only one can be meant', () => {
    expect(mapNamed('C:\\data\\H01.GSF', MAPS)).toBe('h01.gsf');
    expect(mapNamed('h01', MAPS)).toBe('h01.gsf');
    expect(mapNamed('h01', ['a/h01.gsf', 'b/h01.gsf'])).toBeNull();
    expect(mapNamed('a/h01.gsf', ['a/h01.gsf', 'b/h01.gsf'])).toBe('a/h01.gsf');
    expect(mapNamed('2.5', MAPS)).toBeNull();
  });

  it('is in no list until one names it, or a page of it', () => {
    const list = emptyList('hydrostatic');
    addRow(list, 'h00.gsf');
    addRow(list, 'stack.tif#2');
    expect(unlisted(['h00.gsf', 'stack.tif', 'h01.gsf'], [list, null])).toEqual(['h01.gsf']);
  });
});

describe('a list', () => {
  it('is sent without its empty rows, which keep their place here', () => {
    const list = levels();
    list.rows.splice(1, 0, ['', ' ']);
    const sent = sentList(list);
    expect(sent.list.rows.map((row) => row[0])).toEqual(['h00.gsf', 'h01.gsf', 'h02.gsf']);
    expect(sent.rows).toEqual([0, 2, 3]);
    expect(list.rows).toHaveLength(4);
  });

  it('takes a number with its unit in a column of another', () => {
    expect(typedCell('hydrostatic', 'pressure [mbar]', '2.5 kPa')).toBe('25');
    expect(typedCell('hydrostatic', 'pressure', '2.5 kPa')).toBe('2.5 kPa'); // written in experiment.toml
    expect(typedCell('flow', 'run', ' Q5 ')).toBe('Q5');
    expect(headOf(' flow_rate [mL/min] ')).toEqual({ name: 'flow_rate', unit: 'mL/min' });
  });

  it('gets a column once', () => {
    const list = levels();
    const kind = COLUMNS.hydrostatic[2];
    expect([withColumn(list, kind), withColumn(list, kind)]).toEqual([2, 2]);
    expect(list.rows.every((row) => row.length === 3)).toBe(true);
  });
});
