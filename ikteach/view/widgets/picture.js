// A PNG with its text alternative.

import { showPNG } from "./binary.js";
import { element, listen } from "./dom.js";
import { guarded } from "./guarded.js";

/** @type {Render} */
function render({ model, el }) {
  const image = element("img", { class: "ikteach-picture" });
  function update() {
    showPNG(image, model.get("png"));
    image.alt = model.get("alt");
  }
  const stop = listen(model, { change: update });
  update();
  el.append(image);
  return () => {
    stop();
    showPNG(image);
  };
}

export default { render: guarded(render) };
