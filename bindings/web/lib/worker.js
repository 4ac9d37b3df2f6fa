// Decoding on a thread of its own: what `open` gives here answers by promises, and hands arrays over without copying.
import { ReebError } from './instance.js';

/** Opens a file as the function of the package that is called so does, in a worker. `options.worker`: one to use instead of
 * a new one. */
export function open(source, options) {
  return openBy('open', source, options);
}

export function openStreaming(source, options) {
  return openBy('openStreaming', source, options);
}

export function openRanges(url, options) {
  return openBy('openRanges', url, options);
}

async function openBy(how, source, { signal, worker, onProgress, transfer = [], ...others } = {}) {
  signal?.throwIfAborted();
  const thread = new Thread(worker ?? (await startWorker()), onProgress);
  const abort = () => thread.end(signal.reason);
  signal?.addEventListener('abort', abort, { once: true });
  try {
    await thread.ask('open', [how, plain(source), plainOptions(others)], transfer);
    return new WorkerClip(thread);
  } catch (error) {
    thread.end(error);
    throw error;
  } finally {
    signal?.removeEventListener('abort', abort);
  }
}

/** A Clip at the other end of a worker. */
export class WorkerClip {
  #thread;

  constructor(thread) {
    this.#thread = thread;
    this.complete = thread.ask('complete');
    this.complete.catch(() => {}); // told to whoever asks for it
  }

  info() {
    return this.#thread.ask('info');
  }
  metadata() {
    return this.#thread.ask('metadata');
  }
  attributes() {
    return this.#thread.ask('attributes');
  }
  resources() {
    return this.#thread.ask('resources');
  }
  resource(index) {
    return this.#thread.ask('resource', [index]);
  }
  shot(index) {
    return this.#thread.ask('shot', [index]);
  }
  shotOfFrame(frame) {
    return this.#thread.ask('shotOfFrame', [frame]);
  }
  group(index) {
    return this.#thread.ask('group', [index]);
  }
  gap(index) {
    return this.#thread.ask('gap', [index]);
  }
  bounds(group) {
    return this.#thread.ask('bounds', [group]);
  }
  triangles(frame) {
    return this.#thread.ask('triangles', [frame]);
  }
  polygons(frame) {
    return this.#thread.ask('polygons', [frame]);
  }
  values(frame, attribute) {
    return this.#thread.ask('values', [frame, attribute]);
  }
  nameOf(frame, attribute, value) {
    return this.#thread.ask('nameOf', [frame, attribute, value]);
  }
  /** `reuse`: an array that an earlier frame came in; it is handed over. */
  frame(index, reuse) {
    return this.#thread.ask('frame', [index, reuse], buffers(reuse));
  }
  between(position, reuse) {
    return this.#thread.ask('between', [position, reuse], buffers(reuse));
  }
  positionOfTime(seconds, loop = false) {
    return this.#thread.ask('positionOfTime', [seconds, loop]);
  }
  async renderMesh(frame, splitBy) {
    return new WorkerRenderMesh(this.#thread, await this.#thread.ask('renderMesh', [frame, splitBy]));
  }
  /** Ends the worker. */
  close() {
    this.#thread.end(new ReebError('invalid argument', 'the clip is closed'));
  }
}

/** A RenderMesh there; what is the same in all frames is here. */
export class WorkerRenderMesh {
  #thread;
  #number;

  constructor(thread, { number, ...fixed }) {
    this.#thread = thread;
    this.#number = number;
    Object.assign(this, fixed);
  }

  /** `reuse`: as of `WorkerClip.frame`. */
  frame(index, reuse) {
    return this.#ask('frame', [index, reuse], buffers(reuse));
  }
  between(position, reuse) {
    return this.#ask('between', [position, reuse], buffers(reuse));
  }
  pose(position, of, reuse) {
    return this.#ask('pose', [position, of, reuse], buffers(reuse?.positions, reuse?.normals));
  }
  values(frame, attribute) {
    return this.#ask('values', [frame, attribute]);
  }
  close() {
    return this.#ask('close', []);
  }

  #ask(name, values, transfer) {
    return this.#thread.ask('ofRenderMesh', [this.#number, name, values], transfer);
  }
}

function buffers(...arrays) {
  return arrays.filter(Boolean).map((array) => array.buffer);
}

/** Questions to a worker, and who waits for the answers. */
class Thread {
  #worker;
  #waiting = new Map();
  #next = 0;
  #ended; // why
  #onProgress;

  constructor(worker, onProgress) {
    this.#worker = worker;
    this.#onProgress = onProgress;
    listen(worker, 'message', (message) => this.#answer(message));
    listen(worker, 'error', (error) => this.end(new ReebError('io', `the worker failed: ${error.message ?? error}`)));
  }

  ask(name, values = [], transfer = []) {
    if (this.#ended) return Promise.reject(this.#ended);
    return new Promise((resolve, reject) => {
      const id = this.#next++;
      this.#waiting.set(id, { resolve, reject });
      this.#worker.postMessage({ id, name, values }, transfer);
    });
  }

  end(reason) {
    this.#ended ??= reason;
    this.#worker.terminate();
    for (const { reject } of this.#waiting.values()) reject(this.#ended);
    this.#waiting.clear();
  }

  #answer({ id, value, error, progress }) {
    if (progress) {
      this.#onProgress?.(progress);
      return;
    }
    const waiting = this.#waiting.get(id);
    this.#waiting.delete(id);
    if (error) waiting?.reject(error.code ? new ReebError(error.code, error.message) : new Error(error.message));
    else waiting?.resolve(value);
  }
}

// Browsers hand events over, node what they carry.
function listen(worker, name, call) {
  if (worker.addEventListener) worker.addEventListener(name, (event) => call(name === 'message' ? event.data : event));
  else worker.on(name, call);
}

async function startWorker() {
  if (globalThis.Worker) return new Worker(new URL('./worker_thread.js', import.meta.url), { type: 'module' });
  const { Worker: NodeWorker } = await import('node:worker_threads');
  return new NodeWorker(new URL('./worker_thread.js', import.meta.url));
}

// A worker has another base for addresses.
function plain(source) {
  const isAddress = typeof source === 'string' || source instanceof URL;
  return isAddress ? new URL(source, globalThis.document?.baseURI ?? globalThis.location?.href).href : source;
}

function plainOptions({ wasm, headers, ...others }) {
  const module = wasm instanceof WebAssembly.Module || wasm === undefined ? wasm : plain(wasm);
  return { ...others, wasm: module, headers: headers && Object.fromEntries(new Headers(headers)) };
}
