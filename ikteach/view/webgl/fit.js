// Draws a scene at the size that the page gives it: layout.css says how wide, the kernel how high
// for that width, and nothing is stretched.

import { listen } from "../widgets/dom.js";
import { aspects, paint } from "./panes.js";

/** @import { Scene } from "./scene.js" */

const WIDER = [0, 1, 1, 1, 1.4]; // by so much a lone picture is wider for its number of views

/**
 * Fit the picture of a scene from now on; call the answer to stop that.
 * @param {Scene} scene
 * @param {HTMLElement} inside an element of the same `.ikteach-scene`
 */
export function fit(scene, inside) {
  const { renderer } = scene;
  const [width, height] = [renderer.get("_width"), renderer.get("_height")];
  const observer = new ResizeObserver(([{ target }]) => {
    for (const one of Object.values(renderer.views ?? {})) // Lab calls late, it may be closed
      one.then((view) => view.el === target && draw(scene, view, target));
  });
  /** @type {Timer} */
  let looking;

  const boxOf = () => /** @type {HTMLElement | null} */ (inside.closest(".ikteach-scene"));
  const shaped = () => shape(scene, boxOf(), [width, height]);

  function look() {
    const box = boxOf();
    const host = box?.querySelector(".jupyter-threejs");
    if (!box || !host) {
      looking = setTimeout(look, 50); // pythreejs has not made it yet
      return;
    }
    shaped();
    observer.observe(host);
  }

  const again = () => scene.redraw();
  const stops = [
    listen(renderer, { "change:controls": again }),
    listen(scene.model, { shown: shaped }),
  ];
  look();
  return () => {
    for (const stop of stops) stop();
    clearTimeout(looking);
    observer.disconnect();
  };
}

/**
 * Tell layout.css the aspect of the picture, which hangs on the number of views.
 * @param {Scene} scene
 * @param {HTMLElement | null} box
 * @param {[width: number, height: number]} size of the picture of one view [pixels]
 */
function shape(scene, box, [width, height]) {
  if (!box) return;
  const outer = /** @type {HTMLElement | null} */ (box.closest(".ikteach-arranged"));
  const { style } = outer ?? box;
  const count = scene.shown.length;
  const { wide, narrow } = aspects(count, width / height, scene.needed);
  style.setProperty("--wide", `${wide}`);
  style.setProperty("--narrow", `${narrow}`);
  const more = Math.max(WIDER[count] ?? 1, (wide * height) / width);
  box.style.setProperty("--nominal", `${more * width}px`);
  scene.redraw();
}

/**
 * Draw a view of pythreejs at the size of its element, in pixels of the screen.
 * @param {Scene} scene
 * @param {View} view
 * @param {Element} host
 */
function draw(scene, view, host) {
  view.updateSize = () => {
    if (view.isFrozen || !host.clientWidth) return;
    view.renderer.setPixelRatio(window.devicePixelRatio);
    view.renderer.setSize(host.clientWidth, host.clientHeight, false);
    Object.assign(view.renderer.domElement.style, { width: "", height: "" }); // of before
  };
  view.renderScene = () => {
    const size = /** @type {[number, number]} */ ([host.clientWidth, host.clientHeight]);
    if (!size[0]) return;
    scene.aspect = size[0] / size[1];
    paint(scene, view, size);
  };
  view.updateSize();
  view.tick();
}
