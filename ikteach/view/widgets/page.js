// What every widget of ours has in the page; it stands before the script of each.

const LIVES = "ikteach-lives"; // says to the page that our scripts run in it: see lacking.py

const LOST_KERNEL = "its kernel has ended or was restarted";

// `render`, with what goes wrong in it, and later in its callbacks, told to the person.
function told(render) {
  return async (given) => {
    const tell = (error) => complain(given.el, error);
    document.body.classList.add(LIVES);
    try {
      return await render({ ...given, model: guarded(given.model, tell) });
    } catch (error) {
      tell(error);
    }
  };
}

// The same model. What a callback of it throws, or a message that finds no kernel, stops no other.
function guarded(model, tell) {
  const guards = new Map();
  const guard = (act, cause) => (...values) => {
    const fail = (error) => tell(cause ?? error);
    try {
      const done = act(...values);
      done?.catch?.(fail);
      return done;
    } catch (error) {
      fail(error);
    }
  };
  const own = {
    on(events, act) {
      if (!guards.has(act)) guards.set(act, guard(act));
      model.on(events, guards.get(act));
    },
    off: (events, act) => model.off(events, guards.get(act)),
    send: guard((...values) => model.send(...values), LOST_KERNEL),
    save_changes: guard(() => model.save_changes(), LOST_KERNEL),
  };
  return new Proxy({}, {
    get(_, name) {
      const value = own[name] ?? model[name];
      return typeof value === "function" ? value.bind(model) : value;
    },
  });
}

function complain(el, error) { // once: what went wrong first is the cause
  console.warn("ikteach:", error);
  if (el.querySelector(":scope > .ikteach-failed")) return;
  const words = String(error?.message ?? error).slice(0, 200);
  const p = document.createElement("p");
  p.className = "ikteach-failed";
  p.setAttribute("role", "alert");
  p.style.cssText = "border-left:4px solid #d55e00;padding:4px 10px;margin:4px 0";
  p.textContent = `This did not work in the page: ${words}. Run the cell again; if that does ` +
    "not help, save, and reload the page.";
  el.append(p);
}

// The models that these references name, once they are made: also pythreejs's, whose objects are
// those of three.js.
async function resolve({ model, host }, references) {
  const find = (id) => model.widget_manager?.get_model?.(id) ?? host.getModel(`anywidget:${id}`);
  const models = await Promise.all(
    references.map((reference) => find(reference.slice("IPY_MODEL_".length))),
  );
  await Promise.all(models.map((one) => one.initPromise));
  return models;
}

// The renderer and the scene of this widget, as soon as pythreejs has made them; that may be never.
async function sceneOf(given, gone) {
  while (!gone()) {
    const [renderer] = await resolve(given, [given.model.get("renderer")]).catch(() => []);
    const scene = renderer?.get("scene");
    if (scene?.obj) return { renderer, scene };
    await new Promise((done) => setTimeout(done, 1000));
  }
}

// The float32 numbers of a message, whether it brings an ArrayBuffer or a view of one.
function floats(bytes) {
  const { buffer, byteOffset, byteLength } = ArrayBuffer.isView(bytes) ? bytes : new DataView(bytes);
  return new Float32Array(buffer.slice(byteOffset, byteOffset + byteLength));
}

