// Every request that the page makes; all go to the server that the page came from.

import type {
  Body, Entry, Event, Experiment, Fault, FolderState, Job, JobRequest, MapAnswer, MapRequest, Option, Place, Result,
} from './types';

/** An answer that is no success, in the server's own words. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    readonly words: string,
    readonly body: unknown,
  ) {
    super(words);
  }

  /** What was found and what to do, apart. */
  get said(): Said {
    return (this.body as { error?: Said } | null)?.error ?? { found: this.words.replace(/\.$/, ''), mend: '' };
  }
}

type Said = Pick<Fault, 'found' | 'mend'>;

const sentence = (text: string) => (/[.?!]$/.test(text) ? text : `${text}.`);
export const words = ({ found, mend }: Said) => [found, mend].filter(Boolean).map(sentence).join(' ');

function wordsOf(status: number, body: unknown): string {
  const { error, faults } = (body ?? {}) as { error?: Said; faults?: Said[] };
  const list = faults?.length ? faults : error ? [error] : [];
  if (list.length > 0) return list.map(words).join(' ');
  if (status === 401) return 'The server does not know this page any more. Open the address that manoscope serve printed.';
  return `The server answered with ${status}.`;
}

async function ask<T>(method: string, address: string, init: RequestInit = {}): Promise<T> {
  let response: Response;
  try {
    response = await fetch(address, { method, ...init });
  } catch {
    throw new Refused(0, 'manoscope serve does not answer. Is it still running in its terminal?', null);
  }
  const body: unknown = await response.json().catch(() => null);
  if (!response.ok) throw new Refused(response.status, wordsOf(response.status, body), body);
  return body as T;
}

const json = (body: unknown, headers: Record<string, string> = {}): RequestInit => ({
  body: JSON.stringify(body),
  headers: { 'Content-Type': 'application/json', ...headers },
});

function query(values: Record<string, string | undefined>): string {
  const given = Object.entries(values).filter((pair): pair is [string, string] => !!pair[1]);
  return given.map(([key, value]) => `${key}=${encodeURIComponent(value)}`).join('&');
}

export const pathAddress = (rel: string) => rel.split('/').map(encodeURIComponent).join('/');

export const api = {
  state: () => ask<FolderState>('GET', '/api/state'),
  files: (folder: string) =>
    ask<{ folder: string; entries: Entry[]; truncated: boolean }>('GET', `/api/files?${query({ folder })}`),
  upload: (rel: string, file: File) =>
    ask<{ file: string }>('PUT', `/api/files/${pathAddress(rel)}`, {
      body: file, headers: { 'Content-Type': 'application/octet-stream' },
    }),
  map: ({ pitch, ...rest }: MapRequest, signal?: AbortSignal) =>
    ask<MapAnswer>('GET', `/api/map?${query({ ...rest, longest: '900', pitch_x: pitch?.[0], pitch_y: pitch?.[1] })}`, { signal }),
  place: (file: string, body: Body, signal?: AbortSignal) =>
    ask<Place>('POST', '/api/place', { ...json({ file, ...body }), signal }),
  experiment: (file: string) => ask<Experiment>('GET', `/api/experiment?${query({ file })}`),
  check: (file: string, body: Body, maps = false) =>
    ask<Experiment>('POST', '/api/check', json({ file, ...body, ...(maps ? { maps } : {}) })),
  save: (file: string, body: Body, revision: string | null) => {
    const known: Record<string, string> = revision === null ? { 'If-None-Match': '*' } : { 'If-Match': `"${revision}"` };
    const init = json({ file, ...body }, known);
    // Outlives the page, where a browser lets it.
    const keepalive = String(init.body).length < 60_000;
    return ask<Experiment>('PUT', `/api/experiment?${query({ file })}`, { ...init, keepalive });
  },
  draft: (folder: string) =>
    ask<{ file: string; unassigned: string[]; no_maps: string[] }>('POST', '/api/experiment/draft', json({ folder })),
  options: () => ask<{ measure: Option[] }>('GET', '/api/options'),
  start: (job: JobRequest) => ask<Job>('POST', '/api/jobs', json(job)),
  cancel: () => ask<Job>('DELETE', '/api/jobs/current'),
  result: (folder: string) => ask<Result>('GET', `/api/result?${query({ folder })}`),
};

/** Hears the server's events, and takes the line up again when it breaks. */
export function listen(onevent: (event: Event) => void, online: (there: boolean) => void): void {
  const socket = new WebSocket(`ws://${location.host}/api/events`);
  socket.onopen = () => online(true);
  socket.onmessage = (message) => onevent(JSON.parse(String(message.data)) as Event);
  socket.onclose = () => {
    online(false);
    setTimeout(() => listen(onevent, online), 1500);
  };
}
