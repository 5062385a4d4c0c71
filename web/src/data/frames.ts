// What the slider of the map viewer runs over: maps at known pressures by pressure, then those
// under flow by flow rate. Where the page holds no maps: levels and runs.

import { pressureUnit } from '../format/units';
import { shortNumber } from '../format/numbers';
import { type Report, runOrder } from './report';

export interface Frame {
  label: string;
  level: number; // index, -1: under flow
  run: number; // index, -1: at known pressure
  map: number; // index, -1: none
}

function levelLabel(pressure: number | null): string {
  if (pressure === null) return 'pressure not known';
  const unit = pressureUnit(Math.abs(pressure));
  return `${shortNumber(pressure / unit.si)} ${unit.name}, no flow`;
}

function runLabel(report: Report, run: number): string {
  const { flow_rate: rate, name } = report.runs[run];
  const unit = report.units.flow_rate;
  return rate === null ? name : `flow ${shortNumber(rate / unit.si)} ${unit.name}`;
}

function levelOf(report: Report, pressure: number | null): number {
  if (pressure === null) return -1;
  let best = -1;
  report.levels.pressure.forEach((value, level) => {
    const known = best >= 0 ? (report.levels.pressure[best] as number) : Infinity;
    if (value !== null && Math.abs(value - pressure) < Math.abs(known - pressure)) best = level;
  });
  return best;
}

function framesOfMaps(report: Report): Frame[] {
  const order = runOrder(report);
  const list = (report.maps?.list ?? []).map((map, index) => ({ map, index }));
  const levels = list
    .filter(({ map }) => map.run < 0)
    .sort((a, b) => (a.map.pressure ?? 0) - (b.map.pressure ?? 0) || a.index - b.index);
  const runs = list
    .filter(({ map }) => map.run >= 0 && map.run < report.runs.length)
    .sort((a, b) => order.indexOf(a.map.run) - order.indexOf(b.map.run) || a.index - b.index);
  return [
    ...levels.map(({ map, index }) => ({
      label: `${levelLabel(map.pressure)} (${map.name})`,
      level: levelOf(report, map.pressure),
      run: -1,
      map: index,
    })),
    ...runs.map(({ map, index }) => ({
      label: `${runLabel(report, map.run)} (${map.name})`,
      level: -1,
      run: map.run,
      map: index,
    })),
  ];
}

export function frames(report: Report): Frame[] {
  if (report.maps !== null) return framesOfMaps(report);
  const levels = report.levels.pressure.map((pressure, level) => ({
    label: levelLabel(pressure),
    level,
    run: -1,
    map: -1,
  }));
  const runs = runOrder(report).map((run) => ({
    label: runLabel(report, run),
    level: -1,
    run,
    map: -1,
  }));
  return [...levels, ...runs];
}
