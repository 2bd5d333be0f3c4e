/** The list of shapes, and the selected one in numbers. */

import { $, add, set } from "./player/dom.js";
import { numberField } from "./fields.js";
import * as model from "./model.js";
import { text, ZERO } from "./rational.js";
import { bulgeOf } from "./shapes.js";

const [LISTED, ROWS] = [100, 60]; // shapes, and corners of one, that are listed

export function inspector(store) {
  const { state, edit, put } = store;
  let made = ""; // what the fields were made for
  let fields = [];
  const selected = () => model.find(state.drawing, state.selected);
  const change = (parts) => edit(model.changed(state.drawing, state.selected, parts));

  $("shape-name").addEventListener("change", ({ target }) => change(() => ({ name: target.value.trim() })));
  $("shape-kind").addEventListener("change", ({ target }) => edit(model.asWall(state.drawing, state.selected, target.value === "wall")));

  function listShapes() {
    const { drawing } = state;
    const focused = document.activeElement?.dataset?.pick;
    $("shapes-list").replaceChildren();
    for (const shape of drawing.shapes.slice(0, LISTED)) {
      const button = add(add($("shapes-list"), "li"), "button", { type: "button", "data-pick": shape.id }, model.labelOf(drawing, shape));
      set(button, { "aria-pressed": shape.id === state.selected });
      button.addEventListener("click", () => put({ selected: shape.id, vertex: null, tool: "select" }));
      if (shape.id === focused) button.focus();
    }
    const more = drawing.shapes.length - LISTED;
    if (more > 0) add($("shapes-list"), "li", {}, `and ${more} more`);
    $("shapes-none").hidden = drawing.shapes.length > 0;
  }

  function input(row, label, read, write, options) {
    const field = add(row, "input", { type: "text", inputmode: "decimal", "aria-label": label, autocomplete: "off", spellcheck: "false" });
    fields.push(numberField(field, read, write, options));
    return field;
  }

  function rowsOfCircle(shape) {
    const rows = $("numbers");
    add(add(rows, "div", { class: "row head" }), "span", {}, "Centre");
    const center = add(rows, "div", { class: "row" });
    for (const k of [0, 1]) {
      input(center, `Centre ${"xy"[k]}`, () => selected()?.center?.[k], (value) => change((old) => ({ center: old.center.map((own, j) => (j === k ? value : own)) })));
    }
    add(add(rows, "div", { class: "row head" }), "span", {}, "Radius");
    input(add(rows, "div", { class: "row" }), "Radius", () => selected()?.radius, (radius) => change(() => ({ radius })));
  }

  function rowsOfLoop(shape) {
    const rows = $("numbers");
    const head = add(rows, "div", { class: "row head", "aria-hidden": "true" });
    for (const word of ["x", "y", "bulge"]) add(head, "span", {}, word);
    shape.vertices.slice(0, ROWS).forEach((_, k) => {
      const row = add(rows, "div", { class: "row", "data-row": k });
      const vertex = () => selected()?.vertices?.[k];
      const to = (x, y) => change((old) => model.withVertex(old, k, [x, y], bulgeOf));
      input(row, `Corner ${k + 1}, x`, () => vertex()?.x, (x) => to(x, vertex().y));
      input(row, `Corner ${k + 1}, y`, () => vertex()?.y, (y) => to(vertex().x, y));
      const bend = input(row, `Bulge of the edge after corner ${k + 1}`, () => vertex()?.bend?.bulge ?? (vertex()?.bend ? null : ZERO), (bulge) => {
        change((old) => model.withBend(old, k, bulge?.n ? { bulge } : null));
      }, { optional: true });
      if (shape.vertices[k].bend?.center) {
        const [x, y] = shape.vertices[k].bend.center.map(text);
        set(bend, { placeholder: "arc", title: `An arc about (${x}, ${y})` });
      }
      const less = add(row, "button", { type: "button", class: "quiet", "aria-label": `Remove corner ${k + 1}`, title: "Remove this corner" }, "×");
      less.addEventListener("click", () => {
        const rest = model.withoutVertex(selected(), k);
        if (rest) edit(model.changed(state.drawing, state.selected, () => rest), { vertex: null });
      });
      row.addEventListener("focusin", () => state.vertex !== k && put({ vertex: k }));
    });
    const more = shape.vertices.length - ROWS;
    if (more > 0) add(rows, "p", { class: "soft" }, `and ${more} more corners: drag them on the board`);
  }

  function show() {
    listShapes();
    const shape = selected();
    $("shape").hidden = !shape;
    if (!shape) {
      made = "";
      return;
    }
    const wanted = `${shape.id} ${shape.vertices?.map(({ bend }) => (bend?.center ? "c" : "b")).join("") ?? "circle"}`;
    if (wanted !== made) {
      made = wanted;
      fields = [];
      $("numbers").replaceChildren();
      if (shape.center) rowsOfCircle(shape);
      else rowsOfLoop(shape);
    }
    if (document.activeElement !== $("shape-name")) $("shape-name").value = shape.name;
    $("shape-name").placeholder = model.labelOf(state.drawing, { ...shape, name: "" }) || "";
    $("shape-kind").value = shape.wall ? "wall" : "obstacle";
    for (const field of fields) field();
    for (const row of $("numbers").querySelectorAll("[data-row]")) {
      row.classList.toggle("chosen", Number(row.dataset.row) === state.vertex);
    }
  }

  $("shape-delete").addEventListener("click", () => edit(model.without(state.drawing, state.selected), { selected: null, vertex: null }));
  return show;
}
