// Decoder of .reeb files: `open`, `openStreaming` and `openRanges` give a Clip, of which any frame can be had.
import { Clip } from './clip.js';
import { acquire, ReebError, RESULTS } from './instance.js';
import { get, RangeSource } from './range_source.js';

export { Clip, ReebError };
export { preload } from './instance.js';

const DEFAULT_MEMORY = 2 ** 30;

/** Opens a whole file: bytes, a Blob, a Response, or where one is to be fetched from. */
export async function open(source, options = {}) {
  return openBytes(await bytesOf(source, options), options);
}

/** Opens a file while it arrives, as soon as its first frame can be decoded; `clip.complete` tells when all of it is
 * there, and fails where it does not come whole. */
export async function openStreaming(source, options = {}) {
  const pieces = new Pieces(await streamOf(source, options));
  options.signal?.addEventListener('abort', () => pieces.cancel(), { once: true });
  return opened(options, async (instance) => {
    instance.call('open_push', memoryOf(options));
    const arrival = new Arrival(instance, pieces, options);
    await arrival.untilFirstFrame();
    return new Clip(instance, { complete: arrival.untilEnd() });
  });
}

/** Opens a file at an address and fetches no more of it than is asked for, by `clip.fetching`; all of it where the server
 * does not send parts. */
export async function openRanges(url, options = {}) {
  const source = await RangeSource.open(absolute(url), options);
  if (source instanceof Uint8Array) return openBytes(source, options);
  return opened(options, async (instance) => {
    const clip = new Clip(instance, { source });
    instance.source = source;
    await clip.fetching(() => instance.call('open_reader', source.size, memoryOf(options)));
    return clip;
  });
}

function openBytes(bytes, options) {
  return opened(options, (instance) => {
    const at = instance.putFile(bytes);
    instance.call('open_memory', at, bytes.length, memoryOf(options));
    return new Clip(instance);
  });
}

function memoryOf(options) {
  return options.maxMemory ?? DEFAULT_MEMORY;
}

async function opened(options, make) {
  const instance = await acquire(options);
  try {
    return await make(instance);
  } catch (error) {
    instance.giveBack();
    throw error;
  }
}

/** What a stream gives, kept until it is asked for: a stream that fails forgets what it still has. */
class Pieces {
  #reader;
  #kept = [];
  #end; // once there is one, with its `error` if it is one
  #wake = () => {};

  constructor(stream) {
    this.#reader = stream.getReader();
    this.#readAll();
  }

  async #readAll() {
    try {
      for (let piece; !(piece = await this.#reader.read()).done; this.#wake()) this.#kept.push(piece.value);
      this.#end = {};
    } catch (error) {
      this.#end = { error };
    }
    this.#wake();
  }

  /** The next piece; undefined at the end. */
  async next() {
    while (this.#kept.length === 0 && !this.#end) await new Promise((resolve) => (this.#wake = resolve));
    if (this.#kept.length > 0) return this.#kept.shift();
    if (this.#end.error) throw this.#end.error;
    return undefined;
  }

  cancel() {
    this.#reader.cancel().catch(() => {});
  }
}

/** Pushes pieces. */
class Arrival {
  constructor(instance, pieces, options) {
    this.instance = instance;
    this.pieces = pieces;
    this.options = options;
    this.bytes = 0;
    this.ended = false;
  }

  async step() {
    const piece = await this.pieces.next();
    this.options.signal?.throwIfAborted();
    if (this.instance.closed) {
      this.pieces.cancel();
      return (this.ended = true);
    }
    if (piece) {
      this.#push(piece);
    } else {
      this.ended = true;
      this.instance.call('push_end');
    }
    this.options.onProgress?.({ bytes: this.bytes, frameCount: this.frameCount() });
    return this.ended;
  }

  #push(value) {
    const at = this.instance.put(value);
    try {
      this.instance.call('push', at, value.length);
    } finally {
      this.instance.release(at);
    }
    this.bytes += value.length;
  }

  frameCount() {
    const result = this.instance.result('info');
    if (result === RESULTS.indexOf('need more data')) return 0;
    this.instance.check(result);
    return this.instance.numbers(2)[1];
  }

  async untilFirstFrame() {
    while (this.frameCount() === 0) {
      if (this.ended) throw new ReebError('truncated', 'the file ends before its first frame');
      await this.step();
    }
  }

  untilEnd() {
    const all = (async () => {
      while (!this.ended) await this.step();
    })();
    all.catch(() => {}); // told to whoever asks for it
    return all;
  }
}

async function bytesOf(source, options) {
  if (source instanceof Uint8Array) return source;
  if (source instanceof ArrayBuffer) return new Uint8Array(source);
  const whole = isAddress(source) ? await get(absolute(source), options) : source;
  const bytes = new Uint8Array(await whole.arrayBuffer());
  options.signal?.throwIfAborted();
  return bytes;
}

async function streamOf(source, options) {
  if (source instanceof ReadableStream) return source;
  if (source instanceof Blob) return source.stream();
  if (source instanceof Uint8Array || source instanceof ArrayBuffer) return new Blob([source]).stream();
  return (isAddress(source) ? await get(absolute(source), options) : source).body;
}

function isAddress(source) {
  return typeof source === 'string' || source instanceof URL;
}

function absolute(url) {
  return new URL(url, globalThis.document?.baseURI ?? globalThis.location?.href).href;
}
