// A question with its answer: choices, a number, or an order; all of it by native form controls,
// so that keyboards and screen readers know them.

import { element, listen, OWN_KEYS, take } from "../view/widgets/dom.js";
import { guarded } from "../view/widgets/guarded.js";
import { choices, number } from "./fields.js";
import { Ranking } from "./ranking.js";

/** @type {Record<string, (model: Model) => Fields>} */
const FIELDS = { choice: choices, number, ranking: (model) => new Ranking(model) };

/** @type {Render} */
function render({ model, el }) {
  const fields = FIELDS[model.get("kind")](model);
  const button = element("button", { ...OWN_KEYS, type: "submit" }, model.get("button"));
  const status = element("p", { role: "status" });
  const form = makeForm(model, fields.rows, button, status);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const answer = fields.read();
    status.textContent = answer === null ? fields.missing : "";
    if (answer !== null) send(model, answer);
  });

  function update() {
    const locked = model.get("locked");
    fields.lock(locked);
    button.hidden = locked;
    status.textContent = model.get("status");
  }
  update();
  el.append(form);
  return listen(model, {
    "change:locked": update,
    "change:status": update,
    "change:asked": update,
  });
}

/**
 * @param {Model} model
 * @param {HTMLElement[]} rows
 * @param {HTMLElement[]} below
 */
function makeForm(model, rows, ...below) {
  const note = model.get("note");
  const legend = element("legend", {}, model.get("question"));
  const notes = note ? [element("p", {}, note)] : [];
  const fieldset = element("fieldset", {}, legend, ...notes, ...rows);
  const attributes = { class: "ikteach-question", novalidate: "" };
  const form = element("form", attributes, fieldset, ...below);
  form.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" || !(event.target instanceof HTMLInputElement)) return;
    take(event);
    form.requestSubmit();
  });
  return form;
}

/**
 * @param {Model} model
 * @param {unknown} answer
 */
function send(model, answer) {
  model.set("asked", model.get("asked") + 1);
  model.set("answer", answer);
  model.save_changes();
}

export default { render: guarded(render) };
