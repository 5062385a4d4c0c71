// Options of the measurement that are not as they come: they belong to no experiment file but to the
// command line, and are kept with the experiment in this browser.

import { api } from '../api/client';
import type { Option } from '../api/types';

const name = (place: string) => `manoscope options ${place}`;

class MeasureOptions {
  all = $state.raw<Option[]>([]);
  given = $state<Record<string, string>>({});
  private place = '';

  async read(): Promise<void> {
    if (this.all.length === 0) this.all = (await api.options()).measure;
  }

  /** Those of another experiment. */
  turnTo(place: string): void {
    if (place === this.place) return;
    this.place = place;
    try {
      this.given = JSON.parse(localStorage.getItem(name(place)) ?? '{}') as Record<string, string>;
    } catch {
      this.given = {};
    }
  }

  set(option: string, value: string): void {
    if (value.trim() === '') delete this.given[option];
    else this.given[option] = value.trim();
    try {
      localStorage.setItem(name(this.place), JSON.stringify(this.given));
    } catch {
      // A forbidden store: the options then last as long as the page.
    }
  }
}

export const measureOptions = new MeasureOptions();
