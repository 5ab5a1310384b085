// Mouse and touch: a target is dragged in the plane that faces the camera.

/** @import { Scene } from "./scene.js" */

/** @type {Record<string, number>} */
const NEAR = { mouse: 18, pen: 22, touch: 32 }; // [pixels] from a target's middle that still hit it

export class Picking {
  /** @type {{ node: number, depth: number, grip: Vector3, pointer: number, begun: boolean } | null} */
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
    const node = this.#hit(event);
    if (node < 0) return;
    event.preventDefault(); // no mousedown for the camera
    event.stopPropagation();
    this.#turning(false);
    const at = this.#handles.where(node);
    const depth = at.clone().project(this.#scene.camera).z;
    const grip = at.sub(this.#under(event, depth)); // it does not jump to the pointer
    this.#drag = { node, depth, grip, pointer: event.pointerId, begun: false };
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
      this.#handles.move(drag.node, this.#under(event, drag.depth).add(drag.grip), !drag.begun);
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
    this.#turning(true);
  }

  /** @param {boolean} enabled whether dragging turns the camera */
  #turning(enabled) {
    for (const controls of this.#scene.controls) controls.obj.enabled = enabled;
  }

  /**
   * The node under the pointer; −1 for none.
   * @param {PointerEvent} event
   */
  #hit(event) {
    const { camera } = this.#scene;
    const seen = this.#handles.nodes.map((_, node) => this.#handles.where(node).project(camera));
    return nearest(seen, this.#pixel(event), NEAR[event.pointerType] ?? NEAR.mouse);
  }

  /**
   * The point under the pointer, at this depth of the picture.
   * @param {PointerEvent} event
   * @param {number} depth
   */
  #under(event, depth) {
    const [x, y, width, height] = this.#pixel(event);
    const point = this.#scene.vector((2 * x) / width - 1, 1 - (2 * y) / height, depth);
    return point.unproject(this.#scene.camera);
  }

  /** @param {PointerEvent} event */
  #pixel(event) {
    const picture = this.#stage.querySelector("canvas, img") ?? this.#stage;
    const box = picture.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top, box.width, box.height];
  }
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
