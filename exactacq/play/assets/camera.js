/** Which part of the plane is in the window: pixels a unit, and the place in the middle. */

import { clamp } from "./player/dom.js";

const [LEAST, MOST] = [1e-90, 1e90]; // pixels a unit
const ROOM = 0.86; // share of the window that what is looked at may fill
const FOOT = 44; // pixels at its bottom where buttons lie
const USUAL = [-10, -10, 10, 10]; // what is looked at where there is nothing but a start with a range of 10
const STEP = 1.25; // of a zoom by key or button

/** The least box about two; one may be null. */
const about = (a, b) => (b ? a.map((side, k) => (k < 2 ? Math.min : Math.max)(side, b[k])) : a);

/** `extent` tells the box about everything (left, bottom, right, top), or null if there is nothing. */
export function camera(element, extent) {
  const listeners = [];
  const { width, height } = element.getBoundingClientRect();
  const view = { x: 0, y: 0, scale: 24, width: width || 1, height: height || 1 };
  let home = null; // what was put into the window as a whole, until it is moved or made larger by hand
  const tell = () => listeners.forEach((listener) => listener(view));

  const toWindow = ([x, y]) => [(x - view.x) * view.scale + view.width / 2, (view.y - y) * view.scale + view.height / 2];
  const toPlane = ([u, v]) => [(u - view.width / 2) / view.scale + view.x, (view.height / 2 - v) / view.scale + view.y];

  /** Moves the window, by pixels. */
  function pan(du, dv) {
    home = null;
    view.x -= du / view.scale;
    view.y += dv / view.scale;
    tell();
  }

  /** Makes all larger by a factor, about a place in the window. */
  function zoom(factor, fixed = [view.width / 2, view.height / 2]) {
    home = null;
    const [x, y] = toPlane(fixed);
    view.scale = clamp(view.scale * factor, LEAST, MOST);
    const [u, v] = toPlane(fixed);
    view.x += x - u;
    view.y += y - v;
    tell();
  }

  /** Puts everything into the window, and keeps it there when that gets another size. */
  function fit() {
    home = extent();
    if (!home || (home[0] === home[2] && home[1] === home[3])) home = USUAL.map((side, k) => side + (home?.[k] ?? 0));
    show(home);
  }

  function show([left, bottom, right, top]) {
    const high = Math.max(view.height - FOOT, 1);
    view.scale = clamp(ROOM / Math.max((right - left) / view.width, (top - bottom) / high), LEAST, MOST);
    [view.x, view.y] = [(left + right) / 2, (bottom + top - FOOT / view.scale) / 2];
    tell();
  }

  function center(x, y) {
    home = null;
    [view.x, view.y] = [x, y];
    tell();
  }

  new ResizeObserver(([{ contentRect }]) => {
    const [left, top] = toPlane([0, 0]);
    [view.width, view.height] = [contentRect.width || 1, contentRect.height || 1];
    if (home) {
      show(about(home, extent()));
      return;
    }
    // What is in the upper left corner stays there.
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
