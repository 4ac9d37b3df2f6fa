// node --test: the interface of the package; its bits are held to the conformance streams by decode_stream.mjs.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { after, test } from 'node:test';
import { pathToFileURL } from 'node:url';

const folder = pathToFileURL(`${process.env.REEB_PACKAGE}/`);
const { open, openRanges, openStreaming, ReebError } = await import(new URL('reeb.js', folder));
const { acquire } = await import(new URL('instance.js', folder));
const worker = await import(new URL('worker.js', folder));
const file = (name) => new Uint8Array(readFileSync(new URL(`../../../tests/codec/data/${name}.reeb`, import.meta.url)));
const stream = (name) => new Uint8Array(readFileSync(new URL(`../../../conformance/streams/${name}.reeb`, import.meta.url)));
const fails = (code) => (error) => error instanceof ReebError && error.code === code && error.message.length > 8;

// Serves fast.reeb in pieces; `/cut` ends half-way; `/ranges` sends the parts that are asked for, which do not come every
// third time; `/changing` is another file for each request.
let asked = 0;
function sendRange(request, answer) {
  const bytes = file('fast');
  if (++asked % 3 === 0) return answer.destroy();
  const [, first, last] = /bytes=(\d+)-(\d+)/.exec(request.headers.range).map(Number);
  const part = bytes.subarray(first, last + 1);
  const etag = request.url === '/changing' ? `"${asked}"` : '"1"';
  answer.writeHead(206, { 'content-range': `bytes ${first}-${first + part.length - 1}/${bytes.length}`, etag });
  return answer.end(part);
}

const server = createServer(async (request, answer) => {
  if (request.url === '/none') return answer.writeHead(404).end();
  if (request.url === '/ranges' || request.url === '/changing') return sendRange(request, answer);
  const bytes = file('fast');
  answer.writeHead(200, { 'content-length': bytes.length });
  for (let at = 0; at < bytes.length; at += 400) {
    if (request.url === '/cut' && at > bytes.length / 2) return answer.destroy();
    answer.write(bytes.subarray(at, at + 400));
    await new Promise((resolve) => setTimeout(resolve, 2));
  }
  return answer.end();
});
await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
const address = `http://127.0.0.1:${server.address().port}`;
after(() => server.close());

test('frames lie between their neighbours', async () => {
  const clip = await open(file('main'));
  const { frameCount, shotCount } = clip.info;
  assert.equal(shotCount, 1);
  const [a, b] = [clip.frame(3), clip.frame(4)];
  const half = clip.between(3.5);
  assert.equal(half.length, 3 * clip.vertexCount(3));
  half.forEach((x, i) => assert.ok(Math.abs(x - (a[i] + b[i]) / 2) <= 1e-6 * (1 + Math.abs(x))));
  assert.deepEqual(clip.between(frameCount - 1), clip.frame(frameCount - 1));
  assert.ok(a.some((x, i) => x !== b[i]));
  clip.close();
});

test('triangles are those of polygons, each a fan', async () => {
  const clip = await open(file('fast'));
  const { sizes, corners } = clip.polygons(0);
  const expected = [];
  let at = 0;
  for (const size of sizes) {
    for (let i = 1; i + 1 < size; ++i) expected.push(corners[at], corners[at + i], corners[at + i + 1]);
    at += size;
  }
  assert.equal(at, corners.length);
  assert.deepEqual(Array.from(clip.triangles(0)), expected);
  clip.close();
});

test('normals are those of the faces around', async () => {
  const clip = await open(file('fast'));
  const normals = new Float32Array(3 * clip.vertexCount(0));
  const xyz = clip.frame(0, undefined, normals);
  const sums = new Float64Array(normals.length);
  const t = clip.triangles(0);
  for (let i = 0; i < t.length; i += 3) {
    const [p, q, r] = [0, 1, 2].map((k) => xyz.subarray(3 * t[i + k], 3 * t[i + k] + 3));
    const [u, v] = [q, r].map((x) => [x[0] - p[0], x[1] - p[1], x[2] - p[2]]);
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    for (let k = 0; k < 3; ++k) for (let c = 0; c < 3; ++c) sums[3 * t[i + k] + c] += n[c];
  }
  for (let i = 0; i < sums.length; i += 3) {
    const length = Math.hypot(sums[i], sums[i + 1], sums[i + 2]) || 1;
    for (let c = 0; c < 3; ++c) assert.ok(Math.abs(normals[i + c] - sums[i + c] / length) < 1e-4);
  }
  clip.close();
});

