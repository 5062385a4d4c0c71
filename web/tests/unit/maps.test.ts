import { deflateSync } from 'node:zlib';
import { describe, expect, it } from 'vitest';
import { MISSING, unfold, unpack, unpackText } from '../../src/data/maps';

/** What the report writer does, written anew. */
function fold(counts: number[]): Uint8Array {
  const bytes = new Uint8Array(2 * counts.length);
  let last = 0;
  counts.forEach((count, i) => {
    const d = count - last;
    const code = count === MISSING ? 0xffff : d >= 0 ? 2 * d : -2 * d - 1;
    if (count !== MISSING) last = count;
    bytes[i] = code & 0xff;
    bytes[counts.length + i] = code >> 8;
  });
  return bytes;
}

describe('unpack', () => {
  it('gives back every count, the largest and the missing ones', async () => {
    const counts = [0, 1, -1, MISSING, 16383, -16383, MISSING, MISSING, 5, 300, -40];
    const packed = deflateSync(fold(counts)).toString('base64');
    expect([...(await unpack(packed, counts.length))]).toEqual(counts);
  });

  it('refuses a map of another size', () => {
    expect(() => unfold(new Uint8Array(10), 6)).toThrow('not 12');
  });

  it('refuses damaged bytes', async () => {
    const packed = deflateSync(fold([1, 2, 3])).subarray(0, 6).toString('base64');
    await expect(unpack(packed, 3)).rejects.toThrow();
  });

  it('reads texts with letters beyond ASCII', async () => {
    const packed = deflateSync(Buffer.from('{"a":"µ ζ </script>"}')).toString('base64');
    expect(JSON.parse(await unpackText(packed))).toEqual({ a: 'µ ζ </script>' });
  });
});
