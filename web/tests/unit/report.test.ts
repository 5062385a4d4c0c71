import { describe, expect, it } from 'vitest';
import { LIGHT, colourAt } from '../../src/chart/colours';
import { legendOf, tableOf } from '../../src/chart/spec';
import { frames } from '../../src/data/frames';
import { type Report, extent, flagWords, nearest, runOrder } from '../../src/data/report';
import { deflectionText, placeText, pressureText } from '../../src/islands/readout';
import { agreementSpec, dropSpec } from '../../src/islands/specs_agreement';
import { budgetBars, budgetSpec } from '../../src/islands/specs_budget';
import { pressureSpec } from '../../src/islands/specs_pressure';
import { curveSpec, framePressureSpec, mapSpec, profileSpec } from '../../src/islands/specs_wall';
import { example } from './example';

describe('report', () => {
  it('finds the nearest station, at the ends too', () => {
    const x = [0, 1, 2, 4];
    expect([-5, 0.4, 0.6, 2.9, 3.1, 9].map((at) => nearest(x, at))).toEqual([0, 0, 1, 2, 3, 3]);
  });

  it('orders runs by flow rate and leaves those without one last', () => {
    const report = example();
    expect(runOrder(report)).toEqual([1, 0]);
    report.runs[1].flow_rate = null;
    expect(runOrder(report)).toEqual([0, 1]);
  });

  it('leaves out what does not exist', () => {
    expect(extent([[null, 3], [-1]])).toEqual([-1, 3]);
    expect(extent([[null]])).toBeNull();
  });

  it('says flags in words', () => {
    expect(flagWords(example(), 20)).toEqual(['more than one pressure fits', 'outside the test section']);
  });
});

describe('frames', () => {
  it('are the levels by pressure, then the runs by flow rate', () => {
    expect(frames(example()).map((frame) => [frame.map, frame.level, frame.run])).toEqual([
      [1, 0, -1],
      [0, 1, -1],
      [3, -1, 1],
      [2, -1, 0],
    ]);
    expect(frames(example())[1].label).toBe('1 kPa, no flow (h1.gsf)');
  });

  it('are levels and runs where there are no maps', () => {
    expect(frames({ ...example(), maps: null }).map((frame) => frame.map)).toEqual([-1, -1, -1, -1]);
  });
});

describe('readout', () => {
  it('gives the value with its expanded uncertainty', () => {
    expect(pressureText(example(), 0, 0.001)).toBe('p = 1000 ± 10 Pa');
    expect(placeText(example(), 0.001)).toBe('x = 1.000 mm');
  });

  it('gives the reason where there is no value', () => {
    expect(pressureText(example(), 0, 0.003)).toBe('no pressure: more than one pressure fits');
    expect(deflectionText(example(), null)).toBe('no deflection');
  });
});

describe('charts', () => {
  const choice = { run: 0, models: ['momentum'], base: '', band: true, crossings: true };

  it('show the reading with its interval and the models that are on', () => {
    const spec = pressureSpec(example(), choice, LIGHT);
    expect(spec.series.map((series) => series.label)).toEqual([
      'p(x) read off the wall',
      'p(x) read off the wall, lower end',
      'p(x) read off the wall, upper end',
      'momentum',
    ]);
    expect(spec.columns[2]).toEqual([1210, 1010, 910, null, 610]);
    expect(legendOf(spec).map((entry) => entry.label)).not.toContain('eq. (4)');
  });

  it('show everything less a model', () => {
    const spec = pressureSpec(example(), { ...choice, base: 'paper' }, LIGHT);
    expect(spec.columns[0]).toEqual([-3, -3, -3, null, -3]);
    expect(spec.columns[3]).toEqual([-5, -5, -5, null, -5]);
    expect(spec.y.label).toBe('p − eq. (4) (Pa)');
  });

  it('frame the test section, not what happens beyond it', () => {
    const report = example();
    report.runs[0].upper[0] = 1e9;
    expect(pressureSpec(report, choice, LIGHT).y.range[1]).toBeLessThan(1500);
  });

  it('show every run', () => {
    const spec = pressureSpec(example(), { ...choice, run: -1 }, LIGHT);
    expect(spec.series).toHaveLength(6);
    expect(spec.bands).toHaveLength(2);
  });

  it('give tables with empty cells for what is missing', () => {
    const rows = tableOf(pressureSpec(example(), { ...choice, band: false, models: [] }, LIGHT));
    expect(rows[0]).toEqual(['x (mm)', 'p(x) read off the wall']);
    expect(rows[4]).toEqual(['3', '']);
  });

  it('give tables of drops and variances, too', () => {
    const drops = tableOf(agreementSpec(example(), ['paper'], false, LIGHT));
    expect(drops[0]).toEqual(['run', 'Q (mL/min)', 'read off the wall (Pa)', 'U of it (Pa)', 'eq. (4) (Pa)', 'U of it (Pa)']);
    expect(drops[1]).toEqual(['fast', '12', '500', '10', '510', '12']);
    expect(tableOf(dropSpec(example(), true, LIGHT))[2].slice(0, 4)).toEqual(['slow', '6', '500', '10']);
    expect(tableOf(budgetSpec(example(), 0, true, LIGHT))[1]).toEqual(['0', '16', '9']);
  });

  it('hold levels and the frame in one picture', () => {
    const list = frames(example());
    expect(profileSpec(example(), list[3], LIGHT).columns[2]).toEqual([1, 1, 1, 1, 1]);
    expect(curveSpec(example(), list[3], 0.002, LIGHT).columns[0]).toEqual([0, 2]);
  });

  it('compare drops in their unit and in percent', () => {
    const both = agreementSpec(example(), ['paper', 'momentum'], false, LIGHT);
    expect(both.x.range[1]).toBeGreaterThan(510);
    const percent = agreementSpec(example(), ['paper'], true, LIGHT);
    expect(percent.y.range[0]).toBeLessThan(0);
    expect(percent.y.range[1]).toBeGreaterThan(2 + (100 * Math.hypot(10, 12)) / 500 - 0.01);
  });

  it('keep logarithmic axes above zero', () => {
    const report = example();
    report.runs[0].drops.extracted.value = -5;
    const spec = dropSpec(report, true, LIGHT);
    expect(spec.x.range[0]).toBeGreaterThan(0);
    expect(spec.y.range[0]).toBeGreaterThan(0);
  });
});