test('arrays are filled that are given, if there is room', async () => {
  const clip = await open(file('fast'));
  const target = new Float32Array(3 * clip.info.maxVertices);
  assert.equal(clip.frame(2, target), target);
  assert.deepEqual(target, clip.frame(2));
  assert.throws(() => clip.frame(2, new Float32Array(3)), RangeError);
  clip.close();
});

test('what is broken is refused with the sentence of the decoder, and others open', async () => {
  await assert.rejects(open(new Uint8Array(100)), fails('corrupt'));
  await assert.rejects(open(file('fast').subarray(0, 20)), fails('truncated'));
  await assert.rejects(open(file('main'), { maxMemory: 1000 }).then((clip) => clip.frame(0)), fails('limit exceeded'));
  const clip = await open(file('fast'));
  assert.throws(() => clip.frame(clip.info.frameCount), fails('invalid argument'));
  assert.ok(clip.frame(0).every(Number.isFinite));
  clip.close();
  assert.ok(clip.closed);
  assert.throws(() => clip.frame(0), fails('invalid argument'));
});

test('a lack of memory ends one instance and no other', async () => {
  const other = await open(file('fast'));
  const instance = await acquire();
  assert.throws(() => instance.allocate(2 ** 32 - 2 ** 16), fails('out of memory'));
  assert.ok(instance.closed);
  assert.ok(other.frame(0).every(Number.isFinite));
  other.close();
});

test('a thousand files leave nothing behind', async () => {
  const bytes = file('fast');
  const memory = () => process.memoryUsage().rss;
  const round = async (count) => {
    for (let i = 0; i < count; ++i) {
      const clip = await open(bytes);
      clip.frame(0);
      clip.close();
    }
  };
  await round(100);
  const before = memory();
  await round(1000);
  assert.ok(memory() - before < 32 * 2 ** 20, `${(memory() - before) / 2 ** 20} MiB more`);
});

test('a file is fetched, and what cannot be is said', async () => {
  const clip = await open(`${address}/fast`);
  const whole = await open(file('fast'));
  assert.deepEqual(clip.frame(5), whole.frame(5));
  await assert.rejects(open(`${address}/none`), fails('io'));
  const given = new AbortController();
  given.abort();
  await assert.rejects(open(`${address}/fast`, { signal: given.signal }), { name: 'AbortError' });
  const fromBlob = await open(new Blob([file('fast')]));
  assert.deepEqual(fromBlob.frame(5), whole.frame(5));
  for (const c of [clip, whole, fromBlob]) c.close();
});

test('a file plays while it arrives', async () => {
  const counts = [];
  const clip = await openStreaming(`${address}/fast`, { onProgress: (p) => counts.push(p.frameCount) });
  const early = clip.info.frameCount;
  const whole = await open(file('fast'));
  assert.deepEqual(clip.frame(0), whole.frame(0));
  await clip.complete;
  assert.ok(early > 0 && early < whole.info.frameCount);
  assert.equal(clip.info.frameCount, whole.info.frameCount);
  assert.deepEqual(counts, counts.slice().sort((a, b) => a - b));
  assert.deepEqual(clip.frame(whole.info.frameCount - 1), whole.frame(whole.info.frameCount - 1));
  clip.close();
  whole.close();
});

test('a connection that breaks leaves what has come', async () => {
  const clip = await openStreaming(`${address}/cut`);
  await assert.rejects(clip.complete);
  assert.ok(clip.frame(0).every(Number.isFinite));
  clip.close();
  const whole = file('fast');
  await assert.rejects(openStreaming(new Blob([whole.subarray(0, 60)])), (e) => e instanceof ReebError);
});

