// The experiment that is open: what the page holds of its file, and how both stay the same.

import { SvelteSet } from 'svelte/reactivity';
import { Refused, api } from '../api/client';
import type { Body, Experiment, Fault, Form, Pair, Text } from '../api/types';
import { differences } from './differences';
import { setField } from './fields';
import { type ListName, sentList } from './lists';
import { type Kept, forget, keep, kept } from './unsaved';

const PAUSE = 500; // ms from the last change to saving
const MOST_UNDOS = 100;

export type Status = 'saved' | 'changed' | 'saving' | 'unsaved';

const copy = <T>(value: T): T => JSON.parse(JSON.stringify(value)) as T;

/** The form as it is sent: lists without empty rows. */
function sentForm(form: Form): { form: Form; rows: Record<ListName, number[]> } {
  const sent = copy(form);
  const rows: Record<ListName, number[]> = { hydrostatic: [], flow: [] };
  for (const name of ['hydrostatic', 'flow'] as const) {
    const list = sent[name];
    if (list === null) continue;
    const whole = sentList(list);
    sent[name] = whole.list;
    rows[name] = whole.rows;
  }
  return { form: sent, rows };
}

export class Draft {
  readonly file: string;
  form = $state<Form | null>(null);
  text = $state(''); // as the file has it, or will have it
  lists = $state.raw<Record<string, string>>({}); // texts of its lists
  typed = $state<string | null>(null); // the text while it is edited itself
  faults = $state.raw<Fault[]>([]);
  notes = $state.raw<string[]>([]);
  mapsChecked = $state(false);
  status = $state<Status>('saved');
  trouble = $state(''); // why nothing can be saved
  conflict = $state.raw<Experiment | null>(null); // the file as others left it
  told = $state(''); // what happened to the file from outside
  readonly touched = new SvelteSet<string>(); // fields that were set here
  private revision: string | null = null;
  private undone = $state.raw<string[]>([]);
  private base = ''; // the form before the change that is being made
  private timer: ReturnType<typeof setTimeout> | undefined;
  private readonly place: string; // of what is not saved, in the browser

  constructor(experiment: Experiment, folder: string) {
    this.file = experiment.file;
    this.place = `${folder}\n${experiment.file}`;
    this.take(experiment);
    const unsaved = kept(this.place);
    if (unsaved) this.resume(unsaved, experiment);
  }

  /** Folder of the file within the served one; "" for that itself. */
  get folder(): string {
    return this.file.includes('/') ? this.file.slice(0, this.file.lastIndexOf('/')) : '';
  }
  get locked(): boolean {
    return this.typed !== null || this.form === null || this.conflict !== null;
  }
  get canUndo(): boolean {
    return this.undone.length > 0 && !this.locked;
  }

  faultsOf(key: string, row: number | null = null): Fault[] {
    return this.faults.filter((fault) => fault.key === key && fault.row === row);
  }

  /** Changes the form; it is saved a moment later. */
  edit(change: (form: Form) => void): void {
    if (this.form === null || this.locked) return;
    if (this.base === '') this.base = JSON.stringify(this.form);
    change(this.form);
    this.changed();
  }

  /** Sets one field; what stood there as a guess is none any more. */
  set(path: string, value: Text | Pair): void {
    this.touched.add(path);
    this.edit((form) => setField(form, path, value));
  }

  undo(): void {
    const last = this.undone[this.undone.length - 1];
    if (last === undefined || this.locked) return;
    this.undone = this.undone.slice(0, -1);
    this.form = JSON.parse(last) as Form;
    this.base = '';
    this.changed();
  }

