// What of an experiment is sent to the program, and how its answer fits what the page shows.

import type { Body, Experiment, Fault, Form } from '../api/types';
import { differences } from './differences';
import { type ListName, sentList } from './lists';

export type Rows = Record<ListName, number[]>; // where each row of the lists stands on the page

export const copy = <T>(value: T): T => JSON.parse(JSON.stringify(value)) as T;

/** The form as it is sent: lists without empty rows. */
export function sentForm(form: Form): { form: Form; rows: Rows } {
  const sent = copy(form);
  const rows: Rows = { hydrostatic: [], flow: [] };
  for (const name of ['hydrostatic', 'flow'] as const) {
    const list = sent[name];
    if (list === null) continue;
    const whole = sentList(list);
    sent[name] = whole.list;
    rows[name] = whole.rows;
  }
  return { form: sent, rows };
}

export const rowsOf = (form: Form | null): Rows => (form === null ? { hydrostatic: [], flow: [] } : sentForm(form).rows);

/** Whether a file says it already: the page may have gone while its last words were on their way. */
export function same(body: Body, { text, lists, form }: Experiment): boolean {
  if ('form' in body) return form !== null && differences(body.form, form).length === 0;
  return body.text === text && Object.entries(body.lists).every(([name, list]) => lists[name] === list);
}

/** Faults of lists at the rows that the page shows. */
export function placed(faults: Fault[], rows: Rows): Fault[] {
  return faults.map((fault) => {
    const list = fault.key?.split('.')[0];
    if (fault.row === null || (list !== 'hydrostatic' && list !== 'flow')) return fault;
    return { ...fault, row: rows[list][fault.row] ?? fault.row };
  });
}
