import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { Pins } from "../../ikteach/view/webgl/pins.js";
import { Clock, Vector } from "./page.js";

const HAIR = 0.001; // [m]
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
  pins = new Pins({ position: ({ at }) => at.clone(), redraw() {} }, nodes, 1, HAIR);
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
