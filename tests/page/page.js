// As much of a page as the tests need: frames, time, elements, vectors.

import { mock } from "node:test";

/** Time that the test lets pass, in `performance.now`, timers and frames of 16 ms. */
export class Clock {
  now = 0;
  #frames = [];

  constructor() {
    mock.timers.enable({ apis: ["setTimeout"] });
    mock.method(performance, "now", () => this.now);
    globalThis.requestAnimationFrame = (act) => this.#frames.push(act);
  }

  /** Let time [ms] pass. */
  pass(time) {
    for (const end = this.now + time; this.now < end; ) {
      const step = Math.min(16, end - this.now);
      this.now += step;
      mock.timers.tick(step);
      for (const act of this.#frames.splice(0)) act();
    }
  }

  end() {
    mock.timers.reset();
    mock.restoreAll();
  }
}

/** A model with traits, which keeps what is sent to the kernel. */
export class Model {
  sent = [];
  #acts = new Map();

  constructor(traits = {}) {
    this.traits = traits;
  }

  get(name) {
    return this.traits[name];
  }

  on(event, act) {
    this.#acts.set(event, act);
  }

  off(event, act) {
    if (this.#acts.get(event) === act) this.#acts.delete(event);
  }

  send(content) {
    this.sent.push(content);
  }

  tell(event, ...values) {
    return this.#acts.get(event)?.(...values);
  }
}

/** An element that keeps its attributes and children; nothing is drawn. */
export class Element {
  children = [];
  dataset = {};
  src = "";

  setAttribute(name, value) {
    this[name] = value;
  }

  append(...children) {
    this.children.push(...children);
  }

  prepend(...children) {
    this.children.unshift(...children);
  }

  querySelector() {
    return this.children[0];
  }

  closest() {
    return null;
  }

  addEventListener() {}
  remove() {}
}

globalThis.requestAnimationFrame = () => {}; // no frame comes, but those of a `Clock`
globalThis.document = {
  createElement: () => new Element(),
  body: { classList: { add() {} } },
  hidden: false,
};

globalThis.ResizeObserver = class {
  observe() {}
  disconnect() {}
};

/** A point as three.js has it. */
export class Vector {
  constructor(x = 0, y = 0, z = 0) {
    Object.assign(this, { x, y, z });
  }

  clone() {
    return new Vector(this.x, this.y, this.z);
  }

  add({ x, y, z }) {
    return Object.assign(this, { x: this.x + x, y: this.y + y, z: this.z + z });
  }

  sub({ x, y, z }) {
    return this.add({ x: -x, y: -y, z: -z });
  }

  toArray() {
    return [this.x, this.y, this.z];
  }

  distanceTo({ x, y, z }) {
    return Math.hypot(this.x - x, this.y - y, this.z - z);
  }
}
