import type { AnimationActionLoopStyles, Box3, BufferGeometry, Loader, LoadingManager, Material, Mesh, Sphere } from 'three';
import type { Attribute, Group, Info, Resource, Values } from './reeb.js';

export class ReebLoader extends Loader<ReebMesh> {
  constructor(manager?: LoadingManager);
  /** Workers at most, one for each file; 4. 0: everything on the thread of the page. */
  setWorkerLimit(count: number): this;
  setWasm(url: string | URL): this;
  setStreaming(on: boolean): this;
  preload(): Promise<void>;
  load(url: string, onLoad: (mesh: ReebMesh) => void, onProgress?: (event: ProgressEvent) => void,
       onError?: (error: unknown) => void): void;
  parse(bytes: ArrayBuffer | Uint8Array, onLoad?: (mesh: ReebMesh) => void, onError?: (error: unknown) => void): Promise<ReebMesh>;
  dispose(): void;
}

/** Made by ReebLoader. */
export class ReebMesh extends Mesh<BufferGeometry, Material | Material[]> {
  private constructor();
  readonly isReebMesh: true;
  readonly info: Info;
  readonly duration: number;
  readonly frameCount: number;
  readonly frameRate: number;
  /** Of the whole clip, in its own space. */
  readonly box: Box3;
  readonly sphere: Sphere;
  readonly resources: (Resource & { bytes(): Promise<Uint8Array> })[];
  /** Seconds; `seek` sets it. */
  readonly time: number;
  /** The position that is shown, in frames. */
  readonly shownPosition: number;
  readonly playing: boolean;
  /** 1; negative: backwards. */
  speed: number;
  loop: AnimationActionLoopStyles;
  readonly attributes: Attribute[];
  readonly sourceVertices: Uint32Array;
  readonly complete: Promise<void>;
  values(attribute: Attribute, position?: number): Promise<Values>;
  groups(): Promise<Group[]>;
  play(): this;
  pause(): this;
  update(delta: number): Promise<void>;
  seek(seconds: number): Promise<void>;
  showPosition(position: number): Promise<void>;
  instance(materials?: Material | Material[]): ReebMesh;
  dispose(): void;
}
