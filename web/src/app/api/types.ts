// What the local server says and hears, as docs/serve.md has it. SI units where a name does not say
// otherwise; quantities of the experiment are texts as people write them ("15.5 mm").

export interface Fault {
  file: string | null;
  line: number | null;
  key: string | null; // "channel.length", "hydrostatic.pressure"; null: the file as a whole
  row: number | null; // of a list, from 0
  column: string | null;
  found: string;
  mend: string;
  text: string;
}

export interface List {
  file: string | null; // null: written in experiment.toml itself
  columns: string[]; // "pressure [Pa]"
  rows: string[][];
  locked: string | null; // why it cannot be edited here
}

export type Text = string | null;
export type Pair = [string, string] | null;

export interface Form {
  name: Text;
  channel: {
    length: Text; width: Text; height: Text; height_uncertainty: Text;
    origin: Pair; flow: Text; rotation: Text; outward: Text;
  };
  inlet: Record<string, Text>;
  wall: Record<string, Text>;
  fluid: Record<string, Text>;
  instrument: Record<string, Text | Pair>;
  hydrostatic: List | null;
  flow: List | null;
  comments: Record<string, string>; // what stands behind a key in its line
}

export interface Experiment {
  file: string;
  revision: string | null;
  text: string;
  lists: Record<string, string>; // texts of the list files, by the names that the text gives them
  form: Form | null; // null: the text is no TOML
  faults: Fault[];
  notes: string[];
  maps_checked: boolean;
  hydrostatic_maps: number;
  flow_maps: number;
}

export type Body = { form: Form } | { text: string; lists: Record<string, string> };

export interface FolderState {
  version: string;
  revision: string;
  folder: { name: string; path: string };
  experiments: { file: string; folder: string; name: string | null; modified: number }[];
  results: { folder: string; modified: number; report: boolean }[];
  truncated: boolean;
  job: Job | null;
}

export interface Entry {
  name: string;
  kind: 'folder' | 'file';
  size: number;
  modified: number;
  map: boolean;
  result: boolean;
  experiment: boolean;
}

export interface Channel {
  name: string;
  nx: number;
  ny: number;
  unit: string;
  missing: number;
  rms: number | null;
}

export interface Picture {
  nx: number;
  ny: number;
  size_x_m: number | null;
  size_y_m: number | null;
  unit: string;
  step: number;
  counts: string; // packed
  low: number;
  high: number;
}

export interface MapAnswer {
  summary: { file: string; format: string; channels: Channel[] };
  picture: Picture;
}

export interface MapRequest {
  file: string;
  minus?: string;
  channel?: string;
  pitch?: Pair;
  height_unit?: string;
}

export type Point = [number, number];

export interface Place {
  found: { origin: [string, string]; flow: string; rotation: string; outward: string };
  frame: {
    origin_m: Point; length_m: number; width_m: number; flow: string; rotation_rad: number;
    across_reversed: boolean; rim_margin_m: number;
  };
  length_misfit_m: number | null;
  width_misfit_m: number | null;
  along_misfit_m: number | null;
  across_misfit_m: number | null;
  low: string;
  high: string;
}

export interface Option {
  name: string;
  kind: string;
  value: string;
  help: string;
  group: string;
}

export interface Job {
  id: number;
  experiment: string;
  output: string;
  command: string[];
  state: 'running' | 'done' | 'failed' | 'cancelled';
  stage: string;
  fraction: number;
  log: string[];
  seconds: number;
}

export interface JobRequest {
  experiment: string;
  output: string;
  overwrite: boolean;
  options: Record<string, string>;
}

export type Event =
  | { type: 'hello'; job: Job | null }
  | { type: 'start' | 'end'; job: Job }
  | { type: 'progress'; job: number; stage: string; fraction: number }
  | { type: 'log'; job: number; line: string }
  | { type: 'files'; changed: string[] };

export interface ResultRun {
  run: string;
  flow_rate_m3_s: number | null;
  verdict: string | null;
  extracted_drop_Pa: number | null;
  extracted_drop_uncertainty_Pa: number | null;
  pressure_Pa: (number | null)[];
  pressure_uncertainty_Pa: (number | null)[];
}

export interface Result {
  output: string;
  title: string;
  x_m: number[];
  runs: ResultRun[];
  warnings: string[];
}
