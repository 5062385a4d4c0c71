// The channel's rectangle over a map, in camera coordinates: metres along columns (right) and along
// rows (down) from the outer corner of the first pixel.

import type { Form, Place, Point } from '../api/types';
import { ANGLES, LENGTHS, lengthText, siOf } from './quantity';

export const FLOWS = ['+columns', '-columns', '+rows', '-rows'] as const;
export type Flow = (typeof FLOWS)[number];

export interface Rectangle {
  origin: Point; // inlet-side corner
  length: number;
  width: number;
  flow: Flow;
  rotation: number; // rad, from columns towards growing rows
  reversed: boolean; // extends across towards falling rows (columns)
}

export type Edge = 'inlet' | 'outlet' | 'near' | 'far'; // near: the side that holds the origin

const plus = (a: Point, b: Point, k = 1): Point => [a[0] + k * b[0], a[1] + k * b[1]];
const dot = (a: Point, b: Point) => a[0] * b[0] + a[1] * b[1];

/** Unit vectors along the flow and across it. */
export function axes({ flow, rotation, reversed }: Rectangle): { along: Point; across: Point } {
  const [c, s] = [Math.cos(rotation), Math.sin(rotation)];
  const columns: Point = [c, s];
  const rows: Point = [-s, c];
  const sign = flow.startsWith('+') ? 1 : -1;
  const side = reversed ? -1 : 1;
  const [x, z] = flow.endsWith('columns') ? [columns, rows] : [rows, columns];
  return { along: [sign * x[0], sign * x[1]], across: [side * z[0], side * z[1]] };
}

/** Corners (0, -w/2), (l, -w/2), (l, w/2), (0, w/2), the rectangle widened by a margin on every side. */
export function corners(r: Rectangle, margin = 0): Point[] {
  const { along, across } = axes(r);
  const at = (x: number, z: number) => plus(plus(r.origin, along, x), across, z);
  const [x0, x1, z0, z1] = [-margin, r.length + margin, -margin, r.width + margin];
  return [at(x0, z0), at(x1, z0), at(x1, z1), at(x0, z1)];
}

export const centre = (r: Rectangle): Point => {
  const { along, across } = axes(r);
  return plus(plus(r.origin, along, r.length / 2), across, r.width / 2);
};

/** The same rectangle about a given centre. */
function centred(r: Rectangle, at: Point): Rectangle {
  const { along, across } = axes(r);
  return { ...r, origin: plus(plus(at, along, -r.length / 2), across, -r.width / 2) };
}

export const moved = (r: Rectangle, by: Point): Rectangle => ({ ...r, origin: plus(r.origin, by) });
export const turned = (r: Rectangle, by: number): Rectangle => centred({ ...r, rotation: r.rotation + by }, centre(r));

/** Flows the other way, or along the other axis, about the same centre. */
export const flowing = (r: Rectangle, flow: Flow): Rectangle => centred({ ...r, flow, reversed: false }, centre(r));

/** One edge moved, by the part of `by` that points across it; at least `least` remains between edges. */
export function stretched(r: Rectangle, edge: Edge, by: Point, least: number): Rectangle {
  const { along, across } = axes(r);
  if (edge === 'inlet' || edge === 'near') {
    const [axis, size] = edge === 'inlet' ? [along, r.length] : [across, r.width];
    const step = Math.min(dot(by, axis), size - least);
    const origin = plus(r.origin, axis, step);
    return edge === 'inlet' ? { ...r, origin, length: size - step } : { ...r, origin, width: size - step };
  }
  if (edge === 'outlet') return { ...r, length: Math.max(least, r.length + dot(by, along)) };
  return { ...r, width: Math.max(least, r.width + dot(by, across)) };
}

/** How far a point lies from the rectangle, towards its outside; negative within. */
export function outside(r: Rectangle, point: Point): number {
  const { along, across } = axes(r);
  const from = plus(point, r.origin, -1);
  const [x, z] = [dot(from, along), dot(from, across)];
  return Math.max(-x, x - r.length, -z, z - r.width);
}

export const within = (r: Rectangle, size: Point) =>
  corners(r).every(([x, y]) => x >= 0 && y >= 0 && x <= size[0] && y <= size[1]);

const isFlow = (text: string | null): text is Flow => FLOWS.some((flow) => flow === text);

/**
 * The rectangle that the form states; null where it leaves out what is needed. As the program does it,
 * it extends across towards growing rows (columns), or the other way if only that lies in the map.
 */
export function statedRectangle({ channel }: Form, size: Point): Rectangle | null {
  const length = siOf(channel.length ?? '', LENGTHS);
  const width = siOf(channel.width ?? '', LENGTHS);
  const origin = channel.origin?.map((text) => siOf(text, LENGTHS)) ?? [];
  const rotation = channel.rotation === null ? 0 : siOf(channel.rotation, ANGLES);
  const [x, y] = origin;
  if (!length || !width || rotation === null || x == null || y == null || !isFlow(channel.flow)) return null;
  const plain: Rectangle = { origin: [x, y], length, width, flow: channel.flow, rotation, reversed: false };
  const other = { ...plain, reversed: true };
  return !within(plain, size) && within(other, size) ? other : plain;
}

export function foundRectangle({ frame }: Place): Rectangle | null {
  if (!isFlow(frame.flow)) return null;
  const { origin_m: origin, length_m: length, width_m: width, flow, rotation_rad: rotation } = frame;
  return { origin, length, width, flow, rotation, reversed: frame.across_reversed };
}

/** Something to begin with, where nothing is known: the middle of the map, along its longer side. */
export function guessedRectangle(form: Form, [x, y]: Point): Rectangle {
  const flow = isFlow(form.channel.flow) ? form.channel.flow : x >= y ? '+columns' : '+rows';
  const [long, broad] = flow.endsWith('columns') ? [x, y] : [y, x];
  const length = siOf(form.channel.length ?? '', LENGTHS) || 0.8 * long;
  const width = siOf(form.channel.width ?? '', LENGTHS) || 0.5 * broad;
  return centred({ origin: [0, 0], length, width, flow, rotation: 0, reversed: false }, [x / 2, y / 2]);
}

export const angleText = (rotation: number) => `${Number(((rotation * 180) / Math.PI).toFixed(3))} deg`;

/** Writes a rectangle into the form; sizes only if they were changed with it. */
export function writeRectangle({ channel }: Form, r: Rectangle, sizes: boolean): void {
  const { across } = axes(r);
  // The file has no word for the other side: the same rectangle from its other corner.
  const origin = r.reversed ? plus(r.origin, across, r.width) : r.origin;
  channel.origin = origin.map((v, i) => lengthText(v, channel.origin?.[i])) as [string, string];
  channel.flow = r.flow;
  if (r.rotation !== 0 || channel.rotation !== null) channel.rotation = angleText(r.rotation);
  if (!sizes) return;
  channel.length = lengthText(r.length, known(channel.length));
  channel.width = lengthText(r.width, known(channel.width));
}

const known = (text: string | null) => (text === null || text.startsWith('?') ? undefined : text);
