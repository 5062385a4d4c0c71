import { describe, expect, it } from 'vitest';
import { LIGHT } from '../../../src/chart/colours';
import { tableOf } from '../../../src/chart/spec';
import type { Result, ResultRun } from '../../../src/app/api/types';
import { words } from '../../../src/app/api/client';
import { atPlaces, compareSpec, dropDifference, pairs } from '../../../src/app/model/compare';
import { differences } from '../../../src/app/model/differences';
import { fieldOf, idOf, isPlaceholder, setField, stepOf } from '../../../src/app/model/fields';
import { exampleForm } from './form';

describe('fields', () => {
  it('are read and set by their path', () => {
    const form = exampleForm();
    for (const [path, value] of [['name', 'S2'], ['channel.length', '5 mm'], ['fluid.density', '998 kg/m3']]) {
      setField(form, path, value);
      expect(fieldOf(form, path)).toBe(value);
    }
    expect(fieldOf(form, 'wall.thickness')).toBeNull();
  });

  it('know the step in which a fault of theirs is mended', () => {
    expect(['channel.origin', 'hydrostatic.pressure', 'flow', 'fluid.density', 'instrument.wavelength', 'instrument.pressure_noise'].map(stepOf))
      .toEqual(['channel', 'calibration', 'runs', 'runs', 'maps', 'calibration']);
    expect([stepOf('rigid.inlet'), stepOf(null)]).toEqual([null, null]);
    expect(idOf('channel.length')).toBe('field-channel-length');
  });

  it('tell a placeholder from a value', () => {
    expect([isPlaceholder('? mm'), isPlaceholder('1 mm'), isPlaceholder(null)]).toEqual([true, false, false]);
  });
});

describe('two states of a file', () => {
  it('differ in words, key by key and by rows of lists', () => {
    const [here, there] = [exampleForm(), exampleForm()];
    expect(differences(here, there)).toEqual([]);
    there.channel.length = '5 mm';
    there.channel.origin = null;
    there.hydrostatic!.rows[1][1] = '120';
    there.hydrostatic!.rows.push(['h02.gsf', '200']);
    there.flow = { file: 'flow.csv', columns: ['map'], rows: [], locked: null };
    expect(differences(here, there)).toEqual([
      'channel.length: here "4 mm", in the file "5 mm"',
      'channel.origin: here 0.5 mm, 0.25 mm, in the file nothing',
      'hydrostatic: 2 rows differ',
      'flow: a list there alone',
    ]);
  });
});

it('what is wrong and what to do are two sentences', () => {
  expect(words({ found: 'the file is empty', mend: 'Write something' })).toBe('the file is empty. Write something.');
  expect(words({ found: 'Is it there?', mend: '' })).toBe('Is it there?');
});

describe('two results', () => {
  const run = (name: string, drop: number | null): ResultRun => ({
    run: name, flow_rate_m3_s: 1e-6, verdict: null, extracted_drop_Pa: drop, extracted_drop_uncertainty_Pa: 5,
    pressure_Pa: [3000, 2000, null, 0], pressure_uncertainty_Pa: [10, 20, null, 10],
  });
  const result = (output: string, runs: ResultRun[], x = [0, 1e-3, 2e-3, 3e-3]): Result => ({ output, title: '', x_m: x, runs, warnings: [] });

  it('are compared run by run, by name', () => {
    const list = pairs(result('a', [run('Q5', 10), run('Q10', 20)]), result('b', [run('Q10', 25), run('Q20', 40)]));
    expect(list.map((pair) => [pair.run, pair.first !== null, pair.second !== null])).toEqual([
      ['Q5', true, false], ['Q10', true, true], ['Q20', false, true],
    ]);
    expect(list.map(dropDifference)).toEqual([null, 5, null]);
  });

  it('are laid over each other at the places of the first, with k = 2', () => {
    const [a, b] = [result('a', [run('Q5', 1)]), result('b', [run('Q5', 1)], [0, 0.5e-3, 1e-3, 3e-3])];
    const spec = compareSpec(a, b, pairs(a, b)[0], LIGHT);
    expect(tableOf(spec)[0]).toEqual(['x (mm)', 'a', 'a, lower end', 'a, upper end', 'b', 'b, lower end', 'b, upper end']);
    expect(spec.columns[1][1]).toBeCloseTo(1.96, 9); // kPa
    expect(spec.columns[3]).toEqual([3, null, null, 0]);
    expect(spec.y.range[1]).toBeGreaterThan(3);
  });

  it('bridge no gap', () => {
    expect(atPlaces([0, 1, 2], [0, 10, null], [0, 0.5, 1, 1.5, 2, 3])).toEqual([0, 5, 10, null, null, null]);
  });
});
