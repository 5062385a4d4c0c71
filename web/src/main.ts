import 'uplot/dist/uPlot.min.css';
import './chart/chart.css';
import './style.css';
import { mount } from 'svelte';
import Explore from './Explore.svelte';
import { readReport } from './data/report';
import { offerFigures } from './page/figures';
import { shared } from './page/place.svelte';
import { offerTables } from './page/tables';

const VIEWS = [
  ['explore-pressure', 'Pressure'],
  ['explore-maps', 'Maps to pressure'],
  ['explore-agreement', 'Agreement'],
  ['explore-budget', 'Uncertainty along x'],
];

/** Links to the views, beside those that the page has already. */
function addLinks(): void {
  const after = document.querySelector('nav a[href="#warnings"]');
  for (const [id, words] of [...VIEWS].reverse()) {
    if (!document.getElementById(id)) continue;
    const link = document.createElement('a');
    link.href = `#${id}`;
    link.textContent = words;
    after?.after(link);
  }
}

async function begin(): Promise<void> {
  const target = document.getElementById('explore');
  const report = await readReport(document);
  if (!target || !report) return;
  shared.x = report.x[report.x.length >> 1] ?? 0;
  mount(Explore, { target, props: { report } });
  addLinks();
  requestAnimationFrame(() => performance.mark('views-shown'));
  // What follows in the page may still be on its way.
  if (document.readyState === 'loading') {
    await new Promise((done) => document.addEventListener('DOMContentLoaded', done, { once: true }));
  }
  offerFigures();
  offerTables();
}

begin().catch((error: unknown) => {
  // Without the views the page is what it is without scripts: whole, but for a word of the reason.
  document.getElementById('explore')?.append(`The interactive views did not start: ${String(error)}`);
});
