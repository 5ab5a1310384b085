// Mouse and touch: a target is dragged in the plane that faces the camera. Where that is the plane
// of two axes of the world, as seen from the front, the side or the top, the third coordinate stays.

import { pixelOf } from "./scene.js";

/** @import { Scene } from "./scene.js" */

/** @type {Record<string, number>} */
const NEAR = { mouse: 18, pen: 22, touch: 32 }; // [pixels] from a target's middle that still hit it
const ALONG = 0.9998; // cosine of the angle [1.1°] up to which a camera looks along an axis

export class Picking {
  /** @type {{ node: number, depth: number, grip: Vector3, pointer: number, begun: boolean, start: Vector3 } | null} */
  #drag = null;
  #scene;
  #stage;
  #handles;

  /**
   * @param {Scene} scene
   * @param {HTMLElement} stage the picture of the scene
   * @param {Movable} handles
   */
  constructor(scene, stage, handles) {
    this.#scene = scene;
    this.#stage = stage;
    this.#handles = handles;
  }

  /** Whether a target is held. */
  get held() {
    return this.#drag !== null;
  }

  /** Whether the target that is held was moved. */
  get begun() {
    return this.#drag?.begun ?? true;
  }

  /** @param {PointerEvent} event */
  down(event) {
    if (event.button !== 0 || this.#drag) return;
    this.#scene.choose(this.#scene.at(pixelOf(this.#stage, event)));
    const node = this.#hit(event);
    if (node < 0) return;
    event.preventDefault(); // no mousedown for the camera
    event.stopPropagation();
    this.#scene.held = true;
    const at = this.#handles.where(node);
    const depth = at.clone().project(this.#scene.camera).z;
    const start = at.clone();
    const grip = at.sub(this.#under(event, depth)); // it does not jump to the pointer
    this.#drag = { node, depth, grip, pointer: event.pointerId, begun: false, start };
    this.#stage.setPointerCapture(event.pointerId);
    this.#stage.focus({ preventScroll: true });
    this.#handles.choose(node);
  }

  /** @param {PointerEvent} event */
  move(event) {
    const drag = this.#drag;
    if (!drag) {
      this.#stage.style.cursor = event.buttons === 0 && this.#hit(event) >= 0 ? "grab" : "";
    } else if (event.pointerId === drag.pointer) {
      event.stopPropagation();
      const at = this.#under(event, drag.depth).add(drag.grip).toArray();
      const back = this.#scene.camera.matrixWorld.elements.slice(8, 11);
      const [x, y, z] = inPlane(back, at, drag.start.toArray());
      this.#handles.move(drag.node, this.#scene.vector(x, y, z), !drag.begun);
      drag.begun = true;
    }
  }

  /** @param {PointerEvent} event */
  up(event) {
    if (event.pointerId === this.#drag?.pointer) this.release();
  }

  /** Let the target go where it is. */
  release() {
    if (!this.#drag) return;
    this.#drag = null;
    this.#scene.held = false;
  }

  /**
   * The node under the pointer; −1 for none.
   * @param {PointerEvent} event
   */
  #hit(event) {
    const pixel = pixelOf(this.#stage, event);
    const pane = this.#scene.panes[this.#scene.at(pixel)];
    const seen = this.#handles.nodes.map((_, i) => this.#handles.where(i).project(pane.camera));
    return nearest(seen, pane.pixel(pixel), NEAR[event.pointerType] ?? NEAR.mouse);
  }

  /**
   * The point under the pointer, at this depth of the picture.
   * @param {PointerEvent} event
   * @param {number} depth
   */
  #under(event, depth) {
    const [x, y, width, height] = this.#scene.pane.pixel(pixelOf(this.#stage, event));
    const point = this.#scene.vector((2 * x) / width - 1, 1 - (2 * y) / height, depth);
    return point.unproject(this.#scene.camera);
  }
}

/**
 * A place to which something is dragged, in the plane in which the drag began if the camera looks
 * along an axis of the world.
 * @param {number[]} back from what the camera looks at to it, of length 1
 * @param {number[]} at
 * @param {number[]} start
 */
export function inPlane(back, at, start) {
  const axis = back.findIndex((part) => Math.abs(part) > ALONG);
  return at.map((part, i) => (i === axis ? start[i] : part));
}

/**
 * The number of the point nearest to a pixel; −1 if none is within reach.
 * @param {{ x: number, y: number, z: number }[]} points as the camera projects them, −1..1
 * @param {number[]} pixel x, y, and the width and height of the picture
 * @param {number} reach [pixels]
 */
export function nearest(points, [x, y, width, height], reach) {
  let best = -1;
  let least = reach;
  points.forEach((point, i) => {
    const dx = ((point.x + 1) * width) / 2 - x;
    const dy = ((1 - point.y) * height) / 2 - y;
    const distance = Math.hypot(dx, dy);
    if (distance < least && Math.abs(point.z) < 1) [best, least] = [i, distance];
  });
  return best;
}
