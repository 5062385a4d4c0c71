// A canvas context that writes SVG: what a chart draws on the screen it draws into a file. Holds
// what uPlot and our layers call, no more.

type Matrix = [number, number, number, number, number, number];

const round = (value: number) => String(Math.round(value * 100) / 100);
const escape = (text: string) =>
  text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('"', '&quot;');

/** A colour and its opacity, apart: not every reader of SVG knows them in one. */
function colourOf(style: string): [string, number] {
  const hex = /^(#[0-9a-f]{6})([0-9a-f]{2})$/i.exec(style);
  if (hex) return [hex[1], parseInt(hex[2], 16) / 255];
  const rgba = /^rgba\((.*),([^,]*)\)$/.exec(style);
  return rgba ? [`rgb(${rgba[1]})`, Number(rgba[2])] : [style, 1];
}

function painted(kind: 'fill' | 'stroke', style: string): string {
  const [colour, opacity] = colourOf(style);
  return `${kind}="${colour}"` + (opacity < 1 ? ` ${kind}-opacity="${round(opacity)}"` : '');
}

/** Stands in for Path2D. */
export class SvgPath {
  d: string;
  constructor(from?: SvgPath) {
    this.d = from?.d ?? '';
  }
  moveTo(x: number, y: number) {
    this.d += `M${round(x)} ${round(y)}`;
  }
  lineTo(x: number, y: number) {
    this.d += `${this.d === '' ? 'M' : 'L'}${round(x)} ${round(y)}`;
  }
  rect(x: number, y: number, width: number, height: number) {
    this.d += `M${round(x)} ${round(y)}h${round(width)}v${round(height)}h${round(-width)}z`;
  }
  bezierCurveTo(...at: number[]) {
    this.d += `C${at.map(round).join(' ')}`;
  }
  arc(x: number, y: number, r: number) {
    // Whole circles are all that is drawn.
    this.d +=
      `M${round(x - r)} ${round(y)}a${round(r)} ${round(r)} 0 1 0 ${round(2 * r)} 0` +
      `a${round(r)} ${round(r)} 0 1 0 ${round(-2 * r)} 0z`;
  }
  closePath() {
    this.d += 'z';
  }
}

interface State {
  matrix: Matrix;
  clip: string;
  fillStyle: string;
  strokeStyle: string;
  lineWidth: number;
  dash: number[];
  font: string;
  textAlign: string;
  textBaseline: string;
  globalAlpha: number;
  lineJoin: string;
  lineCap: string;
}

const ANCHORS: Record<string, string> = { center: 'middle', right: 'end', end: 'end' };
const SHIFTS: Record<string, number> = { top: 0.8, hanging: 0.8, middle: 0.35, bottom: -0.2 };

export class SvgContext {
  readonly canvas: HTMLCanvasElement;
  private readonly parts: string[] = [];
  private readonly clips: string[] = [];
  private stack: State[] = [];
  private path = new SvgPath();
  private state: State = {
    matrix: [1, 0, 0, 1, 0, 0],
    clip: '',
    fillStyle: '#000',
    strokeStyle: '#000',
    lineWidth: 1,
    dash: [],
    font: '13px sans-serif',
    textAlign: 'start',
    textBaseline: 'alphabetic',
    globalAlpha: 1,
    lineJoin: 'miter',
    lineCap: 'butt',
  };

  constructor(canvas: HTMLCanvasElement) {
    this.canvas = canvas;
    for (const key of Object.keys(this.state) as (keyof State)[]) {
      if (key in this) continue;
      Object.defineProperty(this, key, {
        get: () => this.state[key],
        set: (value) => ((this.state as unknown as Record<string, unknown>)[key] = value),
      });
    }
  }

  save() {
    this.stack.push({ ...this.state });
  }
  restore() {
    this.state = this.stack.pop() ?? this.state;
  }
  translate(x: number, y: number) {
    const [a, b, c, d, e, f] = this.state.matrix;
    this.state.matrix = [a, b, c, d, a * x + c * y + e, b * x + d * y + f];
  }
  rotate(angle: number) {
    const [a, b, c, d, e, f] = this.state.matrix;
    const [s, t] = [Math.sin(angle), Math.cos(angle)];
    this.state.matrix = [a * t + c * s, b * t + d * s, c * t - a * s, d * t - b * s, e, f];
  }
  setLineDash(dash: number[]) {
    this.state.dash = dash;
  }
  clearRect() {}
  beginPath() {
    this.path = new SvgPath();
  }
  closePath() {
    this.path.closePath();
  }
  moveTo(x: number, y: number) {
    this.path.moveTo(x, y);
  }
  lineTo(x: number, y: number) {
    this.path.lineTo(x, y);
  }
  rect(x: number, y: number, width: number, height: number) {
    this.path.rect(x, y, width, height);
  }
  arc(x: number, y: number, r: number) {
    this.path.arc(x, y, r);
  }
  clip(path: unknown = this.path) {
    const id = `clip${this.clips.length}`;
    const within = this.state.clip ? ` clip-path="url(#${this.state.clip})"` : '';
    this.clips.push(`<clipPath id="${id}"${within}><path d="${(path as SvgPath).d}"/></clipPath>`);
    this.state.clip = id;
  }
  fill(path: unknown = this.path) {
    this.add('path', `d="${(path as SvgPath).d}" ${painted('fill', this.state.fillStyle)}`);
  }
  stroke(path: unknown = this.path) {
    const { strokeStyle, lineWidth, dash, lineJoin, lineCap } = this.state;
    const { d } = path as SvgPath;
    if (d === '' || lineWidth === 0) return;
    const dashes = dash.length > 0 ? ` stroke-dasharray="${dash.map(round).join(' ')}"` : '';
    this.add(
      'path',
      `d="${d}" fill="none" ${painted('stroke', strokeStyle)} stroke-width="${round(lineWidth)}"${dashes}` +
        ` stroke-linejoin="${lineJoin}" stroke-linecap="${lineCap}"`,
    );
  }
  fillRect(x: number, y: number, width: number, height: number) {
    const path = new SvgPath();
    path.rect(x, y, width, height);
    this.fill(path);
  }
  fillText(text: string, x: number, y: number) {
    const { font, textAlign, textBaseline, fillStyle } = this.state;
    const size = Number(/([\d.]+)px/.exec(font)?.[1] ?? 13);
    const anchor = ANCHORS[textAlign] ?? 'start';
    const shifted = y + (SHIFTS[textBaseline] ?? 0) * size;
    this.add(
      'text',
      `x="${round(x)}" y="${round(shifted)}" fill="${fillStyle}" font-size="${round(size)}"` +
        ` text-anchor="${anchor}"`,
      escape(text),
    );
  }
  drawImage(image: HTMLCanvasElement, x: number, y: number, width: number, height: number) {
    this.add(
      'image',
      `x="${round(x)}" y="${round(y)}" width="${round(width)}" height="${round(height)}"` +
        ` preserveAspectRatio="none" href="${image.toDataURL('image/png')}"`,
    );
  }
  measureText(text: string) {
    const size = Number(/([\d.]+)px/.exec(this.state.font)?.[1] ?? 13);
    return { width: 0.55 * size * text.length };
  }

  private add(tag: string, attributes: string, content = '') {
    const { matrix, clip, globalAlpha } = this.state;
    const moved = matrix.join() !== '1,0,0,1,0,0';
    const place = moved ? ` transform="matrix(${matrix.map((v) => v.toFixed(4)).join(' ')})"` : '';
    const alpha = globalAlpha < 1 ? ` opacity="${globalAlpha}"` : '';
    const inside = clip ? ` clip-path="url(#${clip})"` : '';
    const element = `<${tag} ${attributes}${place}${alpha}>${content}</${tag}>`;
    this.parts.push(inside ? `<g${inside}>${element}</g>` : element);
  }

  /** The whole document, on white. */
  document(width: number, height: number, title: string): string {
    const { width: w, height: h } = this.canvas;
    const tag = 'svg';
    return (
      `<${tag} xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}"` +
      ` viewBox="0 0 ${w} ${h}" font-family="Helvetica, Arial, sans-serif">\n` +
      `<title>${escape(title)}</title>\n<defs>${this.clips.join('')}</defs>\n` +
      `<rect width="${w}" height="${h}" fill="#ffffff"/>\n${this.parts.join('\n')}\n</${tag}>\n`
    );
  }
}
