// A slider of two dimensions: drag the globe, or use the arrow keys.

import { clamp } from "./choosing.js";
import { listen, OWN_KEYS, set, svg, take } from "./dom.js";
import { globe, RADIUS } from "./globe.js";
import { guarded } from "./guarded.js";

const STEP = 5; // [degrees] per key press; 1 with Shift
/** @type {Record<string, number[]>} */
const KEYS = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** @type {Render} */
function render({ model, el }) {
  const ball = makeBall(model.get("label"));
  el.append(ball);

  function draw() {
    const azimuth = model.get("azimuth");
    const elevation = model.get("elevation");
    ball.replaceChildren(...globe(azimuth, elevation));
    const left = `${Math.round(azimuth)}° to the left of the front`;
    set(ball, {
      "aria-valuenow": Math.round(azimuth),
      "aria-valuetext": `${left}, ${Math.round(elevation)}° up`,
    });
  }

  drag(ball, model);
  ball.addEventListener("keydown", (event) => {
    const move = KEYS[event.key];
    if (!move) return;
    take(event);
    const step = event.shiftKey ? 1 : STEP;
    turn(model, model.get("azimuth") + step * move[0], model.get("elevation") + step * move[1]);
  });
  draw();
  return listen(model, { change: draw });
}

/** @param {string} label */
function makeBall(label) {
  const size = 2 * RADIUS + 12;
  return svg("svg", {
    ...OWN_KEYS,
    class: "ikteach-ball",
    role: "slider",
    tabindex: 0,
    width: size,
    height: size,
    viewBox: `${-size / 2} ${-size / 2} ${size} ${size}`,
    "aria-label": label,
    "aria-valuemin": -180,
    "aria-valuemax": 180,
  });
}

/**
 * Let the pointer turn the ball, a degree per pixel.
 * @param {SVGElement} ball
 * @param {Model} model
 */
function drag(ball, model) {
  /** @type {number[] | null} */
  let held = null; // azimuth + x and elevation − y, which stay while the ball is dragged
  ball.addEventListener("pointerdown", (event) => {
    ball.setPointerCapture(event.pointerId);
    held = [model.get("azimuth") + event.clientX, model.get("elevation") - event.clientY];
  });
  ball.addEventListener("pointermove", (event) => {
    if (held) turn(model, held[0] - event.clientX, held[1] + event.clientY);
  });
  for (const name of ["pointerup", "pointercancel"])
    ball.addEventListener(name, () => {
      held = null;
    });
}

/**
 * @param {Model} model
 * @param {number} azimuth [degrees]
 * @param {number} elevation [degrees]
 */
function turn(model, azimuth, elevation) {
  model.set("azimuth", ((azimuth + 540) % 360) - 180);
  model.set("elevation", clamp(elevation, -85, 85));
  model.save_changes();
}

export default { render: guarded(render) };
