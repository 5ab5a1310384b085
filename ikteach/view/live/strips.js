// Curves over the last seconds. A message brings rows of float32: the time [s], then the value of
// every line of every panel.

import { floats } from "../widgets/binary.js";
import { element, listen, svg } from "../widgets/dom.js";
import { guarded } from "../widgets/guarded.js";
import { Plot } from "./plot.js";

/** @type {Render} */
function render({ model, el }) {
  const seconds = model.get("seconds");
  const root = element("div", { class: "ikteach-strips", role: "img" });
  el.append(root);
  let width = 1; // of a row
  /** @type {Plot[]} */
  const plots = model.get("panels").map((/** @type {Panel} */ panel) => {
    const canvas = element("canvas");
    root.append(element("div", {}, canvas, legend(panel.lines)));
    const plot = new Plot(canvas, panel, width, seconds);
    width += panel.lines.length;
    return plot;
  });
  /** @type {Float32Array[]} */
  let samples = []; // the oldest first
  let asked = false;

  function draw() {
    asked = false;
    for (const plot of plots) plot.draw(samples);
    const drawn = Number(root.dataset.drawn ?? 0) + 1;
    Object.assign(root.dataset, { samples: samples.length, drawn });
  }

  /** @type {(content: { fresh?: boolean, rows: number }, buffers: DataView[]) => void} */
  function receive({ fresh, rows }, buffers) {
    if (fresh) samples = [];
    if (rows) samples = recent([...samples, ...split(floats(buffers[0]), width)], seconds);
    if (!asked) requestAnimationFrame(draw);
    asked = true;
  }

  const describe = () => root.setAttribute("aria-label", model.get("alt"));
  describe();
  draw();
  const stops = [
    listen(model, { "msg:custom": receive, "change:alt": describe }),
    fitted(root, plots, draw),
  ];
  return () => {
    for (const stop of stops) stop();
  };
}

/**
 * Have plots as wide as the page has room for; call the answer to stop that.
 * @param {HTMLElement} root
 * @param {Plot[]} plots
 * @param {() => void} draw
 */
function fitted(root, plots, draw) {
  const observer = new ResizeObserver(([{ target }]) => {
    if (!target.clientWidth) return;
    for (const plot of plots) plot.resize(target.clientWidth);
    draw();
  });
  const first = root.querySelector("canvas"); // all are equally wide
  if (first) observer.observe(first);
  return () => observer.disconnect();
}

/**
 * @param {Float32Array} numbers
 * @param {number} width of a row
 */
export function split(numbers, width) {
  const rows = Math.floor(numbers.length / width);
  return Array.from({ length: rows }, (_, i) => numbers.subarray(i * width, (i + 1) * width));
}

/**
 * The samples of the last seconds.
 * @param {Float32Array[]} samples
 * @param {number} seconds
 */
export function recent(samples, seconds) {
  const oldest = samples[samples.length - 1][0] - seconds;
  return samples.filter(([time]) => time >= oldest);
}

/** @param {Line[]} lines */
function legend(lines) {
  const entries = lines.map(({ name, colour, dashes }) => {
    const look = { stroke: colour, "stroke-width": 2.5, "stroke-dasharray": dashes.join(" ") };
    const stroke = svg("line", { x1: 0, y1: 4, x2: 30, y2: 4, ...look });
    const sample = svg("svg", { width: 30, height: 8, "aria-hidden": true }, stroke);
    return element("span", {}, sample, " ", name);
  });
  return element("div", {}, ...entries);
}

export default { render: guarded(render) };
