// The local app: what an experimenter does with it, against the program itself.

import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { launch } from './support';
import {
  EXPERIMENT, MAPS, begin, field, go, openApp, openTab, pasteInto, rowsOf, saved, serve, toml, withExperiment, withMaps,
} from './serve';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());

const stated = (key: string) => new RegExp(`^${key}\\s*=\\s*"([^"]*)"`, 'm').exec(readFileSync(join(EXPERIMENT(), 'experiment.toml'), 'utf8'))![1];
const table = (rows: string[][]) => rows.map((row) => row.join('\t')).join('\n');

describe('from an empty folder to a report', () => {
  const all = begin(() => browser, () => {});

  it('takes maps, and says what is none', async () => {
    const { page } = all;
    expect(await page.getByRole('main').innerText()).toContain('No map in this folder yet');
    const none = { name: 'minutes.docx', mimeType: 'application/octet-stream', buffer: Buffer.from([80, 75, 3, 4, 1, 2, 3]) };
    await page.getByTestId('picker').setInputFiles([none]);
    await page.getByRole('alert').getByText('minutes.docx').waitFor();
    expect(await page.getByRole('alert').innerText()).toContain('is of no known format');
    await page.getByTestId('picker').setInputFiles(MAPS().map((name) => join(EXPERIMENT(), name)));
    await page.getByText(`${MAPS().length} files came.`).waitFor();
    await page.getByRole('img', { name: `Heights of ${MAPS()[0]}` }).waitFor();
    await page.getByRole('button', { name: MAPS()[2], exact: true }).click();
    await page.getByRole('img', { name: `Heights of ${MAPS()[2]}` }).waitFor();
  });

  it('replaces no file of the folder', async () => {
    const { page } = all;
    await page.getByTestId('picker').setInputFiles(join(EXPERIMENT(), MAPS()[0]));
    await page.getByRole('alert').getByText(MAPS()[0]).waitFor();
  });

  it('drafts the experiment and tells what is missing, where it is missing', async () => {
    const { page, served } = all;
    await page.getByRole('button', { name: 'Draft the experiment' }).click();
    await page.getByRole('heading', { name: 'Channel' }).waitFor();
    expect(toml(served)).toContain('manoscope = 1');
    const length = field(page, 'Length');
    expect(await length.getAttribute('aria-invalid')).toBe('true');
    await length.fill('15 furlongs');
    await page.locator('#field-channel-length-about').getByText('furlong').waitFor();
    await length.fill(stated('length'));
    await field(page, 'Width').fill(stated('width'));
    await field(page, 'Height').fill(stated('height'));
    await saved(page);
    await expect.poll(() => length.getAttribute('aria-invalid')).toBe('false');
    expect(toml(served)).toMatch(new RegExp(`^length = "${stated('length')}"`, 'm'));
  });

  it('fills the tables from a spreadsheet', async () => {
    const { page, served } = all;
    const levels = rowsOf('hydrostatic.csv');
    await go(page, 'Calibration');
    await page.getByRole('row', { name: /h00\.gsf/ }).waitFor();
    // In kilopascals, in another order, without endings: values find their rows by the names.
    const rows = levels.map(([map, pressure]) => [map.replace('.gsf', ''), String(Number(pressure) / 1000)]).reverse();
    await pasteInto(page, 'Pressure, row 1', `file\tp (kPa)\n${table(rows)}\n`);
    await page.getByTestId('hydrostatic-told').getByText(`Pasted ${levels.length} values into ${levels.length} rows.`).waitFor();
    await field(page, 'Noise of one reading').fill('10 Pa');
    await go(page, 'Runs');
    const runs = rowsOf('flow.csv');
    await pasteInto(page, 'Flow rate, row 1', `map\tQ [mL/min]\n${table(runs.map(([map, rate]) => [map, rate]))}\n`);
    await field(page, 'Flow rate, row 1').fill(`${Number(runs[0][1]) * 1000} uL/min`);
    await field(page, 'Flow rate, row 1').press('Enter');
    await field(page, 'Flow rate, row 2').focus();
    expect(await field(page, 'Flow rate, row 1').inputValue()).toBe(String(Number(runs[0][1])));
    await saved(page);
    const written = readFileSync(join(served.folder, 'hydrostatic.csv'), 'utf8');
    for (const [map, pressure] of levels) {
      const cells = written.split('\n').find((line) => line.startsWith(map))!.split(',');
      expect(Number(cells[1])).toBeCloseTo(Number(pressure), 6);
    }
  });

  it('finds the channel, and moves it by keys and by hand', async () => {
    const { page, served } = all;
    await go(page, 'Channel');
    await page.getByTestId('place-words').getByText('Found in the maps').waitFor();
    await page.getByRole('button', { name: 'Write the found place into the file' }).click();
    await saved(page);
    const origin = () => /^origin = \["([\d.]+) mm", "([\d.]+) mm"\]/m.exec(toml(served))!.slice(1).map(Number);
    // The program itself finds it to within a few pixels of where the experiment has it.
    const [x, y] = /^origin\s*=\s*\["([\d.]+) mm", "([\d.]+) mm"\]/m.exec(readFileSync(join(EXPERIMENT(), 'experiment.toml'), 'utf8'))!.slice(1).map(Number);
    expect(Math.hypot(origin()[0] - x, origin()[1] - y)).toBeLessThan(0.3);
    const found = origin();
    await page.getByTestId('channel').focus();
    for (let i = 0; i < 3; ++i) await page.keyboard.press('ArrowRight');
    await page.keyboard.press('ArrowUp');
    await saved(page);
    const pushed = origin();
    expect(pushed[0]).toBeGreaterThan(found[0]);
    expect(pushed[1]).toBeLessThan(found[1]);
    const box = (await page.getByTestId('channel').boundingBox())!;
    await page.mouse.move(box.x + box.width / 4, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 4 - 12, box.y + box.height / 2, { steps: 4 });
    await page.mouse.up();
    await saved(page);
    expect(origin()[0]).toBeLessThan(pushed[0]);
    expect(origin()[1]).toBeCloseTo(pushed[1], 3);
    await page.getByTestId('margin').focus();
    await page.keyboard.press('ArrowRight');
    expect(await page.getByLabel(/^Rigid frame begins/).first().inputValue()).toMatch(/^[\d.]+ um$/);
    await page.getByRole('button', { name: 'As it comes' }).click();
    await page.getByRole('button', { name: 'Let it be found' }).click();
    await saved(page);
    expect(toml(served)).not.toMatch(/^origin/m);
  });

  it('goes back by Undo, step by step', async () => {
    const { page, served } = all;
    const density = toml(served).match(/^density.*$/m)![0];
    await go(page, 'Runs');
    await field(page, 'Density').fill('1 kg/m3');
    await saved(page);
    await page.getByRole('button', { name: 'Undo' }).click();
    await saved(page);
    expect(toml(served)).toContain(density);
  });

  it('measures, and shows the report', async () => {
    const { page, served } = all;
    await go(page, 'Check');
    await page.getByText('No fault found.').waitFor();
    await page.getByRole('button', { name: 'Read every map, too' }).click();
    await page.getByText('Every map was read.').waitFor();
    await go(page, 'Measure');
    await page.getByRole('button', { name: 'Measure', exact: true }).last().click();
    await page.getByRole('progressbar').waitFor();
    await page.getByText(/^Done in/).waitFor({ timeout: 60_000 });
    expect(existsSync(join(served.folder, 'result', 'result.nc'))).toBe(true);
    await page.getByRole('button', { name: 'See the result' }).click();
    await page.getByRole('row', { name: /^f00 4\.000/ }).waitFor(); // a run without a name is called like its map
    const report = page.frameLocator('iframe');
    await report.locator('#summary').waitFor();
    // Its script runs: views are drawn when they are looked at.
    await report.locator('#explore .chart').first().scrollIntoViewIfNeeded();
    await report.locator('#explore canvas').first().waitFor();
  });

  it('measures again, elsewhere', async () => {
    const { page } = all;
    await go(page, 'Measure');
    await page.getByText('replaces the result that is there').waitFor();
    await field(page, 'Folder of the result').fill('again');
    await page.getByRole('button', { name: 'Measure', exact: true }).last().click();
    await page.getByText(/^Done in.*again/).waitFor({ timeout: 60_000 });
  });

  it('compares two results', async () => {
    const { page } = all;
    await go(page, 'Results');
    await page.getByLabel('compared with').selectOption({ index: 1 });
    await page.getByRole('columnheader', { name: /Difference/ }).waitFor();
    await page.getByRole('img', { name: /^Pressure along the channel/ }).locator('canvas').waitFor();
    // Measured from the same maps with the same options.
    const differences = await page.locator('table.numbers tbody tr td:last-child').allInnerTexts();
    expect(differences).toEqual(differences.map(() => '0'));
  });
});

