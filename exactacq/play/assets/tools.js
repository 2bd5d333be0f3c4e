/** The tools: what clicks, drags and the keys of the board do to the drawing. */

import { $ } from "./player/dom.js";
import * as model from "./model.js";
import { add, equal, float, parse, snapped, text, ZERO } from "./rational.js";
import { bulgeOf, bulgeTo, edgesOf } from "./shapes.js";

const NEAR = 12; // pixels at which a click means the first vertex
const BULGES = ["1/8", "1/64"].map(parse); // steps of bulges that snap to the grid, and of those that do not
const WIDEST = 8; // largest bulge by a handle
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const LEAP = 5; // grid steps that an arrow key goes with shift

export const HINTS = {
  select: "Drag shapes, corners and the round handles that bend edges. Double-click an edge for a new corner.",
  polygon: "Click the corners; click the first one again to close the shape. Enter closes it too, Backspace takes a corner back.",
  rectangle: "Click two opposite corners.",
  circle: "Click the centre, then a point of the circle.",
  start: "Click where the robot starts.",
  terrain: "Click two opposite corners of the terrain that the Seed Spreader sweeps.",
};

export function tools(store, camera, grid, board) {
  const { state, edit, put } = store;
  const svg = $("board");
  let points = []; // of the shape that is being drawn
  let drag = null;
  let cursor = [ZERO, ZERO]; // of the keyboard: where the pointer was, or where the arrows led
  let isKeyed = false; // whether the arrows led there
  const fingers = new Map();

  const windowPlace = (event) => {
    const box = svg.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const planePlace = (event) => grid.snap(camera.toPlane(windowPlace(event)));
  const floats = ([x, y]) => [float(x), float(y)];
  const selected = () => model.find(state.drawing, state.selected);
  const sketch = (next = null) => board.sketch(points.length || next ? { points, next, kind: state.tool } : null);

  function choose(tool) {
    points = [];
    put({ tool });
    sketch();
  }

  // -- drawing ----------------------------------------------------------------------------------

  /** A click of a drawing tool. */
  function place(at) {
    const { tool, drawing } = state;
    if (tool === "start") {
      const strategy = drawing.strategy === "seed-spreader" ? "sightseer" : drawing.strategy;
      edit({ ...drawing, start: at, strategy }, { tool: "select" });
      return;
    }
    if (tool === "polygon" && points.length > 2 && isFirst(at)) {
      close();
      return;
    }
    if (points.length && isLast(at)) return;
    points = [...points, at];
    if (tool !== "polygon" && points.length === 2) close();
    sketch();
  }

  const isFirst = (at) => {
    const [[x, y], [u, v]] = [points[0], at].map((place) => camera.toWindow(floats(place)));
    return Math.hypot(u - x, v - y) < NEAR;
  };

  const isLast = (at) => points.at(-1).every((value, axis) => equal(value, at[axis]));

  /** The shape that is being drawn is whole. */
  function close() {
    const [made, kind] = [points, state.tool];
    points = [];
    sketch();
    if (kind === "terrain" && made.length === 2) {
      const terrain = model.terrainOf(...made);
      if (terrain) edit({ ...state.drawing, terrain }, { tool: "select" });
      return;
    }
    const shape = shapeOf(kind, made);
    if (shape) edit(model.withShape(state.drawing, shape), { selected: shape.id, vertex: null });
  }

  function shapeOf(kind, made) {
    if (kind === "polygon" && made.length > 2) {
      return model.fresh({ vertices: made.map(([x, y]) => ({ x, y, bend: null })) });
    }
    if (made.length !== 2) return null;
    if (kind === "rectangle") {
      return made[0].some((value, axis) => equal(value, made[1][axis])) ? null : model.rectangle(...made);
    }
    const [[x, y], [u, v]] = made.map(floats);
    const radius = snapped(Math.hypot(u - x, v - y), grid.fineness());
    return kind === "circle" && radius.n > 0n ? model.fresh({ center: made[0], radius }) : null;
  }

  // -- pointers ---------------------------------------------------------------------------------

  svg.addEventListener("pointerdown", (event) => {
    if (event.button > 1) return;
    svg.focus({ preventScroll: true });
    svg.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, windowPlace(event));
    if (fingers.size === 2) {
      drag = { kind: "pinch" };
      return;
    }
    const isPan = event.button === 1 || state.mode === "watch";
    if (isPan) drag = { kind: "pan", last: windowPlace(event) };
    else if (state.tool === "select") drag = grabbed(event);
    else drag = { kind: "place", first: windowPlace(event), last: windowPlace(event) };
  });

  /** What a pointer takes hold of: a handle, a shape, the start, or the plane. */
  function grabbed(event) {
    const [handle, path, start] = [".handle", "[data-shape]", "[data-start=true]"].map((kind) => event.target.closest(kind));
    const shape = selected();
    const gesture = `drag ${event.timeStamp}`;
    if (handle && shape) {
      const { vertex, edge } = handle.dataset;
      if (vertex !== undefined) put({ vertex: Number(vertex) });
      return { kind: vertex !== undefined ? "vertex" : edge !== undefined ? "bend" : "radius", k: Number(vertex ?? edge), id: shape.id, gesture };
    }
    if (start) return { kind: "start", gesture };
    if (path) {
      const id = path.dataset.shape;
      put({ selected: id, vertex: null });
      return { kind: "shape", id, from: planePlace(event), was: state.drawing, gesture };
    }
    put({ selected: null, vertex: null });
    return { kind: "pan", last: windowPlace(event) };
  }

  svg.addEventListener("pointermove", (event) => {
    const at = planePlace(event);
    $("where").textContent = `${text(at[0])}, ${text(at[1])}`;
    [cursor, isKeyed] = [at, false];
    const before = fingers.get(event.pointerId);
    if (before) fingers.set(event.pointerId, windowPlace(event));
    if (drag?.kind === "pinch") pinch(event.pointerId, before);
    else if (drag) dragged(event, at);
    else if (state.mode === "draw" && state.tool !== "select") sketch(at);
  });

  function pinch(id, before) {
    const other = [...fingers].find(([key]) => key !== id)?.[1];
    if (!before || !other) return;
    const now = fingers.get(id);
    const size = (place) => Math.hypot(place[0] - other[0], place[1] - other[1]) || 1;
    camera.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
    camera.zoom(size(now) / size(before), [(now[0] + other[0]) / 2, (now[1] + other[1]) / 2]);
  }

  function dragged(event, at) {
    const { drawing } = state;
    const { kind, id, k, gesture } = drag;
    const shape = id && model.find(drawing, id);
    if (kind === "pan") {
      const now = windowPlace(event);
      camera.pan(now[0] - drag.last[0], now[1] - drag.last[1]);
      drag.last = now;
    } else if (kind === "place") {
      drag.last = windowPlace(event);
      sketch(at);
    } else if (kind === "start") {
      edit({ ...drawing, start: at }, { gesture });
    } else if (kind === "shape") {
      const by = at.map((value, axis) => add(value, { n: -drag.from[axis].n, d: drag.from[axis].d }));
      const was = model.find(drag.was, id);
      if (by.some(({ n }) => n) || drawing !== drag.was) edit(model.changed(drawing, id, () => model.movedBy(was, by)), { gesture });
    } else if (kind === "vertex") {
      edit(model.changed(drawing, id, () => model.withVertex(shape, k, at, bulgeOf)), { gesture });
    } else if (kind === "radius") {
      const [[x, y], [u, v]] = [floats(shape.center), floats(at)];
      const radius = snapped(Math.hypot(u - x, v - y), grid.fineness());
      if (radius.n > 0n) edit(model.changed(drawing, id, () => ({ radius })), { gesture });
    } else if (kind === "bend") {
      const to = bulgeTo(edgesOf(shape)[k], camera.toPlane(windowPlace(event)));
      const bulge = snapped(Math.min(Math.max(to, -WIDEST), WIDEST), BULGES[grid.settings.isOn ? 0 : 1]);
      edit(model.changed(drawing, id, () => model.withBend(shape, k, bulge.n ? { bulge } : null)), { gesture });
    }
  }

  function released(event) {
    fingers.delete(event.pointerId);
    const [was, end] = [drag, windowPlace(event)];
    drag = null;
    if (was?.kind !== "place" || event.type === "pointercancel") return;
    // A drag draws too: from where it began to where it ends.
    const isDrag = Math.hypot(end[0] - was.first[0], end[1] - was.first[1]) > NEAR;
    const two = ["rectangle", "circle", "terrain"].includes(state.tool);
    if (isDrag && two && !points.length) place(grid.snap(camera.toPlane(was.first)));
    place(planePlace(event));
  }
  svg.addEventListener("pointerup", released);
  svg.addEventListener("pointercancel", released);
  svg.addEventListener("pointerleave", () => !drag && sketch());
  $("shapes").addEventListener("pointerover", ({ target }) => board.pointAt(target.dataset.shape));
  $("shapes").addEventListener("pointerout", () => board.pointAt(null));
  svg.addEventListener("dblclick", (event) => {
    const handle = event.target.closest("[data-edge]");
    if (state.mode === "draw" && state.tool === "polygon") close();
    else if (handle && selected()) divide(Number(handle.dataset.edge));
  });
  $("show").addEventListener("wheel", (event) => {
    if (event.target.closest("#callouts, #welcome")) return;
    event.preventDefault();
    const lines = event.deltaMode ? 16 : 1;
    camera.zoom(Math.exp((-event.deltaY * lines) / 500), windowPlace(event));
  }, { passive: false });

  // -- keys -------------------------------------------------------------------------------------

  function divide(k) {
    edit(model.changed(state.drawing, state.selected, (shape) => model.divided(shape, k)), { vertex: k + 1 });
  }

  /** Takes away the chosen vertex, or else the selected shape. */
  function remove() {
    const shape = selected();
    if (!shape) return;
    const less = state.vertex === null ? null : model.withoutVertex(shape, state.vertex);
    if (less) edit(model.changed(state.drawing, shape.id, () => less), { vertex: null });
    else edit(model.without(state.drawing, shape.id), { selected: null, vertex: null });
  }

  function shiftSelected(by) {
    const shape = selected();
    const { vertex } = state;
    const change = vertex === null || shape.center
      ? () => model.movedBy(shape, by)
      : () => model.withVertex(shape, vertex, [add(shape.vertices[vertex].x, by[0]), add(shape.vertices[vertex].y, by[1])], bulgeOf);
    edit(model.changed(state.drawing, shape.id, change), { gesture: `arrows ${shape.id} ${vertex}` });
  }

  function cycle(forward) {
    const { shapes } = state.drawing;
    const now = shapes.findIndex(({ id }) => id === state.selected);
    const next = shapes.at(forward ? (now + 1) % (shapes.length || 1) : Math.max(now, 0) - 1);
    if (next) put({ selected: next.id, vertex: null });
  }

  function cycleVertex() {
    const count = selected()?.vertices?.length;
    if (count) put({ vertex: state.vertex === null ? 0 : (state.vertex + 1) % count });
  }

  const keys = {
    Enter: () => (state.tool === "select" ? cycle(true) : place(cursor)),
    " ": () => (state.tool === "select" ? cycleVertex() : place(cursor)),
    "]": () => cycle(true),
    "[": () => cycle(false),
    n: cycleVertex,
    i: () => selected()?.vertices && divide(state.vertex ?? 0),
    Backspace: () => {
      if (points.length) points = points.slice(0, -1);
      else remove();
      sketch();
    },
    Delete: remove,
  };

  svg.addEventListener("keydown", (event) => {
    if (state.mode !== "draw" || event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = ARROWS[event.key];
    if (arrow) {
      const step = grid.step();
      const by = arrow.map((sign) => ({ n: step.n * BigInt(sign * (event.shiftKey ? LEAP : 1)), d: step.d }));
      if (state.tool === "select" && selected()) shiftSelected(by);
      else moveCursor([add(cursor[0], by[0]), add(cursor[1], by[1])]);
    } else if (event.key === "Enter" && state.tool === "polygon" && points.length > 2 && (!isKeyed || isLast(cursor))) {
      close();
    } else if (keys[event.key]) {
      keys[event.key]();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  });

  function moveCursor(to) {
    [cursor, isKeyed] = [to, true];
    $("where").textContent = `${text(to[0])}, ${text(to[1])}`;
    const [u, v] = camera.toWindow(floats(to));
    const { width, height } = camera.view;
    if (u < 0 || v < 0 || u > width || v > height) camera.center(...floats(to));
    board.point(to);
    sketch(state.tool === "select" ? null : to);
  }

  svg.addEventListener("blur", () => board.point(null));

  /** Ends what is begun: the shape that is being drawn, then the tool, then the selection. */
  function escape() {
    if (points.length) {
      points = [];
      sketch();
    } else if (state.tool !== "select") choose("select");
    else put({ selected: null, vertex: null });
  }

  return { choose, escape, remove, finish: close };
}
