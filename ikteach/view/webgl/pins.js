// Targets that a person moves stay where they were put, until the kernel's frames have caught up.

/** @import { Scene } from "./scene.js" */

const LATE = 2000; // [ms] after which a target goes where the kernel says, if that is elsewhere

export class Pins {
  /** @type {Map<number, { at: Vector3, until: number, seen: Vector3 | null }>} */
  #pins = new Map(); // node: where it is shown, and where the kernel's frame had it last
  #scene;
  #nodes;
  #count;
  #hair;

  /**
   * @param {Scene} scene
   * @param {Model[]} nodes of targets, those of one figure after those of another
   * @param {number} count of targets of one figure
   * @param {number} hair [m] so near, a frame has caught up
   */
  constructor(scene, nodes, count, hair) {
    this.#scene = scene;
    this.#nodes = nodes;
    this.#count = count;
    this.#hair = hair;
  }

  /**
   * Where a node is shown.
   * @param {number} node
   */
  where(node) {
    return this.#pins.get(node)?.at.clone() ?? this.#framed(node);
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
      this.#pins.set(other, { at: this.where(other).add(move), until, seen: null });
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
        this.#nodes[node].obj.matrix.setPosition(pin.at);
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
  #framed(node) {
    return this.#scene.position(this.#nodes[node].obj.matrix);
  }
}
