// Fields for an answer that is one of some choices, or a number.

import { element, OWN_KEYS } from "../view/widgets/dom.js";

/**
 * A radio button for each option.
 * @param {Model} model
 * @returns {Fields}
 */
export function choices(model) {
  const name = `q${Math.random()}`;
  /** @type {string[]} */
  const options = model.get("options");
  const inputs = options.map((value) => {
    const input = element("input", { ...OWN_KEYS, type: "radio", name, value });
    input.checked = model.get("answer") === value;
    return input;
  });
  return {
    rows: inputs.map((input) => element("label", {}, input, input.value)),
    missing: "Choose an answer first.",
    read: () => inputs.find((input) => input.checked)?.value ?? null,
    lock: (locked) => {
      for (const input of inputs) input.disabled = locked;
    },
  };
}

/**
 * A box for a number in a range.
 * @param {Model} model
 * @returns {Fields}
 */
export function number(model) {
  const [min, max, unit] = model.get("numbers");
  const input = element("input", { ...OWN_KEYS, type: "number", min, max, step: "any" });
  if (model.get("answer") !== null) input.value = model.get("answer");
  return {
    rows: [element("label", {}, input, `${unit} (from ${min} to ${max})`)],
    missing: "Write a number in the range first.",
    read: () => (input.value !== "" && input.checkValidity() ? input.valueAsNumber : null),
    lock: (locked) => {
      input.disabled = locked;
    },
  };
}
