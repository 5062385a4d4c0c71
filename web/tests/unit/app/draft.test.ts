// What the page holds of a file, against a server whose answers the test lets through one by one.

import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import type { Experiment, Form } from '../../../src/app/api/types';
import { Draft } from '../../../src/app/model/draft.svelte';
import { exampleForm } from './form';

interface Asked {
  method: string;
  revision: string | null; // that it is sent on
  body: { form?: Form; text?: string; lists?: Record<string, string> } | null;
  answer: (status: number, body: unknown) => Promise<void>;
}

let asked: Asked[] = [];
const store = new Map<string, string>();

beforeEach(() => {
  vi.useFakeTimers();
  asked = [];
  store.clear();
  vi.stubGlobal('sessionStorage', {
    getItem: (key: string) => store.get(key) ?? null,
    setItem: (key: string, value: string) => void store.set(key, value),
    removeItem: (key: string) => void store.delete(key),
  });
  vi.stubGlobal('fetch', (_: string, init: RequestInit) => new Promise((resolve) => {
    const headers = init.headers as Record<string, string> | undefined;
    asked.push({
      method: init.method!,
      revision: headers?.['If-Match']?.replaceAll('"', '') ?? null,
      body: init.body ? JSON.parse(String(init.body)) : null,
      answer: async (status, body) => {
        resolve(new Response(JSON.stringify(body), { status }));
        await vi.advanceTimersByTimeAsync(0);
      },
    });
  }));
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

function experiment(revision: string, change: (form: Form) => void = () => {}, text = `text of ${revision}`): Experiment {
  const form = exampleForm();
  change(form);
  return { file: 'experiment.toml', revision, text, lists: {}, form, faults: [], notes: [], maps_checked: false, hydrostatic_maps: 0, flow_maps: 0 };
}
const dense = (density: string) => (form: Form) => void (form.fluid.density = density);
const newest = () => asked[asked.length - 1];
const puts = () => asked.filter(({ method }) => method === 'PUT');
const wait = (ms: number) => vi.advanceTimersByTimeAsync(ms);
const begin = (first = experiment('r1')) => new Draft(first, '/data');

/** Sets a density and has it saved as a revision. */
async function saved(draft: Draft, density: string, revision: string): Promise<void> {
  draft.set('fluid.density', density);
  await wait(600);
  await newest().answer(200, experiment(revision, dense(density)));
}

describe('Undo', () => {
  it('goes back and forth, a change that is not saved yet being a step of its own', async () => {
    const draft = begin();
    await saved(draft, '1', 'r2');
    draft.set('fluid.density', '2');
    draft.undo();
    expect(draft.form!.fluid.density).toBe('1');
    draft.undo();
    expect(draft.form!.fluid.density).toBeUndefined();
    expect(draft.canUndo).toBe(false);
    draft.redo();
    draft.redo();
    expect([draft.form!.fluid.density, draft.canRedo]).toEqual(['2', false]);
    draft.undo();
    draft.set('fluid.density', '3');
    expect(draft.canRedo).toBe(false);
  });

  it('during a save does not come back to what was undone', async () => {
    const draft = begin();
    draft.set('fluid.density', '1');
    await wait(600);
    draft.undo();
    await newest().answer(200, experiment('r2', dense('1')));
    await newest().answer(200, experiment('r3'));
    expect([puts().length, draft.status, draft.canUndo, draft.canRedo]).toEqual([2, 'saved', false, true]);
  });

  it('takes back nothing that an editor or another tab wrote', async () => {
    const draft = begin();
    await saved(draft, '1', 'r2');
    expect(draft.canUndo).toBe(true);
    void draft.look();
    await wait(0);
    await newest().answer(200, experiment('r3', (form) => (form.channel.length = '5 mm')));
    expect([draft.form!.channel.length, draft.canUndo]).toEqual(['5 mm', false]);
  });

  it('nor what was taken from the file in a conflict', async () => {
    const draft = begin();
    await saved(draft, '1', 'r2');
    draft.set('fluid.density', '2');
    await wait(600);
    await newest().answer(412, { experiment: experiment('r3', dense('9')) });
    draft.takeTheirs();
    expect([draft.form!.fluid.density, draft.canUndo, draft.canRedo]).toEqual(['9', false, false]);
  });
});

describe('a look at the file', () => {
  it('that was answered before a save, and came after it, puts nothing back', async () => {
    const draft = begin();
    void draft.look();
    await wait(0);
    const early = newest();
    await saved(draft, '1', 'r2');
    await early.answer(200, experiment('r1'));
    expect(draft.form!.fluid.density).toBe('1');
    await newest().answer(200, experiment('r2', dense('1'))); // it looks again
    expect([draft.form!.fluid.density, draft.status, draft.conflict, draft.told]).toEqual(['1', 'saved', null, '']);
  });

  it('that is overtaken by a later one says nothing', async () => {
    const draft = begin();
    void draft.look();
    void draft.look();
    await wait(0);
    await asked[1].answer(200, experiment('r3', dense('3')));
    await asked[0].answer(200, experiment('r2', dense('2')));
    expect(draft.form!.fluid.density).toBe('3');
  });

  it('takes a text that is no TOML', async () => {
    const broken: Experiment = { ...experiment('r1'), form: null };
    const draft = begin(broken);
    const looked = draft.look();
    await wait(0);
    await newest().answer(200, { ...broken, notes: ['still broken'] });
    await looked; // rejected before: there was no form to count rows of
    expect(draft.notes).toEqual(['still broken']);
  });
});

describe('saving', () => {
  it('is waited for where it is under way already', async () => {
    const draft = begin();
    draft.set('fluid.density', '1');
    void draft.save();
    draft.set('fluid.density', '2');
    let done = false;
    void draft.save().then(() => (done = true));
    await newest().answer(200, experiment('r2', dense('1')));
    expect(done).toBe(false);
    await newest().answer(200, experiment('r3', dense('2')));
    expect([done, draft.status, newest().revision]).toEqual([true, 'saved', 'r2']);
  });

  it('goes on with what was changed meanwhile, by rows of which some are empty', async () => {
    const draft = begin();
    draft.edit((form) => form.hydrostatic!.rows.unshift(['', '']));
    await wait(600);
    expect(newest().body!.form!.hydrostatic!.rows).toHaveLength(2);
    const fault = { file: 'hydrostatic.csv', line: 2, key: 'hydrostatic.pressure', row: 0, column: 'pressure', found: 'x', mend: '', text: 'x.' };
    await newest().answer(200, { ...experiment('r2'), faults: [fault] });
    expect(draft.faultsOf('hydrostatic.pressure', 1)).toHaveLength(1); // the row that the page shows second
  });
});

describe('the text', () => {
  it('waits until the form is saved, which loses nothing', async () => {
    const draft = begin();
    draft.set('fluid.density', '1');
    expect(draft.textLocked).toBe(true);
    draft.type('other');
    expect(draft.typed).toBeNull();
    await wait(600);
    await newest().answer(200, experiment('r2', dense('1')));
    expect([newest().method, draft.textLocked]).toEqual(['PUT', false]);
  });

  it('that could not be saved is tried again as a text, and kept until then', async () => {
    const draft = begin();
    draft.type('mine');
    void draft.saveNow();
    await newest().answer(500, { error: { found: 'no', mend: '' } });
    expect([draft.status, draft.unsafe]).toEqual(['unsaved', true]);
    void draft.saveNow();
    expect(newest().body).toMatchObject({ text: 'mine' });
    expect([...store.values()].join()).toContain('mine');
    await newest().answer(200, experiment('r2', undefined, 'mine'));
    expect([draft.status, draft.typed, draft.unsafe, store.size]).toEqual(['saved', null, false, 0]);
  });

  it('is not saved when the page goes, but kept', async () => {
    const draft = begin();
    draft.type('mine');
    await draft.save();
    expect([puts().length, draft.typed]).toEqual([0, { '': 'mine' }]);
    const next = begin();
    expect(next.typed).toEqual({ '': 'mine' });
  });

  it('typed on while it is saved goes on from the new state', async () => {
    const draft = begin();
    draft.type('one');
    void draft.saveNow();
    draft.type('one and two');
    await newest().answer(200, experiment('r2', undefined, 'one'));
    expect([draft.status, draft.typed, draft.text]).toEqual(['saved', { '': 'one and two' }, 'one']);
    expect([...store.values()].map((text) => JSON.parse(text).revision)).toEqual(['r2']);
    void draft.saveNow();
    expect(newest().revision).toBe('r2');
  });

  it('of a list is sent beside that of the experiment', async () => {
    const draft = begin({ ...experiment('r1'), lists: { 'flow.csv': 'map\n' } });
    draft.type('map,run\n', 'flow.csv');
    draft.type('text of r1 # remark');
    void draft.saveNow();
    expect(newest().body).toMatchObject({ text: 'text of r1 # remark', lists: { 'flow.csv': 'map,run\n' } });
    await newest().answer(412, { experiment: { ...experiment('r2', undefined, 'text of r1 # remark'), lists: { 'flow.csv': 'map,run\n' } } });
    expect([draft.status, draft.conflict, draft.typed]).toEqual(['saved', null, null]); // it says so already
  });
});
