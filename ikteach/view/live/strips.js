// Draws curves over the last seconds on a canvas. A message brings rows of float32: the time [s],
// then the value of every line of every panel.

const HEIGHT = 170, LEFT = 44, TOP = 22, BOTTOM = 20, RIGHT = 8;

function render({ model, el }) {
  const panels = model.get("panels"), seconds = model.get("seconds");
  const width = 1 + panels.reduce((sum, panel) => sum + panel.lines.length, 0);
  const root = document.createElement("div");
  root.className = "ikteach-strips";
  root.style.cssText = "display:flex;flex-wrap:wrap;gap:12px";
  root.setAttribute("role", "img");
  el.appendChild(root);
  let samples = []; // Float32Arrays, the oldest first
  let first = 1;
  const views = panels.map((panel) => {
    const view = { panel, first, canvas: figure(root, panel) };
    first += panel.lines.length;
    return view;
  });
  let asked = false;

  function draw() {
    asked = false;
    for (const view of views) paint(view, samples, seconds);
    root.dataset.samples = samples.length;
    root.dataset.drawn = +(root.dataset.drawn ?? 0) + 1;
  }

  function receive({ fresh, rows }, buffers) {
    if (fresh) samples = [];
    if (rows) {
      const numbers = floats(buffers[0]);
      for (let i = 0; i < rows; i++) samples.push(numbers.subarray(i * width, (i + 1) * width));
      const oldest = samples.at(-1)[0] - seconds;
      samples = samples.filter((sample) => sample[0] >= oldest);
    }
    if (!asked) requestAnimationFrame(draw);
    asked = true;
  }

  const describe = () => root.setAttribute("aria-label", model.get("alt"));
  model.on("msg:custom", receive);
  model.on("change:alt", describe);
  describe();
  draw();
  return () => {
    model.off("msg:custom", receive);
    model.off("change:alt", describe);
  };
}

function svg(name, attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

function figure(root, panel) {
  const box = document.createElement("div");
  box.style.cssText = "flex:1 1 280px;max-width:440px";
  const canvas = document.createElement("canvas");
  canvas.width = 420;
  canvas.height = HEIGHT;
  canvas.style.width = "100%";
  const legend = document.createElement("div");
  legend.style.cssText = "display:flex;flex-wrap:wrap;gap:2px 12px;font-size:12px";
  for (const line of panel.lines) {
    const entry = document.createElement("span");
    const sample = svg("svg", { width: 30, height: 8, "aria-hidden": true });
    sample.append(svg("line", {
      x1: 0, y1: 4, x2: 30, y2: 4,
      stroke: line.colour, "stroke-width": 2.5, "stroke-dasharray": line.dashes.join(" "),
    }));
    entry.append(sample, " ", line.name);
    legend.appendChild(entry);
  }
  box.append(canvas, legend);
  root.appendChild(box);
  return canvas;
}

function paint({ panel, first, canvas }, samples, seconds) {
  const pen = canvas.getContext("2d"), { width, height } = canvas;
  const ink = getComputedStyle(canvas).color, [low, high] = panel.range.map(Math.log10);
  const now = samples.length ? samples.at(-1)[0] : 0;
  const x = (t) => LEFT + ((t - now + seconds) / seconds) * (width - LEFT - RIGHT);
  const y = (v) => {
    const share = (Math.log10(Math.max(v, panel.range[0])) - low) / (high - low);
    return height - BOTTOM - Math.min(share, 1) * (height - TOP - BOTTOM);
  };
  pen.clearRect(0, 0, width, height);
  pen.setLineDash([]);
  pen.lineWidth = 1;
  pen.fillStyle = pen.strokeStyle = ink;
  pen.font = "12px sans-serif";
  pen.textAlign = "left";
  pen.fillText(`${panel.title} [${panel.unit}]`, LEFT, 14);
  pen.globalAlpha = 0.25;
  for (let power = Math.ceil(low); power <= high; power++)
    rule(LEFT, y(10 ** power), width - RIGHT, y(10 ** power));
  for (let s = 0; s <= seconds; s += 2) rule(x(now - s), TOP, x(now - s), height - BOTTOM);
  pen.globalAlpha = 1;
  pen.textAlign = "right";
  for (let power = Math.ceil(low); power <= high; power++)
    pen.fillText(Math.abs(power) < 5 ? 10 ** power : `1e${power}`, LEFT - 4, y(10 ** power) + 4);
  pen.fillText("now", width - RIGHT, height - 5);
  pen.textAlign = "left";
  pen.fillText(`−${seconds} s`, LEFT, height - 5);
  pen.lineWidth = 2;
  panel.lines.forEach((line, i) => {
    pen.strokeStyle = line.colour;
    pen.setLineDash(line.dashes);
    pen.beginPath();
    for (const sample of samples) pen.lineTo(x(sample[0]), y(sample[first + i]));
    pen.stroke();
  });

  function rule(x1, y1, x2, y2) {
    pen.beginPath();
    pen.moveTo(x1, y1);
    pen.lineTo(x2, y2);
    pen.stroke();
  }
}

export default { render: told(render) };
