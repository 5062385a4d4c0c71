// The figures that were drawn for print: downloads, and a switch for those that the page shows
// better itself.

import { savePng, saveSvg } from '../format/save';

const TWINS = [
  'fig3c_pressure_highest_flow',
  'fig3b_pressure_lowest_flow',
  'pressure_all_runs',
  'fig2b_flow_profiles',
  'fig4_drop_agreement',
  'fig2a_pressure_drop',
  'fig1d_static_profiles',
  'fig3a_profiles_overlaid',
  'fig1ef_crest_deflection',
];

/** A figure of the page as a document of its own. */
function documentOf(svg: SVGSVGElement): string {
  const copy = svg.cloneNode(true) as SVGSVGElement;
  copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
  return new XMLSerializer().serializeToString(copy);
}

function button(text: string, label: string, act: () => void): HTMLButtonElement {
  const made = document.createElement('button');
  made.type = 'button';
  made.textContent = text;
  made.setAttribute('aria-label', label);
  made.addEventListener('click', act);
  return made;
}

function offerFigure(figure: HTMLElement): void {
  const svg = figure.querySelector('svg');
  if (!svg) return;
  const title = figure.querySelector('figcaption b')?.textContent ?? figure.id;
  const tools = document.createElement('div');
  tools.className = 'tools';
  const { width, height } = svg.viewBox.baseVal;
  tools.append(
    button('SVG', `Save as SVG: ${title}`, () => saveSvg(figure.id, documentOf(svg))),
    button('PNG', `Save as PNG: ${title}`, () => void savePng(figure.id, documentOf(svg), width, height)),
  );
  figure.append(tools);
}

function addSwitch(list: HTMLElement, twins: HTMLElement[]): void {
  const words = (open: boolean) =>
    open ? "Hide the paper's figures" : `Show the paper's figures, as they print (${twins.length})`;
  const toggle = button(words(false), '', () => {
    const open = list.classList.toggle('folded') === false;
    toggle.textContent = words(open);
    toggle.setAttribute('aria-expanded', String(open));
  });
  toggle.removeAttribute('aria-label');
  toggle.setAttribute('aria-expanded', 'false');
  toggle.className = 'switch';
  list.classList.add('folded');
  list.before(toggle);
}

export function offerFigures(): void {
  const list = document.querySelector<HTMLElement>('div.figures');
  if (!list) return;
  const figures = [...list.querySelectorAll<HTMLElement>('figure')];
  figures.forEach(offerFigure);
  const twins = figures.filter((figure) => TWINS.includes(figure.id));
  twins.forEach((figure) => figure.classList.add('twin'));
  if (twins.length > 0) addSwitch(list, twins);
}
