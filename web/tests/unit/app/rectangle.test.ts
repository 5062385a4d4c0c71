import { describe, expect, it } from 'vitest';
import type { Point } from '../../../src/app/api/types';
import {
  FLOWS, type Rectangle, centre, corners, flowing, guessedRectangle, moved, outside, statedRectangle, stretched, turned, within, writeRectangle,
} from '../../../src/app/model/rectangle';
import { exampleForm } from './form';

const SIZE: Point = [5e-3, 2e-3];
const stated = () => statedRectangle(exampleForm(), SIZE)!;
const near = (found: Point[], wanted: Point[]) =>
  found.forEach(([x, y], i) => {
    expect(x).toBeCloseTo(wanted[i][0], 9);
    expect(y).toBeCloseTo(wanted[i][1], 9);
  });

describe('the rectangle of a file', () => {
  it('begins at the inlet and extends along the flow and across it', () => {
    near(corners(stated()), [[5e-4, 2.5e-4], [4.5e-3, 2.5e-4], [4.5e-3, 1.25e-3], [5e-4, 1.25e-3]]);
  });

  it('extends the other way across if only that lies in the map', () => {
    const form = exampleForm();
    form.channel.origin = ['0.5 mm', '1.5 mm'];
    const r = statedRectangle(form, SIZE)!;
    expect(r.reversed).toBe(true);
    near([corners(r)[2]], [[4.5e-3, 5e-4]]);
    // Written, it is the same rectangle from its other corner.
    writeRectangle(form, r, false);
    expect(form.channel.origin).toEqual(['0.5 mm', '0.5 mm']);
  });

  it('turns from columns towards growing rows', () => {
    const form = exampleForm();
    form.channel.rotation = '90 deg';
    near([corners(statedRectangle(form, SIZE)!)[1]], [[5e-4, 4.25e-3]]);
  });

  it('is not known where something is missing or no length', () => {
    for (const [key, value] of [['origin', null], ['length', '? mm'], ['width', null], ['flow', null], ['rotation', 'some']] as const) {
      const form = exampleForm();
      Object.assign(form.channel, { [key]: value });
      expect(statedRectangle(form, SIZE), key).toBeNull();
    }
  });

  it('is what was written of it, for every flow', () => {
    for (const flow of FLOWS) {
      const form = exampleForm();
      const r: Rectangle = { ...flowing(stated(), flow), length: 1.2e-3, width: 8e-4, rotation: 0.01 };
      writeRectangle(form, r, true);
      const read = statedRectangle(form, SIZE)!;
      corners(read).forEach(([x, y], i) => {
        // Lengths are written to 0.1 um, the angle to a thousandth of a degree, over 1.4 mm.
        expect(Math.hypot(x - corners(r)[i][0], y - corners(r)[i][1])).toBeLessThan(2e-7);
      });
    }
  });
});

describe('moving it', () => {
  it('shifts, turns about the middle, flows the other way about the middle', () => {
    const r = stated();
    near([centre(moved(r, [1e-4, -2e-4]))], [[2.6e-3, 5.5e-4]]);
    for (const next of [turned(r, 0.3), flowing(r, '-columns'), flowing(r, '+rows'), flowing(r, '-rows')]) near([centre(next)], [centre(r)]);
    const back = corners(flowing(r, '-columns'));
    near([back[0]], [[4.5e-3, 2.5e-4]]); // the inlet is where the outlet was
  });

  it('moves one edge and leaves the other three', () => {
    const r = stated();
    const by: Point = [1e-4, 5e-5];
    const [a, b, c, d] = corners(r);
    near(corners(stretched(r, 'inlet', by, 0)), [[a[0] + 1e-4, a[1]], b, c, [d[0] + 1e-4, d[1]]]);
    near(corners(stretched(r, 'outlet', by, 0)), [a, [b[0] + 1e-4, b[1]], [c[0] + 1e-4, c[1]], d]);
    near(corners(stretched(r, 'near', by, 0)), [[a[0], a[1] + 5e-5], [b[0], b[1] + 5e-5], c, d]);
    near(corners(stretched(r, 'far', by, 0)), [a, b, [c[0], c[1] + 5e-5], [d[0], d[1] + 5e-5]]);
  });

  it('never makes it vanish', () => {
    for (const edge of ['inlet', 'outlet', 'near', 'far'] as const) {
      for (const by of [[1, 1], [-1, -1]] as Point[]) {
        const r = stretched(stated(), edge, by, 1e-5);
        expect(Math.min(r.length, r.width)).toBeGreaterThanOrEqual(0.99e-5);
      }
    }
  });

  it('writes sizes only when they were changed', () => {
    const form = exampleForm();
    writeRectangle(form, { ...stated(), length: 3e-3 }, false);
    expect([form.channel.length, form.channel.rotation]).toEqual(['4 mm', null]);
    writeRectangle(form, { ...stated(), length: 3e-3, rotation: Math.PI / 180 }, true);
    expect([form.channel.length, form.channel.rotation]).toEqual(['3 mm', '1 deg']);
  });
});

it('a point lies so far outside', () => {
  const r = stated();
  expect(outside(r, [4e-4, 5e-4])).toBeCloseTo(1e-4, 9);
  expect(outside(r, [2e-3, 1.45e-3])).toBeCloseTo(2e-4, 9);
  expect(outside(r, centre(r))).toBeCloseTo(-5e-4, 9);
});

it('a guess lies in the map, along its longer side', () => {
  const form = exampleForm();
  Object.assign(form.channel, { length: '? mm', width: null, origin: null, flow: null });
  expect(within(guessedRectangle(form, SIZE), SIZE)).toBe(true);
  expect(guessedRectangle(form, SIZE).flow).toBe('+columns');
  expect(guessedRectangle(form, [1e-3, 3e-3]).flow).toBe('+rows');
});
