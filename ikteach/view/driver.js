// Writes poses into the three.js objects that pythreejs has made.
//
// One binary message is one frame: 12 float32 a node, the columns x, y, z and position of its
// matrix. The browser says which frames it has drawn, so that the kernel never sends more than a
// few ahead; what comes late is overwritten, not queued.

const REPORT_EVERY = 15; // frames; each report makes the kernel busy and idle, and the page says so

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
  let received = -1; // number of the newest frame written into the scene
  let change = 0; // what the kernel said of it: how many changes of the controls it knows
  let drawn = -1; // number of the newest frame on the screen
  let reported = -1; // number of the newest frame that the kernel has been told of
  let shown = 0;

  function receive(content, buffers) {
    if (content.frame === undefined) return;
    const view = buffers[0];
    const numbers = new Float32Array(view.buffer, view.byteOffset, view.byteLength / 4);
    nodes.forEach((node, i) => place(node.obj, numbers, 12 * i));
    received = content.frame;
    change = content.change;
    renderer.trigger("rerender", renderer, {});
  }

  function report() {
    if (received === drawn) return;
    drawn = received;
    shown += 1;
    Object.assign(status.dataset, { frame: drawn, change, shown });
    if (drawn - reported < REPORT_EVERY) return;
    reported = drawn;
    model.send({ drawn });
  }

  function describe() {
    const words = model.get("description");
    status.textContent = words;
    status.setAttribute("aria-label", words);
  }

  const hello = () => !document.hidden && model.send({ hello: true });
  model.on("msg:custom", receive);
  model.on("change:description", describe);
  scene.on("afterRender", report);
  document.addEventListener("visibilitychange", hello);
  describe();
  hello();

  return () => {
    model.off("msg:custom", receive);
    model.off("change:description", describe);
    scene.off("afterRender", report);
    document.removeEventListener("visibilitychange", hello);
  };
}

export default { render };
