// Steps that can be gone back and forth: states of the form, as texts.

const MOST = 100;

export class History {
  private past = $state.raw<string[]>([]);
  private future = $state.raw<string[]>([]);

  get canUndo(): boolean {
    return this.past.length > 0;
  }
  get canRedo(): boolean {
    return this.future.length > 0;
  }

  /** A step was made from this state. */
  add(before: string): void {
    this.past = [...this.past.slice(1 - MOST), before];
    this.future = [];
  }

  /** The state before the last step; `now` is what Redo leads to. */
  undo(now: string): string | undefined {
    const last = this.past[this.past.length - 1];
    if (last === undefined) return undefined;
    this.past = this.past.slice(0, -1);
    this.future = [...this.future, now];
    return last;
  }

  redo(now: string): string | undefined {
    const next = this.future[this.future.length - 1];
    if (next === undefined) return undefined;
    this.future = this.future.slice(0, -1);
    this.past = [...this.past, now];
    return next;
  }

  /** States of a file that others have changed lead nowhere: going back would undo what they wrote. */
  clear(): void {
    this.past = this.future = [];
  }
}
