// The page as a whole: what it asks for, how it looks without scripts and on paper, who can use it.

import { readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import type { AddressInfo } from 'node:net';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { REPORT, REPORT_WITHOUT_MAPS, graveFindings, launch, open } from './support';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());

describe('the page', () => {
  it('asks nobody for anything and has no fault', async () => {
    const { page, requests, faults } = await open(browser, REPORT());
    for (const section of await page.locator('#explore > section').all()) {
      await section.scrollIntoViewIfNeeded();
      await page.waitForTimeout(100);
    }
    expect(requests).toEqual([]);
    expect(faults).toEqual([]);
    await page.context().close();
  });

  it('lets no other script run and no request leave', async () => {
    // A server that would answer: what is refused is refused by the page, not by the network.
    let asked = 0;
    const server = createServer((_, response) => {
      asked += 1;
      response.setHeader('Access-Control-Allow-Origin', '*');
      response.end('x');
    });
    await new Promise<void>((done) => server.listen(0, '127.0.0.1', done));
    const address = `http://127.0.0.1:${(server.address() as AddressInfo).port}/`;
    const { page } = await open(browser, REPORT());
    const outcome = await page.evaluate(async (address) => {
      const script = document.createElement('script');
      script.textContent = 'document.title = "taken over"';
      document.body.append(script);
      const image = new Image();
      const loads = new Promise((done) => {
        image.onload = () => done('loaded');
        image.onerror = () => done('refused');
      });
      image.src = address;
      const fetched = await fetch(address).then(() => 'sent', () => 'refused');
      const form = document.createElement('form');
      form.action = address;
      form.target = '_blank';
      document.body.append(form);
      form.submit();
      return { title: document.title, image: await loads, fetched };
    }, address);
    expect(outcome.title).not.toBe('taken over');
    expect([outcome.image, outcome.fetched]).toEqual(['refused', 'refused']);
    await page.waitForTimeout(300);
    expect(asked).toBe(0);
    await page.context().close();
    server.close();
  });

  it('is small enough', () => {
    expect(statSync(REPORT()).size).toBeLessThanOrEqual(8e6);
    const text = readFileSync(REPORT(), 'utf8');
    const scripts = [...text.matchAll(/<script>([^]*?)<\/script>/g)].map((match) => match[1].length);
    expect(scripts).toHaveLength(1);
    expect(scripts[0]).toBeLessThanOrEqual(150_000);
  });

  it('is painted within half a second', async () => {
    // The best of three: other work on the machine is not the page's fault.
    const times = { paint: Infinity, views: Infinity };
    for (let i = 0; i < 3; ++i) {
      const { page } = await open(browser, REPORT());
      const [paint, views] = await page.evaluate(() => [
        performance.getEntriesByName('first-contentful-paint')[0].startTime,
        performance.getEntriesByName('views-shown')[0].startTime,
      ]);
      times.paint = Math.min(times.paint, paint);
      times.views = Math.min(times.views, views);
      await page.context().close();
    }
    console.log(`first paint ${times.paint.toFixed(0)} ms, first views ${times.views.toFixed(0)} ms`);
    expect(times.views).toBeLessThanOrEqual(500);
  });

  it('says everything without scripts', async () => {
    const { page, faults } = await open(browser, REPORT(), { javaScriptEnabled: false });
    expect(await page.locator('noscript').textContent()).toContain('scripts allowed');
    const figures = page.locator('figure');
    expect(await figures.count()).toBeGreaterThan(8);
    for (const figure of await figures.all()) expect(await figure.isVisible()).toBe(true);
    expect(await page.locator('#summary').innerText()).toMatch(/In \d+ of \d+ runs/);
    expect(faults).toEqual([]);
    await page.context().close();
  });

  it('prints the figures made for print, and no control', async () => {
    const { page } = await open(browser, REPORT());
    await page.emulateMedia({ media: 'print' });
    expect(await page.locator('#explore').isVisible()).toBe(false);
    for (const figure of await page.locator('figure').all()) expect(await figure.isVisible()).toBe(true);
    for (const button of await page.getByRole('button').all()) expect(await button.isVisible()).toBe(false);
    // Of a page as wide as A4 between its margins nothing is cut off.
    await page.setViewportSize({ width: 703, height: 1000 });
    const cut = await page.evaluate(() =>
      [...document.querySelectorAll<HTMLElement>('div.scroll')].filter(
        (part) => part.scrollWidth > part.clientWidth + 1 || part.scrollHeight > part.clientHeight + 1,
      ).length,
    );
    expect(cut).toBe(0);
    const pdf = await page.pdf({ format: 'A4' });
    expect(pdf.subarray(0, 5).toString()).toBe('%PDF-');
    expect(pdf.length).toBeGreaterThan(100_000);
    await page.context().close();
  });

  it('shows curves and pressures where there are no maps, and says so', async () => {
    const { page, faults } = await open(browser, REPORT_WITHOUT_MAPS());
    expect(await page.locator('#no-maps').innerText()).toContain('maps are not at hand');
    await page.locator('#explore-maps').scrollIntoViewIfNeeded();
    await page.getByRole('img', { name: /^Deflection averaged/ }).locator('canvas').waitFor();
    expect(await page.getByRole('img', { name: /^Deflection of the wall/ }).count()).toBe(0);
    expect(faults).toEqual([]);
    await page.context().close();
  });
});

describe('everyone', () => {
  for (const colorScheme of ['light', 'dark'] as const) {
    for (const width of [1440, 800]) {
      it(`can use it: ${colorScheme}, ${width} px wide`, async () => {
        const { page } = await open(browser, REPORT(), { colorScheme, bypassCSP: true, viewport: { width, height: 900 } });
        for (const section of await page.locator('#explore > section').all()) {
          await section.scrollIntoViewIfNeeded();
          await page.waitForTimeout(100);
        }
        // All of it in the light and wide; in the dark and narrow without the insides of the figures,
        // which are long and the same; else what the script makes.
        const light = colorScheme === 'light';
        const wide = width === 1440;
        const part = light === wide ? { exclude: light ? [] : [['figure svg']] } : { include: [['#explore']] };
        expect(await graveFindings(page, part)).toEqual([]);
        const beyond = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        expect(beyond).toBeLessThanOrEqual(0); // nothing sticks out sideways
        await page.context().close();
      });
    }
  }
});
