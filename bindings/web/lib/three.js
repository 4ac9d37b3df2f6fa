// Clips in three.js: ReebLoader gives a ReebMesh, a Mesh whose positions follow its time.
import { Box3, BufferAttribute, BufferGeometry, DynamicDrawUsage, Loader, LoopOnce, LoopRepeat, Mesh, MeshStandardMaterial,
         Sphere, Vector3 } from 'three';

import { open, openStreaming, preload } from './reeb.js';
import { open as openInWorker, openStreaming as streamInWorker } from './worker.js';
import { Poses } from './three_poses.js';

const NORMALISED = ['u8 normalised', 'u16 normalised'];
const DEFAULT_FRAME_RATE = 25; // where a file does not tell

/** Loads `.reeb` files. Decodes in workers, one for each file, or on the thread of the page once their limit is reached. */
export class ReebLoader extends Loader {
  #workerLimit = 4;
  #workers = 0;
  #options = {};
  #streaming = false;

  /** 0: everything on the thread of the page. */
  setWorkerLimit(count) {
    this.#workerLimit = count;
    return this;
  }

  /** Where the WebAssembly is, if not beside the package. */
  setWasm(url) {
    this.#options.wasm = url;
    return this;
  }

  /** Whether `load` ends as soon as the first frame is there; the mesh grows then, and tells so by the event `arrival`, with
   * `bytes`, `frameCount` and, once it has ended, `complete` or `error`. */
  setStreaming(on) {
    this.#streaming = on;
    return this;
  }

  /** Fetches the decoder before the first file asks for it. */
  preload() {
    return preload(this.#options);
  }

  load(url, onLoad, onProgress, onError) {
    const address = this.manager.resolveURL(this.path ? new URL(url, new URL(this.path, base())).href : url);
    this.manager.itemStart(address);
    const made = this.#streaming ? this.#arriving(address, onProgress) : this.#fetched(address, onProgress).then((bytes) => this.parse(bytes));
    made
      .then(onLoad)
      .catch((error) => {
        if (onError) onError(error);
        else console.error(error);
        this.manager.itemError(address);
      })
      .finally(() => this.manager.itemEnd(address));
  }

  /** Of the bytes of a file: gives a promise, and calls back where asked. */
  parse(bytes, onLoad, onError) {
    const made = this.#made(open, openInWorker, bytes, this.#options);
    if (onLoad) made.then(onLoad, onError);
    return made;
  }

  /** Meshes that were loaded stay. */
  dispose() {
    this.#workerLimit = 0;
  }

  async #fetched(address, onProgress) {
    const answer = await fetch(new URL(address, base()), this.#request());
    if (!answer.ok) throw new Error(`${address}: ${answer.status} ${answer.statusText}`);
    if (!onProgress || !answer.body) return answer.arrayBuffer();
    const total = Number(answer.headers.get('content-length'));
    let loaded = 0;
    const counted = answer.body.pipeThrough(new TransformStream({
      transform(piece, out) {
        loaded += piece.length;
        onProgress({ lengthComputable: total > 0, loaded, total });
        out.enqueue(piece);
      },
    }));
    return new Response(counted).arrayBuffer();
  }

  async #arriving(address, onProgress) {
    let mesh;
    const grow = async (progress) => {
      onProgress?.({ lengthComputable: false, loaded: progress.bytes, total: 0 });
      await mesh?.refresh(progress);
    };
    const options = { ...this.#options, ...this.#request(), onProgress: grow };
    mesh = await this.#made(openStreaming, streamInWorker, new URL(address, base()).href, options);
    mesh.complete.then(() => mesh.refresh({ complete: true }), (error) => mesh.refresh({ error }));
    return mesh;
  }

  #request() {
    return { headers: this.requestHeader, credentials: this.withCredentials ? 'include' : 'same-origin' };
  }

  // By one of two functions: on this thread, or in a worker as long as there may be one more.
  async #made(here, there, source, options) {
    if (this.#workers >= this.#workerLimit) return new ReebMesh(await Poses.make(await here(source, options)));
    ++this.#workers;
    const ended = () => --this.#workers;
    try {
      return new ReebMesh(await Poses.make(await there(source, options), ended));
    } catch (error) {
      ended();
      throw error;
    }
  }
}

/** An animated mesh. `update(delta)` once a drawn frame; `instance()` gives another one that has a time of its own and the
 * same decoder, which is freed with the last of them. */
export class ReebMesh extends Mesh {
  #poses;
  #geometries = [];
  #wanted = -1; // position that was asked for last
  #underWay; // while a worker is at work
  #disposed = false;

  constructor(poses, materials) {
    super();
    this.isReebMesh = true;
    this.type = 'ReebMesh';
    this.#poses = poses;
    poses.addUser();
    this.time = 0;
    this.shownPosition = -1;
    this.speed = 1;
    this.loop = LoopRepeat;
    this.playing = true;
    this.box = boxOf(poses.box);
    this.sphere = this.box.getBoundingSphere(new Sphere());
    this.#showShot(poses.shots[0]);
    this.material = materials ?? makeMaterials(poses.shots[0]);
    this.seek(0);
  }

