import assert from "node:assert/strict";
import { test } from "node:test";
import { parts, upright, whole } from "../../ikteach/view/webgl/movers.js";

// Columns x, y, z of a quarter turn about z, then a position.
const TURN = [0, 1, 0, -1, 0, 0, 0, 0, 1, 10, 20, 30];
const STAY = [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0];
const LONG = [2, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]; // twice as long along x
const frame = new Float32Array([...STAY, ...TURN, ...LONG]);

function mesh(points, normals) {
  const attribute = (numbers) => numbers && { array: new Float32Array(numbers.flat()) };
  const attributes = { position: attribute(points), normal: attribute(normals) };
  return { visible: false, geometry: { attributes } };
}

test("an object as a whole has the matrix of its row", () => {
  const object = { matrix: { set: (...rows) => Object.assign(object, { rows }) } };
  whole(object, 1)(frame);
  assert.deepEqual(object.rows, [0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30, 0, 0, 0, 1]);
  assert.ok(object.matrixWorldNeedsUpdate);
});

test("points of a mesh are at R x + p, each run by its row", () => {
  const runs = [
    [1, 2],
    [0, 1],
  ];
  const object = mesh([[1, 0, 0], [0, 1, 0], [7, 8, 9]]); // biome-ignore format: a table
  const move = parts(object, runs);
  move(frame);
  move(frame); // from where they are at rest, not from where they were
  const { array } = object.geometry.attributes.position;
  assert.deepEqual([...array], [10, 21, 30, 9, 20, 30, 7, 8, 9]);
  assert.ok(object.visible);
});

test("what is moved by other runs afterwards still knows its rest", () => {
  const object = mesh([[1, 0, 0]]);
  parts(object, [[1, 1]])(frame);
  parts(object, [[0, 1]])(frame);
  assert.deepEqual([...object.geometry.attributes.position.array], [1, 0, 0]);
});

test("normals stay normal to what is stretched", () => {
  const object = mesh([[0, 0, 0]], [[0.6, 0.8, 0]]);
  parts(object, [[2, 1]])(frame);
  const [x, y] = object.geometry.attributes.normal.array;
  const along = [2 * 0.8, -0.6]; // a tangent, stretched
  assert.ok(Math.abs(x * along[0] + y * along[1]) < 1e-6);
  assert.deepEqual([...upright(new Float32Array(STAY))].slice(0, 9), STAY.slice(0, 9));
});
