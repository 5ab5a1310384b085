// The distance of each effector to its target, in figures that are read from the last row.

import { element } from "../widgets/dom.js";

export class Far {
  box = element("div", { class: "ikteach-far", "aria-hidden": true }); // the words say it, too
  #numbers;

  /** @param {[name: string, colour: string][]} effectors */
  constructor(effectors) {
    this.#numbers = effectors.map(([name, colour]) => {
      const number = element("b");
      const one = element("span", {}, element("b", {}, `${name} `), number);
      one.style.borderColor = colour;
      this.box.append(one);
      return number;
    });
    this.box.hidden = true;
  }

  /**
   * Show these distances; none hide the box.
   * @param {string[]} [distances]
   */
  show(distances) {
    this.box.hidden = !distances;
    distances?.forEach((words, i) => {
      this.#numbers[i].textContent = words;
    });
  }
}
