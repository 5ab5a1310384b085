// A wire globe in SVG. It is a slider of two dimensions: drag it, or use the arrow keys.

const R = 54, STEP = 5; // [pixels], [degrees]
const KEYS = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const SVG = "http://www.w3.org/2000/svg";

function svg(name, attributes, words = "") {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = words;
  return made;
}

function render({ model, el }) {
  const ball = svg("svg", {
    width: 2 * R + 12, height: 2 * R + 12, viewBox: `${-R - 6} ${-R - 6} ${2 * R + 12} ${2 * R + 12}`,
    tabindex: 0, role: "slider", class: "ikteach-ball", "data-lm-suppress-shortcuts": "true",
    "aria-valuemin": -180, "aria-valuemax": 180,
    style: "touch-action:none;cursor:grab", "aria-label": model.get("label"),
  });
  el.appendChild(ball);
  let held = null;

  function turn(azimuth, elevation) {
    model.set("azimuth", ((azimuth + 540) % 360) - 180);
    model.set("elevation", Math.max(-85, Math.min(85, elevation)));
    model.save_changes();
  }

  function draw() {
    const a = (model.get("azimuth") * Math.PI) / 180, e = (model.get("elevation") * Math.PI) / 180;
    const view = (x, y, z) => { // the camera goes round: the globe turns the other way
      const right = x * Math.cos(a) - z * Math.sin(a), toward = x * Math.sin(a) + z * Math.cos(a);
      return [right * R, -(y * Math.cos(e) - toward * Math.sin(e)) * R, toward * Math.cos(e) + y * Math.sin(e)];
    };
    const circle = (at) => {
      let path = "", up = false;
      for (let i = 0; i <= 48; i++) {
        const [x, y, depth] = view(...at((i * Math.PI) / 24));
        path += depth < 0 ? "" : `${up ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`;
        up = depth >= 0;
      }
      return svg("path", { d: path, fill: "none", stroke: "currentColor", "stroke-opacity": 0.5 });
    };
    const lines = [-60, -30, 0, 30, 60].map((degrees) => {
      const b = (degrees * Math.PI) / 180;
      return circle((t) => [Math.cos(b) * Math.sin(t), Math.sin(b), Math.cos(b) * Math.cos(t)]);
    });
    for (let m = 0; m < 6; m++) {
      const b = (m * Math.PI) / 6;
      lines.push(circle((t) => [Math.sin(b) * Math.cos(t), Math.sin(t), Math.cos(b) * Math.cos(t)]));
    }
    const [x, y, depth] = view(0, 0, 1);
    const front = depth < 0 ? [] : [
      svg("circle", { cx: x, cy: y, r: 6, fill: "#d55e00" }),
      svg("text", { x: x + 8, y: y + 4, "font-size": 11, fill: "currentColor" }, "front"),
    ];
    const rim = { r: R, fill: "#56b4e9", "fill-opacity": 0.2, stroke: "currentColor" };
    ball.replaceChildren(svg("circle", rim), ...lines, ...front);
    const words = `${Math.round(model.get("azimuth"))}° to the left of the front, ` +
      `${Math.round(model.get("elevation"))}° up`;
    ball.setAttribute("aria-valuenow", Math.round(model.get("azimuth")));
    ball.setAttribute("aria-valuetext", words);
  }

  ball.addEventListener("pointerdown", (event) => {
    ball.setPointerCapture(event.pointerId);
    held = { x: event.clientX, y: event.clientY, a: model.get("azimuth"), e: model.get("elevation") };
  });
  ball.addEventListener("pointermove", (event) => {
    if (!held) return;
    turn(held.a - (event.clientX - held.x), held.e + (event.clientY - held.y));
  });
  for (const name of ["pointerup", "pointercancel"])
    ball.addEventListener(name, () => { held = null; });
  ball.addEventListener("keydown", (event) => {
    const move = KEYS[event.key];
    if (!move) return;
    event.preventDefault();
    event.stopPropagation();
    const step = event.shiftKey ? 1 : STEP;
    turn(model.get("azimuth") + step * move[0], model.get("elevation") + step * move[1]);
  });
  model.on("change", draw);
  draw();
  return () => model.off("change", draw);
}

export default { render: told(render) };
