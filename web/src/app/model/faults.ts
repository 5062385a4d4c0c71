// Faults in words: what is told of those that come or go, and how many of one kind are one entry.

import type { Fault } from '../api/types';

const many = (n: number) => (n === 0 ? 'No fault left.' : n === 1 ? 'One fault left.' : `${n} faults left.`);

/** Faults that follow each other and differ in their place alone, as rows of a list do. */
export function faultGroups(faults: Fault[]): Fault[][] {
  const groups: Fault[][] = [];
  for (const fault of faults) {
    const last = groups[groups.length - 1]?.[0];
    const alike = last && last.row !== null && (['file', 'key', 'text'] as const).every((part) => last[part] === fault[part]);
    if (alike) groups[groups.length - 1].push(fault);
    else groups.push([fault]);
  }
  return groups;
}

/** "hydrostatic.csv, lines 3 to 9: hydrostatic.pressure" */
export function placeOf(group: Fault[]): string {
  const [{ file, line, key }, last] = [group[0], group[group.length - 1]];
  const lines = line === null ? '' : group.length === 1 ? `, line ${line}` : `, lines ${line} to ${last.line}`;
  return [file && file + lines, key].filter(Boolean).join(': ');
}

/** What a screen reader is told: the first fault that was not there before, else how many are left; nothing if nothing changed. */
export function faultNews(before: Fault[], now: Fault[]): string {
  const known = new Set(before.map(({ key, row, text }) => JSON.stringify([key, row, text])));
  const fresh = now.filter(({ key, row, text }) => !known.has(JSON.stringify([key, row, text])));
  if (fresh.length > 0) return fresh.length === 1 ? fresh[0].text : `${fresh[0].text} And ${fresh.length - 1} more.`;
  return now.length < before.length ? many(now.length) : '';
}
