// The worker's end of worker.js: one clip, asked by name.
import * as reeb from './reeb.js';

const READ = new Set(['info', 'metadata', 'attributes', 'resources', 'complete']);
const CALLED = new Set(['shot', 'shotOfFrame', 'group', 'gap', 'bounds', 'triangles', 'polygons', 'values', 'nameOf',
                        'frame', 'between', 'positionOfTime', 'resource']);
const MESH_CALLED = new Set(['frame', 'between', 'pose', 'values', 'close']);
let clip;
const meshes = [];

const known = {
  async open(how, source, options) {
    clip = await reeb[how](source, { ...options, onProgress: (progress) => port.postMessage({ progress }) });
  },

  renderMesh(frame, splitBy) {
    return clip.fetching(() => {
      const mesh = clip.renderMesh(frame, splitBy);
      return { ...mesh, number: meshes.push(mesh) - 1 };
    });
  },

  ofRenderMesh(number, name, values) {
    const mesh = meshes[number];
    if (!MESH_CALLED.has(name)) throw new Error(`a render mesh has no '${name}'`);
    return clip.fetching(() => mesh[name](...values));
  },
};

function answer(name, values) {
  if (Object.hasOwn(known, name)) return known[name](...values);
  if (READ.has(name)) return clip[name];
  if (CALLED.has(name)) return clip.fetching(() => clip[name](...values));
  throw new Error(`there is no question '${name}'`);
}

/** Buffers that belong to the answer alone. */
function buffersOf(value) {
  if (ArrayBuffer.isView(value)) return [value.buffer];
  return value && typeof value === 'object' ? Object.values(value).filter(ArrayBuffer.isView).map((a) => a.buffer) : [];
}

const port = globalThis.postMessage ? globalThis : (await import('node:worker_threads')).parentPort;
const listen = (call) => (port === globalThis ? (port.onmessage = (event) => call(event.data)) : port.on('message', call));

listen(async ({ id, name, values }) => {
  try {
    const value = await answer(name, values);
    port.postMessage({ id, value }, buffersOf(value));
  } catch (error) {
    port.postMessage({ id, error: { code: error.code, message: error.message } });
  }
});
