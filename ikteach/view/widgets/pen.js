// A pen on a plane: a stroke is drawn by a pointer, points are set one by one with keys.

import { listen, svg, take } from "./dom.js";

const MOST = 1000; // points of a stroke that are sent

/**
 * Let pointer and keys draw on a plane; the kernel is told {stroke}, {point} or {back}.
 * @param {SVGElement} plane
 * @param {SVGElement} knob where the pen is, which takes the keys
 * @param {Model} model
 * @param {(event: PointerEvent) => number[]} under the point of the plane under the pointer
 * @param {(points: number[][]) => string} line the points as a path
 */
export function makePen(plane, knob, model, under, line) {
  const ink = svg("path", { class: "ikteach-ink" });
  plane.append(ink);
  /** @type {number[][] | null} */
  let stroke = null;
  const draw = () => ink.setAttribute("d", stroke?.length ? line(stroke) : "");
  const stop = drawStroke(plane, {
    begin: (event) => {
      stroke = [under(event)];
    },
    go: (events) => {
      if (!stroke) return;
      stroke.push(...events.map(under));
      draw();
    },
    end: (whole) => {
      if (stroke && whole) model.send({ stroke: thinned(stroke, MOST) });
      stroke = null;
      if (!whole) draw(); // else the ink stays until the curve is there
    },
  });
  knob.addEventListener("keydown", (event) => {
    const { key } = /** @type {KeyboardEvent} */ (event);
    if (key !== "Enter" && key !== "Backspace") return;
    take(event);
    model.send(key === "Enter" ? { point: model.get("at") } : { back: true });
  });
  const quiet = listen(model, { "change:lines": draw });
  return () => {
    stop();
    quiet();
  };
}

/**
 * At most so many of a stroke's points, the first and the last among them.
 * @param {number[][]} stroke
 * @param {number} most
 */
export function thinned(stroke, most) {
  const every = Math.ceil(stroke.length / most);
  return stroke.filter((_, i) => i % every === 0 || i === stroke.length - 1);
}

/**
 * Follow one pointer from where it is pressed until it is let go; call the answer to stop.
 * @param {SVGElement} plane
 * @param {{ begin: Act, go: (events: PointerEvent[]) => void, end: (whole: boolean) => void }} acts
 */
function drawStroke(plane, { begin, go, end }) {
  /** @type {number | null} */
  let pointer = null;
  /** @type {Record<string, (event: PointerEvent) => void>} */
  const heard = {
    pointerdown: (event) => {
      if (event.button !== 0 || pointer !== null) return;
      pointer = event.pointerId;
      plane.setPointerCapture(pointer);
      take(event);
      begin(event);
    },
    pointermove: (event) => {
      if (event.pointerId !== pointer) return;
      const all = event.getCoalescedEvents?.() ?? [];
      go(all.length ? all : [event]);
    },
    pointerup: (event) => finish(event, true),
    pointercancel: (event) => finish(event, false),
  };
  function finish(/** @type {PointerEvent} */ event, /** @type {boolean} */ whole) {
    if (event.pointerId !== pointer) return;
    pointer = null;
    end(whole);
  }
  for (const [name, act] of Object.entries(heard))
    plane.addEventListener(name, /** @type {EventListener} */ (act));
  return () => {
    for (const [name, act] of Object.entries(heard))
      plane.removeEventListener(name, /** @type {EventListener} */ (act));
  };
}
