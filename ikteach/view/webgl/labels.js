// The names of views, over the picture: which there are, and on which of them keys act.

import { element, listen } from "../widgets/dom.js";

/** @import { Scene } from "./scene.js" */

export class Labels {
  #box = element("div", { class: "ikteach-views", "aria-hidden": true }); // words say it, too
  #scene;
  #host;
  #stop;

  /**
   * @param {Scene} scene
   * @param {HTMLElement} host the picture
   */
  constructor(scene, host) {
    this.#scene = scene;
    this.#host = host;
    this.#stop = listen(scene.model, { afterViews: () => this.#show() });
  }

  end() {
    this.#stop();
    this.#box.remove();
  }

  #show() {
    const { panes, chosen } = this.#scene;
    const many = panes.length > 1;
    if (many && this.#box.parentElement !== this.#host) this.#host.append(this.#box);
    if (!many) return this.#box.remove();
    while (this.#box.children.length > panes.length) this.#box.lastElementChild?.remove();
    panes.forEach((pane, i) => {
      const one = this.#one(i);
      const words = i === chosen ? `▸ ${pane.title}` : pane.title;
      const label = one.children[0];
      if (label.textContent !== words) label.textContent = words;
      one.classList.toggle("ikteach-chosen", i === chosen);
      const [left, top, width, height] = pane.place.map((share) => `${100 * share}%`);
      Object.assign(one.style, { left, top, width, height });
    });
  }

  /** @param {number} i */
  #one(i) {
    while (this.#box.children.length <= i) this.#box.append(element("span", {}, element("b")));
    return /** @type {HTMLElement} */ (this.#box.children[i]);
  }
}
