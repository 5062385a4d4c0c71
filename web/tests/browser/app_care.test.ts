// What the local app takes care of: half-typed fields, keys, the way back, drops, tabs, a server that was restarted.

import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { quoted } from '../../src/app/model/command';
import { launch } from './support';
import { EXPERIMENT, begin, field, go, openTab, saved, toml, withExperiment, withMaps } from './serve';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());

const REMARK = '# of the balance';
const remarked = (folder: string) => {
  withExperiment(folder);
  const file = join(folder, 'experiment.toml');
  writeFileSync(file, readFileSync(file, 'utf8').replace(/^(density = "[^"]*").*$/m, `$1 ${REMARK}`));
};
const focused = (page: Page) => page.evaluate(() => document.activeElement?.textContent);

describe('a field', () => {
  const all = begin(() => browser, remarked);

  it('at fault is told to who does not see it', async () => {
    const { page } = all;
    await go(page, 'Runs');
    const viscosity = field(page, 'Viscosity');
    const before = await viscosity.inputValue();
    await viscosity.fill('1 furlong');
    await page.getByTestId('news').getByText('furlong').waitFor();
    await viscosity.fill(before);
    await page.getByTestId('news').getByText('No fault left.').waitFor();
  });

  it('that is empty while it is typed anew keeps its line and its remark', async () => {
    const { page, served } = all;
    await go(page, 'Runs');
    const before = toml(served);
    const density = field(page, 'Density');
    await density.fill('');
    await page.waitForTimeout(1200); // more than twice the pause before saving
    expect(toml(served)).toBe(before);
    await density.fill('991 kg/m3');
    await saved(page);
    expect(toml(served)).toContain(`density = "991 kg/m3" ${REMARK}`);
    await density.fill('');
    await density.blur();
    await expect.poll(() => toml(served)).not.toMatch(/^density/m);
  });

  it('first typed in and then emptied is empty in the file, too', async () => {
    const { page, served } = all;
    await field(page, 'Density').pressSequentially('9');
    await saved(page);
    await field(page, 'Density').press('Backspace');
    await field(page, 'Density').blur();
    await expect.poll(() => toml(served)).not.toMatch(/^density/m);
  });

  it('in a row of a list that is empty for a moment keeps the row', async () => {
    const { page, served } = all;
    await go(page, 'Runs');
    const count = await page.getByRole('table', { name: 'Maps under flow' }).getByLabel(/^Map, row/).count();
    await page.getByRole('button', { name: 'Add a row' }).click();
    const cell = field(page, `Map, row ${count + 1}`);
    await cell.fill('f99.gsf');
    await expect.poll(() => toml(served, 'flow.csv')).toContain('f99.gsf');
    await cell.fill('');
    await page.waitForTimeout(1200);
    expect(toml(served, 'flow.csv')).toContain('f99.gsf');
    await cell.blur();
    await expect.poll(() => toml(served, 'flow.csv')).not.toContain('f99.gsf');
    await saved(page);
  });
});

describe('keys', () => {
  const all = begin(() => browser, (folder) => withExperiment(folder));

  it('undo and redo the experiment, but not while something else is typed', async () => {
    const { page, served } = all;
    await go(page, 'Runs');
    const before = toml(served);
    await field(page, 'Density').fill('990 kg/m3');
    await saved(page);
    const after = toml(served);
    await go(page, 'Measure');
    await field(page, 'Folder of the result').pressSequentially('abc');
    await page.keyboard.press('Control+z');
    await page.waitForTimeout(800);
    expect(toml(served)).toBe(after);
    await page.getByRole('heading', { name: 'Measure', exact: true }).focus();
    await page.keyboard.press('Control+z');
    await expect.poll(() => toml(served)).toBe(before);
    await saved(page);
    await page.keyboard.press('Control+Shift+Z');
    await expect.poll(() => toml(served)).toBe(after);
  });

  it('and Back lead through the views, whose head has the cursor and whose name is in the title', async () => {
    const { page } = all;
    await go(page, 'Runs');
    expect([await focused(page), await page.title()]).toEqual(['Runs', expect.stringMatching(/^Runs – .* – manoscope$/)]);
    await go(page, 'Calibration');
    await page.goBack();
    await page.getByRole('heading', { name: 'Runs', exact: true }).waitFor();
    expect(await focused(page)).toBe('Runs');
    await page.goForward();
    await page.getByRole('heading', { name: 'Calibration', exact: true }).waitFor();
  });
});

describe('an address', () => {
  const all = begin(() => browser, (folder) => withExperiment(folder));

  it('that cannot be read leads to the maps, and says so', async () => {
    const { page, served } = all;
    await page.goto('about:blank');
    await page.goto(`${new URL(served.address).origin}/#/maps/%zz`);
    await page.getByRole('alert').getByText('names no file').waitFor();
    await page.getByRole('heading', { name: 'Maps' }).waitFor();
  });
});

describe('maps', () => {
  const all = begin(() => browser, (folder) => {
    withMaps(folder);
    mkdirSync(join(folder, 'inner'));
  });

  it('dropped beside the place for them do not make the browser leave', async () => {
    const { page } = all;
    const kept = await page.getByRole('heading', { name: 'Maps' }).evaluate((head) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File(['x'], 'x.gsf'));
      return ['dragover', 'drop'].map((kind) => !head.dispatchEvent(new DragEvent(kind, { dataTransfer, bubbles: true, cancelable: true })));
    });
    expect(kept).toEqual([true, true]);
  });

  it('that are a folder are told so', async () => {
    const { page, opened, served } = all;
    const box = (await page.getByRole('group', { name: 'Bring maps' }).boundingBox())!;
    const hand = await opened.context.newCDPSession(page);
    const data = { items: [], files: [join(served.folder, 'inner')], dragOperationsMask: 1 };
    for (const type of ['dragEnter', 'dragOver', 'drop'] as const) {
      await hand.send('Input.dispatchDragEvent', { type, x: box.x + 20, y: box.y + 10, data });
    }
    await page.getByRole('alert').getByText('this is a folder').waitFor();
  });

  it('beyond what is looked through are told of', async () => {
    const { page } = all;
    await page.route('**/api/state', async (route) => {
      const answer = await route.fetch();
      await route.fulfill({ response: answer, json: { ...(await answer.json()), truncated: true } });
    });
    await page.reload();
    await page.getByText('than is looked through').waitFor();
    await page.unroute('**/api/state');
  });
});

