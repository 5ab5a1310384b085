"use strict";
// One slide at a time, by keys or buttons; notes under it or in a window of their own; live links
// to wherever the course runs.
const slides = [...document.querySelectorAll(".slide")];
const help = document.querySelector("dialog");
const address = { lecture: "http://127.0.0.1:8866/", lab: "http://127.0.0.1:8888/" };
let here = 0;
let notes = null;

/** Show slide `i`, and its notes where they are open. */
function go(i) {
  here = Math.max(0, Math.min(slides.length - 1, i));
  slides.forEach((slide, j) => slide.classList.toggle("here", j === here));
  history.replaceState(null, "", `#${here + 1}`);
  document.querySelector("nav output").textContent = `${here + 1} of ${slides.length}`;
  tell();
}

/** Make the letters of a slide smaller until all of it is seen; never below the least that is read. */
function fit(slide) {
  const body = slide.querySelector(".body");
  for (let size = 1; size > 0.74; size -= 0.05) {
    body.style.setProperty("--fit", size);
    if (body.scrollHeight <= body.clientHeight + 1 && body.scrollWidth <= body.clientWidth + 1) return;
  }
}

/** Bring the window of the notes up to date. */
function tell() {
  if (!notes || notes.closed) return;
  const page = notes.document;
  page.title = `Notes ${here + 1}`;
  page.body.style.cssText = "font: 20px/1.4 system-ui, sans-serif; margin: 1.5rem; max-width: 60rem";
  page.body.innerHTML = slides[here].nextElementSibling.innerHTML;
  const next = page.createElement("p");
  const after = slides[here + 1];
  next.textContent = after ? `Next: ${after.querySelector("h1, h2").textContent}` : "The end.";
  page.body.prepend(next);
}

/** Open the notes in a window of their own: for the screen that the class does not see. */
function openNotes() {
  notes = window.open("", "notes", "width=900,height=700");
  if (notes) notes.addEventListener("keydown", pressed);
  tell();
}

/** Point the links to the servers that were named. */
function aim() {
  for (const link of document.querySelectorAll("a[data-at]"))
    link.href = new URL(link.dataset.to, address[link.dataset.at]).href;
}

/** Take what was typed as the server's address; without a token, for the page has asked once. */
function named(input) {
  try {
    const url = new URL(input.value);
    if (!/^https?:$/.test(url.protocol)) throw new Error("no web address");
    address[input.name] = url.origin + url.pathname.replace(/(voila|lab|tree)\b.*$/, "");
    input.setCustomValidity("");
    aim();
  } catch {
    input.setCustomValidity("An address begins with http:// or https://");
  }
  input.reportValidity();
}

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
  f: () =>
    document.fullscreenElement
      ? document.exitFullscreen()
      : document.documentElement.requestFullscreen(),
  "?": () => help.showModal(),
};

/** Do what a key does, unless it is meant for a control. */
function pressed(event) {
  const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const control = event.target.closest && event.target.closest("input, dialog[open]");
  const press = event.key === " " && event.target.closest && event.target.closest("a, button");
  if (control || press || event.ctrlKey || event.altKey || event.metaKey || !(name in acts)) return;
  event.preventDefault();
  acts[name]();
}

document.addEventListener("keydown", pressed);
for (const button of document.querySelectorAll("[data-key]"))
  button.addEventListener("click", () => acts[button.dataset.key]());
for (const input of document.querySelectorAll("dialog input")) {
  input.value = address[input.name];
  input.addEventListener("change", () => named(input));
}
window.addEventListener("hashchange", () => go(Number(location.hash.slice(1)) - 1 || 0));
for (const slide of slides) {
  slide.classList.add("here"); // what is not shown has no size
  fit(slide);
  slide.classList.remove("here");
}
aim();
go(Number(location.hash.slice(1)) - 1 || 0);
