// A link to the state of a figure: copied, and shown as a text to select.

import { element, listen, OWN_KEYS, take } from "../widgets/dom.js";
import { guarded } from "../widgets/guarded.js";
import { keepInView } from "../widgets/inview.js";

const PAGE = /\/voila\/render\//; // in the path of a page that takes states from its address

/** @type {Render} */
function render({ model, el }) {
  el.classList.add("ikteach-link");
  if (model.get("button")) {
    const button = element("button", { ...OWN_KEYS, type: "button" }, "Link to this");
    button.addEventListener("click", () => model.send({ link: true }));
    el.append(button);
  }
  return listen(model, { "change:asked": () => show(el, addressOf(model.get("state"), location)) });
}

/**
 * @param {Element} el
 * @param {string} address
 */
function show(el, address) {
  const before = document.activeElement;
  const said = element("span", { role: "status" });
  const text = element("input", { ...OWN_KEYS, readonly: "", value: address, spellcheck: "false" });
  const row = element("label", {}, "Link to this:", text, said);
  el.querySelector("label")?.remove();
  el.append(row);
  text.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    take(event);
    row.remove();
    if (before instanceof HTMLElement) before.focus({ preventScroll: true });
  });
  text.focus({ preventScroll: true });
  text.select();
  keepInView(row);
  const by = "Ctrl + C copies it, Escape puts it away.";
  (navigator.clipboard?.writeText(address) ?? Promise.reject()).then(
    () => said.append("It is copied; Escape puts it away."),
    () => said.append(by),
  );
}

/**
 * What leads to a state: an address, or in a notebook what a cell needs.
 * @param {string} state
 * @param {{ origin: string, pathname: string }} place of the page
 */
export function addressOf(state, { origin, pathname }) {
  if (!PAGE.test(pathname)) return `preset(figure, "${state}")`;
  return `${origin}${pathname}${state && "?"}${state}`;
}

export default { render: guarded(render) };
