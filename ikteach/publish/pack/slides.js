// One slide at a time, by keys or buttons; notes under it or in a window of their own; live links
// to wherever the course runs.

/**
 * All elements of a kind.
 * @param {string} selector
 * @returns {HTMLElement[]}
 */
const every = (selector) =>
  [...document.querySelectorAll(selector)].map((found) => /** @type {HTMLElement} */ (found));

const slides = every(".slide");
const [help] = /** @type {HTMLDialogElement[]} */ (every("dialog"));
const [count] = every("nav output");
/** @type {Record<string, string>} */
const address = { lecture: "http://127.0.0.1:8866/", lab: "http://127.0.0.1:8888/" };
let here = 0;
/** @type {Window | null} */
let notes = null;

/**
 * Show slide `i`, and its notes where they are open.
 * @param {number} i
 */
function go(i) {
  here = Math.max(0, Math.min(slides.length - 1, i));
  for (const slide of slides) slide.classList.toggle("here", slide === slides[here]);
  history.replaceState(null, "", `#${here + 1}`);
  count.textContent = `${here + 1} of ${slides.length}`;
  tell();
}

/** The slide that the address names. */
const named = () => Number(location.hash.slice(1)) - 1 || 0;

/**
 * Make the letters of a slide smaller until all of it is seen; never below the least that is read.
 * @param {HTMLElement} slide
 */
function fit(slide) {
  const body = /** @type {HTMLElement} */ (slide.querySelector(".body"));
  for (let size = 1; size > 0.74; size -= 0.05) {
    body.style.setProperty("--fit", `${size}`);
    const wide = body.scrollWidth > body.clientWidth + 1;
    if (!wide && body.scrollHeight <= body.clientHeight + 1) return;
  }
}

/** Bring the window of the notes up to date. */
function tell() {
  if (!notes || notes.closed) return;
  const page = notes.document;
  page.title = `Notes ${here + 1}`;
  page.body.style.cssText =
    "font: 20px/1.4 system-ui, sans-serif; margin: 1.5rem; max-width: 60rem";
  const told = slides[here].nextElementSibling?.childNodes ?? [];
  const next = page.createElement("p");
  const after = slides[here + 1]?.querySelector("h1, h2")?.textContent;
  next.textContent = after ? `Next: ${after}` : "The end.";
  page.body.replaceChildren(next, ...[...told].map((node) => page.importNode(node, true)));
}

/** Open the notes in a window of their own: for the screen that the class does not see. */
function openNotes() {
  notes = window.open("", "notes", "width=900,height=700");
  notes?.addEventListener("keydown", pressed);
  tell();
}

/** Point the links to the servers that were named. */
function aim() {
  for (const link of every("a[data-at]")) {
    const { at = "", to = "" } = link.dataset;
    link.setAttribute("href", new URL(to, address[at]).href);
  }
}

/**
 * Take what was typed as a server's address; without a token, for the page has asked once.
 * @param {HTMLInputElement} input
 */
function take(input) {
  const url = URL.canParse(input.value) ? new URL(input.value) : null;
  const web = url && /^https?:$/.test(url.protocol);
  input.setCustomValidity(web ? "" : "An address begins with http:// or https://");
  if (web) {
    address[input.name] = url.origin + url.pathname.replace(/(voila|lab|tree)\b.*$/, "");
    aim();
  }
  input.reportValidity();
}

/** Fill the screen, or no longer. */
function fill() {
  if (document.fullscreenElement) document.exitFullscreen();
  else document.documentElement.requestFullscreen();
}

/** @type {Record<string, () => unknown>} */
const acts = {
  ArrowRight: () => go(here + 1),
  PageDown: () => go(here + 1),
  " ": () => go(here + 1),
  ArrowLeft: () => go(here - 1),
  PageUp: () => go(here - 1),
  Home: () => go(0),
  End: () => go(slides.length - 1),
  n: () => document.body.classList.toggle("told"),
  s: openNotes,
  p: () => window.print(),
  f: fill,
  "?": () => help.showModal(),
};

/**
 * Do what a key does, unless it is meant for a control.
 * @param {KeyboardEvent} event
 */
function pressed(event) {
  const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const at = /** @type {HTMLElement} */ (event.target);
  const control = at.closest("input, dialog[open]") || (name === " " && at.closest("a, button"));
  if (control || event.ctrlKey || event.altKey || event.metaKey || !(name in acts)) return;
  event.preventDefault();
  acts[name]();
}

document.addEventListener("keydown", pressed);
for (const button of every("[data-key]")) {
  button.addEventListener("click", () => acts[button.dataset.key ?? ""]());
}
for (const input of /** @type {HTMLInputElement[]} */ (every("dialog input"))) {
  input.value = address[input.name];
  input.addEventListener("change", () => take(input));
}
window.addEventListener("hashchange", () => go(named()));
for (const slide of slides) {
  slide.classList.add("here"); // what is not shown has no size
  fit(slide);
  slide.classList.remove("here");
}
aim();
go(named());
