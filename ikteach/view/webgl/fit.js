// Draws a scene at the size that the page gives it: layout.css says how wide, the kernel how high
// for that width, and nothing is stretched.

/** @import { Scene } from "./scene.js" */

/**
 * Fit the picture of a scene from now on; call the answer to stop that.
 * @param {Scene} scene
 * @param {HTMLElement} inside an element of the same `.ikteach-scene`
 */
export function fit({ renderer }, inside) {
  const [width, height] = [renderer.get("_width"), renderer.get("_height")];
  const observer = new ResizeObserver(([{ target }]) => {
    for (const one of Object.values(renderer.views ?? {})) // Lab calls late, it may be closed
      one.then((view) => view.el === target && draw(view, target));
  });
  /** @type {Timer} */
  let looking;

  function look() {
    const box = /** @type {HTMLElement | null} */ (inside.closest(".ikteach-scene"));
    const host = box?.querySelector(".jupyter-threejs");
    if (!box || !host) {
      looking = setTimeout(look, 50); // pythreejs has not made it yet
      return;
    }
    const outer = /** @type {HTMLElement | null} */ (box.closest(".ikteach-arranged"));
    (outer ?? box).style.setProperty("--aspect", `${width / height}`);
    box.style.setProperty("--nominal", `${width}px`);
    observer.observe(host);
  }

  look();
  return () => {
    clearTimeout(looking);
    observer.disconnect();
  };
}

/**
 * Draw a view of pythreejs at the size of its element, in pixels of the screen.
 * @param {View} view
 * @param {Element} host
 */
function draw(view, host) {
  view.updateSize = () => {
    if (view.isFrozen || !host.clientWidth) return;
    view.renderer.setPixelRatio(window.devicePixelRatio);
    view.renderer.setSize(host.clientWidth, host.clientHeight, false);
    Object.assign(view.renderer.domElement.style, { width: "", height: "" }); // of before
  };
  view.updateSize();
  view.tick();
}
