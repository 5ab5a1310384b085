// Moves targets in the picture. A target follows at once, here in the page; the kernel hears of it,
// and its frames are shown again once they have caught up.

import { element, listen, listenTo } from "../widgets/dom.js";
import { complain, guarded } from "../widgets/guarded.js";
import { resolve } from "../widgets/models.js";
import { Courier } from "./courier.js";
import { Keys } from "./keys.js";
import { Picking } from "./picking.js";
import { Pins } from "./pins.js";
import { sceneOf, stageOf } from "./scene.js";

/** @import { Scene } from "./scene.js" */

const CAMERA =
  "Arrows turn the camera, page up goes nearer, page down farther. Tab chooses a target. Other keys stand under the picture.";
const TARGET =
  "Arrows move it, page up and down in depth, shift for fine steps, Escape takes back.";

class Handles {
  chosen = -1; // a node
  #model;
  #scene;
  #halo;
  #pins;
  #post;
  #said;
  #picking;
  #keys;

  /**
   * @param {Model} model
   * @param {Scene} scene
   * @param {Object3D} halo
   * @param {Model[]} nodes the targets of one figure after those of another
   * @param {HTMLElement} stage
   * @param {HTMLElement} said says what is chosen and where it is
   */
  constructor(model, scene, halo, nodes, stage, said) {
    /** @type {string[]} */
    this.names = model.get("names");
    this.nodes = nodes;
    this.#model = model;
    this.#scene = scene;
    this.#halo = halo;
    const step = model.get("step"); // a hair is a millimetre on a human
    this.#pins = new Pins(scene, nodes, model.get("lengths"), step / 50);
    this.#post = new Courier(model);
    this.#said = said;
    this.#picking = new Picking(scene, stage, this);
    this.#keys = new Keys(scene, this, step);
  }

  /** @param {number} node */
  where(node) {
    return this.#pins.where(node);
  }

  /**
   * Move a target, within its range, and have the kernel hear of it.
   * @param {number} node
   * @param {Vector3} at
   * @param {boolean} fresh whether a move begins
   */
  move(node, at, fresh) {
    const target = node % this.names.length;
    const inside = this.#inside(node, at);
    this.#pins.pin(node, inside.clone().add(this.#origin(node)));
    this.#post.send({ target, at: inside.toArray(), fresh });
    this.say(`${this.names[target]}: ${this.#words(node, inside)}`);
  }

