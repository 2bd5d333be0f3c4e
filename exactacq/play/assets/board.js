/** The drawing board: shows the drawing, what is selected, and what is being drawn. */

import { labelsOf } from "./labels.js";
import { $, add, set } from "./player/dom.js";
import { float } from "./rational.js";
import { edgesOf, lineOf, middleOf } from "./shapes.js";
const START = [-10, -26, 10, 9]; // the box of the start's sign and letter about its place
const HANDLED = 400; // vertices beyond which a shape's edges have no handles

export function board({ state }, camera, grid) {
  const spot = ([x, y]) => camera.toWindow([x, y]);
  const place = ([x, y]) => spot([float(x), float(y)]);
  const outlines = new Map();
  let draft = null; // {points, next, kind} of a shape that is being drawn, in rationals
  let cursor = null; // of the keyboard, in rationals
  let pointed = null; // id of the shape that is pointed at

  /** The outline of each shape: the elements stay as long as their shapes do. */
  function drawShapes() {
    const { drawing, selected, flaws } = state;
    const faulty = new Set(flaws.flatMap(({ ids }) => ids));
    const present = new Set();
    for (const shape of drawing.shapes) {
      present.add(shape.id);
      const path = outlines.get(shape.id) ?? add($("shapes"), "path", { "data-shape": shape.id });
      outlines.set(shape.id, path);
      const line = lineOf(shape, spot, camera.view.scale);
      const { width, height } = camera.view;
      const beyond = shape.wall ? `M-9 -9H${width + 9}V${height + 9}H-9Z` : "";
      const looks = ["shape", shape.wall && "wall", shape.id === selected && "selected", faulty.has(shape.id) && "faulty"];
      set(path, { d: line + beyond, class: looks.filter(Boolean).join(" ") });
    }
    for (const [id, path] of outlines) {
      if (present.has(id)) continue;
      path.remove();
      outlines.delete(id);
    }
  }

  function drawLabels() {
    $("labels").replaceChildren();
    const { drawing, selected, flaws } = state;
    const wanted = [pointed, selected];
    const preferred = flaws.flatMap(({ ids }) => ids);
    const sign = beginning() && place(beginning());
    const taken = sign ? [START.map((side, k) => side + sign[k % 2])] : [];
    for (const { at, label } of labelsOf(drawing, camera, { wanted, preferred, taken })) {
      add($("labels"), "text", { x: at[0], y: at[1] + 4.5 }, label);
    }
  }

  /** Where the robot starts: null if that is not told. */
  function beginning() {
    const { start, terrain, strategy } = state.drawing;
    return strategy === "seed-spreader" && terrain ? [terrain.x, terrain.y] : start;
  }

  function drawGround() {
    const { radius, terrain, strategy } = state.drawing;
    const at = beginning();
    for (const name of ["beginning", "reach"]) set($(name), { visibility: at ? "visible" : "hidden" });
    if (at) {
      const [x, y] = place(at);
      set($("beginning"), { transform: `translate(${x} ${y})`, "data-start": strategy !== "seed-spreader" });
      set($("reach"), { cx: x, cy: y, r: radius ? Math.max(0, float(radius)) * camera.view.scale : 0 });
    }
    const [x, y] = terrain ? place([terrain.x, terrain.y]) : [0, 0];
    const [width, height] = terrain ? [terrain.width, terrain.height].map((side) => Math.max(0, float(side)) * camera.view.scale) : [0, 0];
    set($("ground"), { x, y: y - height, width, height, visibility: terrain ? "visible" : "hidden" });
  }

  /** Handles of the selected shape: its vertices, and the middles of its edges by which they bend. */
  function drawHandles() {
    $("handles").replaceChildren();
    const shape = state.drawing.shapes.find(({ id }) => id === state.selected);
    if (!shape || state.tool !== "select") return;
    if (shape.center) {
      const [x, y] = place(shape.center);
      handle(x + Math.abs(float(shape.radius)) * camera.view.scale, y, { "data-radius": "" }, "radius");
      return;
    }
    if (shape.vertices.length > HANDLED) return;
    edgesOf(shape).forEach((edge, k) => handle(...spot(middleOf(edge)), { "data-edge": k }, "bend"));
    shape.vertices.forEach(({ x, y }, k) => {
      handle(...place([x, y]), { "data-vertex": k }, k === state.vertex ? "corner chosen" : "corner");
    });
  }

  function handle(x, y, data, looks) {
    const group = add($("handles"), "g", { class: `handle ${looks}`, transform: `translate(${x} ${y})`, ...data });
    add(group, "circle", { r: 14, class: "reachable" });
    if (looks === "bend" || looks === "radius") add(group, "circle", { r: 4.5 });
    else add(group, "rect", { x: -4.5, y: -4.5, width: 9, height: 9, rx: 1.5 });
  }

  function drawDraft() {
    const { points = [], next = null, kind = "" } = draft ?? {};
    const places = [...points, ...(next ? [next] : [])].map(place);
    const corners = places.map(([x, y]) => `${x} ${y}`);
    let line = corners.length > 1 ? `M${corners.join("L")}` : "";
    if (kind === "rectangle" && places.length === 2) {
      const [[x, y], [u, v]] = places;
      line = `M${x} ${y}H${u}V${v}H${x}Z`;
    }
    if (kind === "circle" && places.length === 2) {
      const [[x, y], [u, v]] = places;
      const r = Math.hypot(u - x, v - y);
      line = `M${x + r} ${y}A${r} ${r} 0 0 0 ${x - r} ${y}A${r} ${r} 0 0 0 ${x + r} ${y}M${x} ${y}L${u} ${v}`;
    }
    set($("draft"), { d: line, class: kind });
    $("dots").replaceChildren();
    for (const [k, [cx, cy]] of places.slice(0, points.length).entries()) {
      add($("dots"), "circle", { cx, cy, r: k === 0 && kind === "polygon" ? 6 : 4, class: k ? "" : "first" });
    }
    const target = next ?? cursor;
    set($("cursor"), { visibility: target ? "visible" : "hidden" });
    if (target) set($("cursor"), { transform: `translate(${place(target).join(" ")})` });
  }

  function draw() {
    grid.draw($("thin"), $("thick"), $("axes"));
    if (state.mode !== "draw") return;
    drawGround();
    drawShapes();
    drawLabels();
    drawHandles();
    drawDraft();
  }

  return {
    draw,
    sketch(value) {
      draft = value;
      drawDraft();
    },
    point(value) {
      cursor = value;
      drawDraft();
    },
    /** A shape that is pointed at has its label, whatever else has not. */
    pointAt(id) {
      if (id === pointed) return;
      pointed = id;
      drawLabels();
    },
  };
}
