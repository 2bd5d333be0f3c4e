/** What the page is at: the drawing with its past and future, what is selected, the tool, the mode. */

import { EMPTY } from "./model.js";

const PAST = 300; // edits that can be undone

/** State that tells whoever wants to know that it has changed, once for all changes of a turn. */
export function store() {
  const listeners = [];
  const state = {
    drawing: EMPTY, past: [], future: [], selected: null, vertex: null, tool: "select", mode: "draw",
    flaws: [], checked: false, saved: EMPTY,
  };
  let waiting = false;
  let merging = null;

  function tell() {
    if (waiting) return;
    waiting = true;
    queueMicrotask(() => {
      waiting = false;
      for (const listener of listeners) listener(state);
    });
  }

  /** Changes what can not be undone. */
  function put(change) {
    if ("drawing" in change) throw new Error("drawings change by edits");
    Object.assign(state, change);
    tell();
  }

  /** Changes the drawing; edits of one gesture, which have the same name, are undone together. */
  function edit(drawing, { gesture = null, ...rest } = {}) {
    if (drawing !== state.drawing) {
      if (gesture === null || gesture !== merging) state.past = [...state.past, state.drawing].slice(-PAST);
      merging = gesture;
      state.future = [];
      state.checked = false;
    }
    Object.assign(state, { drawing, ...rest });
    tell();
  }

  /** Shows another drawing, of which there is nothing to be saved. */
  function open(drawing) {
    edit(drawing, { selected: null, vertex: null, tool: "select", saved: drawing });
  }

  function back(from, to) {
    if (!state[from].length) return;
    const drawing = state[from].at(-1);
    state[from] = state[from].slice(0, -1);
    state[to] = [...state[to], state.drawing];
    merging = null;
    const selected = drawing.shapes.some(({ id }) => id === state.selected) ? state.selected : null;
    Object.assign(state, { drawing, selected, vertex: null, checked: false });
    tell();
  }

  return {
    state, put, edit, open,
    /** Whether something was drawn or edited since the drawing was saved or opened. */
    isUnsaved: () => state.drawing !== state.saved && state.drawing.shapes.length > 0,
    undo: () => back("past", "future"),
    forget: () => (state.past = []),
    redo: () => back("future", "past"),
    listen: (listener) => listeners.push(listener),
  };
}
