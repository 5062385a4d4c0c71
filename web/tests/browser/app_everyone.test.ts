// Who can use the local app: every view by axe-core, light and dark, wide and narrow; and by keys alone.

import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, expect, it } from 'vitest';
import { type Served, go, openApp, serve, withExperiment } from './serve';
import { graveFindings, launch } from './support';

const STEPS = ['Maps', 'Channel', 'Calibration', 'Runs', 'Check', 'Measure', 'Results'];
let browser: Browser;
let served: Served;

beforeAll(async () => {
  browser = await launch();
  // With faults, so that they are looked at, too.
  served = await serve((folder) => {
    withExperiment(folder);
    const change = (file: string, from: RegExp, to: string) => {
      const text = readFileSync(join(folder, file), 'utf8');
      expect(text).toMatch(from);
      writeFileSync(join(folder, file), text.replace(from, to));
    };
    change('experiment.toml', /^height = ".*?"/m, 'height = "175" # CONFIRM');
    change('hydrostatic.csv', /^(h0[1-9]\.gsf,)[^,]*/m, '$1?');
  });
});
afterAll(async () => {
  await browser?.close();
  await served?.stop();
});

for (const colorScheme of ['light', 'dark'] as const) {
  for (const width of [1440, 800]) {
    it(`every view can be used: ${colorScheme}, ${width} px wide`, async () => {
      const { page, context } = await openApp(browser, served, { colorScheme, bypassCSP: true, viewport: { width, height: 900 } });
      for (const step of STEPS) {
        await go(page, step);
        await page.getByRole('heading', { name: step, exact: true }).waitFor();
        if (step === 'Channel') await page.getByTestId('channel').waitFor();
        for (const folded of await page.locator('main details').all()) await folded.evaluate((d) => d.setAttribute('open', ''));
        expect(await graveFindings(page, {}), step).toEqual([]);
        const beyond = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        expect(beyond, step).toBeLessThanOrEqual(0); // nothing sticks out sideways
      }
      await context.close();
    });
  }
}

it('every control of a view is reached by Tab, with a ring around it', async () => {
  const { page, context } = await openApp(browser, served);
  await go(page, 'Channel');
  await page.getByTestId('channel').waitFor();
  const wanted = await page.locator('main').evaluate((main) =>
    [...main.querySelectorAll<HTMLElement>('button:enabled, input:enabled:not([hidden]), select:enabled, summary, [tabindex="0"]')]
      .filter((part) => part.checkVisibility()).length,
  );
  await page.getByRole('button', { name: 'Results', exact: true }).focus();
  const reached = new Set<string>();
  for (let i = 0; i < wanted + 5; ++i) {
    await page.keyboard.press('Tab');
    const [inside, mark, ringed] = await page.evaluate(() => {
      const now = document.activeElement as HTMLElement;
      now.dataset.seen ??= String(performance.now());
      const looks = () => {
        const { outlineStyle, fill, stroke, strokeWidth } = getComputedStyle(now);
        return now instanceof SVGElement ? [fill, stroke, strokeWidth].join() : outlineStyle;
      };
      const ringed = looks();
      let ring = ringed !== 'none';
      // A handle over the map has no ring: it changes its colour.
      if (now instanceof SVGElement) {
        now.blur();
        ring = looks() !== ringed;
        now.focus();
      }
      return [now.closest('main') !== null, now.dataset.seen, ring] as const;
    });
    if (!inside) continue;
    expect(ringed).toBe(true);
    reached.add(mark);
  }
  expect(reached.size).toBe(wanted);
  await context.close();
});
