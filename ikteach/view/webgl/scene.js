// The scene of pythreejs in the page.

import { resolve } from "../widgets/models.js";

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

  /** @returns {Vector3} of the three.js that pythreejs has brought */
  vector(x = 0, y = 0, z = 0) {
    return new this.camera.position.constructor(x, y, z);
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

/** Whether this browser can draw in 3-D. */
export function hasWebGL() {
  const gl = document.createElement("canvas").getContext("webgl");
  gl?.getExtension("WEBGL_lose_context")?.loseContext(); // a page may have few
  return gl !== null;
}
