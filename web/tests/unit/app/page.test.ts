// What the page says and hears besides the form: commands, keys, faults that come and go, options.

import { afterEach, describe, expect, it, vi } from 'vitest';
import { execFileSync } from 'node:child_process';
import type { Fault } from '../../../src/app/api/types';
import { measureCommand, quoted } from '../../../src/app/model/command';
import { stepOfKey } from '../../../src/app/model/keys';
import { MeasureOptions } from '../../../src/app/model/measure_options.svelte';
import { faultGroups, faultNews, placeOf } from '../../../src/app/model/faults';

describe('a command', () => {
  it('comes through a shell word by word', () => {
    const words = ['plain', 'two words', "it's", '$HOME', '`x`', '"', '\\', '*', 'µm', '', '~'];
    const said = execFileSync('sh', ['-c', `printf '%s\\n' ${words.map(quoted).join(' ')}`], { encoding: 'utf8' });
    expect(said.split('\n').slice(0, -1)).toEqual(words);
  });

  it('names files by whole paths and options as the server gives them', () => {
    expect(measureCommand('/data/my maps', 's1/experiment.toml', 's1-result', { 'rim-margin': '50 um', draws: '10' })).toBe(
      "manoscope measure '/data/my maps/s1/experiment.toml' -o '/data/my maps/s1-result' --draws=10 '--rim-margin=50 um'",
    );
    expect(measureCommand('/', 'experiment.toml', 'result', {})).toBe('manoscope measure /experiment.toml -o /result');
  });
});

it('keys go back and forth', () => {
  const pressed = (key: string, more = {}) =>
    stepOfKey({ key, ctrlKey: true, metaKey: false, altKey: false, shiftKey: false, ...more });
  expect([pressed('z'), pressed('Z', { shiftKey: true }), pressed('y'), pressed('z', { ctrlKey: false, metaKey: true })])
    .toEqual(['undo', 'redo', 'redo', 'undo']);
  expect([pressed('z', { ctrlKey: false }), pressed('z', { altKey: true }), pressed('a')]).toEqual([null, null, null]);
});

describe('faults', () => {
  const fault = (text: string, row: number | null = null): Fault =>
    ({ file: null, line: null, key: 'channel.length', row, column: null, found: text, mend: '', text });

  it('that come are read out, those that go are counted, the rest is silence', () => {
    const [a, b, c] = [fault('a.'), fault('b.'), fault('b.', 1)];
    expect(faultNews([], [a])).toBe('a.');
    expect(faultNews([a], [a, b, c])).toBe('b. And 1 more.');
    expect(faultNews([a, b, c], [a, b])).toBe('2 faults left.');
    expect(faultNews([a], [])).toBe('No fault left.');
    expect(faultNews([a], [fault('a.')])).toBe('');
  });

  it('of one kind in many rows are one entry, of many fields many', () => {
    const rows = [3, 4, 9].map((line, row) => ({ ...fault('no number.', row), file: 'flow.csv', line }));
    const groups = faultGroups([fault('a.'), fault('a.'), ...rows, { ...rows[0], text: 'other.' }]);
    expect(groups.map(({ length }) => length)).toEqual([1, 1, 3, 1]);
    expect(groups.map(placeOf)).toEqual([
      'channel.length', 'channel.length', 'flow.csv, lines 3 to 9: channel.length', 'flow.csv, line 3: channel.length',
    ]);
  });
});

describe('options of the measurement', () => {
  afterEach(() => vi.unstubAllGlobals());

  it('are the same in two tabs, neither of which overwrites what the other set', () => {
    const store = new Map<string, string>();
    const tabs = new EventTarget();
    vi.stubGlobal('localStorage', {
      getItem: (key: string) => store.get(key) ?? null,
      setItem: (key: string, value: string) => void store.set(key, value),
    });
    vi.stubGlobal('addEventListener', (kind: string, hear: (event: globalThis.Event) => void) => tabs.addEventListener(kind, hear));
    const [one, other] = [new MeasureOptions(), new MeasureOptions()];
    for (const tab of [one, other]) tab.turnTo('/data');
    one.set('rim-margin', '50 um');
    other.set('draws', '10'); // before it heard of the first
    const wanted = { 'rim-margin': '50 um', draws: '10' };
    expect(other.given).toEqual(wanted);
    tabs.dispatchEvent(Object.assign(new Event('storage'), { key: [...store.keys()][0] }));
    expect(one.given).toEqual(wanted);
    one.set('draws', '');
    expect(one.given).toEqual({ 'rim-margin': '50 um' });
  });
});
