// A map as an image, and its colour bar.

import type uPlot from 'uplot';
import { MISSING } from '../data/maps';
import type { Axis } from '../data/report';
import { fixed } from '../format/numbers';
import { type MapName, type Theme, colourAt, css } from './colours';
import type { Layer } from './spec';

/** Colours of a map as 32-bit words, red in the lowest byte. */
function palette(map: MapName): Uint32Array {
  const words = new Uint32Array(256);
  for (let i = 0; i < 256; ++i) {
    const [r, g, b] = colourAt(map, i / 255);
    words[i] = (255 << 24) | (b << 16) | (g << 8) | r;
  }
  return words;
}

const palettes = new Map<MapName, Uint32Array>();

/** Paints counts into a canvas of their size, z upwards; what is missing stays clear. */
export function paint(
  canvas: HTMLCanvasElement,
  counts: Int16Array,
  [n_x, n_z]: [number, number],
  [low, high]: [number, number],
  map: MapName,
): void {
  canvas.width = n_x;
  canvas.height = n_z;
  if (!palettes.has(map)) palettes.set(map, palette(map));
  const colours = palettes.get(map)!;
  const context = canvas.getContext('2d')!;
  const image = context.createImageData(n_x, n_z);
  const words = new Uint32Array(image.data.buffer);
  const scale = 255 / Math.max(high - low, 1e-12);
  for (let iz = 0; iz < n_z; ++iz) {
    const from = iz * n_x;
    const to = (n_z - 1 - iz) * n_x;
    for (let ix = 0; ix < n_x; ++ix) {
      const count = counts[from + ix];
      if (count === MISSING) continue;
      const place = (count - low) * scale;
      words[to + ix] = colours[place <= 0 ? 0 : place >= 255 ? 255 : (place + 0.5) | 0];
    }
  }
  context.putImageData(image, 0, 0);
}

/** The edges of the outermost cells, not their centres. */
export function edges(axis: Axis): [number, number] {
  const half = axis.n > 1 ? (axis.last - axis.first) / (axis.n - 1) / 2 : 0.5e-6;
  return [axis.first - half, axis.last + half];
}

export function image(
  canvas: HTMLCanvasElement,
  x: [number, number],
  z: [number, number],
): Layer {
  return (plot) => {
    if (canvas.width === 0) return;
    const left = plot.valToPos(x[0], 'x', true);
    const top = plot.valToPos(z[1], 'y', true);
    const width = plot.valToPos(x[1], 'x', true) - left;
    plot.ctx.drawImage(canvas, left, top, width, plot.valToPos(z[0], 'y', true) - top);
  };
}

/** On the right of the plot: the colours, and what they stand for. */
export function colourBar(
  map: MapName,
  [low, high]: [number, number],
  unit: string,
  theme: Theme,
): Layer {
  return (plot: uPlot) => {
    const { ctx, bbox } = plot;
    const k = ctx.canvas.width / plot.width;
    const left = bbox.left + bbox.width + 10 * k;
    const width = 12 * k;
    const n = 64;
    for (let i = 0; i < n; ++i) {
      ctx.fillStyle = css(colourAt(map, i / (n - 1)));
      const bottom = bbox.top + bbox.height * (1 - i / n);
      ctx.fillRect(left, bottom - bbox.height / n - 0.5, width, bbox.height / n + 1);
    }
    ctx.fillStyle = theme.ink;
    ctx.font = `${12 * k}px system-ui, Helvetica, Arial, sans-serif`;
    ctx.textAlign = 'left';
    const decimals = Math.max(0, 1 - Math.floor(Math.log10(Math.max(high - low, 1e-9))));
    for (const [share, baseline] of [[0, 'bottom'], [0.5, 'middle'], [1, 'top']] as const) {
      ctx.textBaseline = baseline;
      const y = bbox.top + bbox.height * (1 - share);
      const text = fixed(low + share * (high - low), decimals);
      ctx.fillText(share === 1 ? `${text} ${unit}` : text, left + width + 4 * k, y);
    }
  };
}
