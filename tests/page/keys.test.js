import assert from "node:assert/strict";
import { test } from "node:test";
import { after, along, turned } from "../../ikteach/view/webgl/keys.js";
import { chosenBy, clamp } from "../../ikteach/view/widgets/choosing.js";

test("Tab goes from the camera through the targets and out", () => {
  assert.equal(after(-1, false, 2), 0);
  assert.equal(after(0, false, 2), 1);
  assert.equal(after(1, false, 2), undefined);
  assert.equal(after(0, true, 2), -1);
  assert.equal(after(-1, true, 2), undefined);
});

test("an arrow moves along the axis of the world nearest to it", () => {
  const side = [0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 5, 0, 0, 1]; // looked at from +x
  assert.deepEqual(along(side, [1, 0, 0]).map(Math.round), [0, 0, -1]);
  assert.deepEqual(along(side, [-1, 0, 0]).map(Math.round), [0, 0, 1]);
  assert.deepEqual(along(side, [0, 1, 0]).map(Math.round), [0, 1, 0]);
  assert.deepEqual(along(side, [0, 0, 1]).map(Math.round), [1, 0, 0]);
});

test("the camera turns round what it looks at", () => {
  const away = [0, 1, 3];
  const right = turned(away, [1, 0, 0]);
  assert.ok(Math.abs(Math.hypot(...right) - Math.hypot(...away)) < 1e-12);
  assert.ok(Math.abs(right[1] - 1) < 1e-12);
  assert.ok(Math.abs(Math.atan2(right[0], right[2]) - 0.1) < 1e-12);
  assert.ok(Math.abs(Math.hypot(...turned(away, [0, 0, -1])) - Math.hypot(...away) / 1.1) < 1e-12);
});

test("the camera does not turn over the pole", () => {
  let away = [0, 0, 3];
  for (let i = 0; i < 40; i++) away = turned(away, [0, 1, 0]);
  assert.ok(Math.abs(Math.asin(away[1] / 3) - 1.5) < 1e-12);
});

test("keys choose one of a row, and no farther than its ends", () => {
  const steps = { ArrowUp: -1, PageDown: 10 };
  assert.equal(chosenBy("ArrowUp", steps, 3, 8), 2);
  assert.equal(chosenBy("ArrowUp", steps, 0, 8), 0);
  assert.equal(chosenBy("PageDown", steps, 3, 8), 8);
  assert.equal(chosenBy("Home", steps, 3, 8), 0);
  assert.equal(chosenBy("End", steps, 3, 8), 8);
  assert.equal(chosenBy("a", steps, 3, 8), undefined);
  assert.equal(clamp(5, 0, -1), 0);
});
