// The charts of the page before a class: each is a table, one of whose columns is bars.

import { element } from "../../view/widgets/dom.js";

/** @import { Exercise, Prediction, Row } from "./page.js" */

/**
 * A prediction: how many have answered and, once it is open, what.
 * @param {Prediction} one
 * @param {number} students
 * @param {{ open: boolean, marked: boolean }} seen
 */
export function prediction(one, students, { open, marked }) {
  const title = element("h1", {}, one.question || one.key);
  const parts = [title, count(one.answered, students, "have answered")];
  if (!open)
    parts.push(element("p", { class: "hidden" }, "The answers are hidden until Reveal (R)."));
  else parts.push(chart(one.rows, one.answered, marked ? one.result : null, "answer"));
  if (open && one.note) parts.push(element("p", { class: "count" }, one.note));
  if (open && marked && one.result !== null)
    parts.push(element("p", { class: "count" }, `✓ Computed: ${one.result}`));
  return [...parts, ...people("Answered", one.who), ...people("Not yet", one.missing)];
}

/**
 * All exercises: who passed, who is at work, who is stuck.
 * @param {Exercise[]} all
 * @param {number} students
 */
export function exercises(all, students) {
  const heads = ["exercise", "passed", "at work", "stuck", "longest", "most tries"];
  const rows = all.map((one) => {
    const numbers = [one.passed, one.working].map(number);
    const stuck = number(one.stuck);
    if (one.stuck) stuck.classList.add("stuck");
    const since = one.stuck ? [`${one.longest} min`, one.tries] : ["–", "–"];
    return element("tr", {}, name(one.key), ...numbers, stuck, ...since.map(number));
  });
  const words = `Of ${students}; stuck: three wrong tries, or ten minutes.`;
  return [element("h1", {}, "Exercises"), table(words, heads, rows)];
}

/**
 * One exercise: what is got wrong in it, and by how many.
 * @param {Exercise} one
 * @param {number} students
 */
export function exercise(one, students) {
  const parts = [
    element("h1", {}, `Exercise ${one.key}`),
    count(one.passed, students, `have passed; ${one.working} at work, ${one.stuck} stuck`),
  ];
  const wrong = one.kinds.reduce((sum, row) => sum + row.count, 0);
  if (wrong) parts.push(chart(one.kinds, wrong, null, "what the check finds"));
  const stuck = one.who?.map((who) => `${who.name}: ${who.minutes} min, ${who.tries} tries`);
  const examples = one.kinds.filter((row) => row.example);
  const words = examples.map((row) => `${row.example} (${row.who?.join(", ")})`);
  return [...parts, ...people("Stuck", stuck), ...people("Findings", words)];
}

/**
 * A chart that is a table.
 * @param {Row[]} rows
 * @param {number} whole
 * @param {string | null} result of the row that is marked
 * @param {string} what the rows are
 */
export function chart(rows, whole, result, what) {
  const lines = rows.map(({ label, count }) => {
    const bar = element("div", { class: "bar", ...(count ? {} : { "data-none": "" }) });
    bar.style.width = `${(100 * count) / Math.max(whole, 1)}%`;
    const computed = label === result;
    const head = name(computed ? `✓ ${label}` : label);
    const cells = [number(share(count, whole)), number(count)];
    const line = element("tr", {}, head, element("td", { "aria-hidden": "true" }, bar), ...cells);
    if (computed) line.classList.add("computed");
    return line;
  });
  const made = table(`Of ${whole}`, [what, "", "share", "count"], lines);
  made.classList.add("chart");
  return made;
}

/**
 * @param {number} part
 * @param {number} whole
 */
export function share(part, whole) {
  return whole ? `${Math.round((100 * part) / whole)} %` : "–";
}

/**
 * @param {string} caption
 * @param {string[]} heads
 * @param {HTMLElement[]} rows
 */
function table(caption, heads, rows) {
  const head = heads.map((text, i) => {
    return text
      ? element("th", { scope: "col", class: i ? "number" : "name" }, text)
      : element("td");
  });
  const parts = [element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...rows)];
  return element("table", {}, element("caption", {}, caption), ...parts);
}

/** @param {string} text */
function name(text) {
  return element("th", { scope: "row" }, text);
}

/** @param {string | number} value */
function number(value) {
  return element("td", { class: "number" }, `${value}`);
}

/**
 * @param {number} part
 * @param {number} whole
 * @param {string} words
 */
function count(part, whole, words) {
  return element("p", { class: "count" }, element("b", {}, `${part}`), ` of ${whole} ${words}`);
}

/**
 * People, where they were asked for.
 * @param {string} what
 * @param {string[] | undefined} list
 */
function people(what, list) {
  if (!list?.length) return [];
  const items = list.map((one) => element("li", {}, one));
  return [element("h2", {}, what), element("ul", { class: "small" }, ...items)];
}
