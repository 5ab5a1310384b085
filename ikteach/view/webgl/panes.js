// Views of one scene that share a picture: where each is in it, and what its camera shows there.

/** @import { Scene } from "./scene.js" */

/** Controls whose camera looks at their target: three's look at the origin when they are made. */
const aimed = new WeakSet();
const TURNED = 0.9998; // cosine of the angle [1.1°] by which a view is no longer what it is called
/** @typedef {[left: number, top: number, width: number, height: number]} Place */

export class Pane {
  /**
   * @param {Shown} shown
   * @param {Controls} controls of its camera
   * @param {Place} place in the picture, as shares of its sides
   */
  constructor({ name, way }, controls, place) {
    this.name = name;
    this.way = way;
    this.controls = controls;
    this.place = place;
  }

  get camera() {
    return this.controls.get("controlling").obj;
  }

  /** Its name, and whether it was turned away from what that says. */
  get title() {
    if (!this.way) return this.name;
    const { x, y, z } = this.camera.position.clone().sub(this.controls.obj.target);
    const along = x * this.way[0] + y * this.way[1] + z * this.way[2];
    const cosine = along / Math.hypot(x, y, z) / Math.hypot(...this.way);
    return cosine < TURNED ? `${this.name}, turned` : this.name;
  }

  /**
   * A pixel of the picture in this pane, and the size of the pane.
   * @param {number[]} pixel x, y, and the width and height of the picture
   */
  pixel([x, y, width, height]) {
    const [left, top, wide, high] = this.place;
    return [x - left * width, y - top * height, wide * width, high * height];
  }

  /**
   * Have the camera show what must be seen in the middle of this pane.
   * @param {number} aspect of the picture
   * @param {number} needed width over height of what must be seen
   */
  aim(aspect, needed) {
    const { camera, controls } = this;
    if (!aimed.has(controls.obj)) {
      aimed.add(controls.obj);
      controls.obj.update();
    }
    const full = camera.isOrthographicCamera
      ? (camera.right - camera.left) / (camera.top - camera.bottom)
      : camera.aspect;
    const own = (aspect * this.place[2]) / this.place[3];
    const height = Math.max(1, needed / own);
    const width = own * height;
    const cut = [full, 1, (full - width) / 2, (1 - height) / 2, width, height];
    const {
      fullWidth,
      fullHeight,
      offsetX,
      offsetY,
      width: wide,
      height: high,
    } = camera.view ?? {};
    const old = [fullWidth, fullHeight, offsetX, offsetY, wide, high];
    if (cut.some((value, i) => value !== old[i])) camera.setViewOffset(...cut);
  }
}

/**
 * Columns and rows in which views share a picture, as stage/views.py has it: two stand beside or
 * below each other, so that what must be seen is the larger.
 * @param {number} count
 * @param {number} aspect of the picture
 * @param {number} needed width over height of what must be seen
 * @returns {[columns: number, rows: number]}
 */
export function grid(count, aspect, needed) {
  if (count !== 2) return [Math.round(Math.sqrt(count)), Math.round(Math.sqrt(count))];
  const beside = Math.min(1, aspect / 2 / needed);
  const below = Math.min(1 / 2, aspect / needed);
  return beside >= below ? [2, 1] : [1, 2];
}

/**
 * The aspect of a picture in which so many views have the one that they need: where it may be wide,
 * and where it is narrow.
 * @param {number} count
 * @param {number} aspect of the picture of one view
 * @param {number} needed width over height of what must be seen
 */
export function aspects(count, aspect, needed) {
  if (count !== 2) return { wide: aspect, narrow: aspect };
  const below = needed / 2;
  return { wide: needed > 1.3 ? below : 2 * needed, narrow: below };
}

/**
 * The place of each of so many views.
 * @param {number} count
 * @param {[columns: number, rows: number]} grid
 * @returns {Place[]}
 */
export function places(count, [columns, rows]) {
  return Array.from({ length: count }, (_, i) => [
    (i % columns) / columns,
    Math.floor(i / columns) / rows,
    1 / columns,
    1 / rows,
  ]);
}

/**
 * Draw each view in its place.
 * @param {Scene} scene
 * @param {View} view of the renderer
 * @param {[width: number, height: number]} size [pixels]
 */
export function paint(scene, view, [width, height]) {
  const usual = Object.getPrototypeOf(view).renderScene;
  for (const pane of scene.panes) {
    if (view.isFrozen) view.unfreeze();
    const [left, top, wide, high] = pane.place;
    const box = [left * width, top * height, wide * width, high * height].map(Math.round);
    view.renderer.setViewport(...box);
    view.renderer.setScissor(...box);
    view.renderer.setScissorTest(true);
    pane.aim(width / height, scene.needed);
    usual.call(view, undefined, pane.camera);
    if (view.isFrozen) return; // there are too many pictures, and this one has become an image
  }
  view.renderer.setScissorTest(false); // others draw with it, too
  view.renderer.setViewport(0, 0, width, height);
  scene.model.trigger("afterViews");
}
