// node --test: the loader for three.js, without drawing.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { after, test } from 'node:test';
import { pathToFileURL } from 'node:url';

const folder = pathToFileURL(`${process.env.REEB_PACKAGE}/`);
const { open } = await import(new URL('reeb.js', folder));
const { ReebLoader } = await import(new URL('three.js', folder));
const THREE = await import(new URL('../node_modules/three/build/three.module.js', folder));
const bytesOf = (name) => new Uint8Array(readFileSync(new URL(`../../../${name}.reeb`, import.meta.url)));
const fast = 'tests/codec/data/fast';
const shots = 'tests/codec/data/shots';
const texture = 'conformance/streams/core/attributes_texture';
const local = () => new ReebLoader().setWorkerLimit(0);

// `?later` sends the last bytes when they are wanted.
let wantRest;
const restIsWanted = new Promise((resolve) => (wantRest = resolve));
const server = createServer(async (request, answer) => {
  if (request.headers['x-key'] !== '7') return answer.writeHead(403).end();
  const bytes = bytesOf(fast);
  answer.writeHead(200, { 'content-length': bytes.length });
  const most = bytes.length - 400;
  answer.write(bytes.subarray(0, most));
  if (request.url.endsWith('?later')) await restIsWanted;
  return answer.end(bytes.subarray(most));
});
await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
const address = `http://127.0.0.1:${server.address().port}/walk.reeb`;
after(() => server.close());

// Vertices without a face are not shown.
function assertShows(mesh, positions) {
  const { array } = mesh.geometry.attributes.position;
  assert.ok(mesh.sourceVertices.length > 0);
  const at = Array.from(mesh.sourceVertices, (v) => [positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]]);
  assert.deepEqual(array, Float32Array.from(at.flat()));
}

test('a mesh shows the pose of its time', async () => {
  const mesh = await local().parse(bytesOf(fast));
  const clip = await open(bytesOf(fast));
  assert.equal(mesh.frameCount, clip.info.frameCount);
  assert.equal(mesh.duration, mesh.frameCount / mesh.frameRate);
  assertShows(mesh, clip.frame(0));
  mesh.update(2.5 / mesh.frameRate);
  assert.ok(Math.abs(mesh.shownPosition - 2.5) < 1e-9);
  assertShows(mesh, clip.between(mesh.shownPosition));
  mesh.speed = -1;
  mesh.update(1 / mesh.frameRate);
  assert.ok(Math.abs(mesh.shownPosition - 1.5) < 1e-9);
  assertShows(mesh, clip.between(mesh.shownPosition));
  mesh.pause().update(1);
  assert.ok(Math.abs(mesh.shownPosition - 1.5) < 1e-9);
  mesh.dispose();
  clip.close();
});

test('a loop goes around, and once ends with an event', async () => {
  const mesh = await local().parse(bytesOf(fast));
  mesh.update(mesh.duration + 3 / mesh.frameRate);
  assert.ok(Math.abs(mesh.shownPosition - 3) < 1e-9);
  mesh.loop = THREE.LoopOnce;
  let finished = 0;
  mesh.addEventListener('finished', () => ++finished);
  mesh.update(mesh.duration);
  assert.equal(finished, 1);
  assert.equal(mesh.shownPosition, mesh.frameCount - 1);
  assert.equal(mesh.playing, false);
  mesh.dispose();
});

test('a worker shows the same, the newest wish last', async () => {
  const mesh = await new ReebLoader().parse(bytesOf(fast));
  const clip = await open(bytesOf(fast));
  await mesh.showPosition(4);
  assertShows(mesh, clip.frame(4));
  for (let t = 0; t < 8; t += 0.5) mesh.showPosition(t);
  await mesh.showPosition(6.5);
  assert.equal(mesh.shownPosition, 6.5);
  assertShows(mesh, clip.between(6.5));
  mesh.dispose();
  clip.close();
});

