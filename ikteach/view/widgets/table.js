// A table one row of which is chosen, by a click or by the keys.

import { chosenBy } from "./choosing.js";
import { element, listen, OWN_KEYS, take } from "./dom.js";
import { guarded } from "./guarded.js";

/** @type {Record<string, number>} */
const STEPS = { ArrowUp: -1, ArrowDown: 1, PageUp: -10, PageDown: 10 };

/** @type {Render} */
function render({ model, el }) {
  const box = element("div", { class: "ikteach-rows" });
  el.append(box);
  /** @type {HTMLTableRowElement[]} */
  let rows = [];
  /** @type {HTMLTableRowElement | undefined} */
  let shown;

  function fill() {
    rows = model.get("rows").map(makeRow);
    box.replaceChildren(makeTable(model.get("label"), model.get("header"), rows));
    shown = undefined;
    move();
  }

  function move() {
    const row = rows[model.get("chosen")];
    if (!row) return;
    const inside = box.contains(document.activeElement);
    mark(shown, false);
    mark(row, true);
    shown = row;
    if (inside) row.focus({ preventScroll: true });
    scroll(box, row, rows[0].offsetTop);
  }

  follow(model, box);
  fill();
  return listen(model, { "change:rows": fill, "change:chosen": move });
}

/**
 * Choose by click and by keys.
 * @param {Model} model
 * @param {HTMLElement} box
 */
function follow(model, box) {
  function choose(/** @type {number} */ i) {
    box.querySelectorAll("tr")[i + 1].focus({ preventScroll: true }); // below the heading
    model.set("chosen", i);
    model.save_changes();
  }

  box.addEventListener("click", ({ target }) => {
    const row = target instanceof Element ? target.closest("tr")?.dataset.row : undefined;
    if (row !== undefined) choose(+row);
  });
  box.addEventListener("keydown", (event) => {
    const last = model.get("rows").length - 1;
    const chosen = chosenBy(event.key, STEPS, model.get("chosen"), last);
    if (chosen === undefined) return;
    take(event);
    choose(chosen);
  });
}

/**
 * @param {string} label
 * @param {string[]} names
 * @param {HTMLElement[]} rows
 */
function makeTable(label, names, rows) {
  const head = names.map((name) => element("th", { scope: "col" }, name));
  const attributes = { role: "grid", "aria-label": label };
  return element(
    "table",
    attributes,
    element("thead", {}, element("tr", {}, ...head)),
    element("tbody", {}, ...rows),
  );
}

/**
 * @param {string[]} words
 * @param {number} i
 */
function makeRow(words, i) {
  const attributes = { ...OWN_KEYS, "data-row": i, tabindex: -1, "aria-selected": false };
  return element("tr", attributes, ...words.map((text) => element("td", {}, text)));
}

/**
 * @param {HTMLElement | undefined} row
 * @param {boolean} chosen
 */
function mark(row, chosen) {
  row?.setAttribute("aria-selected", `${chosen}`);
  row?.setAttribute("tabindex", chosen ? "0" : "-1");
}

/**
 * Scroll no farther than brings the row into view.
 * @param {HTMLElement} box
 * @param {HTMLElement} row
 * @param {number} head how much of the box the heading covers [pixels]
 */
function scroll(box, row, head) {
  const below = row.offsetTop + row.offsetHeight - box.clientHeight;
  box.scrollTop = Math.max(below, Math.min(box.scrollTop, row.offsetTop - head));
}

export default { render: guarded(render) };
