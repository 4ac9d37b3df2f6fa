/** What a stream may be: bytes, a file, an answer, or where one is to be fetched from. */
export type Source = Uint8Array | ArrayBuffer | Blob | Response | string | URL;

export interface OpenOptions {
  /** Where the WebAssembly is, or the module; the package's own where not given. */
  wasm?: string | URL | WebAssembly.Module;
  /** Bytes that decoding may take at once; 2^30. */
  maxMemory?: number;
  /** Ends opening, and the arrival of a file. */
  signal?: AbortSignal;
  /** Of requests for an address. */
  headers?: HeadersInit;
  credentials?: RequestCredentials;
}

export interface RangesOptions extends OpenOptions {
  /** Bytes that a request asks for at least; 65,536. */
  rangeBytes?: number;
}

export interface StreamingOptions extends OpenOptions {
  onProgress?(progress: { bytes: number; frameCount: number }): void;
}

export type ErrorCode =
  | 'invalid argument' | 'corrupt' | 'truncated' | 'unsupported' | 'limit exceeded' | 'io' | 'cancelled'
  | 'out of memory' | 'need more data';

/** Why something failed; `message` is a sentence for people. */
export class ReebError extends Error {
  readonly code: ErrorCode;
}

export interface Info {
  formatVersion: number;
  /** Up to the last frame that can be decoded. */
  frameCount: number;
  /** Of the sequence as it was encoded. */
  totalFrames: number;
  shotCount: number;
  groupCount: number;
  gapCount: number;
  maxVertices: number;
  truncated: boolean;
  /** Frames a second; 0 where unknown. */
  frameRate: number;
  startTime: number;
  fileBytes: number;
  /** Fewer than `fileBytes` of a file that is fetched by ranges. */
  bytesFetched: number;
}

export interface Shot {
  firstFrame: number;
  endFrame: number;
  frameCount: number;
  vertexCount: number;
  faceCount: number;
  orderKept: boolean;
}

export interface Group {
  firstFrame: number;
  frameCount: number;
  shot: number;
  componentCount: number;
  regionCount: number;
  bytes: number;
}

export interface Attribute {
  shot: number;
  index: number;
  name: string;
  semantic: 'generic' | 'texture coordinate' | 'normal' | 'tangent' | 'colour' | 'velocity' | 'material' | 'group'
    | 'index';
  domain: 'vertex' | 'corner' | 'face' | 'shot';
  type: 'binary32' | 'u8' | 'u16' | 'i32' | 'u8 normalised' | 'u16 normalised';
  channels: number;
  animated: boolean;
  computed: boolean;
  bytes: number;
}

export type Values = Float32Array | Uint8Array | Uint16Array | Int32Array;

export interface Box {
  low: number[];
  high: number[];
}

export interface Resource {
  name: string;
  mediaType: string;
}

export interface Pose {
  positions: Float32Array;
  normals: Float32Array;
}

/** Triangles `first` .. `first + count - 1` of a render mesh have one material. */
export interface MaterialRange {
  /** Value of the mesh's `materialAttribute`. */
  material: number;
  name: string;
  first: number;
  count: number;
}

/** What is the same in all frames of a render mesh. */
export interface RenderMeshFixed {
  readonly shot: number;
  readonly firstFrame: number;
  readonly vertexCount: number;
  /** Vertex of the shot, of each vertex here. */
  readonly sourceVertices: Uint32Array;
  /** A corner that has its values. */
  readonly sourceCorners: Uint32Array;
  /** Three vertices of each triangle. */
  readonly indices: Uint32Array;
  /** Face of each triangle. */
  readonly sourceFaces: Uint32Array;
  /** What triangles are sorted by. */
  readonly materialAttribute: Attribute | undefined;
  readonly ranges: MaterialRange[];
}

export interface RenderMesh extends RenderMeshFixed {
  frame(index: number, positions?: Float32Array, normals?: Float32Array): Float32Array;
  between(position: number, positions?: Float32Array, normals?: Float32Array): Float32Array;
  pose(position: number, of?: Attribute, reuse?: Pose): Pose;
  values(frame: number, attribute: Attribute): Values;
  close(): void;
}

export class Clip {
  private constructor();
  readonly closed: boolean;
  /** When all of the file is there. */
  readonly complete: Promise<void>;
  readonly info: Info;
  readonly metadata: Record<string, string>;
  readonly attributes: Attribute[];
  shot(index: number): Shot;
  group(index: number): Group;
  gap(index: number): { firstFrame: number; frameCount: number };
  /** Of a group, or of the clip; undefined where the file does not tell. */
  bounds(group?: number): Box | undefined;
  shotOfFrame(frame: number): number;
  vertexCount(frame: number): number;
  triangles(frame: number): Uint32Array;
  polygons(frame: number): { sizes: Uint32Array; corners: Uint32Array };
  frame(index: number, positions?: Float32Array, normals?: Float32Array): Float32Array;
  between(position: number, positions?: Float32Array, normals?: Float32Array): Float32Array;
  positionOfTime(seconds: number, loop?: boolean): number;
  values(frame: number, attribute: Attribute): Values;
  nameOf(frame: number, attribute: Attribute, value: number): string;
  readonly resources: Resource[];
  resource(index: number): Uint8Array;
  /** `splitBy`: attributes at whose seams vertices are split; texture coordinates, normals and colours where not given. */
  renderMesh(frame: number, splitBy?: Attribute[]): RenderMesh;
  /** What `call` gives once its bytes are there. It may be called several times. */
  fetching<T>(call: (clip: Clip) => T): Promise<T>;
  close(): void;
}

export function open(source: Source, options?: OpenOptions): Promise<Clip>;
export function openStreaming(source: Source | ReadableStream<Uint8Array>, options?: StreamingOptions): Promise<Clip>;
export function openRanges(url: string | URL, options?: RangesOptions): Promise<Clip>;
/** Fetches and compiles the WebAssembly before the first file does. */
export function preload(options?: Pick<OpenOptions, 'wasm'>): Promise<void>;
