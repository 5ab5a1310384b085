import assert from "node:assert/strict";
import { test } from "node:test";
import { inPlane, nearest } from "../../ikteach/view/webgl/picking.js";

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

test("as seen from the side or the top a drag leaves the third coordinate alone", () => {
  assert.deepEqual(inPlane([1, 0, 0.003], [0.3, 5, 6], [1, 2, 3]), [1, 5, 6]);
  assert.deepEqual(inPlane([0, 0.99986, 0.017], [4, 2.01, 6], [1, 2, 3]), [4, 2, 6]);
  assert.deepEqual(inPlane([0, 0, -1], [4, 5, 6], [1, 2, 3]), [4, 5, 3]);
});

test("as seen from elsewhere it is in the plane that faces the camera", () => {
  assert.deepEqual(inPlane([0.03, 0, 0.99955], [4, 5, 6], [1, 2, 3]), [4, 5, 6]);
  assert.deepEqual(inPlane([0.6, 0.1, 0.79], [4, 5, 6], [1, 2, 3]), [4, 5, 6]);
});
