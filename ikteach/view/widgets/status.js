// Both lines stay where they are while their words change: only then are changes read out.

import { connected, element, listen } from "./dom.js";
import { guarded } from "./guarded.js";
import { keepInView } from "./inview.js";

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
  function come() {
    const opened = model.get("came") && navigator.userActivation?.isActive; // and not loaded anew
    if (opened) keepInView((model.get("with_all") && el.closest(".widget-vbox")) || el);
  }
  let gone = false;
  connected(el, () => gone).then((here) => here && come());
  update();
  const stop = listen(model, { change: update, "change:came": come });
  return () => {
    gone = true;
    stop();
  };
}

export default { render: guarded(render) };