describe('a result of another experiment', () => {
  const all = begin(() => browser, (folder) => {
    withExperiment(folder);
    mkdirSync(join(folder, 'result'));
    writeFileSync(join(folder, 'result', 'result.nc'), 'of another one');
  });

  it('is replaced only when told to', async () => {
    const { page, served } = all;
    await go(page, 'Measure');
    await page.getByRole('button', { name: 'Measure', exact: true }).last().click();
    await page.getByRole('alert').getByText('It failed').waitFor();
    await page.getByRole('button', { name: 'Measure, and replace what is there' }).click();
    await page.getByText(/^Done in/).waitFor({ timeout: 60_000 });
    expect(readFileSync(join(served.folder, 'result', 'result.nc')).length).toBeGreaterThan(10_000);
  });
});

describe('what is typed', () => {
  const all = begin(() => browser, (folder) => withExperiment(folder, 's1'));

  it('outlives a reload at once, and the step too', async () => {
    const { page, served } = all;
    await go(page, 'Runs');
    await field(page, 'Density').fill('997.5 kg/m3');
    await page.reload(); // before it was saved
    await page.getByRole('heading', { name: 'Runs', exact: true }).waitFor();
    expect(await field(page, 'Density').inputValue()).toBe('997.5 kg/m3');
    await saved(page);
    expect(toml(served, 's1/experiment.toml')).toContain('density = "997.5 kg/m3"');
  });

  it('as text outlives it too, and waits to be saved', async () => {
    const { page, served } = all;
    const text = field(page, 'experiment.toml');
    const changed = (await text.inputValue()).replace('997.5 kg/m3', '996 kg/m3') + '# a remark\n';
    await text.fill(changed);
    expect(await field(page, 'Density').isDisabled()).toBe(true);
    await page.reload();
    await page.getByRole('button', { name: 'Save the text' }).waitFor();
    expect(await text.inputValue()).toBe(changed);
    expect(toml(served, 's1/experiment.toml')).not.toContain('# a remark');
    await page.getByRole('button', { name: 'Save the text' }).click();
    await saved(page);
    expect(toml(served, 's1/experiment.toml')).toBe(changed);
    expect(await field(page, 'Density').inputValue()).toBe('996 kg/m3');
    // The form changes its own keys and leaves the rest.
    await field(page, 'Density').fill('995 kg/m3');
    await saved(page);
    expect(toml(served, 's1/experiment.toml')).toBe(changed.replace('996', '995'));
  });

  it('as text that is no TOML is told with its line, and taken back', async () => {
    const { page, served } = all;
    const before = toml(served, 's1/experiment.toml');
    await field(page, 'experiment.toml').fill('manoscope = 1\n[channel\n');
    await go(page, 'Check');
    await page.getByTestId('faults').getByText(/line \d/).first().waitFor();
    await page.getByRole('button', { name: 'Discard' }).click();
    await page.getByText('No fault found.').waitFor();
    expect(toml(served, 's1/experiment.toml')).toBe(before);
  });

  it('leads from the list of faults to the field', async () => {
    const { page } = all;
    await go(page, 'Calibration');
    const cell = field(page, 'Pressure, row 3');
    const before = await cell.inputValue();
    await cell.fill('much');
    await cell.press('Enter');
    await page.getByText('much').first().waitFor();
    await go(page, 'Check');
    await page.getByRole('button', { name: 'Go to Calibration' }).click();
    await expect.poll(() => page.evaluate(() => document.activeElement?.getAttribute('aria-label'))).toBe('Pressure, row 3');
    expect(await cell.getAttribute('aria-invalid')).toBe('true');
    await cell.fill(before);
    await saved(page);
    await expect.poll(() => cell.getAttribute('aria-invalid')).toBe('false');
  });
});

