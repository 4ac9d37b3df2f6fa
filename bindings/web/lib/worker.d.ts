import type { Attribute, Box, Group, Info, OpenOptions, Pose, RangesOptions, RenderMeshFixed, Resource, Shot, Source, StreamingOptions,
              Values } from './reeb.js';

export interface WorkerOptions extends OpenOptions {
  /** A worker that runs `worker_thread.js`, instead of a new one. */
  worker?: Worker;
  /** Buffers of `source` to hand over instead of copying them. */
  transfer?: Transferable[];
}

export class WorkerClip {
  private constructor();
  /** When all of the file is there. */
  readonly complete: Promise<void>;
  info(): Promise<Info>;
  metadata(): Promise<Record<string, string>>;
  attributes(): Promise<Attribute[]>;
  resources(): Promise<Resource[]>;
  resource(index: number): Promise<Uint8Array>;
  shot(index: number): Promise<Shot>;
  shotOfFrame(frame: number): Promise<number>;
  group(index: number): Promise<Group>;
  gap(index: number): Promise<{ firstFrame: number; frameCount: number }>;
  bounds(group?: number): Promise<Box | undefined>;
  triangles(frame: number): Promise<Uint32Array>;
  polygons(frame: number): Promise<{ sizes: Uint32Array; corners: Uint32Array }>;
  values(frame: number, attribute: Attribute): Promise<Values>;
  nameOf(frame: number, attribute: Attribute, value: number): Promise<string>;
  /** `reuse`: an array that an earlier frame came in; it is handed over. */
  frame(index: number, reuse?: Float32Array): Promise<Float32Array>;
  between(position: number, reuse?: Float32Array): Promise<Float32Array>;
  positionOfTime(seconds: number, loop?: boolean): Promise<number>;
  renderMesh(frame: number, splitBy?: Attribute[]): Promise<WorkerRenderMesh>;
  close(): void;
}

export interface WorkerRenderMesh extends RenderMeshFixed {
  frame(index: number, reuse?: Float32Array): Promise<Float32Array>;
  between(position: number, reuse?: Float32Array): Promise<Float32Array>;
  pose(position: number, of?: Attribute, reuse?: Pose): Promise<Pose>;
  values(frame: number, attribute: Attribute): Promise<Values>;
  close(): Promise<void>;
}

type Sendable = Exclude<Source, Response>;
export function open(source: Sendable, options?: WorkerOptions): Promise<WorkerClip>;
export function openStreaming(source: Sendable, options?: WorkerOptions & Pick<StreamingOptions, 'onProgress'>): Promise<WorkerClip>;
export function openRanges(url: string | URL, options?: WorkerOptions & RangesOptions): Promise<WorkerClip>;
