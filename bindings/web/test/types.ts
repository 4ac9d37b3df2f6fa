// Compiled, not run: the types let through what they should, and nothing else.
import { Scene } from 'three';
import { open, openRanges, openStreaming, ReebError, type Attribute, type Clip } from 'reeb';
import { ReebLoader, ReebMesh } from 'reeb/three';
import * as worker from 'reeb/worker';

const clip: Clip = await open(new Uint8Array(8), { signal: AbortSignal.timeout(10), maxMemory: 2 ** 20 });
const xyz: Float32Array = clip.frame(0);
const wanted: Attribute | undefined = clip.attributes.find((a) => a.semantic === 'texture coordinate');
const mesh = clip.renderMesh(0, wanted ? [wanted] : undefined);
mesh.between(0.5, xyz);
const later: Float32Array = await clip.fetching((c) => c.frame(3));
(await openRanges('a.reeb', { rangeBytes: 4096 })).close();
(await openStreaming(new Blob([]), { onProgress: ({ bytes }) => bytes.toFixed() })).complete.catch((e: ReebError) => e.code === 'corrupt');

const there = await worker.open('a.reeb');
const pose = await (await there.renderMesh(0)).pose(1.5);
await there.frame(1, pose.positions);

const shown: ReebMesh = await new ReebLoader().setWorkerLimit(2).setStreaming(true).loadAsync('a.reeb');
new Scene().add(shown.instance());
await shown.update(later.length);

// @ts-expect-error: a clip has no setter for its info
clip.info = undefined;
// @ts-expect-error: frames are numbers
clip.frame('first');
// @ts-expect-error: a worker's answers are promises
there.frame(0).length;