describe('two tabs', () => {
  const all = begin(() => browser, (folder) => withExperiment(folder));

  it('follow each other', async () => {
    const { page, opened } = all;
    const other = await openTab(opened);
    await go(page, 'Runs');
    await go(other, 'Runs');
    await field(other, 'Density').fill('990 kg/m3');
    await saved(other);
    await expect.poll(() => field(page, 'Density').inputValue()).toBe('990 kg/m3');
    await page.getByText('The file was changed outside this page').waitFor();
    await other.close();
  });

  it('tell a conflict in words and leave the choice', async () => {
    const { page, served, opened } = all;
    const change = (density: string) => {
      const text = toml(served).replace(/^density = .*$/m, `density = "${density}"`);
      writeFileSync(join(served.folder, 'experiment.toml'), text);
    };
    for (const choice of ['Keep what is here', 'Take what the file says']) {
      // Both at once: what is typed here and what another program writes.
      await field(page, 'Density').fill('900 kg/m3');
      change('800 kg/m3');
      await page.getByRole('alert').getByText('fluid.density: here "900 kg/m3", in the file "800 kg/m3"').waitFor();
      expect(toml(served)).toContain('800 kg/m3');
      await page.getByRole('button', { name: choice }).click();
      await saved(page);
      const wanted = choice.startsWith('Keep') ? '900 kg/m3' : '800 kg/m3';
      expect(await field(page, 'Density').inputValue()).toBe(wanted);
      expect(toml(served)).toContain(wanted);
    }
    expect(opened.foreign).toEqual([]);
  });
});

