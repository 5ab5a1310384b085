import assert from "node:assert/strict";
import { test } from "node:test";
import { around } from "../../ikteach/view/webgl/handles.js";
import { Scene } from "../../ikteach/view/webgl/scene.js";
import { shift } from "../../ikteach/view/widgets/inview.js";
import { rounded } from "../../ikteach/view/widgets/reachable.js";
import { Model, Vector } from "./page.js";

test("as little is scrolled as shows the whole, or its upper end", () => {
  const view = { top: 100, bottom: 700 };
  assert.equal(shift({ top: 200, bottom: 500 }, view), 0);
  assert.equal(shift({ top: 50, bottom: 500 }, view), -50);
  assert.equal(shift({ top: 300, bottom: 800 }, view), 100);
  assert.equal(shift({ top: 150, bottom: 2000 }, view), 50);
  assert.equal(shift({ top: -900, bottom: 60 }, view), -1000);
});

test("a value is read without its last bits", () => {
  assert.equal(rounded("1.9999999999999964"), "2");
  assert.equal(rounded("-0.25000000000000006"), "-0.25");
  assert.equal(rounded("walking"), "walking");
  assert.equal(rounded(""), "");
});

/** A place that a camera sees as it is: x and y from −1 to 1 are in the picture. */
class Seen extends Vector {
  project() {
    return this;
  }
  unproject() {
    return this;
  }
  clone() {
    return new Seen(this.x, this.y, this.z);
  }
}

test("what is moved stays in the picture, at its depth", () => {
  const camera = { obj: { position: new Seen() } };
  const controls = [new Model({ controlling: camera })];
  const scene = new Scene(new Model({ controls, scene: new Model() }));
  const inside = new Seen(0.5, -0.9, 0.3);
  assert.equal(scene.seen(inside), inside);
  const { x, y, z } = scene.seen(new Seen(7, -0.2, 0.3));
  assert.ok(x < 1 && x > 0.9);
  assert.deepEqual([y, z], [-0.2, 0.3]);
});

test("the target of a direction turns, where it is free to, and keeps its length", () => {
  const all = [
    [-2, -2, -2],
    [2, 2, 2],
  ];
  assert.deepEqual(around([0, 0, 7], ...all, 2), [0, 0, 2]);
  assert.deepEqual(around([-3, 4, 0], ...all, 2), [-1.2, 1.6, 0]);
  const plane = [
    [-2, -2, 0],
    [2, 2, 0],
  ];
  assert.deepEqual(around([-3, 4, 9], ...plane, 2), [-1.2, 1.6, 0]);
  assert.ok(around([0, 0, 9], ...plane, 2).every(Number.isNaN));
});
