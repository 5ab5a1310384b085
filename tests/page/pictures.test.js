import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { Pictures } from "../../ikteach/view/webgl/pictures.js";
import { Clock, Element } from "./page.js";

const PNG = new DataView(new ArrayBuffer(8));
let clock;
let asked;
let pictures;

beforeEach(() => {
  clock = new Clock();
  asked = 0;
  pictures = new Pictures(new Element(), () => {
    asked++;
  });
});
afterEach(() => {
  pictures.stop();
  clock.end();
});

test("nothing is asked for before pictures are wanted", () => {
  pictures.follow(1);
  assert.equal(asked, 0);
  assert.ok(!pictures.on);
});

test("one picture at a time is asked for, and the next when there is news", () => {
  pictures.start("why");
  for (const frame of [1, 2, 3]) pictures.follow(frame);
  assert.equal(asked, 1);
  pictures.put(3, PNG);
  clock.pass(1000);
  assert.equal(asked, 1);
  pictures.follow(4);
  assert.equal(asked, 2);
});

test("the kernel has as much time for itself as a picture took, and a quarter of a second", () => {
  pictures.start("why");
  pictures.follow(1);
  clock.pass(800);
  pictures.follow(2);
  pictures.put(1, PNG);
  clock.pass(750);
  assert.equal(asked, 1);
  clock.pass(50);
  assert.equal(asked, 2);
  pictures.put(2, PNG);
  pictures.follow(3);
  clock.pass(240);
  assert.equal(asked, 2);
  clock.pass(10);
  assert.equal(asked, 3);
});

test("an answer that does not come counts as lost", () => {
  pictures.start("why");
  pictures.follow(1);
  clock.pass(9999);
  assert.equal(asked, 1);
  clock.pass(1);
  assert.equal(asked, 2);
});

test("a picture for which another page asked is not taken", () => {
  pictures.start("why");
  pictures.put(1, PNG);
  pictures.follow(1);
  assert.equal(asked, 1);
});

test("after its end nothing is asked for", () => {
  pictures.start("why");
  pictures.follow(1);
  pictures.stop();
  pictures.follow(2);
  clock.pass(20_000);
  assert.equal(asked, 1);
});
