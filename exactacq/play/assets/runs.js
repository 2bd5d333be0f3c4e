/** Runs: begun, watched while they are made, stopped, shown and saved. */

import { $, add, counted } from "./player/dom.js";
import { player } from "./player/player.js";
import { toRequest } from "./model.js";
import { ask, receive, send, Trouble } from "./server.js";

const POLL = 150; // milliseconds between two looks at how far a run is
const NIGHT = matchMedia("(prefers-color-scheme: dark)");
const CALM = matchMedia("(prefers-reduced-motion: reduce)");

export function runs(store, camera, trouble) {
  const { state, put } = store;
  let [playing, shown, number, follows] = [null, null, 0, false];
  const scales = ask("scales.json");

  /** Explores the drawing; a run that is at work is given up for it. */
  async function run() {
    const { drawing } = state;
    trouble("");
    progress([]);
    document.body.dataset.busy = "run";
    let own = 0;
    try {
      ({ number: own } = await send("api/run", toRequest(drawing)));
      number = own;
      await follow(own, drawing);
    } catch (error) {
      if (own !== number || error.told?.stopped) return;
      trouble(error.message);
      if (!shown) edit();
    } finally {
      if (own === number) delete document.body.dataset.busy;
    }
  }

  /** Looks how far a run is until it is whole; shows what there is of it. */
  async function follow(own, drawing) {
    for (let parts = 0; ; ) {
      const told = await ask("api/run", { number: own });
      if (own !== number) return;
      progress(told.progress);
      if (told.parts > parts) {
        parts = told.parts;
        const data = await ask("api/data", { number: own });
        if (own !== number) return;
        await show(data, drawing, shown?.number === own);
        shown.number = own;
      }
      if (told.state === "finished") return;
      if (told.state !== "running") throw new Trouble(told);
      await new Promise((done) => setTimeout(done, POLL));
    }
  }

  function progress([what = "starting", done = 0, count = 0]) {
    $("doing").textContent = count ? `${what} … ${Math.floor((100 * done) / count)} %` : `${what} …`;
    $("gauge").max = count || 1;
    if (count) $("gauge").value = done;
    else $("gauge").removeAttribute("value");
  }

  async function stop() {
    await send("api/stop");
    if (!shown) edit();
  }

  /** Shows a run; one that is shown better than before goes on where it was. */
  async function show(data, drawing, again) {
    const colours = (await scales)[NIGHT.matches ? "dark" : "light"];
    const [at, wasPlaying] = again && playing ? [playing.place(), document.body.dataset.playing === "true"] : [0, !again];
    playing?.end();
    shown = { data, drawing, number };
    put({ mode: "watch", selected: null, vertex: null });
    document.body.dataset.mode = "watch";
    const away = getComputedStyle(document.body).getPropertyValue("--away");
    playing = player(data.run, { colours, away, moved });
    look();
    playing.move(Math.min(at, data.run.path.at(-1)?.[0] ?? 0));
    tell(data);
    if (wasPlaying && !CALM.matches) playing.play();
  }

  /** The player's window is that of the board: in page units, from the drawing's upper left corner. */
  function look() {
    if (!playing || state.mode !== "watch") return;
    const { run } = shown.data;
    const [left, top] = camera.toPlane([0, 0]);
    const { width, height, scale } = camera.view;
    const [x, y] = [(left - run.corner[0]) * run.scale, (run.corner[1] - top) * run.scale];
    playing.look(x, y, (width / scale) * run.scale, (height / scale) * run.scale);
  }

  /** The window goes with the robot, if that is wanted. */
  function moved(x, y) {
    if (!follows || !shown) return;
    const { corner, scale } = shown.data.run;
    queueMicrotask(() => camera.center(corner[0] + x / scale, corner[1] - y / scale));
  }

  /** The run as a whole, in words and numbers. */
  function tell({ run, report, whole }) {
    const [exact, decimal = ""] = report.length;
    $("outcome-title").textContent = report.title;
    $("whole").textContent = exact;
    $("decimal").textContent = decimal;
    const [word, some, all] = report.done;
    $("summary").textContent = `${some} of ${counted(all, "obstacle")} ${word}, ${counted(run.happened, "event")}`;
    $("missed").replaceChildren();
    for (const [what, names] of Object.entries(report.missed)) add($("missed"), "p", {}, `${what}: ${names.join(", ")}`);
    if (report.trouble) add($("missed"), "p", { class: "bad" }, report.trouble);
    $("bounds").replaceChildren();
    for (const bound of report.bounds) {
      const row = add($("bounds"), "tr", { title: bound.source, class: bound.applies ? "" : "idle" });
      add(row, "th", { scope: "row" }, bound.name);
      add(row, "td", { class: "number" }, bound.closed ? `${bound.closed} ≈ ${bound.value}` : `≈ ${bound.value}`);
      const verdict = !bound.applies ? "does not apply" : bound.holds ? `holds, ${bound.ratio}` : `fails, ${bound.ratio}`;
      add(row, "td", { class: bound.applies && !bound.holds ? "bad" : "" }, verdict);
    }
    const applied = report.bounds.filter((bound) => bound.applies);
    const holding = applied.filter((bound) => bound.holds).length;
    $("verdicts").textContent = applied.length ? `: ${holding} of ${applied.length} hold` : "";
    $("bounds-part").hidden = !report.bounds.length;
    // Those of the paper have none of a run that was given up, or without obstacles.
    $("boundless").hidden = report.bounds.length > 0 || !report.is_own;
    document.body.dataset.whole = whole;
  }

  /** Back to the drawing board. */
  function edit() {
    playing?.end();
    playing = null;
    put({ mode: "draw" });
    document.body.dataset.mode = "draw";
  }

  /** Back to the run, if there is one of this drawing; a run of another one is made anew. */
  async function watch() {
    if (shown?.drawing === state.drawing) await show(shown.data, shown.drawing, false);
    else await run();
  }

  /** Files of the run that is shown: its figure, perhaps of this moment, its trace, its page. */
  async function file(kind, ofMoment) {
    const at = ofMoment && playing ? String(Number((playing.place() / shown.data.run.scale).toPrecision(12))) : "";
    return receive("api/save", null, { kind, at });
  }

  NIGHT.addEventListener("change", () => playing && show(shown.data, shown.drawing, true));
  return {
    run, stop, edit, watch, look, file,
    isOf: (drawing) => shown?.drawing === drawing,
    isBusy: () => document.body.dataset.busy === "run",
    pause: () => playing?.pause(),
    follow: (value) => (follows = value),
  };
}
