/** Shapes in floats, to be shown: edges, arcs, extents, and where a label goes. */

import { float } from "./rational.js";

const point = ([x, y]) => [float(x), float(y)];

/** The bulge of an edge as a float. */
export function bulgeOf(vertices, k) {
  const { bend } = vertices[k];
  if (!bend) return 0;
  if (bend.bulge) return float(bend.bulge);
  const [a, b] = [vertices[k], vertices[(k + 1) % vertices.length]].map(({ x, y }) => point([x, y]));
  const [cx, cy] = point(bend.center);
  const turn = Math.atan2(b[1] - cy, b[0] - cx) - Math.atan2(a[1] - cy, a[0] - cx);
  const full = 2 * Math.PI;
  const positive = ((turn % full) + full) % full || full;
  return Math.tan((bend.clockwise ? positive - full || -full : positive) / 4);
}

/** The edges of a loop as {from, to, bulge}. */
export function edgesOf({ vertices }) {
  const places = vertices.map(({ x, y }) => point([x, y]));
  return places.map((from, k) => ({ from, to: places[(k + 1) % places.length], bulge: bulgeOf(vertices, k) }));
}

/** The place on an edge that is halfway: the top of an arc, which lies to the right where the bulge is positive. */
export function middleOf({ from, to, bulge }) {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  return [(from[0] + to[0]) / 2 + (bulge * dy) / 2, (from[1] + to[1]) / 2 - (bulge * dx) / 2];
}

/** The bulge with which an edge passes a place, as near as it can. */
export function bulgeTo({ from, to }, [x, y]) {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const [u, v] = [x - (from[0] + to[0]) / 2, y - (from[1] + to[1]) / 2];
  return (2 * (u * dy - v * dx)) / (dx * dx + dy * dy || 1);
}

/** Path data of a shape; `at` takes a place to the window, a length is `scale` times as long there. */
export function lineOf(shape, at, scale) {
  const spot = (place) => at(place).map((value) => value.toFixed(2)).join(" ");
  if (shape.center) {
    const [x, y] = point(shape.center);
    const r = Math.abs(float(shape.radius));
    const arc = `A${r * scale} ${r * scale} 0 0 0 `;
    return `M${spot([x + r, y])}${arc}${spot([x - r, y])}${arc}${spot([x + r, y])}Z`;
  }
  const edges = edgesOf(shape);
  return edges.map((edge, k) => (k ? "" : `M${spot(edge.from)}`) + onward(edge, spot, scale)).join("") + "Z";
}

function onward({ from, to, bulge }, spot, scale) {
  const chord = Math.hypot(to[0] - from[0], to[1] - from[1]);
  const radius = (scale * chord * (1 + bulge * bulge)) / (4 * Math.abs(bulge));
  if (!bulge || !(radius < 1e6)) return `L${spot(to)}`;
  return `A${radius} ${radius} 0 ${Math.abs(bulge) > 1 ? 1 : 0} ${bulge > 0 ? 0 : 1} ${spot(to)}`;
}

/** Left, bottom, right and top of a shape; arcs a little larger than they are. */
export function extentOf(shape) {
  if (shape.center) {
    const [x, y] = point(shape.center);
    const r = Math.abs(float(shape.radius));
    return [x - r, y - r, x + r, y + r];
  }
  const places = edgesOf(shape).flatMap((edge) => {
    if (!edge.bulge) return [edge.from];
    const [x, y] = middleOf(edge);
    const half = Math.hypot(edge.to[0] - edge.from[0], edge.to[1] - edge.from[1]) / 2;
    const r = Math.abs(edge.bulge) > 1 ? half * Math.abs(edge.bulge) : 0;
    return [edge.from, [x - r, y - r], [x + r, y + r]];
  });
  return around(places);
}

/** Left, bottom, right and top of places; null if there are none. */
export function around(places) {
  if (!places.length) return null;
  const [xs, ys] = [0, 1].map((axis) => places.map((place) => place[axis]));
  const least = (values) => values.reduce((a, b) => Math.min(a, b));
  const most = (values) => values.reduce((a, b) => Math.max(a, b));
  return [least(xs), least(ys), most(xs), most(ys)];
}

/** The extent of a whole drawing; null if there is nothing. */
export function extentOfAll({ shapes, start, terrain }) {
  const boxes = shapes.map(extentOf);
  const places = boxes.flatMap(([a, b, c, d]) => [[a, b], [c, d]]);
  if (start) places.push(point(start));
  if (terrain) {
    const [x, y, w, h] = [terrain.x, terrain.y, terrain.width, terrain.height].map(float);
    places.push([x, y], [x + w, y + h]);
  }
  return around(places.filter((place) => place.every(Number.isFinite)));
}

/** Places on an edge from its start on, its end aside: an arc is halved so many times. */
function cut(edge, times) {
  const { from, to, bulge } = edge;
  if (!bulge || !times) return [from];
  const [middle, half] = [middleOf(edge), bulge / (1 + Math.sqrt(1 + bulge * bulge))];
  return [...cut({ from, to: middle, bulge: half }, times - 1), ...cut({ from: middle, to, bulge: half }, times - 1)];
}

/** The widest chord along the middle of a shape, in which a label goes: [x, y] of its middle, and its width. */
export function heartOf(shape) {
  if (shape.center) return { middle: point(shape.center), wide: 2 * Math.abs(float(shape.radius)) };
  const [, low, , high] = extentOf(shape);
  const places = edgesOf(shape).flatMap((edge) => cut(edge, 3));
  const y = (low + high) / 2 + (high - low) * 1e-3;
  const crossings = [];
  places.forEach(([x0, y0], k) => {
    const [x1, y1] = places[(k + 1) % places.length];
    if (y0 > y !== y1 > y) crossings.push(x0 + ((y - y0) * (x1 - x0)) / (y1 - y0));
  });
  crossings.sort((a, b) => a - b);
  let best = [places[0][0], places[0][0]];
  for (let k = 0; k + 1 < crossings.length; k += 2) {
    if (crossings[k + 1] - crossings[k] > best[1] - best[0]) best = [crossings[k], crossings[k + 1]];
  }
  return { middle: [(best[0] + best[1]) / 2, y], wide: best[1] - best[0] };
}
