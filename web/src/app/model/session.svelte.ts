// The served folder, the job that runs in it, and what of it the page shows.

import { Refused, api, listen, pathAddress } from '../api/client';
import type { Entry, Event, FolderState, Job } from '../api/types';
import { Draft } from './draft.svelte';
import { STEPS, type Step } from './fields';

const MOST_LINES = 400; // of a job's log, as the server keeps

class Session {
  state = $state.raw<FolderState | null>(null);
  draft = $state.raw<Draft | null>(null);
  entries = $state.raw<Entry[]>([]); // of the folder of the experiment, or of the one that is browsed
  cut = $state(false); // there are more
  browsed = $state(''); // folder that is looked at while no experiment is open
  job = $state<Job | null>(null);
  online = $state(true);
  lost = $state(''); // why the server does not know this page, where it runs
  step = $state<Step>('maps');
  trouble = $state('');
  started = $state(false);
  arrived = $state(0); // how often a view was gone to: it then has the cursor

  /** Folder of the experiment, else the one that is browsed; "" for the served one itself. */
  get folder(): string {
    return this.draft?.folder ?? this.browsed;
  }
  /** Maps of the folder; a list is a table of numbers, too, but none of them. */
  get maps(): string[] {
    const lists = Object.keys(this.draft?.lists ?? {});
    return this.entries.filter(({ map, name }) => map && !lists.includes(name)).map(({ name }) => name);
  }
  get running(): boolean {
    return this.job?.state === 'running';
  }

  async start(): Promise<void> {
    window.addEventListener('hashchange', () => void this.follow());
    await this.attempt(async () => {
      await this.refresh();
      await this.follow();
      listen((event) => this.hear(event), (there) => this.reached(there));
    });
    this.started = true;
  }

  private reached(there: boolean): void {
    const again = there && !this.online;
    this.online = there;
    if (!there) return void this.askWhy();
    this.lost = '';
    if (!again) return;
    // What could not be saved or heard while the server was gone.
    if (this.draft?.status === 'unsaved') void this.draft.saveNow();
    void this.meanwhile(() => this.heed([this.draft?.file ?? '']));
  }

  /** A WebSocket does not tell why it was refused: a server that was started again knows no page of before. */
  private async askWhy(): Promise<void> {
    try {
      await api.state();
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      this.lost = error.status === 401 ? error.words : '';
    }
  }

  /** Does something that nobody asked for: a server that does not answer is told by itself. */
  private async meanwhile(act: () => Promise<void>): Promise<void> {
    try {
      await act();
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      if (error.status !== 0) this.trouble = error.words;
    }
  }

  /** Does something that the server may refuse, and says so. */
  async attempt(act: () => Promise<void>): Promise<boolean> {
    this.trouble = '';
    try {
      await act();
      return true;
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      this.trouble = error.words;
      return false;
    }
  }

  async refresh(): Promise<void> {
    this.state = await api.state();
    await this.readFolder();
  }

  private async readFolder(): Promise<void> {
    try {
      const { entries, truncated } = await api.files(this.folder);
      [this.entries, this.cut] = [entries, truncated];
    } catch (error) {
      // A new folder comes to be with the first map that is brought there.
      if (!(error instanceof Refused) || error.status !== 404) throw error;
      [this.entries, this.cut] = [[], false];
    }
  }

  /** Part of an address as it was before it was encoded; a spelling that means nothing names nothing. */
  private decoded(part: string): string {
    try {
      return decodeURIComponent(part);
    } catch {
      this.trouble = 'The address names no file. Pick the experiment.';
      return '/';
    }
  }

  /** Where an address such as "#/channel/s1/experiment.toml" leads, or "#/maps/s1/" to a folder. */
  private async follow(): Promise<void> {
    const [, step, file] = /^#\/([a-z]+)(?:\/(.*))?$/.exec(location.hash) ?? [];
    const known = STEPS.find(({ name }) => name === step)?.name ?? 'maps';
    const list = this.state?.experiments ?? [];
    const named = file === undefined ? (list.length === 1 ? list[0].file : '/') : this.decoded(file);
    const wanted = named.endsWith('/') ? null : named;
    if (wanted === null) this.browsed = named.slice(0, -1);
    if (wanted === null || wanted !== this.draft?.file) await this.meanwhile(() => this.read(wanted));
    if (this.started && known !== this.step) ++this.arrived;
    this.show(known, 'replaceState');
  }

  private async read(file: string | null): Promise<void> {
    await this.draft?.save();
    this.draft = file === null ? null : new Draft(await api.experiment(file), this.state?.folder.path ?? '');
    await this.readFolder();
  }

  /** Shows a view and puts the cursor there; the browser's Back leads here again. */
  go(step: Step): void {
    this.show(step, 'pushState');
    ++this.arrived;
  }

  private show(step: Step, how: 'pushState' | 'replaceState'): void {
    this.step = step;
    const address = `#/${step}/${pathAddress(this.draft?.file ?? `${this.browsed}/`)}`;
    if (location.hash !== address) history[how](null, '', address);
  }

  /** Opens an experiment, or none: then a folder of maps. */
  async open(file: string | null, folder = ''): Promise<void> {
    this.browsed = folder;
    await this.attempt(() => this.read(file));
    this.show('maps', 'pushState');
  }

  private hear(event: Event): void {
    if (event.type === 'hello') this.job = event.job;
    else if (event.type === 'start' || event.type === 'end') this.job = event.job;
    else if (event.type === 'files') void this.meanwhile(() => this.heed(event.changed));
    if (event.type === 'end') void this.meanwhile(() => this.refresh());
    if (this.job === null) return;
    if (event.type === 'progress' && event.job === this.job.id) {
      this.job.stage = event.stage;
      this.job.fraction = event.fraction;
    }
    if (event.type === 'log' && event.job === this.job.id) this.job.log = [...this.job.log, event.line].slice(-MOST_LINES);
  }

  private async heed(changed: string[]): Promise<void> {
    const within = this.folder === '' ? '' : `${this.folder}/`;
    await this.refresh();
    if (this.draft && changed.some((file) => file.startsWith(within))) await this.draft.look();
  }
}

export const session = new Session();
