import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { mock, test } from "node:test";
import { number } from "../../ikteach/course/fields.js";
import { exchanged } from "../../ikteach/course/ranking.js";
import { addressOf } from "../../ikteach/view/live/link.js";
import { powers, share } from "../../ikteach/view/live/plot.js";
import { recent, split } from "../../ikteach/view/live/strips.js";
import { floats } from "../../ikteach/view/widgets/binary.js";
import { nearest } from "../../ikteach/view/widgets/curve.js";
import { projection, RADIUS } from "../../ikteach/view/widgets/globe.js";
import { guarded } from "../../ikteach/view/widgets/guarded.js";
import { thinned } from "../../ikteach/view/widgets/pen.js";
import { onPlane, overlap, underPoint } from "../../ikteach/view/widgets/plane.js";
import { Element, Model } from "./page.js";

test("numbers are read from a view that begins anywhere", () => {
  const bytes = new Uint8Array(13);
  new DataView(bytes.buffer).setFloat32(5, 1.5, true);
  assert.deepEqual([...floats(new DataView(bytes.buffer, 5, 8))], [1.5, 0]);
  assert.deepEqual([...floats(new Float32Array([2, 3]).buffer)], [2, 3]);
});

test("a link is an address on a page of the lecture, and elsewhere what a cell needs", () => {
  const lecture = { origin: "http://a:1", pathname: "/voila/render/gait.ipynb" };
  assert.equal(addressOf("speed=9", lecture), "http://a:1/voila/render/gait.ipynb?speed=9");
  assert.equal(addressOf("", lecture), "http://a:1/voila/render/gait.ipynb");
  const lab = { origin: "http://a:1", pathname: "/lab/tree/07_gait.ipynb" };
  assert.equal(addressOf("speed=9", lab), 'preset(figure, "speed=9")');
});

test("the front of the globe goes left as the camera goes right, and down as it goes up", () => {
  const close = (seen, ...there) =>
    seen.forEach((value, i) => {
      assert.ok(Math.abs(value - there[i]) < 1e-12);
    });
  close(projection(0, 0)(0, 0, 1), 0, 0, 1);
  close(projection(90, 0)(0, 0, 1), -RADIUS, 0, 0);
  close(projection(0, 90)(0, 0, 1), 0, RADIUS, 0);
  close(projection(0, 90)(0, 1, 0), 0, 0, 1);
});

test("the nearest place of a curve is found", () => {
  const places = [0, 0.1, 0.5, 1];
  assert.deepEqual(
    [-1, 0.04, 0.06, 0.31, 0.74, 2].map((x) => nearest(places, x)),
    [0, 0, 1, 2, 2, 3],
  );
});

test("strips keep the rows of the last seconds", () => {
  const rows = split(new Float32Array([0, 10, 1, 11, 2, 12]), 2);
  assert.deepEqual(
    recent(rows, 1).map((row) => [...row]),
    [
      [1, 11],
      [2, 12],
    ],
  );
});

test("axes of strips are logarithmic", () => {
  const range = [0.001, 10];
  assert.deepEqual(
    [0, 0.001, 0.1, 10, 99].map((value) => share(value, range)),
    [0, 0, 0.5, 1, 1],
  );
  assert.deepEqual(powers([0.002, 10]), [0.01, 0.1, 1, 10]);
});

test("a ranking exchanges two options and keeps the order it had", () => {
  const order = ["a", "b", "c"];
  assert.deepEqual(exchanged(order, 1, 0), ["b", "a", "c"]);
  assert.deepEqual(order, ["a", "b", "c"]);
});

test("a number that is none, or out of its range, is no answer", () => {
  const fields = number(new Model({ numbers: [0, 5, "m"], answer: null }));
  const [input] = fields.rows[0].children;
  const type = (value, valid) =>
    Object.assign(input, { value, valueAsNumber: +value, checkValidity: () => valid });
  type("", true);
  assert.equal(fields.read(), null);
  type("7", false);
  assert.equal(fields.read(), null);
  type("4", true);
  assert.equal(fields.read(), 4);
});

test("an error in a callback is shown, and stops no other", async () => {
  mock.method(console, "warn", () => {});
  const model = new Model();
  const el = new Element();
  let heard = 0;
  const act = () => {
    heard++;
    throw new Error("no such joint");
  };
  await guarded(({ model: guardedModel }) => {
    guardedModel.on("msg:custom", act);
    return () => guardedModel.off("msg:custom", act);
  })({ model, el }).then((end) => {
    model.tell("msg:custom");
    model.tell("msg:custom");
    end();
    model.tell("msg:custom");
  });
  assert.equal(heard, 2);
  assert.equal(el.children.length, 1);
  assert.match(el.children[0].children[0], /no such joint/);
  mock.restoreAll();
});

test("boxes overlap where they have a part in common, and not where they touch", () => {
  const box = { x: 0, y: 0, width: 10, height: 4 };
  assert.ok(overlap(box, { ...box, x: 9, y: 3 }));
  assert.ok(overlap(box, { x: 2, y: 1, width: 1, height: 1 }));
  assert.ok(!overlap(box, { ...box, x: 10 }));
  assert.ok(!overlap(box, { ...box, y: -4 }));
});

test("a point of a plane is found again under the pointer, and never beyond the edges", () => {
  assert.deepEqual(onPlane([0, 0], 2), [160, 160]);
  assert.deepEqual(onPlane([2, 1], 2), [320, 80]);
  for (const at of [
    [0, 0],
    [1.5, -0.5],
  ])
    assert.deepEqual(
      underPoint(
        onPlane(at, 2).map((x) => x / 320),
        2,
      ),
      at,
    );
  assert.deepEqual(underPoint([1.2, -3], 2), [2, 2]);
});

test("models are listened to by single names: marimo's know no lists of them", () => {
  const house = new URL("../../ikteach/", import.meta.url);
  const scripts = readdirSync(house, { recursive: true }).filter((name) => /\.js$/.test(name));
  assert.ok(scripts.length > 20);
  for (const name of scripts) {
    const found = readFileSync(new URL(name, house), "utf8").match(/"change:\w+ [^"]*"/g);
    assert.equal(found, null, name);
  }
});

test("a long stroke is thinned, and keeps its ends", () => {
  const stroke = Array.from({ length: 2501 }, (_, i) => [i, 0]);
  const kept = thinned(stroke, 1000);
  assert.ok(kept.length <= 1001);
  assert.deepEqual(
    [kept[0], kept[1], kept.at(-1)],
    [
      [0, 0],
      [3, 0],
      [2500, 0],
    ],
  );
  assert.equal(thinned(stroke.slice(0, 7), 1000).length, 7);
});
