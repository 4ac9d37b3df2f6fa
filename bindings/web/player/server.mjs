// A server of static files for tests: ranges, a pace (`?pace=BYTES` a second) and connections that break (`?cut=BYTES`).
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json',
                '.wasm': 'application/wasm', '.reeb': 'model/vnd.reeb' };

/** Serves the folders, the first that has a file; gives its address and how to end it. */
export async function serve(...folders) {
  const server = createServer((request, answer) => respond(folders, request, answer));
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { address: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}

function respond(folders, request, answer) {
  const { pathname, searchParams } = new URL(request.url, 'http://localhost');
  const path = normalize(pathname === '/' ? '/index.html' : decodeURIComponent(pathname));
  const file = folders.map((folder) => join(folder, path)).find((name) => existsSync(name));
  if (!file) return answer.writeHead(404).end();
  const { size } = statSync(file);
  const [first, last] = range(request, size);
  const headers = { 'content-type': TYPES[extname(file)] ?? 'application/octet-stream', 'content-length': last - first + 1,
                    'accept-ranges': 'bytes' };
  if (request.headers.range) headers['content-range'] = `bytes ${first}-${last}/${size}`;
  answer.writeHead(request.headers.range ? 206 : 200, headers);
  send(createReadStream(file, { start: first, end: last, highWaterMark: 1024 }), answer, searchParams);
}

function range(request, size) {
  const asked = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? '');
  return asked ? [Number(asked[1]), Math.min(size - 1, asked[2] === '' ? Infinity : Number(asked[2]))] : [0, size - 1];
}

async function send(bytes, answer, asked) {
  let sent = 0;
  for await (const piece of bytes) {
    if (asked.has('cut') && sent >= Number(asked.get('cut'))) {
      setTimeout(() => answer.destroy(), 200); // what is sent should be there
      return;
    }
    answer.write(piece);
    sent += piece.length;
    if (asked.has('pace')) await new Promise((resolve) => setTimeout(resolve, (1000 * piece.length) / Number(asked.get('pace'))));
  }
  answer.end();
}
