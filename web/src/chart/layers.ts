// Things that uPlot does not draw by itself.

import type uPlot from 'uplot';
import { clipped } from './plot';
import type { Layer, Symbol } from './spec';

export interface Point {
  x: number;
  y: number;
  ux?: number; // half lengths of the bars
  uy?: number;
}

const ratio = (plot: uPlot) => plot.ctx.canvas.width / plot.width;

export function drawSymbol(
  ctx: CanvasRenderingContext2D,
  symbol: Symbol,
  x: number,
  y: number,
  r: number,
): void {
  ctx.beginPath();
  if (symbol === 'circle') ctx.arc(x, y, r, 0, 2 * Math.PI);
  const corners = { circle: 0, square: 4, triangle: 3, diamond: 4 }[symbol];
  const start = symbol === 'square' ? Math.PI / 4 : -Math.PI / 2;
  for (let i = 0; i < corners; ++i) {
    const angle = start + (2 * Math.PI * i) / corners;
    const at: [number, number] = [x + 1.25 * r * Math.cos(angle), y + 1.25 * r * Math.sin(angle)];
    if (i === 0) ctx.moveTo(...at);
    else ctx.lineTo(...at);
  }
  ctx.closePath();
  ctx.fill();
}

function drawBar(ctx: CanvasRenderingContext2D, from: number[], to: number[], cap: number) {
  const across = from[0] === to[0] ? [cap, 0] : [0, cap];
  for (const end of [from, to]) {
    ctx.moveTo(end[0] - across[0], end[1] - across[1]);
    ctx.lineTo(end[0] + across[0], end[1] + across[1]);
  }
  ctx.moveTo(from[0], from[1]);
  ctx.lineTo(to[0], to[1]);
}

/** Symbols with error bars. */
export function points(list: Point[], colour: string, symbol: Symbol = 'circle', size = 4): Layer {
  return (plot) =>
    clipped(plot, () => {
      const { ctx } = plot;
      const k = ratio(plot);
      const at = (x: number, y: number) => [plot.valToPos(x, 'x', true), plot.valToPos(y, 'y', true)];
      ctx.strokeStyle = ctx.fillStyle = colour;
      ctx.lineWidth = 1.5 * k;
      ctx.setLineDash([]);
      for (const { x, y, ux = 0, uy = 0 } of list) {
        const [px, py] = at(x, y);
        if (!Number.isFinite(px) || !Number.isFinite(py)) continue;
        ctx.beginPath();
        if (ux > 0) drawBar(ctx, at(x - ux, y), at(x + ux, y), 4 * k);
        if (uy > 0) drawBar(ctx, at(x, y - uy), at(x, y + uy), 4 * k);
        ctx.stroke();
        drawSymbol(ctx, symbol, px, py, size * k);
      }
    });
}

/** A line through points, whatever their order. */
export function line(list: [number, number][], colour: string, dash: number[] = [], width = 1.5): Layer {
  return (plot) =>
    clipped(plot, () => {
      const { ctx } = plot;
      const k = ratio(plot);
      ctx.strokeStyle = colour;
      ctx.lineWidth = width * k;
      ctx.setLineDash(dash.map((part) => part * k));
      ctx.beginPath();
      list.forEach(([x, y], i) => {
        const at: [number, number] = [plot.valToPos(x, 'x', true), plot.valToPos(y, 'y', true)];
        if (i === 0) ctx.moveTo(...at);
        else ctx.lineTo(...at);
      });
      ctx.stroke();
      ctx.setLineDash([]);
    });
}

/** A stretch of x, over the whole height. */
export function stretch(from: number | null, to: number | null, colour: string): Layer {
  return (plot) => {
    if (from === null || to === null) return;
    const left = plot.valToPos(from, 'x', true);
    plot.ctx.fillStyle = colour;
    plot.ctx.fillRect(left, plot.bbox.top, plot.valToPos(to, 'x', true) - left, plot.bbox.height);
  };
}

/** A box in the units of the axes. */
export function box(
  x: [number, number],
  y: [number, number],
  colour: string,
  filled = true,
): Layer {
  return (plot) => {
    const left = plot.valToPos(x[0], 'x', true);
    const top = plot.valToPos(y[1], 'y', true);
    const width = plot.valToPos(x[1], 'x', true) - left;
    const height = plot.valToPos(y[0], 'y', true) - top;
    const { ctx } = plot;
    if (filled) {
      ctx.fillStyle = colour;
      ctx.fillRect(left, top, width, height);
      return;
    }
    ctx.strokeStyle = colour;
    ctx.lineWidth = 1.5 * ratio(plot);
    ctx.setLineDash([6 * ratio(plot), 4 * ratio(plot)]);
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.stroke();
    ctx.setLineDash([]);
  };
}