test('what has come before a stream fails is not lost, however late it is read', async () => {
  const whole = file('fast');
  const failing = new ReadableStream({
    start(control) {
      control.enqueue(whole.subarray(0, 5000));
      setTimeout(() => control.error(new Error('cut')), 0);
    },
  });
  const clip = await openStreaming(failing, { wasm: new URL('reeb.wasm?late', folder) }); // not compiled yet
  await assert.rejects(clip.complete, /cut/);
  assert.ok(clip.frame(0).every(Number.isFinite));
  clip.close();
});

test('opening ends where its signal says so', async () => {
  const control = new AbortController();
  const endless = new ReadableStream({ pull: () => new Promise(() => {}) });
  const opening = openStreaming(endless, { signal: control.signal });
  setTimeout(() => control.abort(), 20);
  await assert.rejects(opening, { name: 'AbortError' });
});

test('a worker gives the same frames', async () => {
  const clip = await worker.open(file('fast'));
  const whole = await open(file('fast'));
  assert.deepEqual(await clip.info(), whole.info);
  assert.deepEqual(await clip.triangles(0), whole.triangles(0));
  const first = await clip.frame(0);
  assert.deepEqual(first, whole.frame(0));
  assert.deepEqual(await clip.frame(1, first), whole.frame(1));
  assert.equal(first.length, 0); // handed over
  await assert.rejects(clip.frame(99), fails('invalid argument'));
  const asked = clip.frame(2);
  clip.close();
  await assert.rejects(asked, fails('invalid argument'));
  await assert.rejects(worker.open(new Uint8Array(100)), fails('corrupt'));
});

test('metadata, shots, groups', async () => {
  const clip = await open(file('shots'));
  const { shotCount, groupCount, frameCount } = clip.info;
  assert.ok(shotCount > 1);
  let next = 0;
  for (let i = 0; i < shotCount; ++i) {
    assert.equal(clip.shot(i).firstFrame, next);
    next = clip.shot(i).endFrame;
    assert.equal(clip.shotOfFrame(next - 1), i);
    assert.equal(clip.frame(next - 1).length, 3 * clip.shot(i).vertexCount);
  }
  assert.equal(next, frameCount);
  const frames = Array.from({ length: groupCount }, (_, i) => clip.group(i).frameCount);
  assert.equal(frames.reduce((a, b) => a + b), frameCount);
  assert.equal(Object.getPrototypeOf(clip.metadata), null);
  clip.close();
});

test('a file is fetched by ranges, no more of it than is needed', async () => {
  const whole = await open(file('fast'));
  const clip = await openRanges(`${address}/ranges`, { rangeBytes: 256 });
  const last = whole.info.frameCount - 1;
  assert.ok(whole.info.groupCount > 1);
  assert.equal(clip.info.frameCount, whole.info.frameCount);
  assert.throws(() => clip.frame(last), fails('need more data'));
  assert.deepEqual(await clip.fetching(() => clip.frame(last)), whole.frame(last));
  assert.deepEqual(clip.frame(last - 1), whole.frame(last - 1)); // of the same group
  const { bytesFetched, fileBytes } = clip.info;
  assert.ok(bytesFetched < fileBytes, `${bytesFetched} of ${fileBytes}`);
  await assert.rejects(clip.fetching(() => clip.frame(last + 1)), fails('invalid argument'));
  const there = await worker.openRanges(`${address}/ranges`, { rangeBytes: 256 });
  assert.deepEqual(await there.frame(last), whole.frame(last));
  const all = await openRanges(`${address}/fast`); // that server knows no ranges
  assert.ok(all.frame(0).every(Number.isFinite));
  await assert.rejects(openRanges(`${address}/changing`, { rangeBytes: 64 }), fails('io'));
  for (const c of [whole, clip, there, all]) c.close();
});

