// Errors in the page are shown in the cell that they come from.

import { connected, element } from "./dom.js";
import { showWhenRun } from "./inview.js";
import { makeReachable } from "./reachable.js";

const RUNS = "ikteach-lives"; // says to the page that our scripts run in it: see lacking.py

const LOST_KERNEL = "its kernel has ended or was restarted";

/**
 * Show what goes wrong in `render`, and later in callbacks of its model, where it renders.
 * @param {Render} render
 * @returns {(given: Given) => Promise<(() => void) | undefined>}
 */
export function guarded(render) {
  return async (given) => {
    const tell = (/** @type {unknown} */ error) => complain(given.el, error);
    document.body.classList.add(RUNS);
    let gone = false;
    connected(given.el, () => gone)
      .then(settle)
      .catch(tell);
    try {
      const end = await render({ ...given, model: guardedModel(given.model, tell) });
      return () => {
        gone = true;
        end?.();
      };
    } catch (error) {
      tell(error);
    }
  };
}

/**
 * What all of ours need once they are in the page.
 * @param {Element | undefined} el
 */
function settle(el) {
  if (!el) return;
  makeReachable(el);
  showWhenRun(el);
}

/**
 * The same model; no error of a callback, nor a message that finds no kernel, stops another.
 * @param {Model} model
 * @param {(error: unknown) => void} tell
 * @returns {Model}
 */
function guardedModel(model, tell) {
  const guards = new Map();
  const own = {
    on(/** @type {string} */ events, /** @type {Act} */ act) {
      if (!guards.has(act)) guards.set(act, guard(act, tell));
      model.on(events, guards.get(act));
    },
    off: (/** @type {string} */ events, /** @type {Act} */ act) =>
      model.off(events, guards.get(act)),
    send: guard(
      (content) => model.send(content),
      () => tell(LOST_KERNEL),
    ),
    save_changes: guard(
      () => model.save_changes(),
      () => tell(LOST_KERNEL),
    ),
  };
  return /** @type {Model} */ (
    new Proxy(own, {
      get(_, name) {
        const value = Reflect.get(own, name) ?? Reflect.get(model, name);
        return typeof value === "function" ? value.bind(model) : value;
      },
    })
  );
}

/**
 * @param {Act} act
 * @param {(error: unknown) => void} tell
 * @returns {Act}
 */
function guard(act, tell) {
  return (...values) => {
    try {
      const done = act(...values);
      done?.catch?.(tell);
      return done;
    } catch (error) {
      tell(error);
    }
  };
}

/**
 * Show an error, unless there was one: the first is the cause.
 * @param {HTMLElement} el
 * @param {unknown} error
 */
export function complain(el, error) {
  console.warn("ikteach:", error);
  if (el.querySelector(":scope > .ikteach-failed")) return;
  const words = (error instanceof Error ? error.message : String(error)).slice(0, 200);
  const advice = "Run the cell again; if that does not help, save, and reload the page.";
  const text = `This did not work in the page: ${words}. ${advice}`;
  el.append(element("p", { class: "ikteach-failed", role: "alert" }, text));
}
