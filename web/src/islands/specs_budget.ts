// The variance of p(x) by source, as stacked bars along x.

import { type Theme, kind } from '../chart/colours';
import { box } from '../chart/layers';
import { type ChartSpec, type Layer, plain } from '../chart/spec';
import { type Report, largest } from '../data/report';
import { pressureUnit } from '../format/units';

export interface Bar {
  from: number;
  to: number;
  variance: number[]; // mean by source
}

/** Means over at most `most` equal stretches of x of the stations that have an answer. */
export function budgetBars(report: Report, run: number, most = 72): Bar[] {
  const { budget } = report.runs[run];
  const { length } = report.channel;
  const n = Math.min(most, report.x.length);
  const bars: Bar[] = [];
  for (let b = 0; b < n; ++b) {
    const [from, to] = [(b * length) / n, ((b + 1) * length) / n];
    const stations = report.x.flatMap((x, i) =>
      x >= from && x < to && budget.every((source) => source[i] !== null) ? [i] : [],
    );
    if (stations.length === 0) continue;
    const variance = budget.map(
      (source) => stations.reduce((sum, i) => sum + (source[i] as number), 0) / stations.length,
    );
    bars.push({ from, to, variance });
  }
  return bars;
}

/** Variance of every source at every station, Pa2. */
function budgetTable(report: Report, run: number): string[][] {
  const head = [`x (${report.units.x.name})`, ...report.budget_sources.map((source) => `${source} (Pa2)`)];
  const rows = report.x.map((x, i) =>
    [x / report.units.x.si, ...report.runs[run].budget.map((source) => source[i])].map(plain),
  );
  return [head, ...rows];
}

const total = (bar: Bar) => bar.variance.reduce((sum, v) => sum + v, 0);

export function budgetSpec(report: Report, run: number, shares: boolean, theme: Theme): ChartSpec {
  const bars = budgetBars(report, run);
  const along = report.units.x;
  const [start, end] = report.runs[run].test_section;
  const inside = bars.filter((bar) => bar.from >= (start ?? 0) && bar.to <= (end ?? Infinity));
  const most = largest((inside.length > 0 ? inside : bars).map((bar) => report.expansion * Math.sqrt(total(bar))));
  const unit = pressureUnit(most);
  const layers: Layer[] = bars.flatMap((bar) => {
    const sum = total(bar);
    if (!(sum > 0)) return [];
    const height = shares ? 100 : (report.expansion * Math.sqrt(sum)) / unit.si;
    const room = 0.06 * (bar.to - bar.from);
    let below = 0;
    return bar.variance.map((variance, source) => {
      const above = below + (height * variance) / sum;
      const layer = box(
        [(bar.from + room) / along.si, (bar.to - room) / along.si],
        [below, above],
        kind(source, theme),
      );
      below = above;
      return layer;
    });
  });
  return {
    x: { label: `x (${along.name})`, range: [0, report.channel.length / along.si] },
    y: {
      label: shares ? 'share of the variance (%)' : `U(p) (${unit.name})`,
      range: [0, shares ? 100 : (1.15 * most) / unit.si || 1],
    },
    places: [],
    columns: [],
    series: [],
    grid: false,
    table: budgetTable(report, run),
    under: layers,
    legend: report.budget_sources.map((label, i) => ({ label, colour: kind(i, theme), area: true })),
  };
}