describe('a map', () => {
  const all = begin(() => browser, (folder) => withExperiment(folder));

  it('is read once for a pitch, not once a letter', async () => {
    const { page } = all;
    await page.getByRole('img', { name: /^Heights of/ }).waitFor();
    await page.locator('summary', { hasText: 'What the files do not say' }).click();
    let asked = 0;
    page.on('request', (request) => void (asked += Number(request.url().includes('/api/map?'))));
    const pitch = page.getByLabel('Distance of pixels, along columns');
    await pitch.pressSequentially('1.5 um', { delay: 60 });
    await saved(page);
    await page.waitForTimeout(600);
    expect(asked).toBe(1);
    await pitch.fill('');
    await pitch.blur();
    await saved(page);
  });
});

describe('options of a measurement', () => {
  const all = begin(() => browser, (folder) => withExperiment(folder));

  it('are the same in two tabs', async () => {
    const { page, opened } = all;
    const other = await openTab(opened);
    for (const tab of [page, other]) {
      await go(tab, 'Measure');
      await tab.locator('summary', { hasText: 'Options' }).click();
    }
    await field(page, 'rim-margin').fill('50 um');
    await expect.poll(() => field(other, 'rim-margin').inputValue()).toBe('50 um');
    await field(other, 'rim-margin').fill('');
    await expect.poll(() => field(page, 'rim-margin').inputValue()).toBe('');
    await other.close();
  });

  it('stand in the command, which is the one that is started; its report opens in a tab', async () => {
    const { page } = all;
    await field(page, 'rim-margin').fill('45 um');
    await field(page, 'Folder of the result').fill("it's mine");
    await go(page, 'Runs');
    // Measured while the last change is still on its way.
    await page.route('**/api/experiment?*', async (route) => {
      await new Promise((done) => setTimeout(done, 1500));
      await route.continue();
    });
    const [sent] = await Promise.all([
      page.waitForRequest((request) => request.method() === 'PUT'),
      field(page, 'Density').fill('998.5 kg/m3'),
    ]);
    await go(page, 'Measure');
    const shown = await page.locator('.command code').first().innerText();
    const [started] = await Promise.all([
      page.waitForResponse((response) => response.url().endsWith('/api/jobs') && response.request().method() === 'POST'),
      page.getByRole('button', { name: 'Measure', exact: true }).last().click(),
    ]);
    expect(sent.postData()).toContain('998.5 kg/m3');
    await page.unroute('**/api/experiment?*');
    const { command } = (await started.json()) as { command: string[] };
    expect(shown).toBe(['manoscope', ...command.slice(1).filter((word) => word !== '--progress')].map(quoted).join(' '));
    await page.getByText(/^Done in/).waitFor({ timeout: 60_000 });
    await page.getByRole('button', { name: 'See the result' }).click();
    const [report] = await Promise.all([
      page.waitForEvent('popup'),
      page.getByRole('link', { name: 'Open the report in a tab' }).click(),
    ]);
    await report.locator('#summary').waitFor();
    await report.locator('#explore .chart').first().scrollIntoViewIfNeeded();
    await report.locator('#explore canvas').first().waitFor();
    await report.close();
  });
});

