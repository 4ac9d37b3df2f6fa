// What is drawn: one mesh, or two side by side under one camera.
import { AmbientLight, Box3, BufferAttribute, DirectionalLight, MeshNormalMaterial, MeshStandardMaterial, PerspectiveCamera,
         Scene, Sphere, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { paint } from './colours.js';

// By Okabe and Ito, to be told apart by everybody; the first is for what has one material.
const MATERIALS = [0x8fb4d8, 0xe69f00, 0x009e73, 0xf0e442, 0x56b4e9, 0xd55e00, 0xcc79a7, 0x0072b2];

function coloured(materials) {
  [materials].flat().forEach((material, i) => material.vertexColors || material.color.set(MATERIALS[i % MATERIALS.length]));
  return materials;
}

export class Stage {
  #renderer;
  #scene = new Scene();
  #camera = new PerspectiveCamera(35, 1, 0.01, 1000);
  #controls;
  #meshes = [];
  #look = { shading: 'smooth', wireframe: false };

  constructor(canvas) {
    this.canvas = canvas;
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.#controls = new OrbitControls(this.#camera, canvas);
    const sun = new DirectionalLight(0xffffff, 2);
    sun.position.set(0.4, 0.7, 1);
    this.#camera.add(sun);
    this.#scene.add(this.#camera, new AmbientLight(0xffffff, 0.7));
  }

  /** One mesh, or two. */
  show(...meshes) {
    for (const mesh of this.#meshes) this.#scene.remove(mesh);
    this.#meshes = meshes;
    this.#scene.add(...meshes);
    this.look(this.#look);
    this.frameAll();
  }

  /** `shading`: 'smooth', 'normals', 'texture' for `texture`, or 'values' where colours are painted. */
  look(look) {
    this.#look = { ...this.#look, ...look };
    for (const mesh of this.#meshes) mesh.material = this.#material(mesh);
  }

  // A file's own materials are kept, to come back to.
  #material(mesh) {
    mesh.userData.own ??= coloured(mesh.material);
    const { shading, wireframe, texture } = this.#look;
    const painted = shading === 'values' || (this.#meshes.length > 1 && mesh === this.#meshes[1]);
    if (shading === 'normals' && !painted) return new MeshNormalMaterial({ wireframe, side: 2 });
    if (shading === 'texture' && !painted) return new MeshStandardMaterial({ map: texture, wireframe, roughness: 0.8, side: 2 });
    if (painted) return new MeshStandardMaterial({ vertexColors: true, wireframe, roughness: 0.8, side: 2 });
    for (const material of [mesh.userData.own].flat()) Object.assign(material, { wireframe, side: 2 });
    return mesh.userData.own;
  }

  /** Colours a mesh by numbers from 0 to 1, one a vertex. */
  paint(mesh, shares) {
    const { geometry } = mesh;
    const count = geometry.attributes.position.count;
    const old = geometry.attributes.color;
    const target = old?.count === count && old.userData?.painted ? old : new BufferAttribute(new Float32Array(3 * count), 3);
    target.userData = { painted: true };
    paint(shares, target.array);
    target.needsUpdate = true;
    if (target !== old) geometry.setAttribute('color', target);
  }

  frameAll() {
    const box = this.#meshes.reduce((all, mesh) => all.union(mesh.box), new Box3());
    const { center, radius } = box.getBoundingSphere(new Sphere());
    const distance = (1.15 * radius) / Math.sin((this.#camera.fov * Math.PI) / 360) / Math.min(1, this.#aspect());
    this.#camera.position.copy(center).add(new Vector3(0.45, 0.25, 1).setLength(distance));
    this.#camera.near = distance / 1000;
    this.#camera.far = distance * 10;
    this.#controls.target.copy(center);
    this.#controls.update();
  }

  #aspect() {
    const { clientWidth, clientHeight } = this.canvas;
    return clientWidth / Math.max(1, this.#meshes.length) / Math.max(1, clientHeight);
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.#renderer.setPixelRatio(Math.min(2, globalThis.devicePixelRatio));
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = this.#aspect();
    this.#camera.updateProjectionMatrix();
    const part = width / Math.max(1, this.#meshes.length);
    this.#renderer.setScissorTest(true);
    this.#meshes.forEach((mesh, i) => {
      for (const other of this.#meshes) other.visible = other === mesh;
      this.#renderer.setViewport(i * part, 0, part, height);
      this.#renderer.setScissor(i * part, 0, part, height);
      this.#renderer.render(this.#scene, this.#camera);
    });
  }
}
