// The page: files, time, what is shown of them.
import { LoopOnce, LoopRepeat, RepeatWrapping, SRGBColorSpace, Texture } from 'three';
import { ReebLoader } from 'reeb/three';

import { shares, sizes } from './colours.js';
import { distances } from './compare.js';
import { Stage } from './stage.js';
import { drawGroups, listFacts } from './statistics.js';

const at = (id) => document.getElementById(id);
const stage = new Stage(at('canvas'));
const state = { meshes: [], sizes: [], groups: [], attribute: undefined, drawn: 0, rate: 0, since: 0, painted: -1 };

async function load(source, name) {
  say(`Opening ${name} …`);
  const loader = new ReebLoader().setStreaming(true);
  try {
    const { url, bytes } = source instanceof Blob ? { url: URL.createObjectURL(source), bytes: source.size } : { url: source };
    const mesh = await loader.loadAsync(url);
    mesh.name = name;
    if (bytes) mesh.complete.finally(() => URL.revokeObjectURL(url)).catch(() => {});
    return mesh;
  } catch (error) {
    say(`${name}: ${error.message}`, true);
    throw error;
  }
}

async function openFirst(source, name) {
  const mesh = await load(source, name);
  for (const old of state.meshes) old.dispose();
  state.meshes = [mesh];
  shown();
}

async function openSecond(source, name) {
  if (state.meshes.length === 0) return openFirst(source, name);
  const mesh = await load(source, name);
  const [first, old] = state.meshes;
  old?.dispose();
  state.meshes = [first, mesh];
  shown();
}

function shown() {
  state.painted = -1;
  state.attribute = undefined;
  say('');
  stage.show(...state.meshes);
  at('drop').hidden = true;
  at('captions').hidden = state.meshes.length < 2;
  for (const id of ['time', 'back', 'play', 'forward']) at(id).disabled = false;
  for (const mesh of state.meshes) {
    mesh.addEventListener('arrival', arrived);
    mesh.complete.catch((error) => say(`${mesh.name}: ${error.message}`, true));
  }
  const [mesh] = state.meshes;
  at('canvas').setAttribute('aria-label', `${mesh.name}: ${mesh.info.maxVertices} vertices, ${mesh.info.totalFrames} frames`);
  listShadings(mesh);
  setLoop();
  setPlaying(true);
  arrived();
}

async function arrived() {
  const [mesh] = state.meshes;
  at('time').max = Math.max(0, mesh.frameCount - 1);
  const groups = await mesh.groups().catch(() => []);
  if (mesh !== state.meshes[0]) return;
  state.groups = groups;
  drawGroups(at('groups'), groups, mesh.info);
  facts();
}

function listShadings(mesh) {
  const select = at('shading');
  while (select.options.length > 2) select.remove(2);
  mesh.attributes
    .filter((a) => ['vertex', 'corner'].includes(a.domain) && a.semantic !== 'index')
    .forEach((a) => select.add(new Option(`${a.name} (${a.semantic})`, `values:${a.index}`)));
  if (mesh.geometry.attributes.uv) {
    mesh.resources.forEach(({ name, mediaType }, i) => mediaType.startsWith('image/') && select.add(new Option(`texture: ${name}`, `texture:${i}`)));
  }
  select.value = 'smooth';
  stage.look({ shading: 'smooth' });
}

async function setShading() {
  const [shading, index] = at('shading').value.split(':');
  const [mesh] = state.meshes;
  state.attribute = shading === 'values' ? mesh?.attributes.find((a) => a.index === Number(index)) : undefined;
  state.painted = -1;
  await paint();
  if (shading === 'texture') stage.look({ texture: await textureOf(mesh.resources[index]) });
  stage.look({ shading });
}

async function textureOf(resource) {
  const image = new Blob([await resource.bytes()], { type: resource.mediaType });
  const texture = new Texture(await createImageBitmap(image, { imageOrientation: 'flipY' })); // v goes up
  Object.assign(texture, { flipY: false, colorSpace: SRGBColorSpace, wrapS: RepeatWrapping, wrapT: RepeatWrapping, needsUpdate: true });
  return texture;
}

// Colours follow the pose; one at a time.
let painting = false;
async function paint() {
  const [mesh, other] = state.meshes;
  if (painting || !mesh || mesh.shownPosition === state.painted) return;
  painting = true;
  state.painted = mesh.shownPosition;
  try {
    if (state.attribute) {
      const values = await mesh.values(state.attribute);
      const { low, high, shares: colours } = shares(sizes(values, state.attribute.channels));
      if (mesh === state.meshes[0] && colours.length === mesh.geometry.attributes.position.count) stage.paint(mesh, colours);
      state.range = `${low.toPrecision(3)} … ${high.toPrecision(3)}`;
    }
    if (other) paintDistances(mesh, other);
  } finally {
    painting = false;
  }
}

function paintDistances(mesh, other) {
  const far = distances(other, mesh);
  const diagonal = mesh.sphere.radius * 2;
  state.largest = far ? far.reduce((a, b) => Math.max(a, b), 0) / diagonal : undefined;
  const whole = state.largest || 1;
  stage.paint(other, far ? far.map((x) => x / diagonal / whole) : new Float32Array(other.sourceVertices.length));
}

function facts() {
  listFacts(at('facts'), state);
}

function setPlaying(on) {
  for (const mesh of state.meshes) on ? mesh.play() : mesh.pause();
  at('play').textContent = on ? 'Pause' : 'Play';
  at('play').setAttribute('aria-pressed', String(on));
}

