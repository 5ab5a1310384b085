// Keys that choose and move targets. Tab goes from the camera through the targets, and out of the picture.

import { clamp } from "../widgets/choosing.js";
import { take } from "../widgets/dom.js";

/** @import { Scene } from "./scene.js" */

const TURN = 0.1; // [rad] of the camera per key press
export const ZOOM = 1.1; // of its distance
/** @type {Record<string, [right: number, up: number, near: number]>} */
const ARROWS = {
  ArrowLeft: [-1, 0, 0],
  ArrowRight: [1, 0, 0],
  ArrowDown: [0, -1, 0],
  ArrowUp: [0, 1, 0],
  PageDown: [0, 0, 1],
  PageUp: [0, 0, -1],
};
/** @type {Record<string, string>} */
const KEYPAD = {
  Numpad4: "ArrowLeft",
  Numpad6: "ArrowRight",
  Numpad2: "ArrowDown",
  Numpad8: "ArrowUp",
  Numpad9: "PageUp",
  Numpad3: "PageDown",
}; // with num lock, too

/**
 * The arrow that a key is, if it is one.
 * @param {KeyboardEvent} event
 * @returns {[right: number, up: number, near: number] | undefined}
 */
export function arrowOf({ code, key }) {
  return ARROWS[KEYPAD[code] ?? key];
}

export class Keys {
  #scene;
  #handles;
  #step;

  /**
   * @param {Scene} scene
   * @param {Movable} handles
   * @param {number} step [m] of a target per key press
   */
  constructor(scene, handles, step) {
    this.#scene = scene;
    this.#handles = handles;
    this.#step = step;
  }

  /** @param {KeyboardEvent} event */
  press(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const arrow = arrowOf(event);
    if (event.key === "Tab") {
      if (!this.#tab(event.shiftKey)) return;
    } else if (event.key === "Escape") this.#handles.undo();
    else if (!arrow || this.#handles.chosen < 0) return;
    else this.#push(arrow, event);
    take(event);
  }

  /**
   * Choose the next target; false if that is out of the picture.
   * @param {boolean} back
   */
  #tab(back) {
    const next = after(this.#handles.chosen, back, this.#handles.names.length);
    if (next === undefined) return false;
    this.#handles.choose(next);
    if (next < 0) this.#handles.invite();
    return true;
  }

  /**
   * @param {number[]} arrow
   * @param {KeyboardEvent} event
   */
  #push(arrow, { shiftKey, repeat }) {
    const { chosen } = this.#handles;
    const step = this.#handles.stride(chosen, this.#step) * (shiftKey ? 0.1 : 1);
    const move = along(this.#scene.camera.matrixWorld.elements, arrow).map((part) => part * step);
    const at = this.#handles.where(chosen).add(this.#scene.vector(...move));
    this.#handles.move(chosen, at, !repeat);
  }
}

/**
 * The target to which Tab leads, −1 for the camera; undefined for out of the picture.
 * @param {number} chosen
 * @param {boolean} back
 * @param {number} count of targets
 */
export function after(chosen, back, count) {
  const next = chosen + (back ? -1 : 1);
  return next < -1 || next >= count ? undefined : next;
}

/**
 * The axis of the world, with its sign, that is nearest to an arrow in the picture.
 * @param {number[]} matrix of the camera in the world (16): columns right, up, and near
 * @param {number[]} arrow
 * @returns {number[]} (3)
 */
export function along(matrix, arrow) {
  const column = arrow.findIndex((part) => part !== 0);
  const way = matrix.slice(4 * column, 4 * column + 3).map((part) => part * arrow[column]);
  const longest = Math.max(...way.map(Math.abs));
  const axis = way.findIndex((part) => Math.abs(part) === longest);
  return way.map((part, i) => (i === axis ? Math.sign(part) : 0));
}

/**
 * Turn the camera round what it looks at, and move it nearer or farther.
 * @param {number[]} away from what it looks at
 * @param {number[]} arrow
 */
export function turned([x, y, z], [right, up, near]) {
  const flat = Math.hypot(x, z);
  const distance = Math.hypot(x, y, z) * ZOOM ** near;
  const azimuth = Math.atan2(x, z) + TURN * right;
  const elevation = clamp(Math.atan2(y, flat) + TURN * up, -1.5, 1.5);
  return [
    distance * Math.cos(elevation) * Math.sin(azimuth),
    distance * Math.sin(elevation),
    distance * Math.cos(elevation) * Math.cos(azimuth),
  ];
}
