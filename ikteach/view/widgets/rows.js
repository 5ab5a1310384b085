// A table one row of which is chosen, by a click or by the keys.
const STEPS = { ArrowUp: -1, ArrowDown: 1, PageUp: -10, PageDown: 10 };

function cell(kind, text, style) {
  const made = document.createElement(kind);
  made.textContent = text;
  made.style.cssText = style;
  return made;
}

function render({ model, el }) {
  const box = document.createElement("div");
  box.className = "ikteach-rows";
  box.style.cssText = "max-height:260px;max-width:100%;overflow:auto;position:relative;" +
    "border:1px solid var(--jp-border-color2,#bbb)";
  el.appendChild(box);
  let rows = [], shown = null;

  function choose(i, focus) {
    const to = Math.min(Math.max(i, 0), rows.length - 1);
    if (focus) rows[to].focus({ preventScroll: true });
    model.set("chosen", to);
    model.save_changes();
  }

  function fill() {
    const table = document.createElement("table"), head = document.createElement("tr");
    table.setAttribute("role", "grid");
    table.setAttribute("aria-label", "ticks of the run");
    table.style.cssText = "border-collapse:collapse;font-variant-numeric:tabular-nums";
    for (const name of model.get("header")) {
      const th = cell("th", name, "position:sticky;top:0;padding:3px 10px;text-align:right;" +
        "background:var(--jp-layout-color2,#eee)");
      th.setAttribute("scope", "col");
      head.append(th);
    }
    rows = model.get("rows").map((words, i) => {
      const tr = document.createElement("tr");
      for (const text of words) tr.append(cell("td", text, "padding:2px 10px;text-align:right"));
      tr.lastElementChild.style.textAlign = "left"; // remarks; the others are numbers
      tr.tabIndex = -1;
      tr.dataset.row = i;
      tr.dataset.lmSuppressShortcuts = "true"; // or the notebook takes the arrow keys
      tr.setAttribute("aria-selected", "false");
      tr.style.cursor = "pointer";
      return tr;
    });
    const body = document.createElement("tbody"), top = document.createElement("thead");
    top.append(head);
    body.append(...rows);
    table.append(top, body);
    box.replaceChildren(table);
    shown = null;
    move();
  }

  function move() {
    const row = rows[model.get("chosen")];
    if (!row) return;
    const inside = box.contains(document.activeElement);
    if (shown) {
      shown.tabIndex = -1;
      shown.setAttribute("aria-selected", "false");
      shown.style.outline = shown.style.fontWeight = "";
    }
    shown = row;
    row.tabIndex = 0;
    row.setAttribute("aria-selected", "true");
    row.style.fontWeight = "bold";
    row.style.outline = "2px solid #0072b2";
    row.style.outlineOffset = "-2px";
    if (inside) row.focus({ preventScroll: true });
    const head = rows[0].offsetTop; // the heading covers so much
    if (row.offsetTop - head < box.scrollTop) box.scrollTop = row.offsetTop - head;
    const below = row.offsetTop + row.offsetHeight - box.clientHeight;
    if (below > box.scrollTop) box.scrollTop = below;
  }

  box.addEventListener("click", (event) => {
    const row = event.target.closest("tr[data-row]");
    if (row) choose(+row.dataset.row, true);
  });
  box.addEventListener("keydown", (event) => {
    const ends = { Home: 0, End: rows.length - 1 };
    if (!(event.key in STEPS || event.key in ends)) return;
    event.preventDefault();
    event.stopPropagation();
    choose(ends[event.key] ?? model.get("chosen") + STEPS[event.key], true);
  });
  model.on("change:rows", fill);
  model.on("change:chosen", move);
  fill();
  return () => { model.off("change:rows", fill); model.off("change:chosen", move); };
}

export default { render: told(render) };
