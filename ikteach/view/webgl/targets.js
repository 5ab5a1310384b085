// A slider and a number box for each coordinate of each target, and a button that takes back.

const STYLE = `
.ikteach-targets { border-collapse: collapse; font-variant-numeric: tabular-nums; }
.ikteach-targets th { text-align: left; padding: 2px 6px 2px 2px; white-space: nowrap; font-weight: normal; }
.ikteach-targets td { padding: 2px 3px; white-space: nowrap; }
.ikteach-targets input[type=range] { width: 4em; vertical-align: middle; }
.ikteach-targets input[type=number] { width: 4.4em; }
.ikteach-targets input:focus-visible, .ikteach-undo:focus-visible { outline: 3px solid #56b4e9; }
.ikteach-alert:not(:empty) { border-left: 4px solid #d55e00; padding: 4px 10px; margin: 4px 0; }`;

function element(name, parent, attributes = {}, text = "") {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  parent.appendChild(made);
  return made;
}

function render({ model, el }) {
  element("style", el, {}, STYLE);
  const names = model.get("names"), low = model.get("low"), high = model.get("high");
  const unit = model.get("unit"), metres = model.get("metres"), digits = model.get("digits");
  const table = element("table", el, { class: "ikteach-targets" });
  const head = element("tr", table);
  for (const title of [`target [${unit}]`, "x, left", "y, up", "z, forward"])
    element("th", head, { scope: "col" }, title);
  const post = courier(model);
  const pairs = names.map((name, target) => {
    const row = element("tr", table);
    const title = element("th", row, { scope: "row" });
    const mark = element("span", title, { "aria-hidden": "true" },
      name.endsWith(".r") ? "■ " : "● ");
    mark.style.color = model.get("colours")[target];
    title.append(name);
    return [..."xyz"].map((letter, axis) => pair(row, target, axis, `${name} ${letter}`));
  });
  const button = element("button", el,
    { class: "ikteach-undo jupyter-button", type: "button" }, "Undo move");
  const alert = element("p", el, { class: "ikteach-alert", role: "alert" });

  function pair(row, target, axis, name) {
    const cell = element("td", row);
    const common = { min: low[target][axis] / metres, max: high[target][axis] / metres,
                     step: model.get("step"),
                     "data-lm-suppress-shortcuts": "true" };
    const slider = element("input", cell, { type: "range", "aria-label": `${name} slider`, ...common });
    const box = element("input", cell, { type: "number", "aria-label": name, ...common });
    if (common.min === common.max) slider.disabled = box.disabled = true;
    slider.addEventListener("input", () => { // one move until the slider is let go
      post.send({ target, axis, value: slider.valueAsNumber * metres, fresh: !slider.dataset.held });
      slider.dataset.held = "true";
    });
    slider.addEventListener("change", () => { delete slider.dataset.held; });
    box.addEventListener("input", () => { box.dataset.typing = "true"; });
    const commit = () => {
      if (!box.dataset.typing) return;
      delete box.dataset.typing;
      const value = Number.isFinite(box.valueAsNumber) ? box.valueAsNumber * metres : null;
      model.send({ target, axis, value, typed: true });
    };
    box.addEventListener("change", commit);
    box.addEventListener("keydown", (event) => { // the notebook keeps Enter from making a change
      if (event.key !== "Enter") return;
      commit();
      event.stopPropagation();
    });
    return { slider, box };
  }

  function show() {
    const values = model.get("values");
    pairs.forEach((row, target) => row.forEach(({ slider, box }, axis) => {
      const value = values[target][axis] / metres;
      if (!slider.dataset.held) slider.value = value;
      slider.setAttribute("aria-valuetext", `${value.toFixed(digits)} ${unit}`);
      if (!box.dataset.typing) box.value = value.toFixed(digits);
    }));
  }

  function complain() { alert.textContent = model.get("alert"); }
  function heard(content) { if (content.again) show(); }
  button.addEventListener("click", () => model.send({ undo: true }));
  model.on("change:values", show);
  model.on("change:alert", complain);
  model.on("msg:custom", heard);
  show();
  complain();
  return () => {
    post.close();
    model.off("change:values", show);
    model.off("change:alert", complain);
    model.off("msg:custom", heard);
  };
}

export default { render: told(render) };
