// A plane with lines and arrows, and one point that is dragged, or moved by keys; it may draw.

import { clamp } from "./choosing.js";
import { connected, listen, OWN_KEYS, svg, take } from "./dom.js";
import { guarded } from "./guarded.js";
import { makePen } from "./pen.js";

const SIZE = 320; // of a side, in units of the drawing
const HEAD = 9; // of an arrow
const ROW = 4; // by which names that meet are moved apart
const FINE = 0.1; // of a key's step, with Shift
/** @type {Record<string, number[]>} */
const KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** @typedef {{ colour: string, dashes: string, width: number }} Look */
/** @typedef {Look & { points: number[][], arrow: boolean, name: string, legend: boolean }} Line */

/** @type {Render} */
function render({ model, el }) {
  const lines = svg("g");
  const knob = makeKnob(model.get("handle"));
  const plane = svg("svg", {
    class: "ikteach-plane",
    role: "group",
    viewBox: `0 0 ${SIZE} ${SIZE}`,
    "aria-label": model.get("title"),
  });
  plane.append(...axes(model), lines);
  if (model.get("handle")) plane.append(knob);
  const held = drag(plane, knob, model);
  const lift = model.get("pen") ? penOn(plane, knob, model) : () => {};

  function draw() {
    const half = model.get("half");
    const shown = model.get("lines");
    const named = shown.filter((/** @type {Line} */ one) => one.legend);
    lines.replaceChildren(
      ...shown.flatMap((/** @type {Line} */ one) => line(one, half)),
      ...named.flatMap(entry),
    );
    spread([...lines.querySelectorAll("text")]);
    plane.setAttribute("aria-label", `${model.get("title")}. ${model.get("alt")}`);
    if (!held.now) place(knob, model.get("at"), half);
    knob.setAttribute("aria-valuetext", model.get("said"));
    knob.setAttribute("aria-valuenow", `${model.get("at")[0]}`);
  }
  draw();
  el.append(plane);
  let gone = false;
  connected(el, () => gone).then(draw); // only then have names a size
  const stop = listen(model, { change: draw });
  return () => {
    gone = true;
    stop();
    lift();
  };
}

/**
 * @param {SVGElement} plane
 * @param {SVGElement} knob
 * @param {Model} model
 */
function penOn(plane, knob, model) {
  plane.classList.add("ikteach-drawn");
  const half = () => model.get("half");
  return makePen(
    plane,
    knob,
    model,
    (event) => underPointer(plane, event, half()),
    (points) => path(points.map((point) => onPlane(point, half()))),
  );
}

/**
 * @param {SVGElement} plane
 * @param {PointerEvent} event
 * @param {number} half
 */
function underPointer(plane, event, half) {
  const box = plane.getBoundingClientRect();
  const [x, y] = [event.clientX - box.left, event.clientY - box.top];
  return underPoint([x / box.width, y / box.height], half);
}

/** @param {number[][]} at */
function path(at) {
  return `M${at.map((p) => p.join(" ")).join("L")}`;
}

/**
 * Where a point of the plane lies in the drawing.
 * @param {number[]} at
 * @param {number} half of the plane's width
 */
export function onPlane([x, y], half) {
  return [(1 + x / half) * (SIZE / 2), (1 - y / half) * (SIZE / 2)];
}

/**
 * The point of the plane under a place of the drawing, within the plane.
 * @param {number[]} at as shares of width and height
 * @param {number} half
 */
export function underPoint([x, y], half) {
  return [clamp((2 * x - 1) * half, -half, half), clamp((1 - 2 * y) * half, -half, half)];
}

/** @param {string} label */
function makeKnob(label) {
  const knob = svg("g", {
    ...OWN_KEYS,
    class: "ikteach-knob",
    role: "slider",
    tabindex: 0,
    "aria-label": `${label}, moved by the arrow keys`,
    "aria-valuenow": 0,
  });
  knob.append(svg("circle", { r: 16, class: "ikteach-grip" }), svg("circle", { r: 7 }));
  return knob;
}

/**
 * @param {SVGElement} knob
 * @param {number[]} at
 * @param {number} half
 */
function place(knob, at, half) {
  const [x, y] = onPlane(at, half);
  knob.setAttribute("transform", `translate(${clamp(x, 0, SIZE)} ${clamp(y, 0, SIZE)})`);
}

