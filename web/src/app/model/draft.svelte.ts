// The experiment that is open: what the page holds of its file, and how both stay the same.

import { SvelteSet } from 'svelte/reactivity';
import { Refused, api } from '../api/client';
import type { Body, Experiment, Fault, Form, Pair, Text } from '../api/types';
import { differences } from './differences';
import { setField } from './fields';
import { History } from './history.svelte';
import { type Rows, copy, placed, rowsOf, same, sentForm } from './sent';
import { type Kept, forget, keep, kept } from './unsaved';

const PAUSE = 500; // ms from the last change to saving

export type Status = 'saved' | 'changed' | 'saving' | 'unsaved';
/** Texts that are edited themselves, by the names of lists; '' is the experiment's. */
export type Typed = Record<string, string>;

export class Draft {
  readonly file: string;
  form = $state<Form | null>(null);
  text = $state(''); // as the file has it, or will have it
  lists = $state.raw<Record<string, string>>({}); // texts of its lists
  typed = $state.raw<Typed | null>(null);
  faults = $state.raw<Fault[]>([]);
  notes = $state.raw<string[]>([]);
  mapsChecked = $state(false);
  status = $state<Status>('saved'); // of the form; of the text while that is sent
  trouble = $state(''); // why nothing can be saved
  conflict = $state.raw<Experiment | null>(null); // the file as others left it
  told = $state(''); // what happened to the file from outside
  output = $state(''); // folder of the next result; '' for the usual one
  readonly touched = new SvelteSet<string>(); // fields that were set here
  private readonly history = new History();
  private base = $state.raw(''); // the form before the change that is being made
  private revision: string | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private running: Promise<void> | null = null; // saving
  private puts = 0;
  private looks = 0;
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
  /** The text waits for the form: it does not say yet what the form says. */
  get textLocked(): boolean {
    return this.conflict !== null || (this.typed === null && this.status !== 'saved');
  }
  get canUndo(): boolean {
    return (this.history.canUndo || this.base !== '') && !this.locked;
  }
  get canRedo(): boolean {
    return this.history.canRedo && this.base === '' && !this.locked;
  }
  /** What closing the tab would lose. */
  get unsafe(): boolean {
    return this.typed !== null || this.conflict !== null || this.status === 'unsaved';
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
    this.step((now) => this.history.undo(now));
  }

  redo(): void {
    this.step((now) => this.history.redo(now));
  }

  private step(to: (now: string) => string | undefined): void {
    if (this.locked) return;
    this.endStep();
    const state = to(JSON.stringify(this.form));
    if (state === undefined) return;
    this.form = JSON.parse(state) as Form;
    this.changed();
  }

  /** What was changed until now is one step for Undo. */
  private endStep(): void {
    if (this.base !== '' && this.base !== JSON.stringify(this.form)) this.history.add(this.base);
    this.base = '';
  }

