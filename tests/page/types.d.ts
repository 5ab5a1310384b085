// Types of what others bring to the page: anywidget, Jupyter's models, three.js as pythreejs has
// it. As much of them as our modules use.

/** Whatever hears of events; its arguments are those of whoever tells. */
type Act = (...values: any[]) => any;
type Attributes = Record<string, string | number | boolean>;
type Message = { fresh?: boolean; [name: string]: unknown };
type Timer = ReturnType<typeof setTimeout> | undefined;

interface Source {
  on(events: string, act: Act): void;
  off(events: string, act: Act): void;
}

/** A model of anywidget, or of pythreejs, which has the object of three.js. */
interface Model extends Source {
  get(name: string): any;
  set(name: string, value: unknown): void;
  save_changes(): void;
  send(content: object): void;
  trigger(event: string, ...values: unknown[]): void;
  update_controlled(): void;
  widget_manager?: { get_model?(id: string): Promise<Model> | undefined };
  initPromise?: Promise<unknown>;
  views: Record<string, Promise<View>>;
  obj: any;
  ikteach?: any; // ours: the scene of a renderer
}

/** A view of a pythreejs Renderer. */
interface View {
  el: HTMLElement;
  isFrozen: boolean;
  unfreeze(): void;
  renderScene(): void;
  renderer: {
    domElement: HTMLCanvasElement;
    setViewport(...box: number[]): void;
    setScissor(...box: number[]): void;
    setScissorTest(on: boolean): void;
    setPixelRatio(ratio: number): void;
    setSize(width: number, height: number, style: boolean): void;
  };
  updateSize(): void;
  tick(): void;
}

/** What anywidget gives `render`, which returns what ends it. */
interface Given {
  model: Model;
  el: HTMLElement;
  host: { getModel(id: string): Promise<Model> };
}
type Render = (given: Given) => () => void;

// three.js

interface Vector3 {
  constructor: new (x: number, y: number, z: number) => Vector3;
  x: number;
  y: number;
  z: number;
  add(other: Vector3): Vector3;
  sub(other: Vector3): Vector3;
  copy(other: Vector3): Vector3;
  clone(): Vector3;
  clamp(low: Vector3, high: Vector3): Vector3;
  distanceTo(other: Vector3): number;
  project(camera: Camera): Vector3;
  unproject(camera: Camera): Vector3;
  setFromMatrixPosition(matrix: Matrix4): Vector3;
  toArray(): number[];
}

interface Matrix4 {
  elements: number[];
  set(...rows: number[]): Matrix4;
  setPosition(at: Vector3): Matrix4;
  extractRotation(other: Matrix4): Matrix4;
}

interface Object3D {
  matrix: Matrix4;
  matrixWorld: Matrix4;
  matrixWorldNeedsUpdate: boolean;
  visible: boolean;
  parent: Object3D | null;
  position: Vector3;
  add(child: Object3D): void;
  remove(child: Object3D): void;
  onBeforeRender(renderer: unknown, scene: unknown, camera: Camera): void;
}

interface Camera extends Object3D {
  isOrthographicCamera?: boolean;
  aspect: number;
  left: number;
  right: number;
  top: number;
  bottom: number;
  zoom: number;
  view: Record<string, number> | null;
  setViewOffset(...cut: number[]): void;
  updateProjectionMatrix(): void;
}

interface Controls {
  get(name: "controlling"): Model;
  obj: { enabled: boolean; target: Vector3; minZoom: number; maxZoom: number; update(): void };
  update_controlled(): void;
}

interface BufferAttribute {
  array: Float32Array;
  rest: Float32Array; // ours: the array of before it was moved
  needsUpdate: boolean;
}

interface Mesh extends Object3D {
  geometry: { attributes: { position: BufferAttribute; normal?: BufferAttribute } };
}

// Ours

/** A view that the kernel wants; `way` leads to its camera, if it is not free. */
type Shown = { name: string; way: number[] | null };

type Mover = (numbers: Float32Array) => void;
type Frame = { frame: number; change: number };
type Line = { name: string; colour: string; dashes: number[] };
type Panel = { title: string; unit: string; range: [low: number, high: number]; lines: Line[] };

/** Targets that can be moved, as picking and keys see them. */
interface Movable {
  names: string[];
  nodes: Model[];
  chosen: number;
  where(node: number): Vector3;
  stride(node: number, step: number): number;
  move(node: number, at: Vector3, fresh: boolean): void;
  choose(node: number): void;
  undo(): void;
  invite(): void;
}

/** The fields of a question; `missing` is said while there is no answer to read. */
interface Fields {
  rows: HTMLElement[];
  missing: string;
  read(): unknown;
  lock(locked: boolean): void;
}
