// A question with its answer: choices, a number, or an order; all of it by native form controls,
// so that keyboards and screen readers know them.

const style = `
.ikteach-question { border-left: 4px solid #0072b2; padding: 2px 14px 8px; margin: 4px 0;
  color: var(--jp-ui-font-color0, #111); font-family: var(--jp-ui-font-family, sans-serif);
  font-size: 14px; line-height: 1.5; max-width: 46rem; }
.ikteach-question fieldset { border: 0; margin: 0; padding: 0; }
.ikteach-question legend { font-weight: 600; padding: 4px 0; }
.ikteach-question label, .ikteach-question li { display: flex; gap: 8px; padding: 3px 0;
  align-items: baseline; }
.ikteach-question ol { list-style: none; margin: 0; padding: 0; }
.ikteach-question button { font: inherit; padding: 2px 10px; margin: 0 2px; cursor: pointer; }
.ikteach-question input[type=number] { font: inherit; width: 9em; }
.ikteach-question :focus-visible { outline: 3px solid #e69f00; outline-offset: 1px; }
.ikteach-question p { margin: 4px 0; }
`;

function make(tag, properties = {}, children = []) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

// Jupyter must not take the keys of what has the focus for its own.
function quiet(element) {
  element.dataset.lmSuppressShortcuts = "true";
  return element;
}

function choices(model, name) {
  const inputs = model.get("options").map((option) => {
    const input = quiet(make("input", { type: "radio", name, value: option }));
    input.checked = model.get("answer") === option;
    return input;
  });
  const rows = inputs.map((input) => make("label", {}, [input, input.value]));
  return { rows, read: () => inputs.find((input) => input.checked)?.value ?? null, inputs };
}

function number(model) {
  const [low, high, unit] = model.get("numbers");
  const input = quiet(make("input", { type: "number", min: low, max: high, step: "any" }));
  if (model.get("answer") !== null) input.value = model.get("answer");
  const row = make("label", {}, [input, `${unit} (from ${low} to ${high})`]);
  const read = () => (input.value !== "" && input.checkValidity() ? input.valueAsNumber : null);
  return { rows: [row], read, inputs: [input] };
}

function ranking(model) {
  let order = [...(model.get("answer") ?? model.get("options"))];
  const list = make("ol");
  const inputs = [];
  function draw() {
    inputs.splice(0);
    list.replaceChildren(...order.map((option, i) => {
      const up = move("▲", option, i, -1), down = move("▼", option, i, 1);
      return make("li", {}, [`${i + 1}.`, up, down, option]);
    }));
  }
  function move(sign, option, i, by) {
    const way = by < 0 ? "up" : "down";
    const button = quiet(make("button", { type: "button", textContent: sign }));
    button.setAttribute("aria-label", `move ${option} ${way}`);
    button.disabled = model.get("locked") || i + by < 0 || i + by >= order.length;
    button.onclick = () => {
      [order[i], order[i + by]] = [order[i + by], order[i]];
      draw();
      const again = list.querySelector(`[aria-label="${CSS.escape(`move ${option} ${way}`)}"]`);
      const buttons = [...list.children[i + by].querySelectorAll("button")];
      (again && !again.disabled ? again : buttons.find((b) => !b.disabled))?.focus();
    };
    inputs.push(button);
    return button;
  }
  draw();
  return { rows: [list], read: () => order, inputs, draw };
}

function render({ model, el }) {
  const kinds = { choice: choices, number, ranking };
  const form = make("form", { className: "ikteach-question", noValidate: true });
  const fields = kinds[model.get("kind")](model, `q${Math.random()}`);
  const button = quiet(make("button", { type: "submit", textContent: model.get("button") }));
  const status = make("p");
  status.setAttribute("role", "status");
  const note = model.get("note");
  form.append(
    make("style", { textContent: style }),
    make("fieldset", {}, [
      make("legend", { textContent: model.get("question") }),
      ...(note ? [make("p", { textContent: note })] : []),
      ...fields.rows,
    ]),
    button,
    status,
  );
  form.onkeydown = (event) => {
    if (event.key !== "Enter" || event.target.tagName !== "INPUT") return;
    event.preventDefault();
    event.stopPropagation();
    form.requestSubmit();
  };
  form.onsubmit = (event) => {
    event.preventDefault();
    const answer = fields.read();
    if (answer === null) {
      status.textContent = model.get("kind") === "number"
        ? "Write a number in the range first." : "Choose an answer first.";
      return;
    }
    status.textContent = "";
    model.set("asked", model.get("asked") + 1);
    model.set("answer", answer);
    model.save_changes();
  };
  function update() {
    const locked = model.get("locked");
    fields.draw?.();
    if (!fields.draw) for (const input of fields.inputs) input.disabled = locked;
    button.hidden = locked;
    status.textContent = model.get("status");
  }
  model.on("change:locked change:status change:asked", update);
  update();
  el.append(form);
  return () => model.off("change:locked change:status change:asked", update);
}

export default { render: told(render) };
