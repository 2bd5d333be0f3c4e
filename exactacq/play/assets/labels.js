/** Which obstacles have labels: those that are large enough on the screen, so that no label covers another one. */

import { labelOf } from "./model.js";
import { extentOf, heartOf } from "./shapes.js";

const FONT = "650 13px system-ui, sans-serif"; // about that of the style
const HIGH = 15; // pixels of a label
const ABOVE = 10; // pixels from an obstacle to the middle of a label above it
const SMALLEST = 8; // pixels of an obstacle that has a label

const pen = document.createElement("canvas").getContext("2d");
const [widths, places] = [new Map(), new WeakMap()];

/** What is made of a key, but only once. */
function once(known, key, make) {
  if (!known.has(key)) known.set(key, make());
  return known.get(key);
}

function widthOf(text) {
  pen.font = FONT;
  return once(widths, text, () => pen.measureText(text).width);
}

const apart = (a, b) => a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];

/** What labels need to know of a shape, in the plane. */
const about = (shape) => once(places, shape, () => ({ ...heartOf(shape), extent: extentOf(shape) }));

/**
 * The labels of a drawing as {at, label}, `at` in the window: in their obstacles, or above those that are narrower.
 * Larger obstacles come first, those of `preferred` ids before all others; `wanted` ones have their labels in any
 * case. No label covers another one or the `taken` boxes, and none above its obstacle covers another obstacle.
 */
export function labelsOf(drawing, camera, { wanted, preferred, taken }) {
  const { width, height, scale } = camera.view;
  const rank = new Map([...preferred.map((id) => [id, 1]), ...wanted.map((id) => [id, 2])]);
  const obstacles = [];
  for (const shape of drawing.shapes) {
    if (shape.wall) continue;
    const { middle, wide, extent: [left, bottom, right, top] } = about(shape);
    const box = [...camera.toWindow([left, top]), ...camera.toWindow([right, bottom])];
    if (box[2] < 0 || box[3] < 0 || box[0] > width || box[1] > height) continue;
    const size = [box[2] - box[0], box[3] - box[1]];
    obstacles.push({ shape, box, size, at: camera.toWindow(middle), wide: wide * scale, order: rank.get(shape.id) ?? 0 });
  }
  obstacles.sort((a, b) => b.order - a.order || b.size[0] * b.size[1] - a.size[0] * a.size[1]);
  const [found, boxes] = [[], [...taken]];
  for (const { shape, box, size, at, wide, order } of obstacles) {
    if (order < 2 && Math.min(...size) < SMALLEST) continue;
    const label = labelOf(drawing, shape);
    const half = widthOf(label) / 2 + 2;
    const isInside = 2 * half <= wide && HIGH <= size[1];
    const [x, y] = isInside ? at : [(box[0] + box[2]) / 2, box[1] - ABOVE];
    const own = [x - half, y - HIGH / 2, x + half, y + HIGH / 2];
    const isFree = boxes.every((other) => apart(own, other)) && (isInside || obstacles.every((other) => apart(own, other.box)));
    if (order < 2 && !isFree) continue;
    boxes.push(own);
    found.push({ at: [x, y], label });
  }
  return found;
}
