// Both lines stay where they are while their words change: only then are changes read out.

import { element, listen } from "./dom.js";
import { guarded } from "./guarded.js";

/** @type {Render} */
function render({ model, el }) {
  const said = element("div", { role: "status", "aria-live": "polite" });
  const wrong = element("div", { role: "alert" });
  el.append(said, wrong);
  el.classList.add("ikteach-status");
  function update() {
    said.textContent = model.get("said");
    wrong.textContent = model.get("wrong");
  }
  update();
  return listen(model, { change: update });
}

export default { render: guarded(render) };
