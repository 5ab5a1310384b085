// What is sent to the kernel while something is dragged: the newest only, at most one message per
// frame, and at most a few that the kernel has not yet answered.

import { listen } from "../widgets/dom.js";

const UNANSWERED = 2;
const PATIENCE = 1000; // [ms] after which an answer counts as lost

export class Courier {
  /** @type {Message | null} */
  #waiting = null;
  #number = 0; // of the message sent last
  #answered = 0; // of the newest message that the kernel has answered
  #sentAt = 0; // [ms]
  #asked = false; // for a frame
  #model;
  #stop;

  /** @param {Model} model */
  constructor(model) {
    this.#model = model;
    this.#stop = listen(model, {
      "msg:custom": ({ heard = 0 }) => {
        this.#answered = Math.max(this.#answered, heard);
      },
    });
  }

  /**
   * Send a message soon. A later one takes its place, but not the sign that a move begins.
   * @param {Message} message
   */
  send(message) {
    this.#waiting = { ...message, fresh: message.fresh || Boolean(this.#waiting?.fresh) };
    this.#soon();
  }

  /** Send nothing more, and return the message that waited. */
  drop() {
    const dropped = this.#waiting;
    this.#waiting = null;
    return dropped;
  }

  close() {
    this.#stop();
    this.drop();
  }

  #soon() {
    if (!this.#asked) requestAnimationFrame(() => this.#post());
    this.#asked = true;
  }

  #post() {
    this.#asked = false;
    if (!this.#waiting) return;
    const now = performance.now();
    if (this.#number - this.#answered >= UNANSWERED && now - this.#sentAt < PATIENCE) {
      this.#soon();
      return;
    }
    this.#sentAt = now;
    this.#model.send({ ...this.drop(), number: ++this.#number });
  }
}