describe('a list that no table can show', () => {
  const all = begin(() => browser, (folder) => {
    withExperiment(folder);
    writeFileSync(join(folder, 'flow.csv'), readFileSync(join(EXPERIMENT(), 'flow.csv'), 'utf8').replace('[mL/min]', '[mL/min'));
  });

  it('is mended in its text', async () => {
    const { page, served } = all;
    await go(page, 'Runs');
    await page.getByText('Mend the text of flow.csv').waitFor();
    expect(await field(page, 'Map, row 1').count()).toBe(0);
    await page.getByLabel('File', { exact: true }).selectOption('flow.csv');
    const text = field(page, 'flow.csv');
    await text.fill((await text.inputValue()).replace('[mL/min', '[mL/min]'));
    await page.getByRole('button', { name: 'Save the text' }).click();
    await field(page, 'Map, row 1').waitFor();
    expect(toml(served, 'flow.csv')).toBe(readFileSync(join(EXPERIMENT(), 'flow.csv'), 'utf8'));
  });
});

describe('text that is not saved', () => {
  const all = begin(() => browser, (folder) => withExperiment(folder));

  it('is asked for before the tab closes', async () => {
    const { page, opened } = all;
    const tab = await openTab(opened);
    await tab.getByLabel('experiment.toml', { exact: true }).click();
    await tab.keyboard.type('# mine');
    const asked = tab.waitForEvent('dialog');
    await tab.close({ runBeforeUnload: true });
    expect((await asked).type()).toBe('beforeunload');
    expect(await page.getByRole('button', { name: 'Save the text' }).count()).toBe(0);
  });

  it('outlives a server that was started again, and so does the way to it', async () => {
    const { page, served } = all;
    await go(page, 'Runs');
    const text = field(page, 'experiment.toml');
    const changed = `${await text.inputValue()}# mine\n`;
    await text.fill(changed);
    await served.restart();
    await page.getByRole('alert').getByText('Open the address that `manoscope serve` printed').waitFor();
    await page.goto(served.address);
    await page.getByRole('button', { name: 'Save the text' }).click();
    await saved(page);
    expect(toml(served)).toBe(changed);
  });
});
