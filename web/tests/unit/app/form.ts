import type { Form } from '../../../src/app/api/types';

export function exampleForm(): Form {
  return {
    name: 'S1',
    channel: {
      length: '4 mm', width: '1 mm', height: '175 um', height_uncertainty: null,
      origin: ['0.5 mm', '0.25 mm'], flow: '+columns', rotation: null, outward: '+height',
    },
    inlet: { profile: null },
    wall: { material: null },
    fluid: { name: 'water', viscosity: '1.0 mPa s' },
    instrument: { pressure_noise: '10 Pa', pixel_pitch: null },
    hydrostatic: { file: 'hydrostatic.csv', columns: ['map', 'pressure [Pa]'], rows: [['h00.gsf', '0'], ['h01.gsf', '100']], locked: null },
    flow: null,
    comments: {},
  };
}
