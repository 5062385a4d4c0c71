// Where two states of an experiment differ, in words.

import type { Form, List } from '../api/types';

const shown = (value: unknown) =>
  value === null || value === undefined ? 'nothing' : Array.isArray(value) ? value.join(', ') : `"${String(value)}"`;

function ofLists(name: string, here: List | null, there: List | null): string[] {
  if (JSON.stringify([here?.columns, here?.rows]) === JSON.stringify([there?.columns, there?.rows])) return [];
  if (here === null || there === null) return [`${name}: a list ${here === null ? 'there' : 'here'} alone`];
  const rows = Math.max(here.rows.length, there.rows.length);
  let n = 0;
  for (let i = 0; i < rows; ++i) if (JSON.stringify(here.rows[i]) !== JSON.stringify(there.rows[i])) n += 1;
  if (n === 0) return [`${name}: other columns`];
  return [`${name}: ${n} ${n === 1 ? 'row differs' : 'rows differ'}`];
}

/** "channel.length: here "15 mm", in the file "16 mm"" ... */
export function differences(here: Form, there: Form): string[] {
  const list: string[] = [];
  if (here.name !== there.name) list.push(`name: here ${shown(here.name)}, in the file ${shown(there.name)}`);
  for (const section of ['channel', 'inlet', 'wall', 'fluid', 'instrument'] as const) {
    const [a, b] = [here[section], there[section]] as Record<string, unknown>[];
    for (const key of new Set([...Object.keys(a), ...Object.keys(b)])) {
      if (JSON.stringify(a[key] ?? null) === JSON.stringify(b[key] ?? null)) continue;
      list.push(`${section}.${key}: here ${shown(a[key])}, in the file ${shown(b[key])}`);
    }
  }
  return [...list, ...ofLists('hydrostatic', here.hydrostatic, there.hydrostatic), ...ofLists('flow', here.flow, there.flow)];
}
