// Moves targets in the picture with mouse, touch and keys. The target follows at once, here in the
// page; the kernel hears of it, and its frames are shown again once they have caught up.

const STYLE = `
.ikteach-stage:focus-visible { outline: 3px solid #56b4e9; outline-offset: -3px; }
.ikteach-stage { width: fit-content; }
.ikteach-said { margin: 2px 4px; }
.ikteach-said[role=status] { min-height: 1.4em; }
.ikteach-said[role=alert]:not(:empty) { border-left: 4px solid #d55e00; padding-left: 8px; }`;
const NEAR = { mouse: 18, pen: 22, touch: 32 }; // [pixels] from a target's middle that still hit it
const LATE = 2000; // [ms] after which a target goes where the kernel says, if that is elsewhere
const TURN = 0.1, ZOOM = 1.1; // one key press: of the camera [rad], of its distance
const KEYS = { ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowDown: [0, -1, 0],
               ArrowUp: [0, 1, 0], PageDown: [0, 0, 1], PageUp: [0, 0, -1] };
const KEYPAD = { Numpad4: "ArrowLeft", Numpad6: "ArrowRight", Numpad2: "ArrowDown",
                 Numpad8: "ArrowUp", Numpad9: "PageUp", Numpad3: "PageDown" }; // with num lock, too
const named = (event) => KEYPAD[event.code] ?? event.key;

function line(el, role) {
  const p = document.createElement("p");
  p.className = "ikteach-said";
  p.setAttribute("role", role);
  el.appendChild(p);
  return p;
}

function render(given) {
  let gone = false, leave = null;
  sceneOf(given, () => gone).then(async (found) => {
    leave = found && await takeHold(given, found);
    if (gone) leave?.();
  }).catch((error) => complain(given.el, error));
  return () => { gone = true; leave?.(); };
}

