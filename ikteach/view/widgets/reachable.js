// Gives the controls of ipywidgets what keys and screen readers need of them: headings that open by
// Tab and Enter, names and rounded values of sliders, buttons that say whether they are pressed.

import { listenTo, set, take } from "./dom.js";
import { bringIntoView } from "./inview.js";

const HEADING = ".jupyter-widget-Collapse-header";
const CLOSED = "jupyter-widget-Collapse";
const OPEN = "jupyter-widget-Collapse-open";
const CHANGES = {
  subtree: true,
  childList: true,
  attributes: true,
  attributeFilter: ["class", "aria-valuetext"],
};

/**
 * Mend all controls of the figure that a widget belongs to, now and whenever they change.
 * @param {Element} el a widget in the page
 */
export function makeReachable(el) {
  const figure = outermost(el);
  if (!(figure instanceof HTMLElement) || figure.dataset.ikteachReachable) return;
  figure.dataset.ikteachReachable = "true"; // by the first of its widgets, for all of them
  listenTo(figure, { keydown: pressed, click: opened }, {});
  const news = new MutationObserver(() => mend(figure));
  news.observe(figure, CHANGES);
  mend(figure);
}

/** @param {Element} el */
function outermost(el) {
  let root = el;
  for (let up = el.parentElement; up; up = up.parentElement)
    if (up.matches(".jupyter-widgets, .widget-box")) root = up;
  return root;
}

/** @param {Element} figure */
function mend(figure) {
  for (const one of figure.querySelectorAll(HEADING)) mendHeading(one);
  for (const one of figure.querySelectorAll(".widget-slider")) mendSlider(one);
  for (const one of figure.querySelectorAll(".widget-toggle-buttons")) {
    const name = words(one.querySelector(".widget-label"));
    if (name) tell(one, { role: "group", "aria-label": name });
  }
  for (const one of figure.querySelectorAll(".jupyter-button.widget-toggle-button"))
    tell(one, { "aria-pressed": one.classList.contains("mod-active") });
}

/** @param {Element} heading */
function mendHeading(heading) {
  const open = Boolean(heading.closest(`.${CLOSED}`)?.classList.contains(OPEN));
  tell(heading, { role: "button", tabindex: 0, "aria-expanded": open });
  for (const mark of heading.querySelectorAll("i")) tell(mark, { "aria-hidden": true });
}

/** @param {Element} slider */
function mendSlider(slider) {
  const label = words(slider.querySelector(".widget-label"));
  const readout = words(slider.querySelector(".widget-readout:not([style*='none'])"));
  for (const handle of slider.querySelectorAll(".noUi-handle")) {
    const value = readout || rounded(handle.getAttribute("aria-valuetext") ?? "");
    tell(handle, { "aria-label": label, "aria-valuetext": value });
  }
}

/**
 * A number without the last bits of its sum, as a person would say it.
 * @param {string} text
 */
export function rounded(text) {
  const value = Number(text);
  return text === "" || Number.isNaN(value) ? text : `${Number(value.toPrecision(6))}`;
}

/** @param {Element | null} one */
function words(one) {
  return one?.textContent?.trim() ?? "";
}

/**
 * Set those attributes that are not so already: what is watched is not to be changed for ever.
 * @param {Element} one
 * @param {Attributes} attributes
 */
function tell(one, attributes) {
  for (const [name, value] of Object.entries(attributes))
    if (one.getAttribute(name) !== `${value}`) set(one, { [name]: value });
}

/** @param {KeyboardEvent} event */
function pressed(event) {
  if (!(event.target instanceof HTMLElement) || !event.target.matches(HEADING)) return;
  if (event.key !== "Enter" && event.key !== " ") return;
  event.target.click();
  take(event);
}

/**
 * What a heading has opened comes into view.
 * @param {MouseEvent} event
 */
function opened(event) {
  const heading = event.target instanceof Element ? event.target.closest(HEADING) : null;
  const panel = heading?.closest(`.${CLOSED}`);
  if (panel) requestAnimationFrame(() => panel.classList.contains(OPEN) && bringIntoView(panel));
}
