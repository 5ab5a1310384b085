// The scene of pythreejs in the page.

import { clamp } from "../widgets/choosing.js";
import { resolve } from "../widgets/models.js";

const RIM = 0.96; // of the half picture: so far from its middle a target may be moved

export class Scene {
  /** @param {Model} renderer the model of a pythreejs Renderer */
  constructor(renderer) {
    this.renderer = renderer;
    this.model = renderer.get("scene");
  }

  /** @returns {Camera} */
  get camera() {
    return this.renderer.get("camera").obj;
  }

  /** @returns {Controls[]} */
  get controls() {
    return this.renderer.get("controls");
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
    const { camera } = this;
    camera.aspect = width / height;
    camera.left = -camera.top * camera.aspect;
    camera.right = camera.top * camera.aspect;
    camera.updateProjectionMatrix();
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
    const { obj } = controls[0];
    const { x, y, z } = camera.position.clone().sub(obj.target);
    camera.position.copy(obj.target).add(this.vector(...turn([x, y, z])));
    if (camera.isOrthographicCamera) {
      camera.zoom = clamp(camera.zoom * zoom, obj.minZoom, obj.maxZoom);
      camera.updateProjectionMatrix();
    }
    obj.update();
    controls[0].update_controlled();
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
 */
export async function sceneOf(given, gone) {
  while (!gone()) {
    const [renderer] = await resolve(given, [given.model.get("renderer")]).catch(() => []);
    if (renderer?.get("scene")?.obj) return new Scene(renderer);
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

/** Whether this browser can draw in 3-D. */
export function hasWebGL() {
  const gl = document.createElement("canvas").getContext("webgl");
  gl?.getExtension("WEBGL_lose_context")?.loseContext(); // a page may have few
  return gl !== null;
}
