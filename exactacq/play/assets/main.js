/** The page: its parts, and what buttons and keys do. */

import { board as makeBoard } from "./board.js";
import { camera as makeCamera } from "./camera.js";
import { files as makeFiles } from "./files.js";
import { flaws as makeFlaws } from "./flaws.js";
import { grid as makeGrid } from "./grid.js";
import { inspector as makeInspector } from "./inspector.js";
import { EMPTY } from "./model.js";
import { $, set } from "./player/dom.js";
import { runs as makeRuns } from "./runs.js";
import { ask } from "./server.js";
import { settings as makeSettings } from "./settings.js";
import { extentOfAll } from "./shapes.js";
import { store as makeStore } from "./store.js";
import { HINTS, tools as makeTools } from "./tools.js";

const RERUN = 350; // milliseconds after a setting has changed while a run is watched

const store = makeStore();
const { state } = store;
const camera = makeCamera($("show"), () => extentOfAll(state.drawing));
const grid = makeGrid(camera);
const board = makeBoard(store, camera, grid);
const tools = makeTools(store, camera, grid, board);
const flaws = makeFlaws(store, camera);
const runs = makeRuns(store, camera, trouble);
const files = makeFiles(store, { opened, trouble, runs });
const showSettings = makeSettings(store, grid);
const showInspector = makeInspector(store);

/** Says what went wrong, until something else is done. */
function trouble(text) {
  $("trouble-text").textContent = text;
  $("trouble").hidden = !text;
}

/** Shows a drawing that was opened. */
function opened(drawing) {
  runs.edit();
  trouble("");
  store.open(drawing);
  camera.fit();
}

const actions = {
  run: () => (state.flaws.length && state.checked ? trouble("First mend what is told beside the drawing.") : runs.run()),
  stop: () => runs.stop(),
  edit: () => runs.edit(),
  watch: () => runs.watch(),
  undo: store.undo,
  redo: store.redo,
  fit: camera.fit,
  larger: camera.larger,
  smaller: camera.smaller,
  open: files.open,
  saveScene: () => files.save("scene"),
  fresh: () => opened({ ...EMPTY }),
  snap: () => {
    grid.settings.isOn = !grid.settings.isOn;
    refresh();
  },
  follow: () => {
    const on = $("follow").getAttribute("aria-pressed") !== "true";
    set($("follow"), { "aria-pressed": on });
    runs.follow(on);
  },
  help: () => $("help-dialog").showModal(),
  mode: () => (state.mode === "draw" ? actions.run() : runs.edit()),
};

for (const button of document.querySelectorAll("[data-action]")) {
  button.addEventListener("click", () => actions[button.dataset.action]());
}
for (const button of document.querySelectorAll("[data-tool]")) {
  button.addEventListener("click", () => tools.choose(button.dataset.tool));
}
for (const button of document.querySelectorAll("[data-example]")) {
  button.addEventListener("click", () => files.openGallery(button.dataset.example));
}
for (const button of document.querySelectorAll("[data-watch]")) {
  button.addEventListener("click", async () => {
    await files.openGallery(button.dataset.watch);
    if (state.drawing.shapes.length) await runs.run();
  });
}
for (const button of document.querySelectorAll("dialog [data-close]")) {
  button.addEventListener("click", () => button.closest("dialog").close());
}
for (const kind of ["pointerover", "focusin"]) {
  $("shapes-list").addEventListener(kind, ({ target }) => board.pointAt(target.dataset.pick ?? null));
}
for (const kind of ["pointerout", "focusout"]) $("shapes-list").addEventListener(kind, () => board.pointAt(null));
$("name").addEventListener("change", ({ target }) => store.edit({ ...state.drawing, name: target.value.trim() }));
$("grid-step").addEventListener("change", ({ target }) => {
  grid.settings.chosen = target.value;
  refresh();
});

// -- keys ----------------------------------------------------------------------------------------

const TOOL_KEYS = { v: "select", p: "polygon", r: "rectangle", c: "circle", s: "start", t: "terrain" };
const KEYS = { "?": "help", g: "snap", f: "fit", "+": "larger", "=": "larger", "-": "smaller", e: "edit" };
const COMMANDS = { Enter: "run", z: "undo", y: "redo", Z: "redo", o: "open", s: "saveScene" };

document.addEventListener("keydown", (event) => {
  if (document.querySelector("dialog[open]")) return;
  const isTyping = event.target.closest("input:not([type=range]):not([type=checkbox]), select, textarea");
  const command = (event.ctrlKey || event.metaKey) && !event.altKey && COMMANDS[event.key];
  if (command && !(isTyping && ["undo", "redo"].includes(command))) {
    event.preventDefault();
    if (isTyping) event.target.blur(); // What is typed is taken.
    if (!(state.mode === "watch" && ["undo", "redo"].includes(command))) actions[command]();
    return;
  }
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === "Escape") {
    if ($("save").open) $("save").open = false;
    else if (isTyping) event.target.blur();
    else if (runs.isBusy()) runs.stop();
    else if (state.mode === "watch") runs.edit();
    else tools.escape();
    return;
  }
  if (isTyping) return;
  const action = KEYS[event.key];
  if (action) actions[action]();
  else if (state.mode === "draw" && TOOL_KEYS[event.key]) tools.choose(TOOL_KEYS[event.key]);
  else return;
  event.preventDefault();
});

window.addEventListener("beforeunload", (event) => {
  if (store.isUnsaved()) event.preventDefault();
});

// -- showing -------------------------------------------------------------------------------------

let [seen, timer] = [null, null];

function refresh() {
  board.draw();
  flaws.list();
  flaws.callOut();
  showSettings();
  showInspector();
  const { tool, mode, drawing } = state;
  for (const button of document.querySelectorAll("[data-tool]")) set(button, { "aria-pressed": button.dataset.tool === tool });
  $("hint").textContent = HINTS[tool];
  $("board").dataset.tool = tool;
  set($("snap"), { "aria-pressed": grid.settings.isOn });
  $("undo").disabled = !state.past.length || mode === "watch";
  $("redo").disabled = !state.future.length || mode === "watch";
  if (document.activeElement !== $("name")) $("name").value = drawing.name;
  // It goes when anything is done, and comes back with a new drawing.
  $("welcome").hidden = drawing !== state.saved || drawing.shapes.length > 0 || tool !== "select" || mode !== "draw";
  $("mode-word").textContent = mode === "draw" ? "Run" : "Edit";
  $("watch").hidden = mode === "watch" || !runs.isOf(drawing);
  const hasRun = runs.isOf(drawing);
  for (const button of $("save").querySelectorAll("[data-save]:not([data-save=scene])")) button.disabled = !hasRun;
  document.title = `${store.isUnsaved() ? "* " : ""}${drawing.name || "Untitled scene"} - exactacq play`;
}

/** A setting that changes while a run is watched makes the run anew. */
function rerun() {
  if (state.drawing === seen) return;
  seen = state.drawing;
  clearTimeout(timer);
  if (state.mode === "watch" && !runs.isOf(state.drawing)) timer = setTimeout(runs.run, RERUN);
}

store.listen(() => {
  refresh();
  flaws.ask();
  rerun();
});
camera.listen(() => {
  board.draw();
  flaws.callOut();
  runs.look();
});

const first = await ask("api/first");
if (first) {
  files.show(first, "");
  if (first.trouble) trouble(first.trouble);
  store.forget();
} else camera.fit();
refresh();
flaws.ask();
document.body.dataset.ready = true;
