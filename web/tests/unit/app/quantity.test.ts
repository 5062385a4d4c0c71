import { describe, expect, it } from 'vitest';
import { FLOW_RATES, LENGTHS, PRESSURES, cellIn, lengthText, numberOf, quantityOf, siOf } from '../../../src/app/model/quantity';

describe('a quantity', () => {
  it('is a number, with point or comma, and its unit', () => {
    expect(quantityOf('2.5 kPa')).toEqual({ number: 2.5, unit: 'kPa' });
    expect(quantityOf(' 2,5kPa ')).toEqual({ number: 2.5, unit: 'kPa' });
    expect(quantityOf('−1e3')).toEqual({ number: -1000, unit: '' });
    expect(quantityOf('0.89 mPa s')).toEqual({ number: 0.89, unit: 'mPa s' });
    expect(quantityOf('h00.gsf')).toBeNull();
    expect(quantityOf('')).toBeNull();
  });

  it('is no number where it is several, or a thousand with a comma', () => {
    expect([numberOf('1.2.3'), numberOf('1,000.5'), numberOf('1 2'), numberOf('1e')]).toEqual([null, null, null, null]);
  });

  it('turns to SI by its unit alone', () => {
    expect(siOf('175 um', LENGTHS)).toBeCloseTo(175e-6, 12);
    expect(siOf('175 µm', LENGTHS)).toBeCloseTo(175e-6, 12);
    expect(siOf('60 mL/min', FLOW_RATES)).toBeCloseTo(1e-6, 15);
    expect([siOf('175', LENGTHS), siOf('175 furlong', LENGTHS), siOf('175 constructor', LENGTHS)]).toEqual([null, null, null]);
  });
});

describe('a cell', () => {
  it('holds the number in the unit of its column', () => {
    expect(cellIn('2.3 kPa', 'Pa', PRESSURES)).toBe('2300'); // not 2299.9999999999995
    expect(cellIn('1 psi', 'kPa', PRESSURES)).toBe('6.894757293');
    expect(cellIn('2,5', 'Pa', PRESSURES)).toBe('2.5');
    expect(cellIn('12 Pa', 'Pa', PRESSURES)).toBe('12');
  });

  it('keeps what it does not understand, for the program to tell', () => {
    expect(cellIn('12 mL/min', 'Pa', PRESSURES)).toBe('12 mL/min');
    expect(cellIn(' about ten ', 'Pa', PRESSURES)).toBe('about ten');
    expect(cellIn('12 kPa', 'inHg', PRESSURES)).toBe('12 kPa');
  });
});

it('a length is written in the unit that stood there', () => {
  expect(lengthText(4.12345678e-4, '0.4 mm')).toBe('0.4123 mm'); // to 0.1 um
  expect(lengthText(4.1e-4, '400 um')).toBe('410 um');
  expect(lengthText(4.1e-4, undefined)).toBe('0.41 mm');
  expect(lengthText(4.1e-4, '4 furlong')).toBe('0.41 mm');
});
