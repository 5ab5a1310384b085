import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { Pins, stick } from "../../ikteach/view/webgl/pins.js";
import { Clock, Vector } from "./page.js";

const HAIR = 0.001; // [m]
const SCENE = {
  position: ({ at }) => at.clone(),
  vector: (...at) => new Vector(...at),
  redraw() {},
};
let clock;
let nodes;
let pins;

function node(x) {
  const matrix = {
    at: new Vector(x),
    setPosition: (at) => {
      matrix.at = at.clone();
    },
  };
  return { obj: { matrix } };
}

/** The kernel's frame has the nodes there; then what is shown. */
function frame(...places) {
  for (const [i, x] of places.entries()) nodes[i].obj.matrix.setPosition(new Vector(x));
  pins.keep(false);
  return nodes.map(({ obj }) => obj.matrix.at.x);
}

beforeEach(() => {
  clock = new Clock();
  nodes = [node(0), node(5)]; // one target of two figures
  pins = new Pins(SCENE, nodes, [0], HAIR);
});
afterEach(() => clock.end());

test("a pinned target moves in all figures, and stays until the kernel has caught up", () => {
  pins.pin(0, new Vector(1));
  assert.deepEqual(frame(0, 5), [1, 6]);
  assert.deepEqual(frame(0.5, 5.5), [1, 6]);
  assert.deepEqual(frame(1.0005, 6.0005), [1.0005, 6.0005]);
  assert.deepEqual(frame(2, 7), [2, 7]);
});

test("its own position in the scene is no frame of the kernel", () => {
  pins.pin(0, new Vector(1));
  frame(0, 5);
  pins.keep(false);
  assert.deepEqual(frame(0.2, 5.2), [1, 6]);
});

test("where the kernel wants it elsewhere, it goes there after two seconds", () => {
  pins.pin(0, new Vector(1));
  clock.pass(1999);
  assert.deepEqual(frame(0.2, 5.2), [1, 6]);
  clock.pass(2);
  assert.deepEqual(frame(0.2, 5.2), [0.2, 5.2]);
});

test("while a target is held all stay", () => {
  pins.pin(0, new Vector(1));
  clock.pass(5000);
  nodes[0].obj.matrix.setPosition(new Vector(0.2));
  pins.keep(true);
  assert.equal(nodes[0].obj.matrix.at.x, 1);
  pins.clear();
  assert.deepEqual(frame(0.2, 5.2), [0.2, 5.2]);
});

/** An arrow that begins at x and points up, of length 2. */
function arrow(x) {
  const one = node(x);
  one.obj.matrix.elements = [1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, x, 0, 0, 1];
  return one;
}

test("a pinned direction turns, in all figures, and goes on with its joint", () => {
  nodes = [arrow(0), arrow(5)];
  pins = new Pins(SCENE, nodes, [2], HAIR);
  assert.deepEqual(pins.where(1).toArray(), [5, 2, 0]);
  pins.pin(0, new Vector(0, 0, 2));
  assert.deepEqual(frame(1, 6), [1, 6]); // the joint has moved
  for (const { obj } of nodes) assert.deepEqual(obj.matrix.elements.slice(4, 7), [0, 0, 2]);
  assert.deepEqual(pins.where(0).toArray(), [1, 0, 2]);
  assert.deepEqual(pins.where(1).toArray(), [6, 0, 2]);
});

test("a stick lies along its vector, with columns that are orthogonal and of length 1", () => {
  for (const along of [
    [0, 2, 0],
    [0, -2, 0],
    [1, -2, 3],
    [-0.2, 0, 0.1],
  ]) {
    const m = stick(along);
    const [x, y, z] = [0, 4, 8].map((i) => m.slice(i, i + 3));
    const dot = (a, b) => a.reduce((sum, part, i) => sum + part * b[i], 0);
    assert.deepEqual(y, along);
    for (const [a, b, wanted] of [
      [x, x, 1],
      [z, z, 1],
      [x, y, 0],
      [y, z, 0],
      [x, z, 0],
    ])
      assert.ok(Math.abs(dot(a, b) - wanted) < 1e-12);
    const [a, b, c] = [1, 2, 0].map((i) => x[i] * y[(i + 1) % 3] - x[(i + 1) % 3] * y[i]);
    assert.ok(dot([a, b, c], z) > 0); // no mirror
  }
});
