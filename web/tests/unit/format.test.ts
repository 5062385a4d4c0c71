import { describe, expect, it } from 'vitest';
import { cellText, csv } from '../../src/format/csv';
import { fixed, number, shortNumber, withUncertainty } from '../../src/format/numbers';
import { lengthUnit, pressureUnit } from '../../src/format/units';

describe('numbers', () => {
  it('have the uncertainty with two digits and the value to the same decimal', () => {
    expect(withUncertainty(14.2349, 0.119)).toBe('14.23 ± 0.12');
    expect(withUncertainty(14234.9, 119)).toBe('14230 ± 120');
    expect(withUncertainty(-3.14159, 0.0996)).toBe('−3.14 ± 0.10');
    expect(withUncertainty(12.345, 0)).toBe('12.35');
    expect(withUncertainty(null, 1)).toBe('–');
  });

  it('are rounded to significant digits without exponents or minus zero', () => {
    expect(number(1234567, 3)).toBe('1230000');
    expect(number(0.00012345, 3)).toBe('0.000123');
    expect(number(9.996, 3)).toBe('10.0');
    expect(number(null)).toBe('–');
    expect(fixed(-0.001, 2)).toBe('0.00');
    expect(shortNumber(-70)).toBe('−70');
    expect(shortNumber(5.5000001)).toBe('5.5');
  });
});

describe('units', () => {
  it('are the largest that do not exceed the magnitude', () => {
    expect(pressureUnit(999).name).toBe('Pa');
    expect(pressureUnit(1000).name).toBe('kPa');
    expect(lengthUnit(0).name).toBe('nm');
    expect(lengthUnit(2e-6).name).toBe('µm');
  });
});

describe('csv', () => {
  it('quotes what must be quoted', () => {
    expect(csv([['a', 'b,c'], ['say "x"', '1\n2']])).toBe('a,"b,c"\r\n"say ""x""","1\n2"\r\n');
  });

  it('holds cells as programs read them', () => {
    expect(cellText('  −3.2 \n ')).toBe('-3.2');
    expect(cellText('–')).toBe('');
  });
});