// Of one attribute, whether the render mesh has for each corner of each triangle what the corner has in the file.
function assertCorners(clip, mesh, attribute) {
  const { sizes, corners } = clip.polygons(0);
  const start = []; // of each face, among the corners
  sizes.reduce((at, size) => (start.push(at), at + size), 0);
  const given = clip.values(0, attribute);
  const made = mesh.values(0, attribute);
  const count = attribute.channels;
  const seen = new Map(); // triangles of each face so far
  mesh.sourceFaces.forEach((face, t) => {
    const k = seen.get(face) ?? 0;
    seen.set(face, k + 1);
    [0, k + 1, k + 2].forEach((corner, i) => {
      const at = start[face] + corner;
      const vertex = mesh.indices[3 * t + i];
      assert.equal(mesh.sourceVertices[vertex], corners[at]);
      const element = attribute.domain === 'corner' ? at : corners[at];
      assert.deepEqual(made.subarray(count * vertex, count * (vertex + 1)), given.subarray(count * element, count * (element + 1)));
    });
  });
}

test('a render mesh has the values of corners, and names its materials', async () => {
  const clip = await open(stream('core/attributes_texture'));
  const mesh = clip.renderMesh(0);
  const [coordinates, of] = clip.attributes;
  assert.equal(coordinates.semantic, 'texture coordinate');
  assertCorners(clip, mesh, coordinates);
  const xyz = clip.frame(1);
  const made = mesh.frame(1);
  mesh.sourceVertices.forEach((v, i) => assert.deepEqual(made.subarray(3 * i, 3 * i + 3), xyz.subarray(3 * v, 3 * v + 3)));
  assert.equal(mesh.ranges.reduce((sum, { count }) => sum + count, 0), mesh.sourceFaces.length);
  assert.deepEqual(mesh.ranges.map(({ name }) => name), ['skin', 'claw', 'eye']);
  assert.deepEqual(mesh.materialAttribute, of);
  const materials = clip.values(0, of);
  for (const { material, name, first, count } of mesh.ranges) {
    assert.ok(mesh.sourceFaces.subarray(first, first + count).every((face) => materials[face] === material));
    assert.equal(name, clip.nameOf(0, of, material));
  }
  mesh.close();
  assert.throws(() => mesh.frame(0), TypeError);
  clip.close();
});

test('poses have normals of length 1, of the file where it has some', async () => {
  const clip = await open(stream('core/attributes_normals'));
  const mesh = clip.renderMesh(0);
  const of = clip.attributes.find((a) => a.semantic === 'normal');
  assert.deepEqual(mesh.pose(1, of).normals, mesh.values(1, of).map(Math.fround));
  const { positions, normals } = mesh.pose(0.25, of);
  assert.deepEqual(positions, mesh.between(0.25));
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]);
    assert.ok(length === 0 || Math.abs(length - 1) < 1e-5);
  }
  const there = await worker.open(stream('core/attributes_normals'));
  const other = await there.renderMesh(0);
  assert.deepEqual(other.indices, mesh.indices);
  assert.deepEqual(await other.pose(0.25, of), { positions, normals });
  there.close();
  clip.close();
});

test('a box holds all frames, and close to', async () => {
  assert.equal((await open(file('main'))).bounds(), undefined);
  const clip = await open(stream('core/attributes_normals'));
  const box = clip.bounds();
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let t = 0; t < clip.info.frameCount; ++t) {
    clip.frame(t).forEach((x, i) => {
      low[i % 3] = Math.min(low[i % 3], x);
      high[i % 3] = Math.max(high[i % 3], x);
    });
  }
  for (let a = 0; a < 3; ++a) {
    const room = 0.01 * (high[a] - low[a]);
    assert.ok(box.low[a] <= low[a] && box.low[a] > low[a] - room);
    assert.ok(box.high[a] >= high[a] && box.high[a] < high[a] + room);
  }
  clip.close();
});

test('resources come as they were packed', async () => {
  const clip = await open(stream('core/attributes'));
  assert.deepEqual(clip.resources, [{ name: 'scene.mtl', mediaType: 'model/mtl' }]);
  assert.equal(new TextDecoder().decode(clip.resource(0)), 'newmtl\n');
  clip.close();
});
