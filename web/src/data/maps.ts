// Maps of the page: base64 of a zlib stream of folded differences (see packed.hpp).

export const MISSING = -32768;
const MISSING_CODE = 0xffff;

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** Text of a packed element. */
export async function unpackText(base64: string): Promise<string> {
  return new TextDecoder().decode(await inflated(bytesOf(base64)));
}

async function inflated(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Counts of n pixels from low bytes, then high bytes, of their folded differences. */
export function unfold(bytes: Uint8Array, n: number): Int16Array {
  if (bytes.length !== 2 * n) throw new Error(`a map holds ${bytes.length} bytes, not ${2 * n}`);
  const counts = new Int16Array(n);
  let last = 0;
  for (let i = 0; i < n; ++i) {
    const code = bytes[i] | (bytes[n + i] << 8);
    if (code === MISSING_CODE) {
      counts[i] = MISSING;
      continue;
    }
    last += (code & 1) === 0 ? code >> 1 : -((code + 1) >> 1);
    counts[i] = last;
  }
  return counts;
}

export async function unpack(base64: string, n: number): Promise<Int16Array> {
  return unfold(await inflated(bytesOf(base64)), n);
}

/** The maps of a page, each unpacked when it is first asked for. */
export class MapStore {
  private readonly known = new Map<number, Promise<Int16Array>>();

  constructor(
    private readonly page: Document,
    private readonly n: number,
  ) {}

  counts(map: number): Promise<Int16Array> {
    const known = this.known.get(map);
    if (known) return known;
    const counts = this.read(map);
    this.known.set(map, counts);
    return counts;
  }

  private async read(map: number): Promise<Int16Array> {
    const find = () => this.page.getElementById(`map-${map}`)?.textContent;
    // The maps stand behind the script that asks for them.
    if (!find() && this.page.readyState === 'loading') {
      await new Promise((done) => this.page.addEventListener('DOMContentLoaded', done, { once: true }));
    }
    const text = find();
    if (!text) throw new Error(`the page holds no map ${map}`);
    return unpack(text, this.n);
  }
}
