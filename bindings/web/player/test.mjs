// node --test: the page in Chromium. REEB_PAGE: the folder of the built page; pictures go to REEB_PICTURES, if given.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { after, before, test } from 'node:test';
import { writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { distances } from './src/compare.js';
import { serve } from './server.mjs';

const page = process.env.REEB_PAGE;
const { chromium } = createRequire(join(page, '../node_modules/'))('playwright-core');
const data = fileURLToPath(new URL('../../../tests/codec/data', import.meta.url));
let server;
let browser;

before(async () => {
  server = await serve(page, data, join(page, '../player/square'));
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
                                    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
});
after(async () => {
  await browser?.close();
  server?.close();
});

const desktop = { width: 1100, height: 700 };
const phone = { width: 390, height: 780 };

// A page with a file; `problems` is what goes wrong on it.
async function opened(query, options = {}) {
  const context = await browser.newContext({ viewport: desktop, ...options });
  context.setDefaultTimeout(40000);
  const tab = await context.newPage();
  tab.problems = [];
  tab.on('pageerror', (error) => tab.problems.push(error.message));
  await tab.goto(`${server.address}/${query}`);
  return tab;
}

const ready = (tab) => tab.waitForFunction(() => globalThis.reebPlayer?.meshes[0]?.shownPosition >= 0);
const position = (tab) => tab.evaluate(() => globalThis.reebPlayer.meshes[0].shownPosition);

async function picture(tab, name) {
  const bytes = await tab.screenshot();
  if (process.env.REEB_PICTURES) writeFileSync(join(process.env.REEB_PICTURES, `${name}.png`), bytes);
}

// How many colours the canvas has, roughly: an empty one has one.
function colours(tab) {
  return tab.evaluate(() => {
    const from = document.getElementById('canvas');
    const small = Object.assign(document.createElement('canvas'), { width: 64, height: 64 });
    const context = small.getContext('2d');
    context.drawImage(from, 0, 0, 64, 64);
    const { data } = context.getImageData(0, 0, 64, 64);
    return new Set(Array.from({ length: 64 * 64 }, (_, i) => data.slice(4 * i, 4 * i + 4).join())).size;
  });
}

test('a sample plays, and every control does what it says', async () => {
  const tab = await opened('');
  await ready(tab);
  const first = await position(tab);
  await tab.waitForFunction((from) => globalThis.reebPlayer.meshes[0].shownPosition !== from, first);
  await tab.keyboard.press('Space');
  assert.equal(await tab.textContent('#play'), 'Play');
  await tab.keyboard.press('Home');
  await tab.waitForFunction(() => globalThis.reebPlayer.meshes[0].shownPosition === 0);
  await tab.keyboard.press('ArrowRight');
  await tab.waitForFunction(() => globalThis.reebPlayer.meshes[0].shownPosition === 1);
  await tab.click('#forward');
  await tab.waitForFunction(() => globalThis.reebPlayer.meshes[0].shownPosition === 2);
  await tab.fill('#time', '7');
  await tab.waitForFunction(() => Math.abs(globalThis.reebPlayer.meshes[0].shownPosition - 7) < 1e-6);
  await tab.waitForFunction(() => document.getElementById('clock').textContent.startsWith('frame 8 of'));
  assert.ok((await colours(tab)) > 20, 'something is drawn');
  await tab.selectOption('#shading', 'normals');
  await tab.keyboard.press('w');
  assert.ok(await tab.isChecked('#wireframe'));
  assert.match(await tab.textContent('#facts'), /vertices/);
  assert.deepEqual(tab.problems, []);
  await tab.context().close();
});

for (const [name, viewport, colorScheme] of [['desktop', desktop, 'light'], ['desktop-dark', desktop, 'dark'], ['phone', phone, 'light'], ['phone-dark', phone, 'dark']]) {
  test(`it fits: ${name}`, async () => {
    const tab = await opened('', { viewport, colorScheme });
    await ready(tab);
    await tab.click('#play');
    await tab.fill('#time', '12');
    await tab.waitForFunction(() => Math.abs(globalThis.reebPlayer.meshes[0].shownPosition - 12) < 1e-6);
    await tab.waitForTimeout(300);
    const wide = await tab.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(wide <= 0, `${wide} pixels too wide`);
    await picture(tab, name);
    await tab.setViewportSize({ width: viewport.width - 60, height: viewport.height - 40 });
    await tab.waitForFunction(() => Math.abs(document.getElementById('canvas').width / devicePixelRatio - document.getElementById('canvas').clientWidth) <= 1);
    await tab.context().close();
  });
}

test('a texture is the right way up', async () => {
  const tab = await opened('?file=square.reeb');
  await ready(tab);
  await tab.click('#play');
  await tab.selectOption('#shading', { label: 'texture: four.png' });
  await tab.waitForTimeout(1000);
  await picture(tab, 'texture');
  // Of each colour the middle of its pixels, from the left and from above.
  const middles = await tab.evaluate(() => {
    const from = document.getElementById('canvas');
    const small = Object.assign(document.createElement('canvas'), { width: 200, height: 200 });
    const context = small.getContext('2d');
    context.drawImage(from, 0, 0, 200, 200);
    const { data } = context.getImageData(0, 0, 200, 200);
    const sums = {};
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b, a] = data.subarray(i, i + 4);
      const name = a < 200 ? '' : r > 2 * g && r > 2 * b ? 'red' : g > 2 * r && g > 2 * b ? 'green' : b > 2 * r && b > 2 * g ? 'blue' : '';
      sums[name] ??= [0, 0, 0];
      [(i / 4) % 200, Math.floor(i / 800), 1].forEach((x, k) => (sums[name][k] += x));
    }
    return Object.fromEntries(Object.entries(sums).map(([name, [x, y, n]]) => [name, [x / n, y / n]]));
  });
  const { red, green, blue } = middles;
  assert.ok(red[0] < green[0] - 5 && Math.abs(red[1] - green[1]) < 30, 'red is to the left of green');
  assert.ok(red[1] < blue[1] - 5 && Math.abs(red[0] - blue[0]) < 30, 'red is above blue');
  await tab.context().close();
});

