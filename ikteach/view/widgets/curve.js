// A picture of curves with a line at the chosen place. To assistive technology it is a slider.

import { showPNG } from "./binary.js";
import { chosenBy, clamp } from "./choosing.js";
import { element, listen, OWN_KEYS, set, take } from "./dom.js";
import { guarded } from "./guarded.js";

/** @type {Record<string, number>} */
const STEPS = {
  ArrowLeft: -1,
  ArrowDown: -1,
  ArrowRight: 1,
  ArrowUp: 1,
  PageUp: 30,
  PageDown: -30,
};

/** @type {Render} */
function render({ model, el }) {
  const image = element("img", { class: "ikteach-chart", draggable: "false" });
  const line = element("div");
  const box = makeBox(image, line);
  el.append(box);
  follow(model, box, image);

  function draw() {
    showPNG(image, model.get("png"));
    image.alt = model.get("alt");
    set(box, { "aria-valuemax": model.get("places").length - 1 });
    move();
  }

  function move() {
    const chosen = model.get("chosen");
    const [start, end] = model.get("span");
    line.style.left = `${100 * (start + (model.get("places")[chosen] ?? 0) * (end - start))}%`;
    set(box, { "aria-valuenow": chosen, "aria-valuetext": model.get("labels")[chosen] ?? "" });
  }

  const stop = listen(model, { "change:png": draw, "change:places": draw, "change:chosen": move });
  draw();
  return () => {
    stop();
    showPNG(image);
  };
}

/** @param {HTMLElement[]} children */
function makeBox(...children) {
  const aria = { role: "slider", "aria-label": "tick on the error plot", "aria-valuemin": 0 };
  const attributes = { ...OWN_KEYS, ...aria, class: "ikteach-curve", tabindex: 0 };
  return element("div", attributes, ...children);
}

/**
 * Choose by pointer and by keys.
 * @param {Model} model
 * @param {HTMLElement} box
 * @param {HTMLElement} image
 */
function follow(model, box, image) {
  const last = () => model.get("places").length - 1;

  function choose(/** @type {number} */ i) {
    model.set("chosen", clamp(i, 0, last()));
    model.save_changes();
  }

  function point(/** @type {PointerEvent} */ event) {
    const { left, width } = image.getBoundingClientRect();
    const [start, end] = model.get("span");
    choose(nearest(model.get("places"), ((event.clientX - left) / width - start) / (end - start)));
  }

  box.addEventListener("pointerdown", (event) => {
    box.setPointerCapture(event.pointerId);
    point(event);
  });
  box.addEventListener("pointermove", (event) => {
    if (event.buttons & 1) point(event);
  });
  box.addEventListener("keydown", (event) => {
    const chosen = chosenBy(event.key, STEPS, model.get("chosen"), last());
    if (chosen === undefined) return;
    take(event);
    choose(chosen);
  });
}

/**
 * The number of the place nearest to x.
 * @param {number[]} places ascending
 * @param {number} x
 */
export function nearest(places, x) {
  let low = 0;
  let high = places.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (places[middle] < x) low = middle;
    else high = middle;
  }
  return x - places[low] <= places[high] - x ? low : high;
}

export default { render: guarded(render) };
