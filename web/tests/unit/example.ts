import type { Report, Run } from '../../src/data/report';

const none = { value: null, u: null };

export function run(name: string, rate: number | null, pressure: (number | null)[]): Run {
  const n = pressure.length;
  const values = (by: number) => pressure.map((p) => (p === null ? null : p + by));
  return {
    name,
    flow_rate: rate,
    flow_rate_uncertainty: null,
    test_section: [0.001, 0.003],
    deflection: Array<number>(n).fill(1e-6),
    pressure,
    u: pressure.map((p) => (p === null ? null : 5)),
    lower: values(-10),
    upper: values(10),
    flags: pressure.map((p) => (p === null ? 4 : 0)),
    crossings: [[0.002, 900, 1e-5]],
    models: { paper: values(3), momentum: values(-2) },
    budget: [pressure.map((p) => (p === null ? null : 16)), pressure.map((p) => (p === null ? null : 9))],
    drops: {
      extracted: { value: 500, u: 5 },
      models: { paper: { value: 510, u: 6 }, momentum: none },
      channel_resistance: none,
      transducer: { value: 800, u: null },
      compliant: none,
      predicted: none,
    },
  };
}

export function example(): Report {
  return {
    title: 'example',
    coverage: 0.95,
    expansion: 2,
    channel: { length: 0.004, width: 0.001 },
    units: {
      x: { name: 'mm', si: 1e-3 },
      deflection: { name: 'µm', si: 1e-6 },
      pressure: { name: 'Pa', si: 1 },
      drop: { name: 'Pa', si: 1 },
      flow_rate: { name: 'mL/min', si: 1e-6 / 60 },
    },
    flags: [
      { bit: 1, meaning: 'too few good pixels', answer: false },
      { bit: 4, meaning: 'more than one pressure fits', answer: false },
      { bit: 16, meaning: 'outside the test section', answer: true },
    ],
    x: [0, 0.001, 0.002, 0.003, 0.004],
    levels: {
      pressure: [0, 1000],
      pressure_uncertainty: [0, 5],
      deflection: [
        [0, 0, 0, 0, 0],
        [0, 2e-6, 2e-6, 2e-6, 0],
      ],
    },
    models: [
      { name: 'paper', words: 'eq. (4)', verdict: false },
      { name: 'momentum', words: 'momentum', verdict: true },
    ],
    budget_sources: ['pixel noise', 'pressure labels'],
    runs: [
      run('fast', 2e-7, [1200, 1000, 900, null, 600]),
      run('slow', 1e-7, [700, 600, 500, 400, 300]),
    ],
    drop_fit: { linear: null, quadratic: null },
    maps: {
      x: { n: 4, first: 0, last: 0.004 },
      z: { n: 2, first: -0.0005, last: 0.0005 },
      list: [
        { name: 'h1.gsf', run: -1, pressure: 1000, step: 1e-8, low: 0, high: 200 },
        { name: 'h0.gsf', run: -1, pressure: 0, step: 1e-8, low: 0, high: 2 },
        { name: 'f0.gsf', run: 0, pressure: null, step: 1e-8, low: 0, high: 100 },
        { name: 'f1.gsf', run: 1, pressure: null, step: 1e-8, low: 0, high: 100 },
      ],
    },
  };
}
