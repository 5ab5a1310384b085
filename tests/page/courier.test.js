import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { Courier } from "../../ikteach/view/webgl/courier.js";
import { Clock, Model } from "./page.js";

let clock;
let model;
let post;

beforeEach(() => {
  clock = new Clock();
  model = new Model();
  post = new Courier(model);
});
afterEach(() => clock.end());

test("of the messages of one frame the newest is sent", () => {
  for (const at of [1, 2, 3]) post.send({ at });
  assert.deepEqual(model.sent, []);
  clock.pass(16);
  assert.deepEqual(model.sent, [{ at: 3, fresh: false, number: 1 }]);
});

test("a later message does not hide that a move begins", () => {
  post.send({ at: 1, fresh: true });
  post.send({ at: 2, fresh: false });
  clock.pass(16);
  post.send({ at: 3, fresh: false });
  clock.pass(16);
  const sent = model.sent.map(({ at, fresh }) => [at, fresh]);
  assert.deepEqual(sent, [
    [2, true],
    [3, false],
  ]);
});

test("two messages wait for their answers, and the third for one of them", () => {
  for (const at of [1, 2, 3]) {
    post.send({ at });
    clock.pass(16);
  }
  assert.equal(model.sent.length, 2);
  model.tell("msg:custom", { heard: 1 });
  clock.pass(16);
  assert.equal(model.sent.length, 3);
});

test("an answer that does not come counts as lost after a second", () => {
  for (const at of [1, 2, 3]) {
    post.send({ at });
    clock.pass(16);
  }
  clock.pass(900);
  assert.equal(model.sent.length, 2);
  clock.pass(100);
  assert.equal(model.sent.length, 3);
});

test("what is dropped is returned and not sent", () => {
  post.send({ at: 1, fresh: true });
  assert.deepEqual(post.drop(), { at: 1, fresh: true });
  assert.equal(post.drop(), null);
  clock.pass(100);
  assert.deepEqual(model.sent, []);
});
