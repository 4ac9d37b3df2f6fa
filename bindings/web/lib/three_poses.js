// Poses of a clip for three.js, decoded on this thread or in a worker.

const FIXED = { 'texture coordinate': 'uv', colour: 'color' }; // what three calls it

/** A clip that several meshes show: its `info`, `box`, `resources`, and `shots`, each with what is the same in all its frames:
 * `index`, `vertexCount`, `indices`, `ranges` of triangles by material, and `fixed`, attributes by three's names. */
export class Poses {
  #clip;
  #closed;
  #users = 0;
  shots = [];

  /** `clip`: a Clip or a WorkerClip, which is closed with the last user; then `closed` is called. */
  static async make(clip, closed = () => {}) {
    const poses = new Poses();
    poses.#clip = clip;
    poses.#closed = closed;
    poses.complete = clip.complete;
    try {
      await poses.#describe();
      return poses;
    } catch (error) {
      clip.close();
      throw error;
    }
  }

  async #describe() {
    await this.refresh();
    this.resources = await read(this.#clip, 'resources');
    this.box = (await this.#clip.bounds()) ?? (await this.#boxOfFrames());
  }

  /** Of a file that arrives: what it has by now. */
  async refresh() {
    const info = await read(this.#clip, 'info');
    const attributes = await read(this.#clip, 'attributes');
    while (this.shots.length < info.shotCount) this.shots.push(await this.#shot(this.shots.length, attributes));
    this.info = info;
  }

  async #shot(index, all) {
    const attributes = all.filter((a) => a.shot === index);
    const { firstFrame } = await this.#clip.shot(index);
    const mesh = await this.#clip.renderMesh(firstFrame);
    const fixed = {};
    for (const attribute of attributes) {
      const name = FIXED[attribute.semantic];
      if (name && !(name in fixed) && !attribute.animated && attribute.domain !== 'face')
        fixed[name] = { attribute, values: await mesh.values(firstFrame, attribute) };
    }
    const normals = attributes.find((a) => a.semantic === 'normal' && a.type === 'binary32' && a.channels === 3);
    const { vertexCount, sourceVertices, indices, ranges } = mesh;
    return { index, firstFrame, mesh, attributes, normals, fixed, vertexCount, sourceVertices, indices, ranges };
  }

  // Few files do not tell their box.
  async #boxOfFrames() {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let t = 0; t < this.info.frameCount; ++t) {
      (await this.#clip.frame(t)).forEach((x, i) => {
        low[i % 3] = Math.min(low[i % 3], x);
        high[i % 3] = Math.max(high[i % 3], x);
      });
    }
    return { low, high };
  }

  /** `positions` and `normals` of the shot that holds `position`, or a promise of them where a worker decodes. */
  pose(position, reuse) {
    const { mesh, normals } = this.shotAt(position);
    return mesh.pose(position, normals, reuse);
  }

  /** Values of one of the attributes of the shot, of each vertex. */
  values(position, attribute) {
    return this.shotAt(position).mesh.values(Math.floor(position), attribute);
  }

  /** Groups of frames and their bytes, as far as they are there. */
  async groups() {
    const out = [];
    for (let i = 0; i < this.info.groupCount; ++i) out.push(await this.#clip.group(i));
    return out;
  }

  shotAt(position) {
    return this.shots.findLast((shot) => shot.firstFrame <= position) ?? this.shots[0];
  }

  resource(index) {
    return this.#clip.resource(index);
  }

  addUser() {
    ++this.#users;
  }

  removeUser() {
    if (--this.#users > 0) return;
    this.#clip.close();
    this.#closed();
  }
}

// A property of a Clip is a question to a WorkerClip.
function read(clip, name) {
  return typeof clip[name] === 'function' ? clip[name]() : clip[name];
}
