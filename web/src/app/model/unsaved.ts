// What is not saved yet, in the tab's own store, so that it outlives a reload.

import type { Form } from '../api/types';

export interface Kept {
  revision: string | null; // of the file that it began from
  form?: Form;
  typed?: Record<string, string>; // texts, by the names of lists; '' is the experiment's
}

const name = (place: string) => `manoscope unsaved ${place}`;

export function keep(place: string, value: Kept): void {
  try {
    sessionStorage.setItem(name(place), JSON.stringify(value));
  } catch {
    // A full or forbidden store: the file is written a moment later all the same.
  }
}

export function kept(place: string): Kept | null {
  try {
    const text = sessionStorage.getItem(name(place));
    return text === null ? null : (JSON.parse(text) as Kept);
  } catch {
    return null;
  }
}

export function forget(place: string): void {
  try {
    sessionStorage.removeItem(name(place));
  } catch {
    // as above
  }
}
