import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { OrthographicCamera, PerspectiveCamera, Vector3 } from "three";
import { aspects, grid, Pane, places } from "../../ikteach/view/webgl/panes.js";
import { Scene } from "../../ikteach/view/webgl/scene.js";
import { Model } from "./page.js";

const ASPECT = 1.125;
const WAYS = { front: [0, 0, 1], side: [1, 0, 0.003], top: [0, 1, 0.017] };
let scene;
let renderer;
let told;

/** Controls of a camera that looks at the origin from there. */
function controls(camera, from) {
  camera.position.set(...from);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  camera.updateProjectionMatrix();
  const update = () => camera.lookAt(obj.target); // as three's controls do
  const obj = { target: new Vector3(), enabled: true, update };
  return Object.assign(new Model({ controlling: { obj: camera } }), { obj });
}

beforeEach(() => {
  const free = controls(new PerspectiveCamera(45, ASPECT, 0.1, 100), [2, 1, 3]);
  const beside = Object.values(WAYS).map((way) =>
    controls(
      new OrthographicCamera(-ASPECT, ASPECT, 1, -1, -10, 10),
      way.map((part) => 3 * part),
    ),
  );
  told = [];
  const model = { trigger: (event) => told.push(event) };
  renderer = new Model({ scene: model, controls: [free, ...beside] });
  renderer.trigger = () => {};
  scene = new Scene(renderer);
  scene.shown = [
    { name: "free", way: null },
    ...Object.entries(WAYS).map(([name, way]) => ({ name, way })),
  ];
  scene.aspect = ASPECT;
});

test("four views are two by two, and two are side by side where there is room", () => {
  assert.deepEqual(grid(4, 2.1, 1), [2, 2]);
  assert.deepEqual(grid(1, 0.5, 1), [1, 1]);
  assert.deepEqual(grid(2, 1.6, 1), [2, 1]);
  assert.deepEqual(grid(2, 0.6, 1), [1, 2]);
  assert.deepEqual(grid(2, 1, 1.9), [1, 2], "a row of figures has one view below the other");
});

test("the picture of two views has the shape in which both are seen well", () => {
  for (const needed of [0.8, 1, 1.9]) {
    const { wide, narrow } = aspects(2, ASPECT, needed);
    const [columns, rows] = grid(2, wide, needed);
    assert.ok(Math.abs((wide / columns) * rows - needed) < 1e-9);
    assert.deepEqual(grid(2, narrow, needed), [1, 2]);
  }
});

test("views tile the picture, and a pixel is in one of them", () => {
  for (const [count, shape] of [
    [1, [1, 1]],
    [2, [2, 1]],
    [2, [1, 2]],
    [4, [2, 2]],
  ]) {
    const all = places(count, shape);
    assert.equal(all.length, count);
    const area = all.reduce((sum, [, , width, height]) => sum + width * height, 0);
    assert.ok(Math.abs(area - 1) < 1e-12);
  }
  const size = [400, 300];
  assert.equal(scene.at([10, 10, ...size]), 0);
  assert.equal(scene.at([210, 10, ...size]), 1);
  assert.equal(scene.at([10, 160, ...size]), 2);
  assert.equal(scene.at([399, 299, ...size]), 3);
  assert.equal(scene.at([-5, 10, ...size]), 0, "outside there is the first");
  assert.deepEqual(scene.panes[3].pixel([210, 160, ...size]), [10, 10, 200, 150]);
});

test("news of names and of cameras may come one by one", () => {
  renderer.traits.controls = renderer.traits.controls.slice(0, 1);
  assert.equal(scene.panes.length, 1);
});

test("a camera that looked at the origin looks at its target, where that is elsewhere", () => {
  const [{ camera, controls }] = scene.panes;
  controls.obj.target.set(0.1, 0.5, 0);
  scene.panes[0].aim(ASPECT, 1);
  camera.updateMatrixWorld();
  const seen = controls.obj.target.clone().project(camera);
  assert.ok(Math.hypot(seen.x, seen.y) < 1e-9);
});

test("whatever the pane, what must be seen is in its middle, as large as may be", () => {
  for (const { camera } of scene.panes)
    for (const aspect of [0.4, 1, ASPECT, 2.2]) {
      const pane = scene.panes.find((one) => one.camera === camera);
      pane.place = [0, 0, 1, 1];
      pane.aim(aspect, 1);
      const high = new Vector3(0, 1, 0).applyQuaternion(camera.quaternion);
      const wide = new Vector3(1, 0, 0).applyQuaternion(camera.quaternion);
      const [up, right] = [high, wide].map((at) => at.clone().project(camera));
      assert.ok(Math.abs(up.x) < 1e-9 && Math.abs(right.y) < 1e-9);
      // Nothing is stretched: a metre is as many pixels across as upwards.
      assert.ok(Math.abs((right.x * aspect) / up.y - 1) < 1e-9);
      // And the kernel's picture, of height 2 at a metre from the middle, just fits.
      pane.aim(2, 1);
      const kernels = new Vector3().copy(high).project(camera).y;
      assert.ok(Math.abs(up.y / kernels - Math.min(1, aspect)) < 1e-9);
    }
});

test("keys and pointer act on the view that is chosen, and turn no other", () => {
  scene.choose(2);
  assert.deepEqual(told, ["chosen"]);
  assert.equal(scene.camera, scene.panes[2].camera);
  const enabled = () => scene.panes.map(({ controls: { obj } }) => obj.enabled);
  assert.deepEqual(enabled(), [false, false, true, false]);
  scene.held = true;
  assert.deepEqual(enabled(), [false, false, false, false]);
  scene.held = false;
  assert.deepEqual(enabled(), [false, false, true, false]);
});

test("while a button of the pointer is down it stays with its view", () => {
  scene.choose(1);
  scene.pressed = true;
  scene.choose(3);
  assert.equal(scene.chosen, 1);
});

test("a view that was turned says so, and the free one has no side to leave", () => {
  assert.deepEqual(
    scene.panes.map(({ title }) => title),
    ["free", "front", "side", "top"],
  );
  for (const pane of scene.panes) pane.camera.position.set(1, 1, 1);
  assert.deepEqual(
    scene.panes.map(({ title }) => title),
    ["free", "front, turned", "side, turned", "top, turned"],
  );
});

test("a scene with one view is as it was", () => {
  scene.shown = scene.shown.slice(0, 1);
  const [{ camera }] = scene.panes;
  const before = camera.projectionMatrix.toArray();
  scene.panes[0].aim(ASPECT, 1);
  for (const [i, value] of camera.projectionMatrix.toArray().entries())
    assert.ok(Math.abs(value - before[i]) < 1e-12);
  assert.ok(scene.panes[0] instanceof Pane);
});