  /**
   * The nearest that a target can be, from its origin: that of a direction turns, and no more.
   * @param {number} node
   * @param {Vector3} at
   */
  #inside(node, at) {
    const target = node % this.names.length;
    const low = this.#scene.vector(...this.#model.get("low")[target]);
    const high = this.#scene.vector(...this.#model.get("high")[target]);
    const length = this.#pins.length(node);
    if (!length) return this.#scene.seen(at).sub(this.#origin(node)).clamp(low, high);
    const way = at.clone().sub(this.#origin(node));
    const [x, y, z] = around(way.toArray(), low.toArray(), high.toArray(), length);
    const turned = this.#scene.vector(x, y, z);
    return Number.isFinite(x) ? turned : this.where(node).sub(this.#origin(node));
  }

  /**
   * How far a key moves a target: a direction's tip no more than about 6°.
   * @param {number} node
   * @param {number} step
   */
  stride(node, step) {
    const length = this.#pins.length(node);
    return length ? Math.min(step, length / 10) : step;
  }

  /** Take the last move back, which the kernel may not have heard of. */
  undo() {
    const unsent = this.#post.drop()?.fresh;
    const { begun } = this.#picking;
    this.#pins.clear();
    this.#picking.release();
    if (begun && !unsent) this.#model.send({ undo: true });
    this.#scene.redraw();
  }

  /**
   * Choose a target, shown by the halo and said; −1 for none.
   * @param {number} node
   */
  choose(node) {
    this.chosen = node;
    this.#halo.visible = node >= 0;
    if (node >= 0) {
      this.nodes[node].obj.add(this.#halo);
      this.#halo.position.copy(this.#scene.vector(0, this.#pins.length(node) ? 1 : 0, 0)); // a tip
    } else this.#halo.parent?.remove(this.#halo);
    const target = node < 0 ? -1 : node % this.names.length;
    this.#model.set("chosen", target);
    this.#model.save_changes();
    this.#scene.redraw();
    if (node < 0) return;
    const at = this.where(node).sub(this.#origin(node));
    this.say(`${this.names[target]} chosen, ${this.#words(node, at)}. ${TARGET}`);
  }

  /** @param {string} text */
  say(text) {
    this.#said.textContent = text;
  }

  invite() {
    this.say(CAMERA);
  }

  /** The events of the stage that are no others' if they are ours, and what they do. */
  firstOfAll() {
    return {
      pointerdown: (/** @type {PointerEvent} */ event) => this.#picking.down(event),
      touchstart: (/** @type {TouchEvent} */ event) => {
        if (this.#picking.held) event.preventDefault(); // the finger drags, the page stays
      },
      keydown: (/** @type {KeyboardEvent} */ event) => this.#keys.press(event),
    };
  }

  /** The other events of the stage, and what they do. */
  events() {
    const up = (/** @type {PointerEvent} */ event) => this.#picking.up(event);
    return {
      pointermove: (/** @type {PointerEvent} */ event) => this.#picking.move(event),
      pointerup: up,
      pointercancel: up,
      lostpointercapture: up,
      focus: () => {
        if (this.chosen < 0 && !this.#picking.held) this.invite();
      },
      blur: () => {
        if (this.#picking.held) return;
        this.choose(-1);
        this.say("");
      },
    };
  }

  keep() {
    this.#pins.keep(this.#picking.held);
  }

  /**
   * Obey the kernel: say something, let go of the targets.
   * @param {{ say?: string, let?: boolean }} content
   */
  hear(content) {
    if (content.say !== undefined) this.say(content.say);
    if (content.let === undefined) return;
    this.#pins.clear();
    this.#scene.redraw();
  }

  end() {
    this.#picking.release();
    this.#post.close();
  }

  /**
   * @param {number} node
   * @param {Vector3} at
   */
  #words(node, at) {
    return `${this.#pins.length(node) ? "points to " : ""}${words(at)}`;
  }

  /**
   * From where a target is counted: the place of its figure, or where a direction begins.
   * @param {number} node
   */
  #origin(node) {
    if (this.#pins.length(node)) return this.#pins.origin(node);
    const figure = Math.floor(node / this.names.length);
    return this.#scene.vector(...this.#model.get("places")[figure]);
  }
}

/**
 * A vector turned along another, where it is free to be so; NaN if that leads nowhere.
 * @param {number[]} way
 * @param {number[]} low
 * @param {number[]} high
 * @param {number} length
 */
export function around(way, low, high, length) {
  const free = way.map((part, i) => (low[i] < high[i] ? part : low[i]));
  const size = Math.hypot(...free);
  return free.map((part) => (length * part) / size);
}

/** @param {Vector3} at */
function words({ x, y, z }) {
  return `x ${x.toFixed(2)}, y ${y.toFixed(2)}, z ${z.toFixed(2)} m`;
}

/** @type {Render} */
function render(given) {
  const { model, el } = given;
  const said = element("p", { class: "ikteach-said", role: "status" });
  const alert = element("p", { class: "ikteach-said", role: "alert" });
  el.append(said, alert);
  const warn = () => {
    alert.textContent = model.get("alert");
  };
  const stop = listen(model, { "change:alert": warn });
  warn();
  let gone = false;
  let leave = () => {};

  async function enter() {
    const scene = await sceneOf(given, () => gone);
    if (!scene) return;
    const references = [model.get("halo"), ...model.get("nodes")];
    const [{ obj: halo }, ...nodes] = await resolve(given, references);
    const stage = await stageOf(el, () => gone);
    if (!stage || gone) return;
    leave = takeHold(
      stage,
      scene,
      halo,
      new Handles(model, scene, halo, nodes, stage, said),
      model,
    );
    el.dataset.ready = "true";
  }

  enter().catch((error) => complain(el, error));
  return () => {
    gone = true;
    stop();
    leave();
  };
}

/**
 * Have the handles hear of events; call the answer to stop that.
 * @param {HTMLElement} stage
 * @param {Scene} scene
 * @param {Object3D} halo
 * @param {Handles} handles
 * @param {Model} model
 */
function takeHold(stage, scene, halo, handles, model) {
  const targets = handles.names.join(", ");
  stage.setAttribute("aria-label", `Scene with ${handles.names.length} targets: ${targets}`);
  halo.visible = false;
  halo.onBeforeRender = (_, __, camera) => {
    const at = scene.position(halo.matrixWorld); // the ring is round from everywhere
    halo.matrixWorld.extractRotation(camera.matrixWorld).setPosition(at);
  };
  const away = new AbortController();
  const { signal } = away;
  // Before the camera hears of it.
  listenTo(stage, handles.firstOfAll(), { capture: true, passive: false, signal });
  listenTo(stage, handles.events(), { signal });
  const stops = [
    listen(scene.model, { beforeRender: () => handles.keep() }),
    listen(model, { "msg:custom": (content) => handles.hear(content) }),
  ];
  return () => {
    away.abort();
    handles.end();
    for (const stop of stops) stop();
  };
}

export default { render: guarded(render) };
