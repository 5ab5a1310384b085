// What a reader has just asked for comes into view, and stays there while it grows.

import { listenTo } from "./dom.js";

const GROWS = 3000; // [ms] for which what has come may still change its height
const MOVES = ["wheel", "pointerdown", "keydown", "touchstart"]; // of a reader who goes elsewhere
const PANEL = ".jp-WindowedPanel-outer"; // what scrolls a notebook in JupyterLab

/**
 * Show all outputs of a cell that was run a moment ago, or their upper end.
 * @param {Element} el a widget in the output, once it is in the page
 */
export function showWhenRun(el) {
  const output = el.closest(".jp-OutputArea-child");
  const cell = output?.closest(".jp-Cell");
  if (!(output instanceof HTMLElement) || !cell || output.dataset.ikteachShown) return;
  output.dataset.ikteachShown = "true"; // by the first of its widgets, for all of them
  const here = [cell, cell.nextElementSibling]; // Shift + Enter goes on to the next cell
  const all = output.closest(".jp-OutputArea") ?? output; // a figure, and below it what to try
  if (here.some((one) => one?.matches(".jp-mod-active"))) keepInView(all);
}

/**
 * Bring an element into view and keep it there, until it has its size or the reader goes elsewhere.
 * @param {Element} one
 */
export function keepInView(one) {
  const bring = () => bringIntoView(one);
  const sizes = new ResizeObserver(bring);
  const panel = one.closest(PANEL);
  const away = new AbortController();
  function stop() {
    sizes.disconnect();
    away.abort();
  }
  const moves = Object.fromEntries(MOVES.map((name) => [name, stop]));
  listenTo(document, moves, { capture: true, signal: away.signal });
  panel?.addEventListener("scroll", bring, { signal: away.signal }); // Lab goes to its next cell
  sizes.observe(one);
  setTimeout(stop, GROWS);
}

/**
 * Scroll as little as shows all of an element, or its upper end if it is higher than the view.
 * @param {Element} one
 */
export function bringIntoView(one) {
  const panel = one.closest(PANEL);
  if (!panel) return one.scrollIntoView({ block: "nearest" });
  panel.scrollTop += shift(one.getBoundingClientRect(), panel.getBoundingClientRect());
}

/**
 * How far to scroll.
 * @param {{ top: number, bottom: number }} box
 * @param {{ top: number, bottom: number }} view
 */
export function shift(box, view) {
  const above = box.top - view.top;
  const below = box.bottom - view.bottom;
  return above < 0 ? above : Math.max(0, Math.min(above, below));
}
