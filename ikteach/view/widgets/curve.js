// A picture of curves with a line at the chosen place. To assistive technology it is a slider.
const STEPS = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: 30, PageDown: -30 };

function render({ model, el }) {
  const box = document.createElement("div"), image = document.createElement("img");
  const line = document.createElement("div");
  box.className = "ikteach-curve";
  box.style.cssText = "position:relative;width:fit-content;max-width:100%;cursor:crosshair";
  image.style.cssText = "display:block;max-width:100%";
  image.draggable = false;
  line.style.cssText = "position:absolute;top:0;bottom:0;width:0;pointer-events:none;" +
    "border-left:2px solid #d55e00";
  box.append(image, line);
  box.tabIndex = 0;
  box.dataset.lmSuppressShortcuts = "true"; // or the notebook takes the arrow keys
  box.setAttribute("role", "slider");
  box.setAttribute("aria-label", "tick on the error plot");
  box.setAttribute("aria-valuemin", "0");
  el.appendChild(box);
  let url = null;

  function choose(i) {
    const last = model.get("places").length - 1;
    model.set("chosen", Math.min(Math.max(i, 0), last));
    model.save_changes();
  }

  function nearest(x) {
    const places = model.get("places");
    let low = 0, high = places.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (places[middle] < x) low = middle; else high = middle;
    }
    return x - places[low] <= places[high] - x ? low : high;
  }

  function point(event) {
    const { left, width } = image.getBoundingClientRect();
    const [start, end] = model.get("span");
    choose(nearest(((event.clientX - left) / width - start) / (end - start)));
  }

  function draw() {
    if (url) URL.revokeObjectURL(url);
    url = URL.createObjectURL(new Blob([model.get("png")], { type: "image/png" }));
    image.src = url;
    image.alt = model.get("alt");
    box.setAttribute("aria-valuemax", model.get("places").length - 1);
    move();
  }

  function move() {
    const i = model.get("chosen"), [start, end] = model.get("span");
    line.style.left = `${100 * (start + (model.get("places")[i] ?? 0) * (end - start))}%`;
    box.setAttribute("aria-valuenow", i);
    box.setAttribute("aria-valuetext", model.get("labels")[i] ?? "");
  }

  box.addEventListener("pointerdown", (event) => {
    box.setPointerCapture(event.pointerId);
    point(event);
  });
  box.addEventListener("pointermove", (event) => { if (event.buttons & 1) point(event); });
  box.addEventListener("keydown", (event) => {
    const last = model.get("places").length - 1;
    const ends = { Home: 0, End: last };
    if (!(event.key in STEPS || event.key in ends)) return;
    event.preventDefault();
    event.stopPropagation();
    choose(ends[event.key] ?? model.get("chosen") + STEPS[event.key]);
  });
  model.on("change:png", draw);
  model.on("change:places", draw);
  model.on("change:chosen", move);
  draw();
  return () => {
    model.off("change:png", draw);
    model.off("change:places", draw);
    model.off("change:chosen", move);
    if (url) URL.revokeObjectURL(url);
  };
}

export default { render: told(render) };
