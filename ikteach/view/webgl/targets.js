// A slider and a number box for each coordinate of each target, and a button that takes back.

import { element, listen, OWN_KEYS } from "../widgets/dom.js";
import { guarded } from "../widgets/guarded.js";
import { Courier } from "./courier.js";

const HEADINGS = ["x, left", "y, up", "z, forward"];

/** @type {Render} */
function render({ model, el }) {
  const post = new Courier(model);
  /** @type {string[]} */
  const names = model.get("names");
  const pairs = names.map((name, target) =>
    [..."xyz"].map((letter, axis) => new Pair(model, post, target, axis, `${name} ${letter}`)),
  );
  const rows = names.map((name, target) =>
    makeRow(name, model.get("marks")[target], model.get("colours")[target], pairs[target]),
  );
  const headings = [`target [${model.get("unit")}]`, ...HEADINGS];
  const head = headings.map((title) => element("th", { scope: "col" }, title));
  const attributes = { class: "ikteach-undo jupyter-button", type: "button" };
  const button = element("button", attributes, "Undo move");
  const alert = element("p", { class: "ikteach-alert", role: "alert" });
  const table = element("table", { class: "ikteach-targets" }, element("tr", {}, ...head), ...rows);
  el.append(table, button, alert);

  function show() {
    for (const pair of pairs.flat()) pair.show();
  }
  function warn() {
    alert.textContent = model.get("alert");
  }
  button.addEventListener("click", () => model.send({ undo: true }));
  const stop = listen(model, {
    "change:values": show,
    "change:alert": warn,
    "msg:custom": ({ again }) => again && show(),
  });
  show();
  warn();
  return () => {
    post.close();
    stop();
  };
}

/** A slider and a number box for one coordinate. */
class Pair {
  #model;
  #post;
  #target;
  #axis;

  /**
   * @param {Model} model
   * @param {Courier} post
   * @param {number} target
   * @param {number} axis
   * @param {string} name
   */
  constructor(model, post, target, axis, name) {
    this.#model = model;
    this.#post = post;
    this.#target = target;
    this.#axis = axis;
    const [min, max] = ["low", "high"].map((end) => this.#shown(end));
    const common = { ...OWN_KEYS, min, max, step: model.get("step") };
    this.slider = element("input", { ...common, type: "range", "aria-label": `${name} slider` });
    this.box = element("input", { ...common, type: "number", "aria-label": name });
    this.slider.disabled = this.box.disabled = min === max;
    this.slider.addEventListener("input", () => this.#slide());
    this.slider.addEventListener("change", () => delete this.slider.dataset.held);
    this.box.addEventListener("input", () => {
      this.box.dataset.typing = "true";
    });
    this.box.addEventListener("change", () => this.#commit());
    this.box.addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      this.#commit();
      event.stopPropagation(); // the notebook would keep Enter from making a change
    });
  }

  /** Show where the target is, unless a person is about to say where. */
  show() {
    const value = this.#shown("values");
    const words = value.toFixed(this.#model.get("digits"));
    if (!this.slider.dataset.held) this.slider.value = `${value}`;
    this.slider.setAttribute("aria-valuetext", `${words} ${this.#model.get("unit")}`);
    if (!this.box.dataset.typing) this.box.value = words;
  }

  /**
   * Its coordinate of `values`, `low` or `high`, in the unit that is shown.
   * @param {string} trait
   * @returns {number}
   */
  #shown(trait) {
    return this.#model.get(trait)[this.#target][this.#axis] / this.#model.get("metres");
  }

  /** One move until the slider is let go. */
  #slide() {
    const { slider } = this;
    this.#post.send({
      target: this.#target,
      axis: this.#axis,
      value: slider.valueAsNumber * this.#model.get("metres"),
      fresh: !slider.dataset.held,
    });
    slider.dataset.held = "true";
  }

  #commit() {
    const { dataset, valueAsNumber } = this.box;
    if (!dataset.typing) return;
    delete dataset.typing;
    const value = Number.isFinite(valueAsNumber) ? valueAsNumber * this.#model.get("metres") : null;
    this.#model.send({ target: this.#target, axis: this.#axis, value, typed: true });
  }
}

/**
 * @param {string} name
 * @param {string} shape
 * @param {string} colour
 * @param {Pair[]} pairs
 */
function makeRow(name, shape, colour, pairs) {
  const mark = element("span", { "aria-hidden": true }, `${shape} `);
  mark.style.color = colour;
  const cells = pairs.map(({ slider, box }) => element("td", {}, slider, box));
  return element("tr", {}, element("th", { scope: "row" }, mark, name), ...cells);
}

export default { render: guarded(render) };