/** @param {Model} model */
function axes(model) {
  const middle = SIZE / 2;
  const [x, y] = [model.get("xlabel"), model.get("ylabel")];
  return [
    svg("path", { class: "ikteach-axis", d: `M0 ${middle}H${SIZE}M${middle} 0V${SIZE}` }),
    svg("text", { x: SIZE - 4, y: middle + 16, "text-anchor": "end" }, x),
    svg("text", { x: middle + 6, y: 14 }, y),
  ];
}

/**
 * A line, with its arrow's head and its name at the end.
 * @param {Line} line
 * @param {number} half
 */
function line({ points, colour, arrow, name, legend, ...look }, half) {
  const at = points.map((point) => onPlane(point, half));
  const made = [svg("path", { ...stroke({ colour, ...look }), d: path(at) })];
  const end = at[at.length - 1];
  const before = at[at.length - 2] ?? end;
  const angle = Math.atan2(end[1] - before[1], end[0] - before[0]);
  if (arrow && Math.hypot(end[0] - before[0], end[1] - before[1]) > 1)
    made.push(svg("path", { d: head(end, angle), fill: colour }));
  if (!name || legend) return made;
  const [x, y] = [end[0] + 14 * Math.cos(angle), end[1] + 14 * Math.sin(angle) + 4];
  const where = { x: clamp(x, 24, SIZE - 24), y: clamp(y, 28, SIZE - 6), "text-anchor": "middle" };
  return [...made, svg("text", { ...where, class: "ikteach-name" }, name)];
}

/**
 * Move names towards the middle until none stands on another; those of the legend, the last, stay.
 * @param {SVGTextElement[]} names
 */
function spread(names) {
  /** @type {DOMRect[]} */
  const taken = [];
  for (const name of names.reverse()) {
    const box = name.getBBox();
    const row = box.y > SIZE / 2 ? -ROW : ROW;
    while (taken.some((one) => overlap(one, box))) box.y += row;
    name.setAttribute("y", `${Number(name.getAttribute("y")) + box.y - name.getBBox().y}`);
    taken.push(box);
  }
}

/**
 * Whether two boxes have a part in common.
 * @param {DOMRect} a
 * @param {DOMRect} b
 */
export function overlap(a, b) {
  return (
    Math.abs(2 * (a.x - b.x) + a.width - b.width) < a.width + b.width &&
    Math.abs(2 * (a.y - b.y) + a.height - b.height) < a.height + b.height
  );
}

/**
 * The row of a line in the legend.
 * @param {Line} line
 * @param {number} row
 */
function entry(line, row) {
  const y = 32 + 16 * row;
  const words = svg("text", { x: 44, y: y + 4 }, line.name);
  return [svg("path", { ...stroke(line), d: `M8 ${y}H38` }), words];
}

/** @param {Look} look */
function stroke({ colour, dashes, width }) {
  return { stroke: colour, "stroke-width": width, "stroke-dasharray": dashes, fill: "none" };
}

/**
 * @param {number[]} end
 * @param {number} angle
 */
function head([x, y], angle) {
  const [left, right] = [angle + 2.7, angle - 2.7].map(
    (a) => `L${x + HEAD * Math.cos(a)} ${y + HEAD * Math.sin(a)}`,
  );
  return `M${x} ${y}${left}${right}Z`;
}

/**
 * Let pointer and keys move the point; `now` is whether the pointer holds it.
 * @param {SVGElement} plane
 * @param {SVGElement} knob
 * @param {Model} model
 */
function drag(plane, knob, model) {
  const held = { now: false };
  const move = (/** @type {number[]} */ at) => {
    const half = model.get("half");
    place(knob, at, half);
    model.set(
      "at",
      at.map((x) => clamp(x, -half, half)),
    );
    model.save_changes();
  };
  knob.addEventListener("pointerdown", (event) => {
    knob.setPointerCapture(event.pointerId);
    knob.focus();
    held.now = true;
    take(event);
  });
  knob.addEventListener("pointermove", (event) => {
    if (held.now) move(underPointer(plane, event, model.get("half")));
  });
  for (const name of ["pointerup", "pointercancel"])
    knob.addEventListener(name, () => {
      held.now = false;
    });
  knob.addEventListener("keydown", (event) => {
    const way = KEYS[event.key];
    if (!way) return;
    take(event);
    const step = model.get("step") * (event.shiftKey ? FINE : 1);
    const [x, y] = model.get("at");
    move([x + step * way[0], y + step * way[1]]);
  });
  return held;
}

export default { render: guarded(render) };
