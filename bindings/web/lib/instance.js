// An instance of the decoder's WebAssembly for each open file. One that fails in the middle of a call, which only a lack
// of memory makes it do, is thrown away; others, when their file is closed, serve the next one.

export const RESULTS = ['ok', 'invalid argument', 'corrupt', 'truncated', 'unsupported', 'limit exceeded', 'io',
                        'cancelled', 'out of memory', 'need more data'];
const KEPT_INSTANCES = 2;
const KEPT_BYTES = 2 ** 26; // of an instance's memory, which never shrinks
const kept = new Map(); // idle instances by module

/** Why something failed: `code` is one of the words above, the message a sentence for people. */
export class ReebError extends Error {
  constructor(code, message, options) {
    super(message, options);
    this.name = 'ReebError';
    this.code = code;
  }
}

/** An instance that nothing is open in. `options.wasm`: a URL or a module instead of the package's own. */
export async function acquire(options = {}) {
  const module = await moduleOf(options.wasm ?? defaultUrl());
  options.signal?.throwIfAborted();
  const idle = kept.get(module)?.pop();
  return idle ?? Instance.make(module);
}

class Instance {
  #exports;
  #module;
  #host; // of what the module calls
  #file = 0; // where the file's bytes are, if they are there
  #meshes = new Set(); // where render meshes are that are open

  constructor(module, exports, host) {
    this.#module = module;
    this.#exports = exports;
    this.#host = host;
    host.source = undefined;
  }

  static async make(module) {
    const host = {};
    const { exports } = await WebAssembly.instantiate(module, imports(host));
    host.memory = exports.memory;
    exports._initialize();
    return new Instance(module, exports, host);
  }

  /** What the file is read from: `read(offset, out)` fills `out`, or is false where the bytes are not there. */
  set source(source) {
    this.#host.source = source;
  }

  get closed() {
    return this.#exports === undefined;
  }

  /** Calls a function that gives a result; fails where it is not ok. */
  call(name, ...values) {
    this.#host.source?.begin();
    this.check(this.result(name, ...values));
  }

  result(name, ...values) {
    if (this.closed) throw new ReebError('invalid argument', 'the clip is closed');
    try {
      return this.#exports[name](...values);
    } catch (error) {
      this.#exports = undefined; // what it was at is half done
      throw error;
    }
  }

  check(result) {
    if (result === 0) return;
    if (this.#host.source?.waits) throw new ReebError('need more data', 'the bytes are not here yet: await clip.fetching(...)');
    const code = RESULTS[result] ?? 'unknown result';
    throw new ReebError(code, this.text(this.result('message_at')) || code);
  }

  /** The first numbers that the last call left. */
  numbers(count) {
    return Array.from(this.view(Float64Array, this.result('numbers_at'), count));
  }

  allocate(bytes) {
    return this.result('allocate', bytes) >>> 0;
  }

  release(at) {
    if (!this.closed) this.result('release', at);
  }

  /** What `use` gives of memory that is there while it runs. */
  filled(bytes, use) {
    const at = this.allocate(bytes);
    try {
      return use(at);
    } finally {
      this.release(at);
    }
  }

  /** Calls a function that writes `vertices` positions and, where there is an array for them, normals. */
  pose(name, place, vertices, positions = new Float32Array(3 * vertices), normals = undefined, mesh = undefined) {
    const floats = 3 * vertices;
    for (const target of [positions, normals]) {
      if (target && target.length < floats) throw new RangeError('room for fewer vertices than the frame has');
    }
    return this.filled(4 * floats * (normals ? 2 : 1), (at) => {
      this.call(name, place, at, normals ? at + 4 * floats : 0, vertices, mesh);
      positions.set(this.view(Float32Array, at, floats));
      normals?.set(this.view(Float32Array, at + 4 * floats, floats));
      return positions;
    });
  }

  /** Calls a function that writes an attribute's values. */
  values(name, frame, attribute, Numbers, elements, mesh = undefined) {
    const count = elements * attribute.channels;
    return this.filled(count * Numbers.BYTES_PER_ELEMENT, (at) => {
      this.call(name, frame, attribute.index, at, elements, mesh);
      return this.copy(Numbers, at, count);
    });
  }

  keepMesh(at) {
    this.#meshes.add(at);
    return at;
  }

  freeMesh(at) {
    if (this.#meshes.delete(at) && !this.closed) this.result('free_render_mesh', at);
  }

  /** Copies bytes to memory that is allocated for them. */
  put(bytes) {
    const at = this.allocate(bytes.length);
    this.view(Uint8Array, at, bytes.length).set(bytes);
    return at;
  }

  /** Copies the bytes of a file, which stay until it is closed. */
  putFile(bytes) {
    return (this.#file = this.put(bytes));
  }

  /** Valid until the next call. */
  view(Numbers, at, count) {
    return new Numbers(this.#exports.memory.buffer, at >>> 0, count);
  }

  copy(Numbers, at, count) {
    return this.view(Numbers, at, count).slice();
  }

  /** UTF-8 up to its closing 0. */
  text(at) {
    const bytes = new Uint8Array(this.#exports.memory.buffer, at >>> 0);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)).slice());
  }

  /** Ends the use of this object; its memory serves another one. */
  giveBack() {
    if (this.closed) return;
    for (const at of this.#meshes) this.freeMesh(at);
    this.result('close');
    this.release(this.#file);
    const exports = this.#exports;
    this.#exports = undefined;
    const others = kept.get(this.#module) ?? [];
    if (others.length >= KEPT_INSTANCES || exports.memory.buffer.byteLength > KEPT_BYTES) return;
    kept.set(this.#module, [...others, new Instance(this.#module, exports, this.#host)]);
  }
}

/** What the module needs of its host: `host.memory` is its own, `host.source` what it reads. */
function imports(host) {
  return {
    reeb: {
      out_of_memory() {
        throw new ReebError('out of memory', 'out of memory');
      },
      read(offset, at, count) {
        return host.source?.read(offset, new Uint8Array(host.memory.buffer, at >>> 0, count)) ? 0 : 1;
      },
    },
    wasi_snapshot_preview1: {
      clock_time_get(clock, precision, at) {
        new DataView(host.memory.buffer).setBigUint64(at, BigInt(Math.round(1e6 * performance.now())), true);
        return 0;
      },
    },
  };
}

const modules = new Map(); // promises of modules by address

function moduleOf(wasm) {
  if (wasm instanceof WebAssembly.Module) return wasm;
  const address = String(wasm);
  if (!modules.has(address)) {
    const module = compile(new URL(wasm, globalThis.location?.href));
    modules.set(address, module);
    module.catch(() => modules.delete(address)); // another try may do better
  }
  return modules.get(address);
}

/** Fetches and compiles the module, so that the first file opens sooner. */
export async function preload(options = {}) {
  await moduleOf(options.wasm ?? defaultUrl());
}

async function compile(url) {
  if (url.protocol === 'file:') {
    const { readFile } = await import('node:fs/promises');
    return WebAssembly.compile(await readFile(url));
  }
  const answer = await fetch(url);
  if (!answer.ok) throw new ReebError('io', `${url}: ${answer.status} ${answer.statusText}`);
  return WebAssembly.compile(await answer.arrayBuffer());
}

function defaultUrl() {
  if (hasVectors()) return new URL('./reeb.wasm', import.meta.url);
  throw new ReebError('unsupported', 'this browser is too old: its WebAssembly has no vectors');
}

// A module of one function that makes a vector.
function hasVectors() {
  return WebAssembly.validate(Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8,
                                            0, 65, 0, 253, 15, 253, 98, 11));
}
