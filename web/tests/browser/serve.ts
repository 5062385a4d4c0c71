// Starts `manoscope serve` on folders of their own. MANOSCOPE_PROGRAM names the program,
// MANOSCOPE_EXPERIMENT a small experiment that measures in seconds.

import { type ChildProcess, spawn } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import type { Browser, BrowserContext, BrowserContextOptions, Page } from 'playwright-core';
import { afterAll, beforeAll, expect } from 'vitest';
import { named } from './support';

export const EXPERIMENT = () => named('MANOSCOPE_EXPERIMENT');
export const MAPS = () => readdirSync(EXPERIMENT()).filter((name) => name.endsWith('.gsf')).sort();

/** Rows of a list of the experiment, without its head. */
export function rowsOf(list: string): string[][] {
  const lines = readFileSync(join(EXPERIMENT(), list), 'utf8').split('\n').filter((line) => line !== '' && !line.startsWith('#'));
  return lines.slice(1).map((line) => line.split(','));
}

export interface Served {
  folder: string;
  address: string; // with its token, which is good once
  known?: Awaited<ReturnType<BrowserContext['storageState']>>; // of the browser that used it
  stop: () => Promise<void>;
  restart: () => Promise<void>; // at the same port; it then knows no browser of before
}

function firstAddress(program: ChildProcess): Promise<string> {
  return new Promise((found, failed) => {
    let said = '';
    const hear = (text: Buffer) => {
      said += text.toString();
      const address = /http:\/\/127\.0\.0\.1:\d+\/\S*/.exec(said);
      if (address) found(address[0]);
    };
    program.stdout!.on('data', hear);
    program.stderr!.on('data', hear);
    program.on('exit', () => failed(new Error(`manoscope serve ended: ${said}`)));
  });
}

/** Serves a folder; `fill` puts into it what the test begins with. */
export async function serve(fill: (folder: string) => void = () => {}): Promise<Served> {
  const folder = mkdtempSync(join(tmpdir(), 'manoscope-app-'));
  fill(folder);
  const start = (port: string) =>
    spawn(resolve(named('MANOSCOPE_PROGRAM')), ['serve', folder, '--port', port, '--no-browser'], { stdio: 'pipe' });
  let program = start('0');
  const end = async () => {
    const ended = new Promise((done) => program.on('exit', done));
    program.kill('SIGINT');
    await ended;
  };
  const served: Served = {
    folder,
    address: await firstAddress(program),
    stop: async () => {
      await end();
      rmSync(folder, { recursive: true });
    },
    restart: async () => {
      await end();
      program = start(new URL(served.address).port);
      served.address = await firstAddress(program);
      served.known = undefined;
    },
  };
  return served;
}

/** The whole experiment as the program made it, without its truth. */
export const withExperiment = (folder: string, into = '') =>
  cpSync(EXPERIMENT(), join(folder, into), { recursive: true, filter: (from) => !/truth|\.manoscope/.test(from) });
export const withMaps = (folder: string) => {
  for (const map of MAPS()) cpSync(join(EXPERIMENT(), map), join(folder, map));
};

export interface Opened {
  page: Page;
  context: BrowserContext;
  foreign: string[]; // requests to any other server
  faults: string[]; // messages of the console and errors nobody caught
}

function watch(page: Page, origin: string, seen: Pick<Opened, 'foreign' | 'faults'>): void {
  page.on('request', (request) => {
    const url = request.url();
    if (!url.startsWith(origin) && !/^(data|blob|about):/.test(url)) seen.foreign.push(url);
  });
  page.on('console', (message) => seen.faults.push(message.text()));
  page.on('pageerror', (error) => seen.faults.push(error.message));
  // Leaving a page that has something unsaved.
  page.on('dialog', (dialog) => void dialog.accept());
}

export async function openApp(browser: Browser, served: Served, options: BrowserContextOptions = {}): Promise<Opened> {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, storageState: served.known, ...options });
  const page = await context.newPage();
  const { origin } = new URL(served.address);
  await context.grantPermissions(['clipboard-read', 'clipboard-write'], { origin });
  context.setDefaultTimeout(15_000);
  const seen = { foreign: [], faults: [] };
  watch(page, origin, seen);
  await page.goto(served.known ? origin : served.address);
  await page.getByRole('heading', { name: 'Maps' }).waitFor();
  served.known = await context.storageState();
  return { page, context, ...seen };
}

/** One more tab of the same browser. */
export async function openTab({ context, page: first, foreign, faults }: Opened): Promise<Page> {
  const page = await context.newPage();
  watch(page, new URL(first.url()).origin, { foreign, faults });
  await page.goto(first.url());
  await page.getByRole('navigation', { name: 'Steps' }).waitFor();
  return page;
}

export const go = (page: Page, step: string) =>
  page.getByRole('navigation', { name: 'Steps' }).getByRole('button', { name: new RegExp(`^${step}`) }).click();

/** Waits until what was typed stands in the file. */
export const saved = (page: Page) => page.getByTestId('saved').getByText('saved', { exact: true }).waitFor();

/** Pastes as a hand does: from the clipboard, into the cell that has the cursor. */
export async function pasteInto(page: Page, cell: string, text: string): Promise<void> {
  await page.evaluate((words) => navigator.clipboard.writeText(words), text);
  await page.getByLabel(cell, { exact: true }).click();
  await page.keyboard.press('Control+V');
}

export const toml = (served: Served, file = 'experiment.toml') => readFileSync(join(served.folder, file), 'utf8');

export interface Begun {
  served: Served;
  opened: Opened;
  page: Page;
}

/** A served folder and a page of it, for the tests of one group; no page of it has asked anybody else for anything. */
export function begin(browser: () => Browser, fill: (folder: string) => void): Begun {
  const all = {} as Begun;
  beforeAll(async () => {
    all.served = await serve(fill);
    all.opened = await openApp(browser(), all.served);
    all.page = all.opened.page;
  });
  afterAll(async () => {
    await all.opened?.context.close();
    await all.served?.stop();
    expect(all.opened.foreign).toEqual([]);
    // An answer that refuses is told by the browser, too, as is a server that is gone; both are tested where they are due.
    expect(all.opened.faults.filter((text) => !/^Failed to load resource|^WebSocket connection/.test(text))).toEqual([]);
  });
  return all;
}

export const field = (page: Page, label: string) => page.getByLabel(label, { exact: true });