async function takeHold(given, { renderer, scene }) {
  const { model, el } = given;
  const style = document.createElement("style");
  style.textContent = STYLE;
  el.appendChild(style);
  const said = line(el, "status"), alert = line(el, "alert");
  const [halo, ...nodes] = await resolve(given, [model.get("halo"), ...model.get("nodes")]);
  const names = model.get("names"), places = model.get("places");
  const post = courier(model);
  let alive = true, stage = null, chosen = -1, drag = null;
  const pins = new Map(); // node: where it is shown whatever the kernel's frames say

  const camera = () => renderer.get("camera").obj;
  const redraw = () => renderer.trigger("rerender", renderer, {});
  const vector = (x = 0, y = 0, z = 0) => new (camera().position.constructor)(x, y, z);
  const where = (node) => pins.get(node)?.at.clone() ?? vector().setFromMatrixPosition(nodes[node].obj.matrix);
  const target = (node) => node % names.length;
  const place = (node) => vector(...places[Math.floor(node / names.length)]);

  // The pinned targets, kept where they are shown.

  function pin(node, at) {
    const move = at.clone().sub(where(node));
    for (let other = target(node); other < nodes.length; other += names.length)
      pins.set(other, { at: where(other).add(move), until: performance.now() + LATE, seen: null });
    redraw();
  }

  function keep() {
    const hair = model.get("step") / 50; // a millimetre on a human
    for (const [node, one] of pins) {
      const { matrix } = nodes[node].obj;
      const kernel = vector().setFromMatrixPosition(matrix);
      const news = one.seen === null || kernel.distanceTo(one.seen) > hair / 1000;
      const met = news && kernel.distanceTo(one.at) < hair;
      if (!drag && (met || performance.now() > one.until)) {
        pins.delete(node);
      } else {
        matrix.setPosition(one.at);
        nodes[node].obj.matrixWorldNeedsUpdate = true;
        one.seen = one.at.clone();
      }
    }
  }

  function move(node, at, fresh) {
    const low = model.get("low")[target(node)], high = model.get("high")[target(node)];
    const inside = at.sub(place(node)).clamp(vector(...low), vector(...high));
    pin(node, inside.clone().add(place(node)));
    post.send({ target: target(node), at: inside.toArray(), fresh });
    say(`${names[target(node)]}: ${words(inside)}`);
  }

  function undo() {
    const unsent = post.drop()?.fresh; // the kernel never heard of this move
    const begun = drag?.begun ?? true;
    pins.clear();
    release();
    if (begun && !unsent) model.send({ undo: true });
    redraw();
  }

  // What is chosen, shown by the halo and said.

  const words = ({ x, y, z }) => `x ${x.toFixed(2)}, y ${y.toFixed(2)}, z ${z.toFixed(2)} m`;
  function say(text) { said.textContent = text; }

  function choose(node) {
    chosen = node;
    halo.obj.visible = node >= 0;
    if (node >= 0) nodes[node].obj.add(halo.obj);
    else halo.obj.parent?.remove(halo.obj);
    model.set("chosen", node < 0 ? -1 : target(node));
    model.save_changes();
    redraw();
    if (node < 0) return;
    say(`${names[target(node)]} chosen, ${words(where(node).sub(place(node)))}. Arrows move it, ` +
        "page up and down in depth, shift for fine steps, Escape takes back.");
  }

  function faceCamera(_, __, eye) { // the ring is round from everywhere
    const at = vector().setFromMatrixPosition(halo.obj.matrixWorld);
    halo.obj.matrixWorld.extractRotation(eye.matrixWorld).setPosition(at);
  }

  // Mouse and touch.

  function pixel(event) {
    const box = stage.querySelector("canvas, img").getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top, box.width, box.height];
  }

  function hit(event) {
    const [x, y, width, height] = pixel(event);
    let best = -1, least = NEAR[event.pointerType] ?? NEAR.mouse;
    nodes.forEach((_, node) => {
      const seen = where(node).project(camera());
      const far = Math.hypot((seen.x + 1) * width / 2 - x, (1 - seen.y) * height / 2 - y);
      if (far < least && Math.abs(seen.z) < 1) [best, least] = [node, far];
    });
    return best;
  }

  function under(event, depth) { // the point under the pointer, so deep in the picture
    const [x, y, width, height] = pixel(event);
    return vector(2 * x / width - 1, 1 - 2 * y / height, depth).unproject(camera());
  }

  function turning(enabled) {
    for (const controls of renderer.get("controls")) controls.obj.enabled = enabled;
  }

  function down(event) {
    if (event.button !== 0 || drag) return;
    const node = hit(event);
    if (node < 0) return;
    event.preventDefault(); // no mousedown for the camera
    event.stopPropagation();
    turning(false);
    const { z } = where(node).project(camera());
    const grip = where(node).sub(under(event, z)); // it does not jump to the pointer
    drag = { node, depth: z, grip, pointer: event.pointerId, begun: false };
    stage.setPointerCapture(event.pointerId);
    stage.focus({ preventScroll: true });
    choose(node);
  }

  function moved(event) {
    if (!drag) {
      stage.style.cursor = event.buttons === 0 && hit(event) >= 0 ? "grab" : "";
    } else if (event.pointerId === drag.pointer) {
      event.stopPropagation();
      move(drag.node, under(event, drag.depth).add(drag.grip), !drag.begun);
      drag.begun = true;
    }
  }

  function release() {
    if (!drag) return;
    drag = null;
    turning(true);
  }

  function up(event) { if (event.pointerId === drag?.pointer) release(); }

  // Keys. Tab goes from the camera through the targets, and out.

  function key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === "Tab") {
      const next = chosen < 0 && event.shiftKey ? -2 : chosen + (event.shiftKey ? -1 : 1);
      if (next < -1 || next >= names.length) return; // out of the picture
      choose(next);
      if (next < 0) invite();
    } else if (event.key === "Escape") undo();
    else if (!KEYS[named(event)]) return;
    else if (chosen < 0) turn(...KEYS[named(event)]);
    else push(event);
    event.preventDefault();
    event.stopPropagation();
  }

  function push(event) { // along that axis of the world which comes nearest to the way on the screen
    const { elements } = camera().matrixWorld;
    const column = KEYS[named(event)].findIndex((part) => part !== 0);
    const way = elements.slice(4 * column, 4 * column + 3);
    const axis = way.reduce((best, part, i) => Math.abs(part) > Math.abs(way[best]) ? i : best, 0);
    const step = vector();
    step.setComponent(axis, KEYS[named(event)][column] * Math.sign(way[axis]) *
                            model.get("step") * (event.shiftKey ? 0.1 : 1));
    move(chosen, where(chosen).add(step), !event.repeat);
  }

  function turn(x, y, z) {
    const [controls] = renderer.get("controls");
    const eye = camera(), away = eye.position.clone().sub(controls.obj.target);
    const far = away.length() * ZOOM ** z, flat = Math.hypot(away.x, away.z);
    const azimuth = Math.atan2(away.x, away.z) + TURN * x;
    const height = Math.max(-1.5, Math.min(1.5, Math.atan2(away.y, flat) + TURN * y));
    eye.position.copy(controls.obj.target).add(vector(
      far * Math.cos(height) * Math.sin(azimuth), far * Math.sin(height),
      far * Math.cos(height) * Math.cos(azimuth)));
    if (eye.isOrthographicCamera) { eye.zoom /= ZOOM ** z; eye.updateProjectionMatrix(); }
    controls.obj.update();
    controls.update_controlled();
    redraw();
  }

  function invite() { say("Arrows turn the camera, page up goes nearer, page down farther. Tab chooses a target."); }
  function focus() { if (chosen < 0 && !drag) invite(); }
  function blur() { if (!drag) { choose(-1); say(""); } }

  // Into the page, and out of it.

  const heard = (content) => {
    if (content.say !== undefined) say(content.say);
    if (content.let !== undefined) { pins.clear(); redraw(); }
  };
  const complain = () => { alert.textContent = model.get("alert"); };
  const events = { pointermove: moved, pointerup: up, pointercancel: up, lostpointercapture: up,
                   keydown: key, focus, blur };

  function enter() {
    stage = el.closest(".ikteach-scene")?.querySelector(".jupyter-threejs");
    if (!stage) { if (alive) requestAnimationFrame(enter); return; }
    stage.classList.add("ikteach-stage");
    stage.tabIndex = 0;
    stage.style.touchAction = "none"; // a finger drags; it does not scroll the page
    stage.dataset.lmSuppressShortcuts = "true"; // else the notebook takes the keys for itself
    stage.setAttribute("role", "application");
    stage.setAttribute("aria-label", `Scene with ${names.length} targets: ${names.join(", ")}`);
    stage.addEventListener("pointerdown", down, true); // before the camera hears of it
    for (const [name, act] of Object.entries(events)) stage.addEventListener(name, act);
    el.dataset.ready = "true";
  }

  halo.obj.visible = false;
  halo.obj.onBeforeRender = faceCamera;
  scene.on("beforeRender", keep);
  model.on("msg:custom", heard);
  model.on("change:alert", complain);
  complain();
  enter();

  return () => {
    alive = false;
    release();
    post.close();
    scene.off("beforeRender", keep);
    model.off("msg:custom", heard);
    model.off("change:alert", complain);
    if (!stage) return;
    stage.removeEventListener("pointerdown", down, true);
    for (const [name, act] of Object.entries(events)) stage.removeEventListener(name, act);
  };
}

export default { render: told(render) };
