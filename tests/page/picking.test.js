import assert from "node:assert/strict";
import { test } from "node:test";
import { nearest } from "../../ikteach/view/webgl/picking.js";

const SIZE = [200, 100]; // [pixels]
const points = [
  { x: 0, y: 0, z: 0.5 },
  { x: 0.1, y: 0, z: 0.5 },
  { x: -0.5, y: 0.5, z: 1.2 }, // behind what the camera sees
];

test("the nearest point within reach is picked", () => {
  assert.equal(nearest(points, [104, 50, ...SIZE], 18), 0);
  assert.equal(nearest(points, [106, 50, ...SIZE], 18), 1);
  assert.equal(nearest(points, [110, 67, ...SIZE], 18), 1);
});

test("none is picked where there is none, or where it cannot be seen", () => {
  assert.equal(nearest(points, [110, 69, ...SIZE], 18), -1);
  assert.equal(nearest(points, [50, 25, ...SIZE], 18), -1);
  assert.equal(nearest([], [0, 0, ...SIZE], 18), -1);
});