test('distances are those of the vertices of the files', () => {
  const mesh = (sourceVertices, ...xyz) => ({ sourceVertices: Uint32Array.from(sourceVertices),
                                              geometry: { attributes: { position: { array: Float32Array.from(xyz.flat()) } } } });
  const first = mesh([0, 1, 0], [0, 0, 0], [1, 0, 0], [0, 0, 0]); // vertex 0 is split
  const other = mesh([1, 0], [1, 3, 4], [0, 0, 2]);
  assert.deepEqual(distances(first, other), Float32Array.of(2, 5, 2));
  assert.deepEqual(distances(other, first), Float32Array.of(5, 2));
  assert.equal(distances(first, mesh([0], [0, 0, 0])), undefined);
});

test('two files are compared', async () => {
  const tab = await opened('?file=main.reeb&with=main.reeb');
  await ready(tab);
  await tab.waitForFunction(() => globalThis.reebPlayer.meshes.length === 2 && globalThis.reebPlayer.largest !== undefined);
  assert.match(await tab.textContent('#facts'), /largest distance/);
  await picture(tab, 'compare');
  await tab.context().close();
});

test('a file plays while it arrives', async () => {
  const tab = await opened('?file=' + encodeURIComponent('fast.reeb?pace=1500'));
  await ready(tab);
  const early = await tab.evaluate(() => globalThis.reebPlayer.meshes[0].frameCount);
  await tab.waitForFunction((count) => globalThis.reebPlayer.meshes[0].frameCount > count, early);
  assert.deepEqual(tab.problems, []);
  await tab.context().close();
});

test('a connection that breaks is told, and what has come plays', async () => {
  const tab = await opened('?file=' + encodeURIComponent('fast.reeb?cut=4096'));
  await ready(tab);
  await tab.waitForFunction(() => !document.getElementById('message').hidden);
  assert.match(await tab.textContent('#message'), /fast\.reeb/);
  await tab.context().close();
});

test('a file that is dropped plays, a broken one is told', async () => {
  const tab = await opened('');
  await ready(tab);
  const drop = (name, bytes) => tab.evaluate(([called, list]) => {
    const files = new DataTransfer();
    files.items.add(new File([Uint8Array.from(list)], called));
    dispatchEvent(new DragEvent('drop', { dataTransfer: files, bubbles: true }));
  }, [name, bytes]);
  await drop('broken.reeb', Array(200).fill(7));
  await tab.waitForFunction(() => document.getElementById('message').textContent.startsWith('broken.reeb: not a Reeb file'));
  const whole = await (await fetch(`${server.address}/shots.reeb`)).arrayBuffer();
  await drop('shots.reeb', Array.from(new Uint8Array(whole)));
  await tab.waitForFunction(() => globalThis.reebPlayer.meshes[0].name === 'shots.reeb');
  await picture(tab, 'dropped');
  assert.deepEqual(tab.problems, []);
  await tab.context().close();
});

test('the package gives the same bits in the browser as under node', async () => {
  const tab = await opened('?file=fast.reeb');
  await ready(tab);
  await tab.click('#play');
  const frame = 5;
  await tab.fill('#time', String(frame));
  await tab.waitForFunction((t) => globalThis.reebPlayer.meshes[0].shownPosition === t, frame);
  const given = await tab.evaluate(() => Array.from(globalThis.reebPlayer.meshes[0].geometry.attributes.position.array));
  const { open } = await import(join(page, '../package/reeb.js'));
  const clip = await open(new Uint8Array(await (await fetch(`${server.address}/fast.reeb`)).arrayBuffer()));
  assert.deepEqual(Float32Array.from(given), clip.renderMesh(frame).frame(frame));
  clip.close();
  await tab.context().close();
});

test('the example plays', async () => {
  const example = await serve(fileURLToPath(new URL('../../../examples/web', import.meta.url)), join(page, '..'), data);
  const tab = await (await browser.newContext({ viewport: desktop })).newPage();
  tab.setDefaultTimeout(40000);
  const problems = [];
  tab.on('pageerror', (error) => problems.push(error.message));
  await tab.goto(`${example.address}/?file=fast.reeb`);
  await tab.waitForSelector('canvas');
  await tab.waitForTimeout(1500);
  const shots = [await tab.screenshot()];
  await tab.waitForTimeout(700);
  shots.push(await tab.screenshot());
  assert.ok(!shots[0].equals(shots[1]), 'it moves');
  assert.deepEqual(problems, []);
  await tab.context().close();
  example.close();
});