  private changed(): void {
    if (this.status !== 'saving') this.status = 'changed';
    this.told = '';
    this.keepForm();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.save(), PAUSE);
  }

  /** Saves what the form has changed; done when nothing of it is under way. A text that is edited waits. */
  async save(): Promise<void> {
    if (this.typed === null) await this.once(() => this.saveForm());
  }

  /** Saves what is edited now: the text, else the form. */
  async saveNow(): Promise<void> {
    await (this.typed === null ? this.save() : this.once(() => this.saveText()));
  }

  private once(act: () => Promise<void>): Promise<void> {
    clearTimeout(this.timer);
    this.running ??= act().finally(() => (this.running = null));
    return this.running;
  }

  private async saveForm(): Promise<void> {
    while (this.form !== null && !this.locked && this.status !== 'saved') {
      this.endStep();
      this.status = 'saving';
      const before = JSON.stringify(this.form);
      const { form, rows } = sentForm(this.form);
      const saved = await this.put({ form });
      if (saved === null) return;
      const more = JSON.stringify(this.form) !== before;
      this.hear(saved, rows);
      this.status = more ? 'changed' : 'saved';
      if (more) this.keepForm();
      else forget(this.place);
    }
  }

  private async saveText(): Promise<void> {
    const typed = this.typed;
    if (typed === null || this.conflict) return;
    const before = this.form && JSON.stringify(this.form);
    this.status = 'saving';
    const saved = await this.put(this.bodyOf(typed));
    if (saved === null) return;
    this.take(saved);
    if (before !== null && before !== JSON.stringify(this.form)) this.history.add(before);
    // What was typed meanwhile goes on from there.
    if (this.typed !== typed) return this.keepTyped();
    this.typed = null;
    forget(this.place);
  }

  private keepForm(): void {
    keep(this.place, { revision: this.revision, form: copy(this.form!) });
  }

  private keepTyped(): void {
    keep(this.place, { revision: this.revision, typed: this.typed! });
  }

  private async put(body: Body): Promise<Experiment | null> {
    ++this.puts;
    try {
      const saved = await api.save(this.file, body, this.revision);
      this.trouble = '';
      return saved;
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      const there = error.status === 412 ? (error.body as { experiment: Experiment }).experiment : null;
      if (there && same(body, there)) return there;
      this.status = 'unsaved';
      if (there) this.conflict = there;
      else this.trouble = error.words;
      return null;
    }
  }

  /** A text is edited itself, of the experiment ('') or of one of its lists; the form waits. */
  type(text: string, list = ''): void {
    if (this.textLocked) return;
    this.typed = { ...this.typed, [list]: text };
    this.keepTyped();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.checkTyped(), PAUSE);
  }

  private async checkTyped(): Promise<void> {
    const typed = this.typed;
    if (typed === null) return;
    const checked = await api.check(this.file, this.bodyOf(typed)).catch(() => null);
    if (checked === null || this.typed !== typed) return;
    this.faults = checked.faults;
    this.notes = checked.notes;
  }

  async discardTyped(): Promise<void> {
    const there = await api.experiment(this.file);
    this.typed = null;
    forget(this.place);
    if (there.revision !== this.revision) this.history.clear();
    this.take(there);
  }

  /** Looks whether the file is still the one that is shown. */
  async look(): Promise<void> {
    while (this.running !== null) await this.running;
    if (this.conflict) return;
    const [look, puts] = [++this.looks, this.puts];
    const there = await api.experiment(this.file).catch(() => null);
    // A later look knows better; what was read before or during a save says nothing any more.
    if (there === null || this.conflict || look !== this.looks) return;
    if (puts !== this.puts) return this.look();
    const idle = this.status === 'saved' && this.typed === null;
    if (there.revision === this.revision) {
      // The lists' maps may have come or gone.
      if (idle) this.hear(there, rowsOf(this.form));
    } else if (idle) {
      this.history.clear();
      this.take(there);
      this.told = 'The file was changed outside this page; it is shown as it is now.';
    } else this.conflict = there;
  }

  /** In a conflict: what the file says now. */
  takeTheirs(): void {
    if (this.conflict === null) return;
    this.history.clear();
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
    this.status = 'changed';
    await this.saveNow();
  }

  /** What differs, in words, where two forms can be compared. */
  conflictWords(): string[] {
    const theirs = this.conflict?.form;
    if (!theirs || !this.form || this.typed !== null) return [];
    return differences(sentForm(this.form).form, theirs);
  }

  async checkMaps(): Promise<void> {
    const body = this.body();
    if (body === null) return;
    const rows = rowsOf(this.form);
    const checked = await api.check(this.file, body, true);
    this.faults = placed(checked.faults, rows);
    this.notes = checked.notes;
    this.mapsChecked = checked.maps_checked;
  }

  body(): Body | null {
    if (this.typed !== null) return this.bodyOf(this.typed);
    return this.form && { form: sentForm(this.form).form };
  }

  private bodyOf({ '': text = this.text, ...lists }: Typed): Body {
    return { text, lists };
  }

  private take(experiment: Experiment): void {
    this.form = experiment.form && copy(experiment.form);
    this.base = '';
    this.status = 'saved';
    this.hear(experiment, rowsOf(this.form));
  }

  /** What the program says of the file, the form left as it is. */
  private hear(experiment: Experiment, rows: Rows): void {
    this.revision = experiment.revision;
    this.text = experiment.text;
    this.lists = experiment.lists;
    this.faults = placed(experiment.faults, rows);
    this.notes = experiment.notes;
    this.mapsChecked = experiment.maps_checked;
    if (this.form && experiment.form) this.form.comments = experiment.form.comments;
  }

  private resume({ revision, form, typed }: Kept, experiment: Experiment): void {
    const body = typed ? this.bodyOf(typed) : form && { form: sentForm(form).form };
    if (!body || same(body, experiment)) return forget(this.place);
    if (typed) this.typed = typed;
    else this.form = form!;
    if (revision !== experiment.revision) {
      this.status = 'unsaved';
      this.conflict = experiment;
    } else if (typed) void this.checkTyped();
    else {
      this.status = 'changed';
      void this.save();
    }
  }
}
