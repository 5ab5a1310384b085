// A plot on a canvas: the last seconds to the right, values on a logarithmic axis upward.

const HEIGHT = 160; // [pixels]
const MARGIN = { top: 22, right: 8, bottom: 20 };

export class Plot {
  #pen;
  #panel;
  #first;
  #seconds;
  #width = 420; // [pixels] of the page; it has letters of one size, however wide it is
  #left = 44; // of the axis: as the widest of its numbers needs

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Panel} panel
   * @param {number} first column of its first line in the samples
   * @param {number} seconds that it shows
   */
  constructor(canvas, panel, first, seconds) {
    this.#pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    this.#panel = panel;
    this.#first = first;
    this.#seconds = seconds;
  }

  /**
   * Take another width, in as many pixels as the screen has for it.
   * @param {number} width
   */
  resize(width) {
    const { canvas } = this.#pen;
    const fine = window.devicePixelRatio;
    this.#width = width;
    canvas.width = Math.round(width * fine);
    canvas.height = Math.round(HEIGHT * fine);
    this.#pen.scale(fine, fine);
  }

  /** @param {Float32Array[]} samples rows: the time [s] and the values, the oldest first */
  draw(samples) {
    const pen = this.#pen;
    pen.clearRect(0, 0, this.#width, HEIGHT);
    pen.setLineDash([]);
    pen.lineWidth = 1;
    pen.fillStyle = pen.strokeStyle = getComputedStyle(pen.canvas).color;
    pen.font = "12px sans-serif";
    const widths = powers(this.#panel.range).map((value) => pen.measureText(written(value)).width);
    this.#left = Math.max(...widths) + 6;
    const now = samples.length ? samples[samples.length - 1][0] : 0;
    this.#grid(now);
    this.#labels();
    this.#lines(samples, now);
  }

  /** @param {number} now [s] */
  #grid(now) {
    this.#pen.globalAlpha = 0.25;
    const [left, right] = [this.#left, this.#width - MARGIN.right];
    const [top, bottom] = [MARGIN.top, HEIGHT - MARGIN.bottom];
    for (const value of powers(this.#panel.range))
      this.#rule(left, this.#y(value), right, this.#y(value));
    for (let age = 0; age <= this.#seconds; age += 2) {
      const x = this.#x(now - age, now);
      this.#rule(x, top, x, bottom);
    }
    this.#pen.globalAlpha = 1;
  }

  #labels() {
    const pen = this.#pen;
    const { title, unit, range } = this.#panel;
    pen.textAlign = "left";
    pen.fillText(`${title} [${unit}]`, this.#left, 14);
    pen.fillText(`−${this.#seconds} s`, this.#left, HEIGHT - 5);
    pen.textAlign = "right";
    pen.fillText("now", this.#width - MARGIN.right, HEIGHT - 5);
    for (const value of powers(range))
      pen.fillText(written(value), this.#left - 4, this.#y(value) + 4);
  }

  /**
   * @param {Float32Array[]} samples
   * @param {number} now [s]
   */
  #lines(samples, now) {
    const pen = this.#pen;
    pen.lineWidth = 2;
    this.#panel.lines.forEach((line, i) => {
      pen.strokeStyle = line.colour;
      pen.setLineDash(line.dashes);
      pen.beginPath();
      for (const row of samples) pen.lineTo(this.#x(row[0], now), this.#y(row[this.#first + i]));
      pen.stroke();
    });
  }

  /**
   * @param {number} time [s]
   * @param {number} now [s]
   */
  #x(time, now) {
    const share = 1 - (now - time) / this.#seconds;
    return this.#left + share * (this.#width - this.#left - MARGIN.right);
  }

  /** @param {number} value */
  #y(value) {
    return (
      HEIGHT -
      MARGIN.bottom -
      share(value, this.#panel.range) * (HEIGHT - MARGIN.top - MARGIN.bottom)
    );
  }

  /**
   * @param {number} x1
   * @param {number} y1
   * @param {number} x2
   * @param {number} y2
   */
  #rule(x1, y1, x2, y2) {
    this.#pen.beginPath();
    this.#pen.moveTo(x1, y1);
    this.#pen.lineTo(x2, y2);
    this.#pen.stroke();
  }
}

/**
 * A power of ten in few letters.
 * @param {number} value
 */
function written(value) {
  const power = Math.round(Math.log10(value));
  return Math.abs(power) < 5 ? `${value}` : `1e${power}`;
}

/**
 * How high a value lies on a logarithmic axis of this range, 0..1.
 * @param {number} value
 * @param {[low: number, high: number]} range
 */
export function share(value, [low, high]) {
  const part = Math.log10(Math.max(value, low) / low) / Math.log10(high / low);
  return Math.min(part, 1);
}

/**
 * The powers of ten in a range.
 * @param {[low: number, high: number]} range
 */
export function powers([low, high]) {
  const first = Math.ceil(Math.log10(low));
  const count = Math.floor(Math.log10(high)) - first + 1;
  return Array.from({ length: count }, (_, i) => 10 ** (first + i));
}
