// The scene of pythreejs in the page.

import { clamp } from "../widgets/choosing.js";
import { resolve } from "../widgets/models.js";
import { grid, Pane, places } from "./panes.js";

const RIM = 0.96; // of the half picture: so far from its middle a target may be moved

export class Scene {
  /** @type {Shown[]} */
  shown = [{ name: "free", way: null }]; // the views that the kernel wants
  needed = 1; // width over height of what each must show
  aspect = 1; // of the picture
  chosen = 0; // number of the view that keys and the pointer act on
  pressed = false; // whether a button of the pointer is down: then it stays with its view
  #held = false;

  /** @param {Model} renderer the model of a pythreejs Renderer */
  constructor(renderer) {
    this.renderer = renderer;
    this.model = renderer.get("scene");
  }

  /** The views as they are drawn. */
  get panes() {
    const controls = this.renderer.get("controls");
    const shown = this.shown.slice(0, controls.length); // news of the two come one by one
    const count = shown.length;
    const where = places(count, grid(count, this.aspect, this.needed));
    return shown.map((one, i) => new Pane(one, controls[i], where[i]));
  }

  /** The view that keys and the pointer act on. */
  get pane() {
    const { panes } = this;
    return panes[this.chosen] ?? panes[0];
  }

  /**
   * The number of the view at a pixel of the picture.
   * @param {number[]} pixel x, y, and the width and height of the picture
   */
  at([x, y, width, height]) {
    const inside = this.panes.findIndex(({ place: [left, top, wide, high] }) => {
      const [across, down] = [x / width - left, y / height - top];
      return across >= 0 && across < wide && down >= 0 && down < high;
    });
    return Math.max(inside, 0);
  }

  /**
   * Have keys and the pointer act on a view, and its camera alone turn with the pointer.
   * @param {number} view
   */
  choose(view) {
    const news = view !== this.chosen && !this.pressed;
    if (news) this.chosen = view;
    this.#allow();
    if (!news) return;
    this.model.trigger("chosen");
    this.redraw();
  }

  /** @param {boolean} on whether the pointer holds a target, and turns no camera */
  set held(on) {
    this.#held = on;
    this.#allow();
  }

  #allow() {
    this.panes.forEach(({ controls: { obj } }, i) => {
      obj.enabled = !this.#held && i === this.chosen;
    });
  }

  /** @returns {Camera} */
  get camera() {
    return this.pane.camera;
  }

  /** @returns {Controls} */
  get controls() {
    return this.pane.controls;
  }

  redraw() {
    this.renderer.trigger("rerender", this.renderer, {});
  }

  /** @returns {[width: number, height: number]} of the picture [pixels] */
  get size() {
    return [this.renderer.get("_width"), this.renderer.get("_height")];
  }

  /**
   * Draw at this size, in this page; the kernel does not hear of it.
   * @param {number} width [pixels]
   * @param {number} height [pixels]
   */
  resize(width, height) {
    this.renderer.set("_width", width);
    this.renderer.set("_height", height);
    this.redraw();
  }

  /**
   * Turn the camera round what it looks at, and move it nearer or farther, as far as it may go.
   * @param {(away: number[]) => number[]} turn what it looks at stays where it is
   * @param {number} zoom of a parallel camera, as many times as before
   */
  look(turn, zoom) {
    const { camera, controls } = this;
    const { obj } = controls;
    const { x, y, z } = camera.position.clone().sub(obj.target);
    camera.position.copy(obj.target).add(this.vector(...turn([x, y, z])));
    if (camera.isOrthographicCamera) {
      camera.zoom = clamp(camera.zoom * zoom, obj.minZoom, obj.maxZoom);
      camera.updateProjectionMatrix();
    }
    obj.update();
    controls.update_controlled();
    this.redraw();
  }

  /** @returns {Vector3} of the three.js that pythreejs has brought */
  vector(x = 0, y = 0, z = 0) {
    return new this.camera.position.constructor(x, y, z);
  }

  /**
   * The place nearest to this one in the picture, at the same depth: what is moved stays in view.
   * @param {Vector3} at
   */
  seen(at) {
    const { x, y, z } = at.clone().project(this.camera);
    if (Math.max(Math.abs(x), Math.abs(y)) <= RIM) return at;
    return this.vector(clamp(x, -RIM, RIM), clamp(y, -RIM, RIM), z).unproject(this.camera);
  }

  /**
   * Where an object is in the world, or in what holds it.
   * @param {Matrix4} matrix
   */
  position(matrix) {
    return this.vector().setFromMatrixPosition(matrix);
  }
}

/**
 * The scene of a widget, once pythreejs has made it; that may be never.
 * @param {Given} given
 * @param {() => boolean} gone whether the widget has left the page
 * @returns {Promise<Scene | undefined>}
 */
export async function sceneOf(given, gone) {
  while (!gone()) {
    const [renderer] = await resolve(given, [given.model.get("renderer")]).catch(() => []);
    if (renderer?.get("scene")?.obj) {
      renderer.ikteach ??= new Scene(renderer); // one for all widgets of the picture
      return renderer.ikteach;
    }
    await new Promise((done) => setTimeout(done, 1000));
  }
}

/**
 * The picture of the scene that a widget belongs to, once it is in the page.
 * @param {HTMLElement} el
 * @param {() => boolean} gone whether the widget has left the page
 */
export async function stageOf(el, gone) {
  while (!gone()) {
    const stage = el.closest(".ikteach-scene")?.querySelector(".jupyter-threejs");
    if (stage) return /** @type {HTMLElement} */ (stage);
    await new Promise(requestAnimationFrame);
  }
}

/**
 * Where in the picture an event of the pointer is: x, y, and the width and height of the picture.
 * @param {HTMLElement} stage the picture of the scene
 * @param {MouseEvent} event
 */
export function pixelOf(stage, event) {
  const picture = stage.querySelector("canvas, img") ?? stage;
  const { left, top, width, height } = picture.getBoundingClientRect();
  return [event.clientX - left, event.clientY - top, width, height];
}

/** Whether this browser can draw in 3-D. */
export function hasWebGL() {
  const gl = document.createElement("canvas").getContext("webgl");
  gl?.getExtension("WEBGL_lose_context")?.loseContext(); // a page may have few
  return gl !== null;
}
