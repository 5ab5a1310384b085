// Options to be put in order, each with a button for up and one for down.

import { element, OWN_KEYS } from "../view/widgets/dom.js";

const UP = { sign: "▲", name: "up", by: -1 };
const DOWN = { sign: "▼", name: "down", by: 1 };

/** @implements {Fields} */
export class Ranking {
  missing = "";
  /** @type {string[]} */
  #order;
  #locked = false;
  #list = element("ol");

  /** @param {Model} model */
  constructor(model) {
    this.#order = model.get("answer") ?? model.get("options");
    this.rows = [this.#list];
  }

  read() {
    return this.#order;
  }

  /** @param {boolean} locked */
  lock(locked) {
    this.#locked = locked;
    this.#draw();
  }

  #draw() {
    const items = this.#order.map((option, i) => {
      const [up, down] = [UP, DOWN].map((way) => this.#button(way, option, i));
      return element("li", {}, `${i + 1}.`, up, down, option);
    });
    this.#list.replaceChildren(...items);
  }

  /**
   * @param {typeof UP} way
   * @param {string} option
   * @param {number} i
   */
  #button({ sign, name, by }, option, i) {
    const attributes = { ...OWN_KEYS, type: "button", "aria-label": `move ${option} ${name}` };
    const button = element("button", attributes, sign);
    button.disabled = this.#locked || i + by < 0 || i + by >= this.#order.length;
    button.addEventListener("click", () => {
      this.#order = exchanged(this.#order, i, i + by);
      this.#draw();
      this.#focus(i + by, by);
    });
    return button;
  }

  /**
   * Keep the focus on the button that was pressed, where that still can be.
   * @param {number} i
   * @param {number} by
   */
  #focus(i, by) {
    const [up, down] = this.#list.children[i].querySelectorAll("button");
    const [same, other] = by < 0 ? [up, down] : [down, up];
    (same.disabled ? other : same).focus();
  }
}

/**
 * The order with two places exchanged.
 * @param {string[]} order
 * @param {number} i
 * @param {number} j
 */
export function exchanged(order, i, j) {
  const changed = [...order];
  [changed[i], changed[j]] = [order[j], order[i]];
  return changed;
}
