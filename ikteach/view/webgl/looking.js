// How a person looks at the scene: the wheel and a finger scroll the page until the picture is
// chosen, keys turn the camera and do what the buttons under the picture do.

import { element, listen, listenTo, OWN_KEYS, set, take } from "../widgets/dom.js";
import { bringIntoView } from "../widgets/inview.js";
import { arrowOf, turned, ZOOM } from "./keys.js";
import { Labels } from "./labels.js";
import { pixelOf } from "./scene.js";

/** @import { Scene } from "./scene.js" */

const LEAST = 200; // [pixels] of a picture's sides
const GAP = 4; // [pixels] between what stands under it
/** @type {Record<string, [string, string]>} key: label of its button, and what it does */
const OWN = {
  0: ["View back", "looks from where it was at first"],
  f: ["Full screen", "fills the screen with the picture, and gives it back"],
  p: ["Save picture", "saves the picture as PNG"],
};
const VIEWS = "shows one view; two, with the side; or four, with front, side and top";
const NEXT = "goes to the next view: keys act there, as they do where one clicks";

export class Looking {
  #scene;
  #stage;
  #model;
  #box;
  /** @type {{ size: [number, number], aspect: string } | null} */
  #before = null; // of the picture, while it fills the screen
  #away = new AbortController();
  /** @type {(() => void)[]} */
  #stops = [];

