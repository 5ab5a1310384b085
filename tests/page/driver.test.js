import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { Driver } from "../../ikteach/view/webgl/driver.js";
import { Element, Model } from "./page.js";

const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0];
let model;
let scene;
let renderer;
let status;
let still;
let driver;
let at;

function frame(number, x) {
  const row = [...IDENTITY];
  row[9] = x;
  driver.receive({ frame: number, change: 7 }, [new DataView(new Float32Array(row).buffer)]);
}

afterEach(() => driver.end());

beforeEach(async () => {
  const obj = {
    matrix: {
      set: (...rows) => {
        at = rows[3];
      },
    },
  };
  scene = Object.assign(new Model(), { obj: {}, trigger() {} });
  renderer = Object.assign(new Model({ scene, controls: [{ obj: {} }] }), { trigger() {} });
  const others = { renderer, node: { obj } };
  const get_model = async (id) => others[id];
  model = Object.assign(
    new Model({
      renderer: "IPY_MODEL_renderer",
      nodes: ["IPY_MODEL_node"],
      plan: [0],
      rows: 1,
      panes: [{ name: "free", way: null }],
      needed: 1,
    }),
    { widget_manager: { get_model } },
  );
  document.createElement = () => ({ getContext: () => ({ getExtension() {} }) });
  status = new Element();
  still = { on: false, followed: [], follow: (news) => still.followed.push(news), stop() {} };
  at = undefined;
  const el = { closest: () => null }; // its picture is not in the page
  driver = new Driver({ model, el }, status, still, { show() {} });
  globalThis.matchMedia = () => ({ matches: false });
  await driver.begin();
  model.sent = [];
});

test("a frame moves its objects at once, and counts when it is drawn", () => {
  frame(1, 3);
  assert.equal(at, 3);
  assert.equal(status.dataset.frame, undefined);
  scene.tell("afterRender");
  assert.deepEqual(status.dataset, { frame: 1, change: 7, shown: 1 });
  scene.tell("afterRender");
  assert.equal(status.dataset.shown, 1);
});

test("what comes faster than it can be drawn is overwritten", () => {
  for (let i = 1; i <= 5; i++) frame(i, i);
  scene.tell("afterRender");
  assert.equal(at, 5);
  assert.deepEqual(status.dataset, { frame: 5, change: 7, shown: 1 });
});

test("one drawn frame in fifteen is reported", () => {
  for (let i = 0; i < 46; i++) {
    frame(i, i);
    scene.tell("afterRender");
  }
  assert.deepEqual(model.sent, [{ drawn: 14 }, { drawn: 29 }, { drawn: 44 }]);
});

test("a frame for other objects than these moves nothing", () => {
  const bytes = new DataView(new Float32Array([...IDENTITY, ...IDENTITY]).buffer);
  driver.receive({ frame: 1, change: 0 }, [bytes]);
  assert.equal(at, undefined);
});

test("while pictures stand in, frames are followed and nothing is moved", () => {
  still.on = true;
  frame(20, 3);
  assert.deepEqual(still.followed, [20]);
  assert.deepEqual(model.sent, [{ drawn: 20 }]);
  assert.equal(at, undefined);
});

test("what the kernel could not do is an error", () => {
  assert.throws(() => driver.receive({ wrong: "no picture" }), /no picture/);
});
