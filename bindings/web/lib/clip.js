// What an open file answers.
import { arrayType, DOMAINS, SEMANTICS, TYPES } from './attribute_types.js';
import { RESULTS } from './instance.js';
import { RenderMesh } from './render_mesh.js';

/** An open file. Frames, shots and groups are counted from 0. */
export class Clip {
  #instance;
  #source;
  #shot = { firstFrame: 0, endFrame: 0 }; // that was asked for last

  /** Made by `open` and its like. `source`: where bytes come from that are not there yet. */
  constructor(instance, { complete = Promise.resolve(), source } = {}) {
    this.#instance = instance;
    this.#source = source;
    this.complete = complete;
  }

  get closed() {
    return this.#instance.closed;
  }

  /** What the file holds; of a file that arrives, so far. */
  get info() {
    const n = this.#ask(12, 'info');
    return {
      formatVersion: n[0], frameCount: n[1], totalFrames: n[2], shotCount: n[3], groupCount: n[4], gapCount: n[6],
      maxVertices: n[7], truncated: n[8] !== 0, frameRate: n[9], startTime: n[10], fileBytes: n[11],
      bytesFetched: this.#source?.bytesFetched ?? n[11],
    };
  }

  /** Keys and values, as an object without prototype. */
  get metadata() {
    const out = Object.create(null);
    const count = this.#ask(6, 'info')[5];
    for (let i = 0; i < count; ++i) {
      const [key, value] = this.#ask(2, 'metadata', i);
      out[this.#instance.text(key)] = this.#instance.text(value);
    }
    return out;
  }

  shot(index) {
    const n = this.#ask(6, 'shot', index);
    return { firstFrame: n[0], endFrame: n[1], frameCount: n[2], vertexCount: n[3], faceCount: n[4],
             orderKept: n[5] !== 0 };
  }

  group(index) {
    const n = this.#ask(6, 'group', index);
    return { firstFrame: n[0], frameCount: n[1], shot: n[2], componentCount: n[3], regionCount: n[4], bytes: n[5] };
  }

  /** Frames that cannot be decoded, as far as is known without trying. */
  gap(index) {
    const [firstFrame, frameCount] = this.#ask(2, 'gap', index);
    return { firstFrame, frameCount };
  }

  /** The box that holds all positions of a group, or of the clip where none is given; undefined where the file does not
   * tell. */
  bounds(group) {
    const result = this.#instance.result('bounds', group ?? 0);
    if (result === RESULTS.indexOf('invalid argument')) return undefined;
    this.#instance.check(result);
    if (group === undefined) return this.#boundsOfAll();
    const n = this.#instance.numbers(6);
    return { low: n.slice(0, 3), high: n.slice(3) };
  }

  #boundsOfAll() {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let g = 0, count = this.info.groupCount; g < count; ++g) {
      const box = this.bounds(g);
      if (!box) return undefined;
      for (let a = 0; a < 3; ++a) {
        low[a] = Math.min(low[a], box.low[a]);
        high[a] = Math.max(high[a], box.high[a]);
      }
    }
    return { low, high };
  }

  /** The shot that holds a frame: the last one that starts no later. */
  shotOfFrame(frame) {
    let found = 0;
    for (let i = 0, count = this.info.shotCount; i < count; ++i) {
      if (this.shot(i).firstFrame <= frame) found = i;
    }
    return found;
  }

  vertexCount(frame) {
    return this.#shotAt(frame).vertexCount;
  }

  /** Three vertices of each triangle of the frame's shot. */
  triangles(frame) {
    const [at, count] = this.#ask(2, 'triangles', frame);
    return this.#instance.copy(Uint32Array, at, 3 * count);
  }

  /** Corners of each face, and the vertices of all corners, one face after another. */
  polygons(frame) {
    const [sizes, faces, corners, count] = this.#ask(4, 'polygons', frame);
    return { sizes: this.#instance.copy(Uint32Array, sizes, faces),
             corners: this.#instance.copy(Uint32Array, corners, count) };
  }

  /** Positions of a frame, x, y, z of each vertex, in any order of frames. Into `positions`, and normals into `normals`,
   * where they are given; gives `positions`. */
  frame(index, positions, normals) {
    return this.#instance.pose('frame', index, this.vertexCount(index), positions, normals);
  }

  /** The same between two frames: 0 .. frameCount - 1, linear. */
  between(position, positions, normals) {
    return this.#instance.pose('between', position, this.vertexCount(Math.floor(position)), positions, normals);
  }

  /** What `between` takes at a time after the first frame; around and around if `loop`. */
  positionOfTime(seconds, loop = false) {
    return this.#ask(1, 'position_of_time', seconds, loop ? 1 : 0)[0];
  }

  /** What meshes have beside positions, shot after shot. */
  get attributes() {
    const out = [];
    const count = this.#ask(1, 'attribute_count')[0];
    for (let i = 0; i < count; ++i) {
      const n = this.#ask(10, 'attribute', i);
      out.push({ shot: n[0], index: n[1], name: this.#instance.text(n[2]), semantic: SEMANTICS[n[3]],
                 domain: DOMAINS[n[4]], type: TYPES[n[5]][0], channels: n[6], animated: n[7] !== 0,
                 computed: n[8] !== 0, bytes: n[9] });
    }
    return out;
  }

  /** Values of one of `attributes` in a frame of its shot, element after element. */
  values(frame, attribute) {
    const elements = this.#elements(frame, attribute.domain);
    return this.#instance.values('values', frame, attribute, arrayType(attribute), elements);
  }

  /** The name that a value of a material or group stands for. */
  nameOf(frame, attribute, value) {
    const length = this.#ask(1, 'name', frame, attribute.index, value, 0, 0)[0];
    return this.#instance.filled(length + 1, (at) => {
      this.#instance.call('name', frame, attribute.index, value, at, length + 1);
      return this.#instance.text(at);
    });
  }

  /** Files that travel along, such as textures: `name`, `mediaType`. */
  get resources() {
    return Array.from({ length: this.#ask(1, 'resource_count')[0] }, (_, i) => {
      const [name, mediaType] = this.#ask(2, 'resource', i);
      return { name: this.#instance.text(name), mediaType: this.#instance.text(mediaType) };
    });
  }

  /** The bytes of one of `resources`, by its number. */
  resource(index) {
    const size = this.#ask(1, 'resource_bytes', index, 0, 0)[0];
    return this.#instance.filled(size, (at) => {
      this.#instance.call('resource_bytes', index, at, size);
      return this.#instance.copy(Uint8Array, at, size);
    });
  }

  /** The mesh of the shot of `frame` as graphics interfaces take it: a vertex wherever the values of one of the attributes
   * `splitBy` differ; those that matter to the look where not given. Lives until it or the clip is closed. */
  renderMesh(frame, splitBy = this.#lookOf(frame)) {
    return new RenderMesh(this, this.#instance, frame, splitBy);
  }

  /** What `call` gives, as soon as the bytes that it needs are there: of a file that is fetched by ranges. */
  async fetching(call) {
    for (;;) {
      try {
        return call(this);
      } catch (error) {
        if (!this.#source?.waits) throw error;
        await this.#source.fetch();
      }
    }
  }

  /** Gives the memory back; the clip cannot be used any more. */
  close() {
    this.#instance.giveBack();
  }

  #ask(count, name, ...values) {
    this.#instance.call(name, ...values);
    return this.#instance.numbers(count);
  }

  // Shots of files that arrive grow; their vertices stay.
  #shotAt(frame) {
    if (frame < this.#shot.firstFrame || frame >= this.#shot.endFrame) this.#shot = this.shot(this.shotOfFrame(frame));
    return this.#shot;
  }

  #lookOf(frame) {
    const shot = this.shotOfFrame(frame);
    const seen = ['texture coordinate', 'normal', 'colour'];
    return this.attributes.filter((a) => a.shot === shot && seen.includes(a.semantic));
  }

  #elements(frame, domain) {
    switch (domain) {
      case 'vertex': return this.vertexCount(frame);
      case 'corner': return this.#ask(4, 'polygons', frame)[3];
      case 'face': return this.#ask(4, 'polygons', frame)[1];
      default: return 1;
    }
  }
}

