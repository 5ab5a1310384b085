// What is seen where the figure cannot live: why, and pictures that the kernel draws. The page asks
// for one when there is news, and leaves the kernel half of its time for everything else.

import { showPNG } from "../widgets/binary.js";
import { element } from "../widgets/dom.js";

const PAUSE = 250; // [ms] at least, from a picture to the next question
const LOST = 10_000; // [ms] after which an answer counts as lost

export class Pictures {
  #image = element("img", { alt: "" }); // the words under it say what it shows
  /** @type {HTMLElement | null} */
  #box = null;
  #news = -1; // number of the newest frame
  #seen = -1; // number of the frame in the picture
  /** @type {number | null} */
  #asked = null; // when [ms], while an answer or the pause after it is waited for
  /** @type {Timer} */
  #pause;
  #el;
  #ask;

  /**
   * @param {HTMLElement} el where to be shown
   * @param {() => void} ask asks the kernel for a picture
   */
  constructor(el, ask) {
    this.#el = el;
    this.#ask = ask;
  }

  /** Whether pictures are shown. */
  get on() {
    return this.#box !== null;
  }

  /**
   * Show pictures from now on, and why.
   * @param {string} why
   */
  start(why) {
    if (this.#box) return;
    const words = element("p", { role: "alert" }, why);
    this.#box = element("div", { class: "ikteach-pictures" }, words, this.#image);
    this.#el.prepend(this.#box);
  }

  stop() {
    clearTimeout(this.#pause);
    showPNG(this.#image);
    this.#box?.remove();
    this.#box = this.#asked = null;
  }

  /**
   * Ask for a picture of this frame, as soon as it is time.
   * @param {number} frame
   */
  follow(frame) {
    this.#news = frame;
    this.#askForNews();
  }

  /**
   * Show the picture of a frame, if this page has asked for it and not another.
   * @param {number} frame
   * @param {DataView} png
   */
  put(frame, png) {
    if (!this.#box || this.#asked === null) return;
    this.#seen = frame;
    showPNG(this.#image, png);
    this.#wait(Math.max(PAUSE, performance.now() - this.#asked));
  }

  #askForNews() {
    if (!this.#box || this.#asked !== null || this.#news === this.#seen) return;
    this.#asked = performance.now();
    this.#wait(LOST);
    this.#ask();
  }

  /** @param {number} time [ms] until the next question may be asked */
  #wait(time) {
    clearTimeout(this.#pause);
    this.#pause = setTimeout(() => {
      this.#asked = null;
      this.#askForNews();
    }, time);
  }
}
