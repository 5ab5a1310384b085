// A wire globe, as SVG.

import { svg } from "./dom.js";

export const RADIUS = 54; // [pixels]
const RADIAN = Math.PI / 180;

/**
 * Where a point of the unit sphere is seen: x right, y down [pixels], depth toward the viewer.
 * The camera goes round: the globe turns the other way.
 * @param {number} azimuth [degrees]
 * @param {number} elevation [degrees]
 * @returns {(x: number, y: number, z: number) => number[]}
 */
export function projection(azimuth, elevation) {
  const [ca, sa] = [Math.cos(azimuth * RADIAN), Math.sin(azimuth * RADIAN)];
  const [ce, se] = [Math.cos(elevation * RADIAN), Math.sin(elevation * RADIAN)];
  return (x, y, z) => {
    const toward = x * sa + z * ca;
    return [(x * ca - z * sa) * RADIUS, (toward * se - y * ce) * RADIUS, toward * ce + y * se];
  };
}

/**
 * Draw the globe: its rim, circles, and the front, where that is seen.
 * @param {number} azimuth [degrees]
 * @param {number} elevation [degrees]
 */
export function globe(azimuth, elevation) {
  const seen = projection(azimuth, elevation);
  const look = { fill: "none", stroke: "currentColor", "stroke-opacity": 0.5 };
  const lines = circles().map((at) => svg("path", { d: path(at, seen), ...look }));
  const rim = { r: RADIUS, fill: "#56b4e9", "fill-opacity": 0.2, stroke: "currentColor" };
  return [svg("circle", rim), ...lines, ...front(...seen(0, 0, 1))];
}

/** Circles of latitude and longitude: the point [x, y, z] of each at an angle t. */
function circles() {
  const parallels = [-60, -30, 0, 30, 60].map((degrees) => {
    const b = degrees * RADIAN;
    return (/** @type {number} */ t) => [
      Math.cos(b) * Math.sin(t),
      Math.sin(b),
      Math.cos(b) * Math.cos(t),
    ];
  });
  const meridians = [0, 30, 60, 90, 120, 150].map((degrees) => {
    const b = degrees * RADIAN;
    return (/** @type {number} */ t) => [
      Math.sin(b) * Math.cos(t),
      Math.sin(t),
      Math.cos(b) * Math.cos(t),
    ];
  });
  return [...parallels, ...meridians];
}

/**
 * The part of a circle that is not behind the globe.
 * @param {(t: number) => number[]} at
 * @param {(x: number, y: number, z: number) => number[]} seen
 */
function path(at, seen) {
  let drawn = "";
  let down = false; // the pen
  for (let i = 0; i <= 48; i++) {
    const [px, py, pz] = at((i * Math.PI) / 24);
    const [x, y, depth] = seen(px, py, pz);
    if (depth >= 0) drawn += `${down ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`;
    down = depth >= 0;
  }
  return drawn;
}

/**
 * @param {number[]} seen
 * @returns {SVGElement[]}
 */
function front(...[x, y, depth]) {
  if (depth < 0) return [];
  const text = { x: x + 8, y: y + 4, "font-size": 11, fill: "currentColor" };
  return [svg("circle", { cx: x, cy: y, r: 6, fill: "#d55e00" }), svg("text", text, "front")];
}
