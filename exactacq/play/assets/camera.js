/** Which part of the plane is in the window: pixels a unit, and the place in the middle. */

import { clamp } from "./player/dom.js";

const [LEAST, MOST] = [1e-90, 1e90]; // pixels a unit
const ROOM = 0.82; // share of the window that what is looked at may fill
const USUAL = 20; // units from bottom to top where there is nothing to be seen
const STEP = 1.25; // of a zoom by key or button

export function camera(element) {
  const listeners = [];
  const { width, height } = element.getBoundingClientRect();
  const view = { x: 0, y: 0, scale: 24, width: width || 1, height: height || 1 };
  const tell = () => listeners.forEach((listener) => listener(view));

  const toWindow = ([x, y]) => [(x - view.x) * view.scale + view.width / 2, (view.y - y) * view.scale + view.height / 2];
  const toPlane = ([u, v]) => [(u - view.width / 2) / view.scale + view.x, (view.height / 2 - v) / view.scale + view.y];

  /** Moves the window, by pixels. */
  function pan(du, dv) {
    view.x -= du / view.scale;
    view.y += dv / view.scale;
    tell();
  }

  /** Makes all larger by a factor, about a place in the window. */
  function zoom(factor, about = [view.width / 2, view.height / 2]) {
    const [x, y] = toPlane(about);
    view.scale = clamp(view.scale * factor, LEAST, MOST);
    const [u, v] = toPlane(about);
    view.x += x - u;
    view.y += y - v;
    tell();
  }

  /** Puts a box (left, bottom, right, top) into the window. */
  function fit(box) {
    const [left, bottom, right, top] = box ?? [0, 0, 0, 0];
    const size = Math.max((right - left) / view.width, (top - bottom) / view.height);
    view.scale = clamp(ROOM / (size || USUAL / view.height), LEAST, MOST);
    [view.x, view.y] = [(left + right) / 2, (bottom + top) / 2];
    tell();
  }

  function center(x, y) {
    [view.x, view.y] = [x, y];
    tell();
  }

  new ResizeObserver(([{ contentRect }]) => {
    // What is in the upper left corner stays there.
    const [left, top] = toPlane([0, 0]);
    [view.width, view.height] = [contentRect.width || 1, contentRect.height || 1];
    [view.x, view.y] = [left + view.width / 2 / view.scale, top - view.height / 2 / view.scale];
    tell();
  }).observe(element);

  return {
    view, toWindow, toPlane, pan, zoom, fit, center,
    larger: () => zoom(STEP),
    smaller: () => zoom(1 / STEP),
    listen: (listener) => listeners.push(listener),
  };
}
