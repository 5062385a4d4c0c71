// Options of the measurement that are not as they come: they belong to no experiment file but to the
// command line, and are kept with the experiment in this browser. All tabs have the same ones.

import { api } from '../api/client';
import type { Option } from '../api/types';

type Given = Record<string, string>;

const name = (place: string) => `manoscope options ${place}`;

function stored(place: string): Given | null {
  try {
    return JSON.parse(localStorage.getItem(name(place)) ?? '{}') as Given;
  } catch {
    return null;
  }
}

export class MeasureOptions {
  all = $state.raw<Option[]>([]);
  given = $state.raw<Given>({});
  private place = '';

  constructor() {
    globalThis.addEventListener?.('storage', ({ key }: StorageEvent) => {
      if (key === name(this.place) || key === null) this.given = stored(this.place) ?? {};
    });
  }

  async read(): Promise<void> {
    if (this.all.length === 0) this.all = (await api.options()).measure;
  }

  /** Those of another experiment. */
  turnTo(place: string): void {
    if (place === this.place) return;
    this.place = place;
    this.given = stored(place) ?? {};
  }

  set(option: string, value: string): void {
    // From the store: another tab may have set one a moment ago.
    const { [option]: _, ...others } = stored(this.place) ?? this.given;
    this.given = value.trim() === '' ? others : { ...others, [option]: value.trim() };
    try {
      localStorage.setItem(name(this.place), JSON.stringify(this.given));
    } catch {
      // A forbidden store: the options then last as long as the page.
    }
  }
}

export const measureOptions = new MeasureOptions();