test('instances have times of their own and one decoder', async () => {
  const mesh = await local().parse(bytesOf(fast));
  const other = mesh.instance();
  const third = mesh.clone();
  mesh.showPosition(1);
  other.showPosition(5);
  const clip = await open(bytesOf(fast));
  assertShows(mesh, clip.frame(1));
  assertShows(other, clip.frame(5));
  assert.equal(other.material, mesh.material);
  mesh.dispose();
  third.dispose();
  other.showPosition(2);
  assertShows(other, clip.frame(2));
  other.dispose();
  assert.throws(() => other.showPosition(3));
  clip.close();
});

test('shots bring geometries of their own', async () => {
  const mesh = await local().parse(bytesOf(shots));
  const clip = await open(bytesOf(shots));
  assert.ok(clip.info.shotCount > 1);
  for (const t of [0, clip.info.frameCount - 1, 0]) {
    mesh.showPosition(t);
    assertShows(mesh, clip.frame(t));
    assert.ok(Math.max(...mesh.geometry.index.array) < mesh.geometry.attributes.position.count);
  }
  mesh.dispose();
  clip.close();
});

test('materials are named, texture coordinates are uv', async () => {
  const mesh = await local().parse(bytesOf(texture));
  assert.deepEqual(mesh.material.map((m) => m.name), ['skin', 'claw', 'eye']);
  assert.deepEqual(mesh.geometry.groups.map((g) => g.materialIndex), [0, 1, 2]);
  assert.equal(mesh.geometry.groups.reduce((sum, g) => sum + g.count, 0), mesh.geometry.index.count);
  assert.equal(mesh.geometry.attributes.uv.itemSize, 2);
  assert.equal(mesh.geometry.attributes.uv.count, mesh.geometry.attributes.position.count);
  mesh.dispose();
});

test('rays hit the pose that is shown, and the box holds all of them', async () => {
  const mesh = await local().parse(bytesOf(fast));
  const [a, b, c] = [0, 1, 2].map(() => new THREE.Vector3());
  for (let t = 0; t < mesh.frameCount; ++t) {
    mesh.showPosition(t);
    const { position } = mesh.geometry.attributes;
    for (let i = 0; i < position.count; ++i) assert.ok(mesh.box.containsPoint(a.fromBufferAttribute(position, i)));
    [a, b, c].forEach((v, k) => v.fromBufferAttribute(position, mesh.geometry.index.getX(k)));
    const middle = a.clone().add(b).add(c).divideScalar(3);
    const normal = b.clone().sub(a).cross(c.clone().sub(a)).normalize();
    const ray = new THREE.Raycaster(middle.clone().addScaledVector(normal, 1e-3), normal.clone().negate());
    const [hit] = ray.intersectObject(mesh);
    assert.ok(hit && hit.point.distanceTo(middle) < 1e-4, `frame ${t}`);
  }
  mesh.dispose();
});

test('a file is loaded with its headers, or its failure is told', async () => {
  const manager = new THREE.LoadingManager();
  const events = [];
  manager.onError = (url) => events.push(url);
  const loader = new ReebLoader(manager).setRequestHeader({ 'x-key': '7' });
  const progress = [];
  const mesh = await loader.loadAsync(address, (event) => progress.push(event.loaded));
  assert.equal(progress.at(-1), bytesOf(fast).length);
  mesh.dispose();
  await assert.rejects(new ReebLoader(manager).loadAsync(address), /403/);
  assert.deepEqual(events, [address]);
  await assert.rejects(loader.parse(new Uint8Array(100)), { code: 'corrupt' });
});

test('a mesh grows while its file arrives', async () => {
  const loader = new ReebLoader().setRequestHeader({ 'x-key': '7' }).setStreaming(true);
  const mesh = await loader.loadAsync(`${address}?later`);
  const early = mesh.frameCount;
  const ended = new Promise((resolve) => mesh.addEventListener('arrival', (event) => event.complete && resolve()));
  wantRest();
  await ended;
  const clip = await open(bytesOf(fast));
  assert.ok(early < clip.info.frameCount);
  assert.equal(mesh.frameCount, clip.info.frameCount);
  await mesh.showPosition(mesh.frameCount - 1);
  assertShows(mesh, clip.frame(mesh.frameCount - 1));
  mesh.dispose();
  clip.close();
});