  /** Seconds of a whole turn. */
  get duration() {
    return this.frameCount / this.frameRate;
  }
  get frameCount() {
    return this.#poses.info.frameCount;
  }
  get frameRate() {
    return this.#poses.info.frameRate || DEFAULT_FRAME_RATE;
  }
  get info() {
    return this.#poses.info;
  }
  /** Of the shot that is shown. */
  get attributes() {
    return this.#shot.attributes;
  }
  /** The vertex of the file that each vertex of the geometry is. */
  get sourceVertices() {
    return this.#shot.sourceVertices;
  }
  /** When all of the file is there. */
  get complete() {
    return this.#poses.complete;
  }
  get #shot() {
    return this.#poses.shotAt(Math.max(0, this.shownPosition));
  }
  /** Values of an attribute of vertices or corners, of each vertex of the geometry: a promise. */
  async values(attribute, position = this.shownPosition) {
    return this.#poses.values(position, attribute);
  }
  /** Runs of frames that decode on their own: `firstFrame`, `frameCount`, `bytes`; a promise. */
  groups() {
    return this.#poses.groups();
  }
  /** Files that travel along, such as textures: `name`, `mediaType`, and `bytes()`, a promise. */
  get resources() {
    return this.#poses.resources.map((resource, i) => ({ ...resource, bytes: async () => this.#poses.resource(i) }));
  }

  play() {
    this.playing = true;
    return this;
  }
  pause() {
    this.playing = false;
    return this;
  }

  /** Goes on by `delta` seconds, times `speed`, which may be negative. Gives a promise of the pose being there, which nobody
   * has to wait for. */
  update(delta) {
    if (!this.playing) return Promise.resolve();
    return this.seek(this.time + delta * this.speed);
  }

  seek(seconds) {
    const whole = this.duration;
    const outside = seconds < 0 || seconds >= whole;
    if (outside && this.loop === LoopOnce) {
      this.playing = false;
      this.dispatchEvent({ type: 'finished' });
    }
    this.time = this.loop === LoopOnce ? Math.min(Math.max(seconds, 0), whole) : seconds - whole * Math.floor(seconds / whole);
    return this.showPosition(Math.min(this.time * this.frameRate, this.frameCount - 1));
  }

  /** The pose at a frame, or between two. A worker answers later: while it is at work, only the newest wish is kept. */
  showPosition(position) {
    this.#wanted = position;
    if (this.#underWay) return this.#underWay;
    const pose = this.#poses.pose(position);
    if (!(pose instanceof Promise)) {
      this.#show(position, pose);
      return Promise.resolve();
    }
    this.#underWay = pose.then((there) => this.#arrived(position, there)).finally(() => (this.#underWay = undefined));
    this.#underWay.catch(() => {}); // told to whoever waits
    return this.#underWay;
  }

  async #arrived(position, pose) {
    this.#show(position, pose);
    for (let there = pose; this.#wanted !== this.shownPosition && !this.#disposed;) {
      const next = this.#wanted;
      there = await this.#poses.pose(next, this.#spare(next, there));
      this.#show(next, there);
    }
  }

  // Arrays for another pose: those of the last one, where they fit.
  #spare(position, pose) {
    return pose.positions.length === 3 * this.#poses.shotAt(position).vertexCount ? pose : undefined;
  }

  #show(position, { positions, normals }) {
    if (this.#disposed) return;
    this.#showShot(this.#poses.shotAt(position));
    copyInto(this.geometry.attributes.position, positions);
    copyInto(this.geometry.attributes.normal, normals);
    this.shownPosition = position;
  }

  #showShot(shot) {
    this.#geometries[shot.index] ??= makeGeometry(shot, this.box, this.sphere);
    this.geometry = this.#geometries[shot.index];
  }

  /** Looks what has arrived. */
  async refresh(progress = {}) {
    if (this.#disposed) return;
    await this.#poses.refresh();
    this.dispatchEvent({ type: 'arrival', ...progress, frameCount: this.frameCount });
  }

  /** Another mesh of the same clip; materials are shared where none are given. */
  instance(materials = this.material) {
    return new ReebMesh(this.#poses, materials);
  }

  clone() {
    return this.instance().copy(this, false);
  }

  copy(source, recursive) {
    const { geometry, material } = this;
    super.copy(source, recursive);
    return Object.assign(this, { geometry, material, time: source.time, speed: source.speed, loop: source.loop,
                                 playing: source.playing });
  }

  /** Frees geometries, and the decoder with the last mesh of the clip. Materials are the caller's. */
  dispose() {
    if (this.#disposed) return;
    this.#disposed = true;
    for (const geometry of this.#geometries) geometry?.dispose();
    this.#poses.removeUser();
  }
}

function boxOf({ low, high }) {
  return new Box3(new Vector3(...low), new Vector3(...high));
}

function makeGeometry(shot, box, sphere) {
  const geometry = new BufferGeometry();
  const moving = () => new BufferAttribute(new Float32Array(3 * shot.vertexCount), 3).setUsage(DynamicDrawUsage);
  geometry.setIndex(new BufferAttribute(shot.indices, 1));
  geometry.setAttribute('position', moving());
  geometry.setAttribute('normal', moving());
  for (const [name, { attribute, values }] of Object.entries(shot.fixed)) {
    geometry.setAttribute(name, new BufferAttribute(values, attribute.channels, NORMALISED.includes(attribute.type)));
  }
  shot.ranges.forEach(({ first, count }, i) => geometry.addGroup(3 * first, 3 * count, i));
  geometry.boundingBox = box.clone(); // of the whole clip, so that culling needs no frame
  geometry.boundingSphere = sphere.clone();
  return geometry;
}

function makeMaterials(shot) {
  const make = (name) => Object.assign(new MeshStandardMaterial({ vertexColors: 'color' in shot.fixed, roughness: 0.7 }), { name });
  const named = shot.ranges.map(({ name }) => make(name));
  return named.length === 1 ? named[0] : named;
}

function copyInto(attribute, values) {
  attribute.array.set(values);
  attribute.needsUpdate = true;
}

function base() {
  return globalThis.document?.baseURI ?? globalThis.location?.href;
}