function setLoop() {
  for (const mesh of state.meshes) mesh.loop = at('loop').checked ? LoopRepeat : LoopOnce;
}

function setSpeed() {
  for (const mesh of state.meshes) mesh.speed = Number(at('speed').value) * (at('reverse').checked ? -1 : 1);
}

function go(frame) {
  const [mesh] = state.meshes;
  if (!mesh) return;
  const place = Math.min(Math.max(frame, 0), mesh.frameCount - 1);
  for (const each of state.meshes) each.seek(Math.min(place, each.frameCount - 1) / each.frameRate).catch(fail);
}

function step(frames) {
  setPlaying(false);
  go(Math.round(state.meshes[0]?.shownPosition ?? 0) + frames);
}

function togglePlaying() {
  const [mesh] = state.meshes;
  if (!mesh) return;
  const atEnd = mesh.loop === LoopOnce && !mesh.playing && mesh.time >= mesh.duration;
  if (atEnd) go(0);
  setPlaying(!mesh.playing);
}

function say(text, lasting = false) {
  at('message').textContent = text;
  at('message').hidden = text === '';
  if (lasting) setTimeout(() => at('message').textContent === text && say(''), 8000);
}

function fail(error) {
  setPlaying(false);
  say(error.message, true);
}

let before = performance.now();
function draw(now) {
  const delta = Math.min(0.25, (now - before) / 1000);
  before = now;
  setSpeed();
  const [mesh, other] = state.meshes;
  if (mesh) {
    const wasPlaying = mesh.playing;
    mesh.update(delta).catch(fail);
    other?.seek(Math.min(mesh.time, other.duration)).catch(fail);
    if (wasPlaying && !mesh.playing) setPlaying(false);
    if (mesh.shownPosition >= 0 && document.activeElement !== at('time')) at('time').value = mesh.shownPosition;
    const text = `frame ${Math.round(mesh.shownPosition) + 1} of ${mesh.frameCount}, ${mesh.time.toFixed(2)} s`;
    at('clock').textContent = text;
    at('time').setAttribute('aria-valuetext', text);
    if (state.attribute || other) paint().catch(fail);
    count(now);
  }
  stage.draw();
  requestAnimationFrame(draw);
}

function count(now) {
  ++state.drawn;
  if (now - state.since < 1000) return;
  state.rate = (1000 * state.drawn) / (now - state.since);
  Object.assign(state, { since: now, drawn: 0 });
  facts();
}

const KEYS = {
  ' ': togglePlaying,
  ArrowLeft: () => step(-1),
  ArrowRight: () => step(1),
  Home: () => go(0),
  End: () => go(Infinity),
  r: () => at('reverse').click(),
  l: () => at('loop').click(),
  w: () => at('wireframe').click(),
  f: () => stage.frameAll(),
};

addEventListener('keydown', (event) => {
  const typing = event.target.matches?.('select, input:not([type=range]), button') && event.key === ' ';
  const call = KEYS[event.key] ?? KEYS[event.key.toLowerCase()];
  if (!call || typing || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.target.matches?.('select')) return;
  event.preventDefault();
  call();
});

const opened = (input, open) => at(input).addEventListener('change', () => {
  const [file] = at(input).files;
  if (file) open(file, file.name).catch(() => {});
  at(input).value = '';
});
opened('file', openFirst);
opened('other', openSecond);

at('play').addEventListener('click', togglePlaying);
at('back').addEventListener('click', () => step(-1));
at('forward').addEventListener('click', () => step(1));
at('loop').addEventListener('change', setLoop);
at('time').addEventListener('input', () => go(Number(at('time').value)));
at('time').addEventListener('change', () => at('time').blur());
at('shading').addEventListener('change', () => setShading().catch(fail));
at('wireframe').addEventListener('change', () => stage.look({ wireframe: at('wireframe').checked }));
addEventListener('resize', () => state.meshes[0] && drawGroups(at('groups'), state.groups, state.meshes[0].info));

for (const type of ['dragover', 'drop', 'dragleave']) {
  addEventListener(type, (event) => {
    event.preventDefault();
    at('view').classList.toggle('over', type === 'dragover');
    const [first, second] = event.dataTransfer?.files ?? [];
    if (type !== 'drop' || !first) return;
    const wanted = event.shiftKey ? openSecond(first, first.name) : openFirst(first, first.name);
    wanted.then(() => second && openSecond(second, second.name)).catch(() => {});
  });
}

// samples.json: names and files that the page comes with; ?file=ADDRESS&with=ADDRESS opens others.
async function start() {
  const samples = await fetch('samples.json').then((answer) => (answer.ok ? answer.json() : []), () => []);
  for (const { name, file } of samples) {
    const link = Object.assign(document.createElement('a'), { href: `?file=${encodeURIComponent(file)}`, textContent: name });
    at('samples').append(link);
  }
  const asked = new URLSearchParams(location.search);
  const file = asked.get('file') ?? samples[0]?.file;
  if (file) await openFirst(file, nameOf(file));
  if (asked.has('with')) await openSecond(asked.get('with'), nameOf(asked.get('with')));
}

function nameOf(address) {
  return decodeURIComponent(address.split('/').at(-1));
}

globalThis.reebPlayer = state; // for tests and the curious
requestAnimationFrame(draw);
start().catch(() => {});
