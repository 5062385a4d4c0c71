import { describe, expect, it } from 'vitest';
import { SvgContext, SvgPath } from '../../src/chart/svg_context';

const canvas = { width: 200, height: 100 } as HTMLCanvasElement;

describe('SvgContext', () => {
  it('writes lines, texts and clips with the state of the time', () => {
    const context = new SvgContext(canvas);
    const drawn = context as unknown as CanvasRenderingContext2D;
    drawn.strokeStyle = '#ff0000';
    drawn.save();
    drawn.beginPath();
    drawn.rect(1, 2, 30, 40);
    drawn.clip();
    drawn.beginPath();
    drawn.moveTo(0, 0);
    drawn.lineTo(10, 5.126);
    drawn.stroke();
    drawn.restore();
    drawn.fillText('a < b & c', 5, 6);
    const text = context.document(100, 50, 'title "x"');
    expect(text).toContain('<clipPath id="clip0"><path d="M1 2h30v40h-30z"/></clipPath>');
    expect(text).toContain('<g clip-path="url(#clip0)"><path d="M0 0L10 5.13" fill="none" stroke="#ff0000"');
    expect(text).toContain('>a &lt; b &amp; c</text>');
    expect(text).toContain('viewBox="0 0 200 100"');
    expect(text).toContain('title &quot;x&quot;');
  });

  it('turns and moves what is drawn', () => {
    const context = new SvgContext(canvas);
    context.translate(10, 20);
    context.rotate(Math.PI / 2);
    context.fillText('up', 1, 0);
    expect(context.document(1, 1, '')).toContain('matrix(0.0000 1.0000 -1.0000 0.0000 10.0000 20.0000)');
  });

  it('begins a line where the first point is, and goes on from a copy', () => {
    const path = new SvgPath();
    path.lineTo(1, 2);
    path.lineTo(3, 4);
    const copy = new SvgPath(path);
    copy.lineTo(5, 6);
    expect([path.d, copy.d]).toEqual(['M1 2L3 4', 'M1 2L3 4L5 6']);
  });

  it('writes opacity apart from the colour', () => {
    const context = new SvgContext(canvas);
    const drawn = context as unknown as CanvasRenderingContext2D;
    drawn.fillStyle = '#0072b280';
    drawn.fillRect(0, 0, 1, 1);
    drawn.fillStyle = 'rgba(1,2,3,0.3)';
    drawn.fillRect(0, 0, 1, 1);
    const text = context.document(1, 1, '');
    expect(text).toContain('fill="#0072b2" fill-opacity="0.5"');
    expect(text).toContain('fill="rgb(1,2,3)" fill-opacity="0.3"');
  });

  it('fills paths made beforehand', () => {
    const path = new SvgPath();
    path.arc(5, 5, 2);
    const context = new SvgContext(canvas);
    context.fill(path);
    expect(context.document(1, 1, '')).toContain('d="M3 5a2 2 0 1 0 4 0a2 2 0 1 0 -4 0z"');
  });
});