describe('a measurement', () => {
  const all = begin(() => browser, (folder) => withExperiment(folder, 's1'));

  it('is cancelled, from either of two tabs, and writes nothing', async () => {
    const { page, served, opened } = all;
    await go(page, 'Measure');
    await page.locator('summary', { hasText: 'Options' }).click();
    await field(page, 'flow-stations').fill('3000'); // a minute and more
    await page.getByRole('button', { name: 'Measure', exact: true }).last().click();
    await page.getByRole('button', { name: 'Cancel' }).waitFor();
    // A reload in the middle finds it again.
    await page.reload();
    await page.getByRole('progressbar').waitFor();
    const other = await openTab(opened);
    await go(other, 'Measure');
    await other.getByRole('button', { name: 'Cancel' }).click();
    await page.getByText('Cancelled. Nothing was written.').waitFor();
    expect(existsSync(join(served.folder, 's1-result'))).toBe(false);
    await other.close();
  });

  it('that fails says why', async () => {
    const { page } = all;
    await page.locator('summary', { hasText: 'Options' }).click();
    await field(page, 'flow-stations').fill('many');
    await page.getByRole('button', { name: 'Measure', exact: true }).last().click();
    await page.getByRole('alert').getByText('many').waitFor();
    await field(page, 'flow-stations').fill('');
  });
});

describe('maps alone', () => {
  const all = begin(() => browser, withMaps);

  it('come by dropping, too', async () => {
    const { page } = all;
    const transfer = await page.evaluateHandle((base64) => {
      const list = new DataTransfer();
      list.items.add(new File([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], 'extra.gsf'));
      return list;
    }, readFileSync(join(EXPERIMENT(), MAPS()[0])).toString('base64'));
    await page.getByRole('group', { name: 'Bring maps' }).dispatchEvent('drop', { dataTransfer: transfer });
    await page.getByRole('button', { name: 'extra.gsf', exact: true }).waitFor();
  });
});

it('what is served is what was built', async () => {
  const served = await serve();
  const { page, context } = await openApp(browser, served);
  for (const file of ['app.js', 'app.css']) {
    const text = await page.evaluate((name) => fetch(`/${name}`).then((r) => r.text()), file);
    expect(text).toBe(readFileSync(new URL(`../../dist/${file}`, import.meta.url), 'utf8'));
  }
  await context.close();
  await served.stop();
});
