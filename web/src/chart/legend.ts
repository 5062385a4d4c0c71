// The legend that an exported figure carries in itself; on the page it is text beside the chart.

import type uPlot from 'uplot';
import type { Theme } from './colours';
import { drawSymbol } from './layers';
import type { LegendEntry } from './spec';

const LETTER = 7.2; // px, about the mean of the font
const SWATCH = 28;

const widthOf = (entry: LegendEntry) => SWATCH + 6 + LETTER * entry.label.length + 18;

/** Entries in rows no wider than that. */
export function legendRows(entries: LegendEntry[], width: number): LegendEntry[][] {
  const rows: LegendEntry[][] = [];
  let used = Infinity;
  for (const entry of entries) {
    if (used + widthOf(entry) > width) {
      rows.push([]);
      used = 0;
    }
    rows[rows.length - 1].push(entry);
    used += widthOf(entry);
  }
  return rows;
}

function drawEntry(ctx: CanvasRenderingContext2D, entry: LegendEntry, x: number, y: number, k: number) {
  ctx.strokeStyle = ctx.fillStyle = entry.colour;
  if (entry.symbol) {
    drawSymbol(ctx, entry.symbol, x + (SWATCH / 2) * k, y, 5 * k);
  } else if (entry.area) {
    ctx.fillRect(x, y - 5 * k, SWATCH * k, 10 * k);
  } else {
    ctx.lineWidth = 2 * k;
    ctx.setLineDash((entry.dash ?? []).map((part) => part * k));
    ctx.beginPath();
    ctx.moveTo(x, y);
    ctx.lineTo(x + SWATCH * k, y);
    ctx.stroke();
    ctx.setLineDash([]);
  }
}

export function drawLegend(plot: uPlot, rows: LegendEntry[][], theme: Theme, font: string): void {
  if (rows.length === 0) return;
  const { ctx, bbox } = plot;
  const k = ctx.canvas.width / plot.width;
  ctx.save();
  ctx.font = font.replace('13px', `${13 * k}px`);
  ctx.textAlign = 'left';
  ctx.textBaseline = 'middle';
  rows.forEach((row, r) => {
    let x = bbox.left;
    const y = (14 + 20 * r) * k;
    for (const entry of row) {
      drawEntry(ctx, entry, x, y, k);
      ctx.fillStyle = theme.ink;
      ctx.fillText(entry.label, x + (SWATCH + 6) * k, y);
      x += widthOf(entry) * k;
    }
  });
  ctx.restore();
}
