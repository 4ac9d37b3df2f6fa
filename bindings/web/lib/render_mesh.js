// A mesh as graphics interfaces take it.
import { arrayType } from './attribute_types.js';

/** Vertices, triangles and ranges of them that share a material; made by `clip.renderMesh`. */
export class RenderMesh {
  #clip;
  #instance;
  #at;

  constructor(clip, instance, frame, splitBy) {
    this.#clip = clip;
    this.#instance = instance;
    this.firstFrame = clip.shot(clip.shotOfFrame(frame)).firstFrame;
    const numbers = Uint32Array.from(splitBy, (a) => a.index);
    this.#at = instance.filled(numbers.byteLength, (at) => {
      instance.view(Uint32Array, at, numbers.length).set(numbers);
      instance.call('make_render_mesh', frame, at, numbers.length);
      return instance.keepMesh(instance.numbers(1)[0]);
    });
    this.#describe();
  }

  #describe() {
    this.#instance.call('render_info', this.#at);
    const [shot, vertices, sources, corners, triangles, indices, faces, ranges, material] = this.#instance.numbers(9);
    const copy = (at, count) => this.#instance.copy(Uint32Array, at, count);
    this.shot = shot;
    this.vertexCount = vertices;
    this.sourceVertices = copy(sources, vertices);
    this.sourceCorners = copy(corners, vertices);
    this.indices = copy(indices, 3 * triangles);
    this.sourceFaces = copy(faces, triangles);
    this.materialAttribute = material < 0 ? undefined : this.#attribute(material);
    this.ranges = Array.from({ length: ranges }, (_, i) => this.#range(i));
  }

  #attribute(index) {
    return this.#clip.attributes.find((a) => a.shot === this.shot && a.index === index);
  }

  #range(i) {
    this.#instance.call('render_range', this.#at, i);
    const [material, first, count] = this.#instance.numbers(3);
    const of = this.materialAttribute;
    return { material, name: of ? this.#clip.nameOf(this.firstFrame, of, material) : '', first, count };
  }

  /** A frame of the mesh's shot, as of `clip.frame`: positions and, into an array that is given, smooth normals. */
  frame(index, positions, normals) {
    return this.#instance.pose('render_frame', index, this.vertexCount, positions, normals, this.#open());
  }

  /** The pose between two frames, as of `clip.between`. */
  between(position, positions, normals) {
    return this.#instance.pose('render_between', position, this.vertexCount, positions, normals, this.#open());
  }

  /** `positions` and `normals` between two frames, in new arrays or in the pair `reuse`. Normals are the values of the attribute
   * `of`, or smooth where none is given. */
  pose(position, of, reuse) {
    const { positions, normals } = reuse ?? { normals: new Float32Array(3 * this.vertexCount) };
    const out = { positions: this.between(position, positions, of ? undefined : normals), normals };
    if (of) this.#mixNormals(position, of, normals);
    return out;
  }

  #mixNormals(position, of, out) {
    const frame = Math.floor(position);
    const share = position - frame;
    const before = this.values(frame, of);
    const last = frame + 1 >= this.#clip.shot(this.shot).endFrame;
    const after = share === 0 || last ? before : this.values(frame + 1, of);
    for (let i = 0; i < out.length; i += 3) {
      const x = before[i] + share * (after[i] - before[i]);
      const y = before[i + 1] + share * (after[i + 1] - before[i + 1]);
      const z = before[i + 2] + share * (after[i + 2] - before[i + 2]);
      const length = Math.hypot(x, y, z) || 1;
      out[i] = x / length;
      out[i + 1] = y / length;
      out[i + 2] = z / length;
    }
  }

  /** Values of an attribute: of each vertex of this mesh or, where it is one of faces, of each triangle. */
  values(frame, attribute) {
    const elements = attribute.domain === 'face' ? this.sourceFaces.length : this.vertexCount;
    return this.#instance.values('render_values', frame, attribute, arrayType(attribute), elements, this.#open());
  }

  /** Gives its memory back. */
  close() {
    if (this.#at) this.#instance.freeMesh(this.#at);
    this.#at = 0;
  }

  #open() {
    if (!this.#at) throw new TypeError('the render mesh is closed');
    return this.#at;
  }
}
