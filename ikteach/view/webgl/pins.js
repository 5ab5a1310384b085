// Targets that a person moves stay where they were put, until the kernel's frames have caught up.

/** @import { Scene } from "./scene.js" */

const LATE = 2000; // [ms] after which a target goes where the kernel says, if that is elsewhere

export class Pins {
  /** @type {Map<number, { at: Vector3, until: number, seen: Vector3 | null }>} */
  #pins = new Map(); // node: where it is shown, from its origin, and where the kernel had it last
  #scene;
  #nodes;
  #lengths;
  #count;
  #hair;

  /**
   * @param {Scene} scene
   * @param {Model[]} nodes of targets, those of one figure after those of another
   * @param {number[]} lengths of the targets of one figure that are directions [m], 0 of points
   * @param {number} hair [m] so near, a frame has caught up
   */
  constructor(scene, nodes, lengths, hair) {
    this.#scene = scene;
    this.#nodes = nodes;
    this.#lengths = lengths;
    this.#count = lengths.length;
    this.#hair = hair;
  }

  /**
   * Where a node is shown.
   * @param {number} node
   */
  where(node) {
    return this.#from(node).add(this.origin(node));
  }

  /**
   * The length of a direction, 0 of a point.
   * @param {number} node
   */
  length(node) {
    return this.#lengths[node % this.#count];
  }

  /**
   * Where a direction begins, from which its arrow is a matrix's second column; of a point 0.
   * @param {number} node
   */
  origin(node) {
    return this.length(node) ? this.#place(node) : this.#scene.vector();
  }

  /**
   * Show a node there, and the same target of the other figures moved as far.
   * @param {number} node
   * @param {Vector3} at
   */
  pin(node, at) {
    const move = at.clone().sub(this.where(node));
    const until = performance.now() + LATE;
    for (let other = node % this.#count; other < this.#nodes.length; other += this.#count)
      this.#pins.set(other, { at: this.#from(other).add(move), until, seen: null });
    this.#scene.redraw();
  }

  /**
   * Put the pinned nodes where they are shown, and let go of those that the kernel's frames have
   * caught up with, or that they will not.
   * @param {boolean} held whether one is dragged: then all stay
   */
  keep(held) {
    for (const [node, pin] of this.#pins) {
      const frame = this.#framed(node);
      const news = pin.seen === null || frame.distanceTo(pin.seen) > this.#hair / 1000;
      const met = news && frame.distanceTo(pin.at) < this.#hair;
      if (!held && (met || performance.now() > pin.until)) {
        this.#pins.delete(node);
      } else {
        this.#put(node, pin.at);
        this.#nodes[node].obj.matrixWorldNeedsUpdate = true;
        pin.seen = pin.at.clone();
      }
    }
  }

  /** Let go of all. */
  clear() {
    this.#pins.clear();
  }

  /** @param {number} node */
  #from(node) {
    return this.#pins.get(node)?.at.clone() ?? this.#framed(node);
  }

  /** @param {number} node */
  #framed(node) {
    if (!this.length(node)) return this.#place(node);
    const [x, y, z] = this.#nodes[node].obj.matrix.elements.slice(4, 7);
    return this.#scene.vector(x, y, z);
  }

  /** @param {number} node */
  #place(node) {
    return this.#scene.position(this.#nodes[node].obj.matrix);
  }

  /**
   * @param {number} node
   * @param {Vector3} at
   */
  #put(node, at) {
    const { matrix } = this.#nodes[node].obj;
    if (!this.length(node)) matrix.setPosition(at);
    else
      stick(at.toArray()).forEach((part, i) => {
        matrix.elements[i] = part;
      });
  }
}

/**
 * The first three columns, of four each, of the matrix that lays (0, 1, 0) along a vector: as
 * `sticks` of body/rotation.py makes them.
 * @param {number[]} along
 */
export function stick(along) {
  const length = Math.hypot(...along);
  const [x, y, z] = along.map((part) => part / length);
  const sign = y < 0 ? -1 : 1;
  const w = [x, y + sign, z]; // wᵀw = 2 (1 + |y|)
  const column = (/** @type {number} */ i) =>
    w.map((part, row) => (row === i ? 1 : 0) - (part * w[i]) / (1 + Math.abs(y)));
  return [...column(0).map((part) => sign * part), 0, ...along, 0, ...column(2), 0];
}