describe('every chart', () => {
  const choices = [-1, 0].flatMap((run) => ['', 'paper'].map((base) => ({ run, base, models: ['paper', 'momentum'], band: true, crossings: true })));
  const specs = (report: Report) => [
    ...choices.map((choice) => pressureSpec(report, choice, LIGHT)),
    ...frames(report).flatMap((frame) => [
      profileSpec(report, frame, LIGHT),
      curveSpec(report, frame, report.x[0], LIGHT),
      framePressureSpec(report, frame, LIGHT),
    ]),
    ...[true, false].flatMap((way) => [
      agreementSpec(report, ['paper', 'momentum'], way, LIGHT),
      dropSpec(report, way, LIGHT),
      budgetSpec(report, 0, way, LIGHT),
    ]),
    mapSpec(report, []),
  ];
  const none = { value: null, u: null };
  const troubles: Record<string, (report: Report) => void> = {
    'with everything': () => {},
    'where nothing was read': (report) => {
      for (const run of report.runs) {
        for (const list of [run.pressure, run.u, run.lower, run.upper, run.deflection, ...run.budget]) list.fill(null);
        run.models = {};
        run.crossings = [];
        run.test_section = [null, null];
        run.drops = { extracted: none, models: {}, channel_resistance: none, transducer: none, compliant: none, predicted: none };
      }
      report.drop_fit = { linear: 1, quadratic: 1 };
    },
    'where everything is zero': (report) => {
      for (const run of report.runs) {
        for (const list of [run.pressure, run.u, run.lower, run.upper, run.deflection, ...run.budget]) list.fill(0);
        run.flow_rate = 0;
        run.drops.extracted = { value: 0, u: 0 };
      }
      for (const list of report.levels.deflection) list.fill(0);
    },
    'of a wall that bends inwards': (report) => {
      for (const run of report.runs) for (const list of [run.pressure, run.lower, run.upper, run.deflection]) list.forEach((v, i) => (list[i] = v === null ? null : -v));
    },
  };
  for (const [name, trouble] of Object.entries(troubles)) {
    it(`has finite axes and legends ${name}`, () => {
      const report = example();
      trouble(report);
      for (const spec of specs(report)) {
        for (const axis of [spec.x, spec.y]) {
          expect(axis.range.every(Number.isFinite), axis.label).toBe(true);
          expect(axis.range[1], axis.label).toBeGreaterThan(axis.range[0]);
        }
        for (const entry of legendOf(spec)) expect(entry.label).not.toMatch(/undefined|NaN/);
        for (const column of spec.columns) expect(column).toHaveLength(spec.places.length);
      }
    });
  }

  it('tells runs of the same flow rate apart', () => {
    const report = example();
    report.runs[1].flow_rate = report.runs[0].flow_rate;
    const labels = legendOf(pressureSpec(report, { ...choices[0], run: -1 }, LIGHT)).map((entry) => entry.label);
    expect(new Set(labels).size).toBe(2);
  });
});

describe('budget', () => {
  it('has bars of mean variances where there are answers', () => {
    const bars = budgetBars(example(), 0, 4);
    expect(bars.map((bar) => bar.from)).toEqual([0, 0.001, 0.002]); // none at 3 mm
    expect(bars[0].variance).toEqual([16, 9]);
  });
});

describe('colour maps', () => {
  it('grow lighter from end to end', () => {
    const lightness = ([r, g, b]: number[]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
    for (const map of ['viridis', 'cividis'] as const) {
      let last = -1;
      for (let i = 0; i <= 100; ++i) {
        const now = lightness(colourAt(map, i / 100));
        expect(now).toBeGreaterThanOrEqual(last - 0.5); // of 255: rounding
        last = now;
      }
    }
  });
});