  private changed(): void {
    this.status = this.status === 'saving' ? 'saving' : 'changed';
    this.told = '';
    this.keepForm();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.save(), PAUSE);
  }

  /** Saves what is not saved yet. */
  async save(): Promise<void> {
    clearTimeout(this.timer);
    if (this.form === null || this.conflict || this.status === 'saving' || this.status === 'saved') return;
    this.status = 'saving';
    const before = JSON.stringify(this.form);
    const { form, rows } = sentForm(this.form);
    const saved = await this.put({ form });
    if (saved === null) return;
    this.hear(saved, rows);
    if (this.base !== '' && this.base !== before) this.undone = [...this.undone.slice(1 - MOST_UNDOS), this.base];
    const more = JSON.stringify(this.form) !== before;
    this.base = more ? before : '';
    this.status = more ? 'changed' : 'saved';
    if (!more) return forget(this.place);
    this.keepForm();
    return this.save();
  }

  private keepForm(): void {
    keep(this.place, { revision: this.revision, form: copy(this.form!) });
  }

  private async put(body: Body): Promise<Experiment | null> {
    try {
      const saved = await api.save(this.file, body, this.revision);
      this.trouble = '';
      return saved;
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      this.status = 'unsaved';
      if (error.status !== 412) {
        this.trouble = error.words;
        return null;
      }
      const there = (error.body as { experiment: Experiment }).experiment;
      if (same(body, there)) return there;
      this.conflict = there;
      return null;
    }
  }

  /** The text is edited itself; the form waits. */
  type(text: string): void {
    this.typed = text;
    keep(this.place, { revision: this.revision, text });
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.checkTyped(), PAUSE);
  }

  private async checkTyped(): Promise<void> {
    const text = this.typed;
    if (text === null) return;
    const checked = await api.check(this.file, { text }).catch(() => null);
    if (checked === null || this.typed !== text) return;
    this.faults = checked.faults;
    this.notes = checked.notes;
  }

  async saveTyped(): Promise<void> {
    clearTimeout(this.timer);
    if (this.typed === null || this.conflict) return;
    const text = this.typed;
    const before = this.form === null ? '' : JSON.stringify(this.form);
    this.status = 'saving';
    const saved = await this.put({ text });
    if (saved === null || this.typed !== text) return;
    this.typed = null;
    this.take(saved);
    if (before !== '') this.undone = [...this.undone.slice(1 - MOST_UNDOS), before];
    forget(this.place);
  }

  async discardTyped(): Promise<void> {
    const there = await api.experiment(this.file);
    this.typed = null;
    forget(this.place);
    this.take(there);
  }

  /** Looks whether the file is still the one that is shown. */
  async look(): Promise<void> {
    if (this.conflict || this.status === 'saving') return;
    const there = await api.experiment(this.file).catch(() => null);
    // Saving that began or ended meanwhile knows better.
    if (there === null || this.conflict || this.isSaving()) return;
    if (there.revision === this.revision) {
      // The lists' maps may have come or gone.
      if (this.status === 'saved' && this.typed === null) this.hear(there, sentForm(this.form ?? there.form!).rows);
      return;
    }
    if (this.status === 'saved' && this.typed === null) {
      this.take(there);
      this.told = 'The file was changed outside this page; it is shown as it is now.';
    } else this.conflict = there;
  }

  private isSaving(): boolean {
    return this.status === 'saving';
  }

  /** In a conflict: what the file says now. */
  takeTheirs(): void {
    if (this.conflict === null) return;
    this.take(this.conflict);
    this.typed = null;
    this.conflict = null;
    this.trouble = '';
    forget(this.place);
  }

  /** In a conflict: what this page says. */
  async keepMine(): Promise<void> {
    if (this.conflict === null) return;
    this.revision = this.conflict.revision;
    this.conflict = null;
    if (this.typed !== null) return this.saveTyped();
    this.status = 'changed';
    await this.save();
  }

  /** What differs, in words, where two forms can be compared. */
  conflictWords(): string[] {
    const theirs = this.conflict?.form;
    if (!theirs || !this.form || this.typed !== null) return [];
    return differences(sentForm(this.form).form, theirs);
  }

  async checkMaps(): Promise<void> {
    if (this.form === null) return;
    const { form, rows } = sentForm(this.form);
    const checked = await api.check(this.file, this.typed === null ? { form } : { text: this.typed }, true);
    this.faults = placed(checked.faults, rows);
    this.notes = checked.notes;
    this.mapsChecked = checked.maps_checked;
  }

  body(): Body | null {
    if (this.typed !== null) return { text: this.typed };
    return this.form === null ? null : { form: sentForm(this.form).form };
  }

  private take(experiment: Experiment): void {
    this.form = experiment.form && copy(experiment.form);
    this.base = '';
    this.status = 'saved';
    this.hear(experiment, this.form ? sentForm(this.form).rows : { hydrostatic: [], flow: [] });
  }

  /** What the program says of the file, the form left as it is. */
  private hear(experiment: Experiment, rows: Record<ListName, number[]>): void {
    this.revision = experiment.revision;
    this.text = experiment.text;
    this.lists = experiment.lists;
    this.faults = placed(experiment.faults, rows);
    this.notes = experiment.notes;
    this.mapsChecked = experiment.maps_checked;
    if (this.form && experiment.form) this.form.comments = experiment.form.comments;
  }

  private resume(unsaved: Kept, experiment: Experiment): void {
    const { form, text } = unsaved;
    const body = text !== undefined ? { text } : form ? sentForm(form) : null;
    if (body === null || same(body, experiment)) return forget(this.place);
    if (text !== undefined) this.typed = text;
    else this.form = form!;
    if (unsaved.revision !== experiment.revision) {
      this.status = 'unsaved';
      this.conflict = experiment;
    } else if (this.typed !== null) void this.checkTyped();
    else {
      this.status = 'changed';
      void this.save();
    }
  }
}

/** Whether a file says it already: the page may have gone while its last words were on their way. */
function same(body: Body, { text, form }: Experiment): boolean {
  if ('text' in body) return body.text === text;
  return form !== null && differences(body.form, form).length === 0;
}

/** Faults of lists at the rows that the page shows. */
function placed(faults: Fault[], rows: Record<ListName, number[]>): Fault[] {
  return faults.map((fault) => {
    const list = fault.key?.split('.')[0];
    if (fault.row === null || (list !== 'hydrostatic' && list !== 'flow')) return fault;
    return { ...fault, row: rows[list][fault.row] ?? fault.row };
  });
}

