// Keys that go back and forth in what was done.

export type Step = 'undo' | 'redo';

interface Keys {
  key: string;
  ctrlKey: boolean;
  metaKey: boolean;
  altKey: boolean;
  shiftKey: boolean;
}

export function stepOfKey({ key, ctrlKey, metaKey, altKey, shiftKey }: Keys): Step | null {
  if (!(ctrlKey || metaKey) || altKey) return null;
  const letter = key.toLowerCase();
  if (letter === 'z') return shiftKey ? 'redo' : 'undo';
  return letter === 'y' && !shiftKey ? 'redo' : null;
}

/** What is typed in has an Undo of its own. */
export const ownsUndo = (target: EventTarget | null): boolean =>
  target instanceof Element && target.closest('textarea, input:not([type=checkbox])') !== null;
