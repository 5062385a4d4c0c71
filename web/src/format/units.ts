import type { Unit } from '../data/report';

function fitting(largest: number, units: Unit[]): Unit {
  return [...units].reverse().find((unit) => unit.si <= largest) ?? units[0];
}

const PRESSURES: Unit[] = [
  { name: 'Pa', si: 1 },
  { name: 'kPa', si: 1e3 },
  { name: 'MPa', si: 1e6 },
];

const LENGTHS: Unit[] = [
  { name: 'nm', si: 1e-9 },
  { name: 'µm', si: 1e-6 },
  { name: 'mm', si: 1e-3 },
  { name: 'm', si: 1 },
];

/** The largest unit that does not exceed a magnitude, else the smallest. */
export const pressureUnit = (largest: number) => fitting(largest, PRESSURES);
export const lengthUnit = (largest: number) => fitting(largest, LENGTHS);
