// The page before a class. What students wrote is set as text, never as markup.

import { element, set, take } from "../../view/widgets/dom.js";
import { exercise, exercises, prediction } from "./tables.js";

const EVERY = 2000; // [ms] between two looks at the counts
const ALL = "all exercises";
/** @type {[key: string, name: string, words: string][]} key, action, label of its button */
const BUTTONS = [
  ["ArrowLeft", "back", "← Back"],
  ["ArrowRight", "next", "Next →"],
  ["r", "reveal", "Reveal"],
  ["a", "answer", "Answer"],
  ["e", "view", "Exercises"],
  ["n", "names", "Names"],
  ["f", "full", "Full screen"],
];

/**
 * @typedef {{ key: string, question: string, answered: number, newest: number, note: string,
 *   result: string | null, rows: Row[], who?: string[], missing?: string[] }} Prediction
 * @typedef {{ label: string, count: number, who?: string[], example?: string }} Row
 * @typedef {{ key: string, passed: number, working: number, stuck: number, longest: number,
 *   tries: number, kinds: Row[], who?: { name: string, minutes: number, tries: number }[] }} Exercise
 * @typedef {{ students: number, troubles: number, predictions: Prediction[],
 *   exercises: Exercise[], named?: string[] }} Counts
 */

class Projector {
  /** @type {Counts} */
  #counts = { students: 0, troubles: 0, predictions: [], exercises: [] };
  #shown = { exercises: false, names: false, prediction: "", exercise: ALL };
  #revealed = new Set();
  #answers = new Set();
  #text = "";
  #main = /** @type {HTMLElement} */ (document.querySelector("main"));
  #said = /** @type {HTMLElement} */ (document.querySelector("#said"));
  #which = element("select", { "aria-label": "What is shown" });
  /** @type {Record<string, HTMLButtonElement>} */
  #buttons = {};

  start() {
    const header = /** @type {HTMLElement} */ (document.querySelector("header"));
    header.append(this.#which);
    for (const [key, name, words] of BUTTONS) header.append(this.#button(key, name, words));
    this.#which.addEventListener("change", () => this.#choose(this.#which.value));
    document.addEventListener("keydown", (event) => this.#press(event));
    this.#look();
  }

  /**
   * @param {string} key
   * @param {string} name
   * @param {string} words
   */
  #button(key, name, words) {
    const hint = key.length === 1 ? [" (", element("kbd", {}, key.toUpperCase()), ")"] : [];
    const button = element("button", { type: "button" }, words, ...hint);
    button.addEventListener("click", () => this.#act(name));
    this.#buttons[name] = button;
    return button;
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target === this.#which) return;
    const found = BUTTONS.find(([key]) => key === event.key || key === event.key.toLowerCase());
    if (!found) return;
    take(event);
    if (!this.#buttons[found[1]].disabled) this.#act(found[1]);
  }

  /** @param {string} name */
  #act(name) {
    const { prediction: key } = this.#shown;
    this.#tell("", false);
    if (name === "back" || name === "next") this.#go(name === "next" ? 1 : -1);
    else if (name === "reveal") this.#toggle(this.#revealed, key, "The answers are", "shown");
    else if (name === "answer")
      this.#toggle(this.#answers, key, "The computed answer is", "marked");
    else if (name === "view") this.#shown.exercises = !this.#shown.exercises;
    else if (name === "names") this.#shown.names = !this.#shown.names;
    else if (document.fullscreenElement) document.exitFullscreen();
    else document.documentElement.requestFullscreen();
    if (name === "names") this.#look(false);
    this.#draw();
  }

  /**
   * @param {Set<string>} set
   * @param {string} key
   * @param {string} what
   * @param {string} done
   */
  #toggle(set, key, what, done) {
    const on = !set.delete(key);
    if (on) set.add(key);
    this.#said.textContent = `${what} ${on ? done : "hidden again"}.`;
  }

  /** @param {string} key */
  #choose(key) {
    this.#shown[this.#shown.exercises ? "exercise" : "prediction"] = key;
    this.#draw();
  }

  get #keys() {
    const { predictions, exercises } = this.#counts;
    const keys = (this.#shown.exercises ? exercises : predictions).map(({ key }) => key);
    return this.#shown.exercises ? [ALL, ...keys] : keys;
  }

  get #key() {
    return this.#shown[this.#shown.exercises ? "exercise" : "prediction"];
  }

  /** @param {number} by */
  #go(by) {
    const keys = this.#keys;
    const at = Math.max(keys.indexOf(this.#key), 0) + by;
    if (keys.length) this.#choose(keys[(at + keys.length) % keys.length]);
  }

  /** Look at the counts, and again after a while. */
  async #look(again = true) {
    try {
      const answer = await fetch(`now?names=${this.#shown.names ? 1 : 0}`);
      const text = await answer.text();
      if (!answer.ok) throw new Error(text);
      if (text !== this.#text) {
        this.#counts = JSON.parse(text);
        this.#text = text;
        this.#draw();
      }
      if (this.#said.dataset.lost) this.#tell("", false);
    } catch {
      this.#tell("The counts do not come any more. Is `python -m ikteach class` running?", true);
    }
    if (again) setTimeout(() => this.#look(), EVERY);
  }

  /**
   * @param {string} words
   * @param {boolean} lost
   */
  #tell(words, lost) {
    if (this.#said.textContent !== words) this.#said.textContent = words;
    if (lost) this.#said.dataset.lost = "true";
    else delete this.#said.dataset.lost;
  }

  #draw() {
    const { predictions, exercises: all, students } = this.#counts;
    const shown = this.#shown;
    if (!shown.prediction && predictions.length)
      shown.prediction = predictions.reduce((a, b) => (b.newest > a.newest ? b : a)).key;
    this.#controls();
    const one = predictions.find(({ key }) => key === shown.prediction);
    const some = all.find(({ key }) => key === shown.exercise);
    const seen = { open: this.#revealed.has(one?.key), marked: this.#answers.has(one?.key) };
    const nobody = element("h1", {}, "Nobody has answered yet.");
    let parts = one ? prediction(one, students, seen) : [nobody];
    if (shown.exercises) parts = some ? exercise(some, students) : exercises(all, students);
    this.#main.replaceChildren(...parts, ...this.#left());
  }

  #controls() {
    const { exercises: off, names, prediction: key } = this.#shown;
    const one = this.#counts.predictions.find((other) => other.key === key);
    const options = this.#keys.map((name) => element("option", { value: name }, name));
    this.#which.replaceChildren(...options);
    this.#which.value = this.#key;
    const { reveal, answer, view, names: named } = this.#buttons;
    set(reveal, { "aria-pressed": !off && this.#revealed.has(key) });
    set(answer, { "aria-pressed": !off && this.#answers.has(key) });
    set(view, { "aria-pressed": off });
    set(named, { "aria-pressed": names });
    reveal.disabled = off || !one;
    answer.disabled = off || one?.result == null || !this.#revealed.has(key);
  }

  #left() {
    const { troubles, named } = this.#counts;
    if (!troubles) return [];
    const words = `${troubles} ${troubles === 1 ? "file or folder" : "files or folders"} could not be read.`;
    const list = (named ?? []).map((name) => element("li", {}, name));
    return [element("p", { class: "small" }, words), element("ul", { class: "small" }, ...list)];
  }
}

if (typeof document !== "undefined") new Projector().start();

export default Projector;
