// Bytes of a file that are fetched piece by piece, when they are asked for.
import { ReebError } from './instance.js';

const BLOCK_BYTES = 2 ** 16;
const TRIES = 3;

/** What a server sends of a file that a decoder reads here and there. */
export class RangeSource {
  #url;
  #block; // bytes
  #signal;
  #headers;
  #credentials;
  #blocks = new Map(); // by their number in the file
  #missing = new Set();
  #version; // of the file, as the server names it: all pieces must be of one

  constructor(url, { signal, headers, credentials, rangeBytes = BLOCK_BYTES } = {}) {
    this.#url = url;
    this.#block = rangeBytes;
    this.#signal = signal;
    this.#headers = headers;
    this.#credentials = credentials;
    this.size = 0;
    this.bytesFetched = 0;
  }

  /** The source, once the file's first piece is there; the bytes where the server sends all of it anyway. */
  static async open(url, options) {
    const source = new RangeSource(url, options);
    const answer = await source.#ask(0, source.#block - 1);
    const bytes = new Uint8Array(await answer.arrayBuffer());
    if (answer.status !== 206) return bytes;
    source.size = Number(answer.headers.get('content-range')?.split('/')[1]);
    if (!(source.size > 0)) throw new ReebError('io', `${url}: the server does not tell how long the file is`);
    source.#version = versionOf(answer);
    source.#keep(0, bytes);
    return source;
  }

  /** Whether what is not here was read since `begin`. */
  get waits() {
    return this.#missing.size > 0;
  }

  begin() {
    this.#missing.clear();
  }

  /** Copies bytes from `offset` on; false where not all are here: the next `fetch` gets them. */
  read(offset, out) {
    const end = Math.ceil((offset + out.length) / this.#block);
    let whole = true;
    for (let b = Math.floor(offset / this.#block); b < end; ++b) {
      if (this.#blocks.has(b)) continue;
      this.#missing.add(b);
      whole = false;
    }
    if (!whole) return false;
    for (let done = 0; done < out.length;) {
      const at = offset + done;
      const piece = this.#blocks.get(Math.floor(at / this.#block)).subarray(at % this.#block).subarray(0, out.length - done);
      out.set(piece, done);
      done += piece.length;
    }
    return true;
  }

  /** Fetches what was missed, blocks that are neighbours together. */
  async fetch() {
    const blocks = Array.from(this.#missing).sort((a, b) => a - b);
    this.#missing.clear();
    const runs = [];
    for (const b of blocks) {
      if (runs.at(-1)?.end === b) runs.at(-1).end = b + 1;
      else runs.push({ first: b, end: b + 1 });
    }
    await Promise.all(runs.map((run) => this.#fetchRun(run)));
  }

  async #fetchRun({ first, end }) {
    const begin = first * this.#block;
    const count = Math.min(end * this.#block, this.size) - begin;
    for (let tried = 1;; ++tried) {
      try {
        const answer = await this.#ask(begin, begin + count - 1);
        if (answer.status !== 206 || versionOf(answer) !== this.#version)
          throw new ReebError('io', `${this.#url}: the file has changed`);
        const bytes = new Uint8Array(await answer.arrayBuffer());
        if (bytes.length !== count) throw new ReebError('io', `${this.#url}: the server sent a piece too short`);
        return this.#keep(begin, bytes);
      } catch (error) {
        const final = error instanceof ReebError && !error.cause;
        if (tried === TRIES || this.#signal?.aborted || final) throw error;
      }
    }
  }

  #keep(begin, bytes) {
    this.bytesFetched += bytes.length;
    for (let at = 0; at < bytes.length; at += this.#block)
      this.#blocks.set((begin + at) / this.#block, bytes.subarray(at, at + this.#block));
  }

  async #ask(first, last) {
    const headers = { ...Object.fromEntries(new Headers(this.#headers)), range: `bytes=${first}-${last}` };
    return get(this.#url, { headers, signal: this.#signal, credentials: this.#credentials });
  }
}

/** The answer of a server, if it is one; `cause` is set where there was none. */
export async function get(url, { headers, signal, credentials } = {}) {
  const answer = await fetch(url, { headers, signal, credentials }).catch((error) => {
    signal?.throwIfAborted();
    throw new ReebError('io', `${url}: ${error.message}`, { cause: error });
  });
  if (answer.ok) return answer;
  throw new ReebError('io', `${url}: ${answer.status} ${answer.statusText}`.trim());
}

function versionOf(answer) {
  return answer.headers.get('etag') ?? answer.headers.get('last-modified');
}
