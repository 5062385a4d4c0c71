// Opens report.html in the machine's own Chromium. MANOSCOPE_REPORT names the page, CHROMIUM the
// browser (else it is looked for on the PATH); MANOSCOPE_REPORT_WITHOUT_MAPS a page without maps.

import { accessSync, constants, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { delimiter, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { type Browser, type BrowserContextOptions, type Page, chromium } from 'playwright-core';

function onPath(names: string[]): string {
  for (const folder of (process.env.PATH ?? '').split(delimiter)) {
    for (const name of names) {
      try {
        accessSync(join(folder, name), constants.X_OK);
        return join(folder, name);
      } catch {
        // not there
      }
    }
  }
  throw new Error('no chromium on the PATH: install it, or name it in the variable CHROMIUM');
}

export function named(variable: string): string {
  const path = process.env[variable];
  if (!path) throw new Error(`the variable ${variable} is not set: run \`make web-check\``);
  return resolve(path);
}

export const REPORT = () => named('MANOSCOPE_REPORT');
export const REPORT_WITHOUT_MAPS = () => named('MANOSCOPE_REPORT_WITHOUT_MAPS');

export function launch(): Promise<Browser> {
  const executablePath = process.env.CHROMIUM || onPath(['chromium', 'chromium-browser', 'google-chrome']);
  // A container's root has no sandbox; the page is our own.
  const args = process.getuid?.() === 0 ? ['--no-sandbox'] : [];
  return chromium.launch({ executablePath, args });
}

export interface Watched {
  page: Page;
  requests: string[]; // all but the page itself and what it made
  faults: string[]; // messages of the console and errors nobody caught
}

export async function open(browser: Browser, file: string, options: BrowserContextOptions = {}): Promise<Watched> {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, ...options });
  const page = await context.newPage();
  const address = pathToFileURL(file).href;
  const watched: Watched = { page, requests: [], faults: [] };
  page.on('request', (request) => {
    const url = request.url();
    if (url !== address && !/^(data|blob):/.test(url)) watched.requests.push(url);
  });
  page.on('console', (message) => watched.faults.push(message.text()));
  page.on('pageerror', (error) => watched.faults.push(error.message));
  await page.goto(address);
  if (options.javaScriptEnabled !== false) {
    await page.waitForFunction(() => performance.getEntriesByName('views-shown').length > 0);
    await page.getByRole('button', { name: 'Save table 1 as CSV' }).waitFor();
  }
  return watched;
}

/** Moves a range input as a hand does: the value changes and the page hears of it. */
export async function slide(page: Page, test: string, value: number): Promise<void> {
  await page.getByTestId(test).evaluate((input: HTMLInputElement, wanted) => {
    input.value = String(wanted);
    input.dispatchEvent(new Event('input', { bubbles: true }));
  }, value);
}

/** The file that a click saves. */
export async function saved(page: Page, click: () => Promise<void>): Promise<{ name: string; bytes: Buffer }> {
  const [download] = await Promise.all([page.waitForEvent('download'), click()]);
  const chunks: Buffer[] = [];
  for await (const chunk of await download.createReadStream()) chunks.push(chunk as Buffer);
  return { name: download.suggestedFilename(), bytes: Buffer.concat(chunks) };
}

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
interface Axe {
  axe: {
    run(context: AxeContext): Promise<{ violations: { id: string; impact: string; nodes: { html: string }[] }[] }>;
  };
}
export interface AxeContext {
  include?: string[][];
  exclude?: string[][];
}

/** What axe-core finds serious or critical, one line a rule. The page's policy must be bypassed. */
export async function graveFindings(page: Page, context: AxeContext): Promise<string[]> {
  await page.evaluate(axe);
  const found = await page.evaluate((part) => (window as unknown as Axe).axe.run(part), context);
  return found.violations
    .filter(({ impact }) => impact === 'serious' || impact === 'critical')
    .map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map((node) => node.html.slice(0, 160)).join(' | ')}`);
}
