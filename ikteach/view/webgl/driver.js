// Writes poses into the three.js objects that pythreejs has made.
//
// One binary message is one frame: rows of 12 float32, the columns x, y, z and position of a
// matrix. A row moves an object as a whole, or some of the points of a mesh of many parts. The
// browser says which frames it has drawn, so that the kernel never sends far ahead; what comes
// faster than it can be drawn is overwritten by what is newer.

const REPORT_EVERY = 15; // frames; each report makes the kernel busy and idle, and the page says so
const LATE = 5000; // [ms] after which a figure that is not there counts as missing

// Two kinds of movers: (numbers of the frame) => what they say is done.

function whole(object, row) {
  return (numbers) => {
    const [ax, ay, az, bx, by, bz, cx, cy, cz, px, py, pz] = numbers.subarray(12 * row, 12 * row + 12);
    object.matrix.set(ax, bx, cx, px, ay, by, cy, py, az, bz, cz, pz, 0, 0, 0, 1);
    object.matrixWorldNeedsUpdate = true;
  };
}

function parts(object, runs) {
  const { position, normal } = object.geometry.attributes;
  for (const one of [position, normal]) if (one) one.rest = one.rest ?? one.array.slice();
  return (numbers) => {
    let from = 0;
    for (const [row, count] of runs) {
      const matrix = numbers.subarray(12 * row, 12 * row + 12), to = from + 3 * count;
      carry(position, matrix, from, to);
      if (normal) carry(normal, upright(matrix), from, to);
      from = to;
    }
    position.needsUpdate = true;
    if (normal) normal.needsUpdate = true;
    object.visible = true;
  };
}

function carry({ rest, array }, [ax, ay, az, bx, by, bz, cx, cy, cz, px, py, pz], from, to) {
  for (let i = from; i < to; i += 3) {
    const x = rest[i], y = rest[i + 1], z = rest[i + 2];
    array[i] = ax * x + bx * y + cx * z + px;
    array[i + 1] = ay * x + by * y + cy * z + py;
    array[i + 2] = az * x + bz * y + cz * z + pz;
  }
}

function upright(matrix) { // how normals turn, where R stretches along its columns: R (RᵀR)⁻¹
  const turned = new Float32Array(12);
  for (let i = 0; i < 9; i += 3) {
    const [x, y, z] = matrix.subarray(i, i + 3), square = x * x + y * y + z * z;
    turned.set([x / square, y / square, z / square], i);
  }
  return turned;
}

function render(given) {
  const { model, el } = given;
  const status = document.createElement("p");
  status.className = "ikteach-driver";
  status.setAttribute("role", "img");
  el.appendChild(status);

  const still = pictures(given); // for as long as there is no figure
  let gone = false;
  let renderer = null, scene = null;
  let movers = [], rows = -1; // what to move, and how many rows a frame for it has
  let gathering = 0;
  let newest = null; // the frame that is in the scene and not yet on the screen
  let reported = -1; // number of the newest frame that the kernel has been told of
  let shown = 0;

  async function begin() {
    if (!hasWebGL()) return without("webgl");
    const late = setTimeout(() => without("pythreejs"), LATE);
    const found = await sceneOf(given, () => gone);
    clearTimeout(late);
    if (gone) return;
    ({ renderer, scene } = found);
    still.stop();
    scene.on("afterRender", drawn);
    await gather();
  }

  function without(cause) {
    if (gone) return;
    still.start(cause);
    hello();
  }

  async function gather() {
    if (!scene) return;
    const turn = ++gathering, plan = model.get("plan");
    let nodes;
    try {
      nodes = await resolve(given, model.get("nodes"));
    } catch {
      return; // the scene was closed meanwhile, and what it moved has gone
    }
    if (turn !== gathering || plan.length !== nodes.length) return; // there is news already
    movers = plan.map((one, i) => (Array.isArray(one) ? parts : whole)(nodes[i].obj, one));
    rows = model.get("rows");
    hello();
  }

  function receive(content, [bytes] = []) {
    if (content.wrong !== undefined) throw new Error(content.wrong);
    if (content.picture !== undefined) {
      still.put(content.picture, bytes);
      if (still.on) say(content.picture, content.change);
    } else if (content.frame !== undefined && still.on) {
      if (document.hidden) return;
      still.follow(content.frame);
      report(content.frame);
    } else if (content.frame !== undefined && bytes?.byteLength === 48 * rows) {
      const numbers = floats(bytes);
      for (const move of movers) move(numbers);
      newest = content;
      renderer.trigger("rerender", renderer, {});
    }
  }

  function drawn() {
    if (!newest) return;
    const { frame, change } = newest;
    newest = null;
    say(frame, change);
    report(frame);
  }

  function say(frame, change) {
    Object.assign(status.dataset, { frame, change, shown: ++shown });
  }

  function report(frame) {
    if (frame - reported < REPORT_EVERY) return;
    reported = frame;
    model.send({ drawn: frame });
  }

  function describe() {
    const words = model.get("description");
    status.textContent = words;
    status.setAttribute("aria-label", words);
  }

  const hello = () => !document.hidden && model.send({ hello: true });
  model.on("msg:custom", receive);
  model.on("change:plan", gather);
  model.on("change:description", describe);
  document.addEventListener("visibilitychange", hello);
  describe();
  begin().catch((error) => complain(el, error));

  return () => {
    gone = true;
    still.stop();
    model.off("msg:custom", receive);
    model.off("change:plan", gather);
    model.off("change:description", describe);
    scene?.off("afterRender", drawn);
    document.removeEventListener("visibilitychange", hello);
  };
}

export default { render: told(render) };