  /**
   * @param {Scene} scene
   * @param {HTMLElement} stage the picture of the scene
   * @param {HTMLElement} el holds the buttons
   * @param {Model} model of the driver
   */
  constructor(scene, stage, el, model) {
    this.#scene = scene;
    this.#stage = stage;
    this.#model = model;
    /** @type {HTMLElement | null} */
    const box = stage.closest(".ikteach-scene");
    this.#box = box ?? stage;
    stage.classList.add("ikteach-stage");
    if (!stage.hasAttribute("aria-label")) stage.setAttribute("aria-label", "Scene");
    set(stage, { ...OWN_KEYS, role: "application", tabindex: 0 });
    const { signal } = this.#away;
    listenTo(stage, this.#first(), { capture: true, signal });
    const choose = () => stage.focus({ preventScroll: true });
    const events = { keydown: this.#press, dblclick: () => this.act("0"), click: choose };
    listenTo(stage, events, { signal });
    const release = () => {
      scene.pressed = false;
    };
    listenTo(window, { pointerup: release, pointercancel: release }, { signal, capture: true });
    listenTo(this.#box, { fullscreenchange: () => this.#fit() }, { signal });
    const sizes = new ResizeObserver(() => this.#before && this.#fit()); // and of the screen
    for (const one of [el, document.body]) sizes.observe(one);
    this.#stops.push(() => sizes.disconnect());
    const tools = element("div", { class: "ikteach-tools", role: "toolbar", ...OWN_KEYS });
    tools.setAttribute("aria-label", "Picture");
    el.prepend(tools);
    const show = () => this.#renew(tools);
    this.#stops.push(listen(model, { "change:acts": show, "change:pace": show }));
    this.#stops.push(listen(model, { "change:measuring": show, "change:splits": show }));
    this.#stops.push(() => tools.remove());
    this.#seeViews(el, show);
    show();
  }

  /**
   * Know which views there are, and name the one that keys act on.
   * @param {HTMLElement} el
   * @param {() => void} show renews the buttons
   */
  #seeViews(el, show) {
    const [scene, model] = [this.#scene, this.#model];
    const labels = new Labels(scene, this.#stage);
    const said = element("p", { class: "ikteach-unseen", role: "status" });
    el.append(said);
    const chosen = () => {
      model.set("view", scene.chosen);
      model.save_changes();
      said.textContent = `Keys act on the view ${scene.pane.title}.`;
      show();
    };
    this.#stops.push(
      listen(scene.model, { chosen }),
      listen(model, { "change:panes": show }),
      () => labels.end(),
      () => said.remove(),
    );
  }

  end() {
    this.#away.abort();
    for (const stop of this.#stops) stop();
  }

  /**
   * Do what a key does; false if it does nothing.
   * @param {string} key
   */
  act(key) {
    if (key === "f") this.#fill();
    else if (key === "p") this.#save();
    else if (key === "d" && this.#model.get("measures")) this.#measure();
    else if (key === "0") this.#goBack();
    else if (key === "v" && this.#model.get("splits")) this.#model.send({ act: "v" });
    else if (key === "n" && this.#scene.panes.length > 1) this.#goOn();
    else if (key in this.#model.get("acts")) this.#model.send({ act: key });
    else return false;
    return true;
  }

  /** What the camera would take for itself, while the picture is not chosen. */
  #first() {
    const pass = (/** @type {Event} */ event) => {
      if (document.activeElement !== this.#stage) event.stopPropagation();
    };
    const here = (/** @type {MouseEvent} */ event) =>
      this.#scene.choose(this.#scene.at(pixelOf(this.#stage, event)));
    const wheel = (/** @type {WheelEvent} */ event) => {
      if (document.activeElement === this.#stage || event.ctrlKey || event.metaKey) here(event);
      else event.stopPropagation();
    };
    const wheels = { wheel, mousewheel: wheel, MozMousePixelScroll: wheel };
    // The camera keeps a mouse from choosing what it presses; a finger may only want to scroll.
    const pointerdown = (/** @type {PointerEvent} */ event) => {
      if (event.pointerType !== "touch") this.#stage.focus({ preventScroll: true });
      here(event);
      this.#scene.pressed = true;
    };
    return { ...wheels, pointerdown, touchstart: pass, touchmove: pass };
  }

  #press = (/** @type {KeyboardEvent} */ event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || event.defaultPrevented) return;
    const arrow = arrowOf(event) ?? { "+": [0, 0, -1], "-": [0, 0, 1] }[event.key];
    if (arrow) this.#scene.look((away) => turned(away, arrow), ZOOM ** -arrow[2]);
    else if (!this.act(event.key === "Home" ? "0" : event.key.toLowerCase())) return;
    take(event);
  };

  #goBack() {
    this.#scene.controls.update_controlled();
    this.#model.send({ act: "0" });
  }

  #goOn() {
    this.#scene.choose((this.#scene.chosen + 1) % this.#scene.panes.length);
  }

  #measure() {
    this.#model.set("measuring", !this.#model.get("measuring"));
    this.#model.save_changes();
  }

  #fill() {
    if (document.fullscreenElement) document.exitFullscreen();
    else this.#box.requestFullscreen().then(() => this.#stage.focus());
  }

  /** Take the size of the screen but for what stands under the picture, or the size of before. */
  #fit() {
    const full = document.fullscreenElement === this.#box;
    if (full) {
      const { style } = this.#box;
      this.#before ??= { size: this.#scene.size, aspect: style.getPropertyValue("--aspect") };
      const others = [...this.#box.children].filter((one) => !one.contains(this.#stage));
      const under = others.reduce((sum, { clientHeight }) => sum + clientHeight + GAP, 0);
      const [width, height] = [window.innerWidth, Math.max(window.innerHeight - under, LEAST)];
      style.setProperty("--aspect", `${width / height}`); // layout.css gives it its place
      this.#scene.resize(width, height);
    } else if (this.#before) {
      this.#box.style.setProperty("--aspect", this.#before.aspect);
      this.#scene.resize(...this.#before.size);
      this.#before = null;
      bringIntoView(this.#box);
    }
  }

  /** The picture is there only just after it was drawn. */
  #save() {
    const stop = listen(this.#scene.model, {
      afterViews: () => {
        stop();
        const canvas = this.#stage.querySelector("canvas");
        const href = canvas?.toDataURL("image/png");
        if (href) element("a", { href, download: "figure.png" }).click();
      },
    });
    this.#scene.redraw();
  }

  /**
   * Show the buttons as they are now; the focus, and the keys that were unfolded, stay.
   * @param {HTMLElement} tools
   */
  #renew(tools) {
    const held = document.activeElement;
    const key = held instanceof HTMLElement && tools.contains(held) ? held.dataset.key : undefined;
    const open = tools.querySelector("details")?.open ?? false;
    tools.replaceChildren(...this.#buttons());
    /** @type {HTMLElement | null} */
    const same = tools.querySelector(`[data-key="${key}"]`);
    same?.focus({ preventScroll: true });
    const keys = tools.querySelector("details");
    if (keys) keys.open = open;
  }

  #buttons() {
    const model = this.#model;
    const acts = Object.entries(model.get("acts"));
    const pace = model.get("pace");
    const buttons = Object.entries(OWN).map(([key, [label]]) => this.#button(key, label));
    if (model.get("measures")) {
      const pressed = { "aria-pressed": model.get("measuring") };
      buttons.push(this.#button("d", "Distances", pressed));
    }
    if ("l" in model.get("acts")) buttons.push(this.#button("l", "Link to this"));
    if (pace) buttons.push(this.#button("s", `Time ${pace}`));
    const views = model.get("panes").length;
    if (model.get("splits")) buttons.push(this.#button("v", `Views: ${views}`));
    if (views > 1) buttons.push(this.#button("n", `View: ${this.#scene.pane.name}`));
    const own = Object.entries(OWN).map(([key, [, does]]) => [key, does]);
    const more = model.get("splits")
      ? [
          ["v", VIEWS],
          ["n", NEXT],
        ]
      : [];
    if (model.get("measures")) more.unshift(["d", MEASURE]);
    return [...buttons, help([...acts, ...own, ...more])];
  }

  /**
   * @param {string} key
   * @param {string} label
   * @param {Attributes} more
   */
  #button(key, label, more = {}) {
    const title = `${label} (key ${key.toUpperCase()})`;
    const button = element("button", { type: "button", "data-key": key, title, ...more }, label);
    button.addEventListener("click", () => this.act(key));
    return button;
  }
}

const MEASURE = "shows the distances in large figures";
const CAMERA = [
  ["click", "chooses the picture: then the wheel zooms; with Ctrl it always does"],
  ["drag", "turns the camera of the view under the pointer"],
  ["arrows", "turn the camera"],
  ["+ −", "go nearer and farther, as Page Up and Page Down do"],
];

/**
 * The keys of the picture, to be unfolded.
 * @param {string[][]} keys
 */
function help(keys) {
  const rows = [...keys, ...CAMERA].flatMap(([key, does]) => [
    element("dt", {}, key === " " ? "Space" : key.length === 1 ? key.toUpperCase() : key),
    element("dd", {}, does),
  ]);
  return element(
    "details",
    { class: "ikteach-keys" },
    element("summary", {}, "Keys"),
    element("dl", {}, ...rows),
  );
}
