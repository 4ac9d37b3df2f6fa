// decode_stream.mjs PACKAGE STREAM OUT: what conformance/README.md describes, by the web package.
import { readFileSync, writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const EXIT_CODES = { ok: 0, corrupt: 3, truncated: 4, unsupported: 5, 'limit exceeded': 6 };
const [folder, stream, out] = process.argv.slice(2);
const { open } = await import(pathToFileURL(`${folder}/reeb.js`));

const words = (...numbers) => new Uint8Array(Uint32Array.from(numbers).buffer);
const bytesOf = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
const parts = [];
let result = 'ok';
const fails = (code) => (result = result === 'ok' ? code : result);

function attempt(work) {
  try {
    work();
    return true;
  } catch (error) {
    if (!error.code) throw error;
    fails(error.code);
    return false;
  }
}

function writeFrame(clip, t) {
  const { sizes, corners } = clip.polygons(t);
  const positions = clip.frame(t);
  parts.push(words(t, positions.length / 3, sizes.length, corners.length), bytesOf(sizes), bytesOf(corners),
             bytesOf(positions));
}

function writeAttributes(clip, t, written) {
  const shot = clip.shotOfFrame(t);
  for (const attribute of clip.attributes.filter((a) => a.shot === shot)) {
    const key = `${shot} ${attribute.index}`;
    if (!attribute.animated && written.has(key)) continue;
    written.add(key);
    attempt(() => {
      const values = bytesOf(clip.values(t, attribute));
      parts.push(words(0xffffffff, t, attribute.index, values.length), values);
    });
  }
}

try {
  const clip = await open(readFileSync(stream));
  if (clip.info.truncated) fails('truncated');
  const written = new Set();
  for (let t = 0; t < clip.info.totalFrames; ++t) {
    if (attempt(() => writeFrame(clip, t))) writeAttributes(clip, t, written);
  }
} catch (error) {
  if (!error.code) throw error;
  fails(error.code);
}
writeFileSync(out, Buffer.concat(parts));
process.exitCode = EXIT_CODES[result] ?? 1;
