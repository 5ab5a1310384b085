// Writes poses into the three.js objects that pythreejs has made.
//
// One binary message is one frame: rows of 12 float32 (see movers.js). The browser says which
// frames it has drawn, so that the kernel never sends far ahead; what comes faster than it can be
// drawn is overwritten by what is newer.

import { floats } from "../widgets/binary.js";
import { element, listen } from "../widgets/dom.js";
import { complain, guarded } from "../widgets/guarded.js";
import { resolve } from "../widgets/models.js";
import { Far } from "./far.js";
import { fit } from "./fit.js";
import { Looking } from "./looking.js";
import { parts, whole } from "./movers.js";
import { Pictures } from "./pictures.js";
import { hasWebGL, sceneOf, stageOf } from "./scene.js";
import { followTheme } from "./theme.js";

/** @import { Scene } from "./scene.js" */

const REPORT_EVERY = 15; // frames; each report makes the kernel busy and idle, and the page says so
const CALM = "(prefers-reduced-motion: reduce)"; // nothing is to move by itself
const LATE = 5000; // [ms] after which a figure that is not there counts as missing

export class Driver {
  #gone = false;
  /** @type {Scene | undefined} */
  #scene;
  /** @type {Looking | undefined} */
  #looking;
  /** @type {Mover[]} */
  #movers = [];
  #rows = -1; // that a frame for these movers has
  #gathering = 0;
  /** @type {Frame | null} */
  #newest = null; // in the scene, and not yet on the screen
  #reported = -1; // number of the newest frame of which the kernel knows that it was drawn
  #shown = 0;
  #stopDrawn = () => {};
  #stopFit = () => {};
  #given;
  #model;
  #status;
  #still;
  #far;

  /**
   * @param {Given} given
   * @param {HTMLElement} status says what the picture shows
   * @param {Pictures} still stands in while there is no figure
   * @param {Far} far shows the distances
   */
  constructor(given, status, still, far) {
    this.#given = given;
    this.#model = given.model;
    this.#status = status;
    this.#still = still;
    this.#far = far;
  }

  /** Wait for the scene of pythreejs; pictures stand in until it comes, if that takes long. */
  async begin() {
    if (!hasWebGL()) return this.#without("webgl");
    const late = setTimeout(() => this.#without("pythreejs"), LATE);
    const scene = await sceneOf(this.#given, () => this.#gone);
    clearTimeout(late);
    if (this.#gone || !scene) return;
    this.#scene = scene;
    this.#still.stop();
    this.see();
    this.#stopFit = fit(scene, this.#status);
    this.#stopDrawn = listen(scene.model, { afterRender: () => this.#drawn() });
    this.#look(scene).catch((error) => complain(this.#given.el, error));
    await this.gather();
  }

  /** @param {Scene} scene */
  async #look(scene) {
    const { el } = this.#given;
    const stage = await stageOf(el, () => this.#gone);
    if (stage) this.#looking = new Looking(scene, stage, el, this.#model);
  }

  end() {
    this.#gone = true;
    this.#looking?.end();
    this.#still.stop();
    this.#stopDrawn();
    this.#stopFit();
  }

  /** Ask the kernel for the newest frame, in a page that is looked at. */
  hello() {
    if (!document.hidden) this.#model.send({ hello: true, calm: matchMedia(CALM).matches });
  }

  /** Show the views that the kernel wants. */
  see() {
    const scene = this.#scene;
    if (!scene) return;
    scene.shown = this.#model.get("panes");
    scene.needed = this.#model.get("needed");
    scene.choose(Math.min(scene.chosen, scene.shown.length - 1));
    scene.model.trigger("shown");
  }

  /** Take the objects that the kernel wants moved. */
  async gather() {
    if (!this.#scene) return;
    const turn = ++this.#gathering;
    const plan = this.#model.get("plan");
    let nodes;
    try {
      nodes = await resolve(this.#given, this.#model.get("nodes"));
    } catch {
      return; // the scene was closed meanwhile, and what it moved has gone
    }
    if (turn !== this.#gathering || plan.length !== nodes.length) return; // there is news already
    this.#movers = nodes.map(({ obj }, i) =>
      Array.isArray(plan[i]) ? parts(obj, plan[i]) : whole(obj, plan[i]),
    );
    this.#rows = this.#model.get("rows");
    this.hello();
  }

  /**
   * Take a message of the kernel: a frame, or a picture for want of a scene.
   * @param {Partial<Frame> & { picture?: number, wrong?: string, far?: string[] }} content
   * @param {DataView[]} [buffers]
   */
  receive({ wrong, picture, frame, change = 0, far }, [bytes] = []) {
    this.#far.show(far);
    if (wrong !== undefined) throw new Error(wrong);
    if (picture !== undefined) {
      this.#still.put(picture, bytes);
      if (this.#still.on) this.#say(picture, change);
    } else if (frame !== undefined && this.#still.on) {
      if (document.hidden) return;
      this.#still.follow(frame);
      this.#report(frame);
    } else if (frame !== undefined && bytes?.byteLength === 48 * this.#rows) {
      const numbers = floats(bytes);
      for (const move of this.#movers) move(numbers);
      this.#newest = { frame, change };
      this.#scene?.redraw();
    }
  }

  /** @param {"webgl" | "pythreejs"} cause */
  #without(cause) {
    if (this.#gone) return;
    this.#still.start(this.#model.get("lacking")[cause]);
    this.hello();
  }

  #drawn() {
    if (!this.#newest) return;
    const { frame, change } = this.#newest;
    this.#newest = null;
    this.#say(frame, change);
    this.#report(frame);
  }

  /**
   * @param {number} frame
   * @param {number} change
   */
  #say(frame, change) {
    Object.assign(this.#status.dataset, { frame, change, shown: ++this.#shown });
  }

  /** @param {number} frame */
  #report(frame) {
    if (frame - this.#reported < REPORT_EVERY) return;
    this.#reported = frame;
    this.#model.send({ drawn: frame });
  }
}

/** @type {Render} */
function render(given) {
  const { model, el } = given;
  const status = element("p", { class: "ikteach-driver", role: "img" });
  const far = new Far(model.get("effectors"));
  el.append(far.box, status);
  const pictures = new Pictures(el, () => model.send({ picture: true }));
  const driver = new Driver(given, status, pictures, far);

  function describe() {
    const views = model.get("panes").map((/** @type {Shown} */ { name }) => name);
    const many = views.length > 1 ? ` ${views.length} views: ${views.join(", ")}.` : "";
    const words = model.get("description") + many;
    status.textContent = words;
    status.setAttribute("aria-label", words);
  }

  const hello = () => driver.hello();
  const stop = listen(model, {
    "msg:custom": (content, buffers) => driver.receive(content, buffers),
    "change:plan": () => driver.gather(),
    "change:description": describe,
    "change:panes": () => {
      describe();
      driver.see();
    },
  });
  const stopTheme = followTheme(model);
  document.addEventListener("visibilitychange", hello);
  describe();
  driver.begin().catch((error) => complain(el, error));
  return () => {
    stop();
    stopTheme();
    driver.end();
    document.removeEventListener("visibilitychange", hello);
  };
}

export default { render: guarded(render) };
