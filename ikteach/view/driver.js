// Writes poses into the three.js objects that pythreejs has made.
//
// One binary message is one frame: 12 float32 a node, the columns x, y, z and position of its
// matrix. The browser says which frames it has drawn, so that the kernel never sends far ahead; of
// what comes faster than it can be drawn, the newest few are kept and the rest dropped.

const REPORT_EVERY = 15; // frames; each report makes the kernel busy and idle, and the page says so

const WAITING = 1; // frames kept for the next redraw: the newest

async function resolve(manager, references) {
  const models = await Promise.all(
    references.map((reference) => manager.get_model(reference.slice("IPY_MODEL_".length))),
  );
  await Promise.all(models.map((model) => model.initPromise));
  return models;
}

function place(object, numbers, at) {
  const [ax, ay, az, bx, by, bz, cx, cy, cz, px, py, pz] = numbers.subarray(at, at + 12);
  object.matrix.set(ax, bx, cx, px, ay, by, cy, py, az, bz, cz, pz, 0, 0, 0, 1);
  object.matrixWorldNeedsUpdate = true;
}

async function render({ model, el }) {
  const status = document.createElement("p");
  status.className = "ikteach-driver";
  status.setAttribute("role", "img");
  el.appendChild(status);

  const [renderer, ...nodes] = await resolve(model.widget_manager, [
    model.get("renderer"),
    ...model.get("nodes"),
  ]);
  const scene = renderer.get("scene");
  const waiting = []; // frames that came while one was being drawn; the newest few are kept
  let drawing = null; // the frame that is in the scene and not yet on the screen
  let reported = -1; // number of the newest frame that the kernel has been told of
  let shown = 0;

  function receive(content, buffers) {
    if (content.frame === undefined) return;
    waiting.push({ ...content, view: buffers[0] });
    if (waiting.length > WAITING) waiting.shift();
    if (!drawing) next();
  }

  function next() {
    drawing = waiting.shift() ?? null;
    if (!drawing) return;
    const { buffer, byteOffset, byteLength } = drawing.view;
    const numbers = new Float32Array(buffer, byteOffset, byteLength / 4);
    nodes.forEach((node, i) => place(node.obj, numbers, 12 * i));
    renderer.trigger("rerender", renderer, {});
  }

  function drawn() {
    if (!drawing) return;
    const { frame, change } = drawing;
    Object.assign(status.dataset, { frame, change, shown: ++shown });
    if (frame - reported >= REPORT_EVERY) {
      reported = frame;
      model.send({ drawn: frame });
    }
    next();
  }

  function describe() {
    const words = model.get("description");
    status.textContent = words;
    status.setAttribute("aria-label", words);
  }

  const hello = () => !document.hidden && model.send({ hello: true });
  model.on("msg:custom", receive);
  model.on("change:description", describe);
  scene.on("afterRender", drawn);
  document.addEventListener("visibilitychange", hello);
  describe();
  hello();

  return () => {
    model.off("msg:custom", receive);
    model.off("change:description", describe);
    scene.off("afterRender", drawn);
    document.removeEventListener("visibilitychange", hello);
  };
}

export default { render };
