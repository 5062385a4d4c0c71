// A chart as an SVG document: drawn once more, in the light colours, by a context that writes.

import uPlot from 'uplot';
import { LIGHT, type Theme } from './colours';
import { type View, dataOf, optionsOf } from './plot';
import type { ChartSpec } from './spec';
import { SvgContext, SvgPath } from './svg_context';

export async function chartSvg(
  build: (theme: Theme) => ChartSpec,
  view: View,
  size: { width: number; height: number },
  title: string,
): Promise<string> {
  const spec = build(LIGHT);
  const holder = document.createElement('div');
  holder.style.cssText = 'position:absolute;left:-9999px;top:0';
  document.body.append(holder);
  const { getContext } = HTMLCanvasElement.prototype;
  const { Path2D } = window;
  const contexts: SvgContext[] = [];
  const written = function (this: HTMLCanvasElement) {
    const known = contexts.find((context) => context.canvas === this);
    if (known) return known;
    contexts.push(new SvgContext(this));
    return contexts[contexts.length - 1];
  };
  HTMLCanvasElement.prototype.getContext = written as unknown as typeof getContext;
  window.Path2D = SvgPath as unknown as typeof Path2D;
  let plot: uPlot | null = null;
  try {
    plot = new uPlot(optionsOf(() => spec, view, LIGHT, size, true), dataOf(spec), holder);
    await Promise.resolve(); // uPlot draws in a microtask of its own
    return contexts[0].document(size.width, size.height, title);
  } finally {
    HTMLCanvasElement.prototype.getContext = getContext;
    window.Path2D = Path2D;
    plot?.destroy();
    holder.remove();
  }
}
