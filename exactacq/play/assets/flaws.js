/** What is wrong with the drawing, as the server says: in a list, and beside the shapes. */

import { $, add, clamp } from "./player/dom.js";
import { obstacles, toRequest } from "./model.js";
import { send } from "./server.js";

const PAUSE = 120; // milliseconds after an edit
const CALLED_OUT = 4; // flaws that are told on the board
const WIDTH = 236; // pixels of such a note, as in the style

/** The rule that is broken: what a text ends with. */
function ruleOf(text) {
  const rule = text.split(": ").at(-1);
  return rule[0].toUpperCase() + rule.slice(1);
}

export function flaws(store, camera) {
  const { state, put } = store;
  let [waiting, asking, asked] = [null, false, null];

  /** Asks the server about the drawing, if it is another one than before; one question at a time. */
  function ask() {
    if (state.drawing === asked || waiting !== null) return;
    waiting = setTimeout(async () => {
      waiting = null;
      if (asking) return;
      asking = true;
      const { drawing } = state;
      asked = drawing;
      try {
        found(drawing, (await send("api/check", toRequest(drawing))).flaws);
      } catch (error) {
        found(drawing, [{ text: error.message, loops: [], places: [] }]);
      }
      asking = false;
      ask();
    }, PAUSE);
  }

  function found(drawing, told) {
    if (drawing !== state.drawing) return;
    const ids = obstacles(drawing).map(({ id }) => id);
    const wall = drawing.shapes.find((shape) => shape.wall)?.id;
    put({ flaws: told.map((flaw) => ({ ...flaw, ids: flaw.loops.map((k) => (k < 0 ? wall : ids[k])) })), checked: true });
  }

  function list() {
    const { flaws: all, checked, drawing } = state;
    $("problems").replaceChildren();
    for (const flaw of all) {
      const item = add($("problems"), "li");
      const button = add(item, "button", { type: "button" }, flaw.text);
      button.disabled = !flaw.places.length && !flaw.ids.length;
      button.addEventListener("click", () => {
        if (flaw.places.length) camera.center(...flaw.places[0]);
        if (flaw.ids.length) put({ selected: flaw.ids[0], vertex: null, tool: "select" });
      });
    }
    const some = drawing.shapes.length > 0;
    const verdict = !checked ? "Looking at the drawing …" : all.length ? "" : some ? "This is a legal scene: run it." : "Nothing is drawn yet.";
    if ($("verdict").textContent !== verdict) $("verdict").textContent = verdict;
    $("verdict").dataset.ok = checked && !all.length && some;
    $("problems-title").textContent = all.length ? `${all.length} to be mended` : "Drawing";
  }

  /** Notes beside the places where rules are broken: one for each set of shapes. */
  function callOut() {
    $("callouts").replaceChildren();
    $("marks").replaceChildren();
    if (state.mode !== "draw") return;
    const told = new Set();
    const { width, height } = camera.view;
    const taken = [];
    for (const flaw of state.flaws) {
      for (const place of flaw.places) {
        const [cx, cy] = camera.toWindow(place);
        add($("marks"), "circle", { cx, cy, r: 8 });
      }
      const key = flaw.ids.join(" ");
      if (!flaw.places.length || told.has(key) || told.size >= CALLED_OUT) continue;
      const [u, v] = camera.toWindow(flaw.places[0]);
      if (u < 0 || v < 0 || u > width || v > height) continue;
      told.add(key);
      const note = add($("callouts"), "p", {}, ruleOf(flaw.text));
      const left = clamp(u + WIDTH + 30 > width ? u - WIDTH - 16 : u + 16, 6, Math.max(6, width - WIDTH - 6));
      let top = clamp(v - 14, 6, Math.max(6, height - note.offsetHeight - 6));
      for (const [low, high, side] of taken) if (Math.abs(side - left) < WIDTH && top < high && top + note.offsetHeight > low) top = high + 6;
      taken.push([top, top + note.offsetHeight, left]);
      note.style.left = `${left}px`;
      note.style.top = `${top}px`;
    }
  }

  return { ask, list, callOut };
}
