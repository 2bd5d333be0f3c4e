/** Plays a run: moves the robot along its path, by the clock, the slider, the keys or the list of events. */

import { chart } from "./chart.js";
import { $, add, clamp, last, set } from "./dom.js";
import { journey } from "./journey.js";
import { labelling } from "./labels.js";
import { wording } from "./words.js";

const TICKS = 60; // most marks on the slider
const PAUSE = 900; // milliseconds at an event where motion is not wanted
const STILL = matchMedia("(prefers-reduced-motion: reduce)");
const KEYS = { " ": "play", ArrowLeft: "previous", ArrowRight: "next", Home: "first", End: "last" };

/**
 * Shows a run's data on the page and makes it playable, until `end` is called.
 *
 * The page has the elements of the stage, the controls, the list of events and the legend. The whole drawing is
 * in the window at first; `look` chooses another part of it. `moved` is told the robot's place.
 */
export function player(data, { colours = data.colours, away = data.away, moved = () => {} } = {}) {
  const { frames } = data;
  const [width, height] = data.box;
  const ending = new AbortController();
  const listen = (target, kind, act) => target.addEventListener(kind, act, { signal: ending.signal });

  /** A length in the scene's unit. */
  const number = (length) => String(Number((length / data.scale).toPrecision(5)));
  const show = chart(data, number);
  const path = journey(data, colours, away);
  const labels = labelling(data, path.total);
  const words = wording(data, number, (frame) => {
    pause();
    go(frame);
  });

  let at = 0; // path length
  let now = -1; // the last frame passed
  let playing = false;

  /** Moves the robot. Frames closer together than the page's digits are told apart by their number. */
  function move(length, frame = last(frames, (entry) => entry.at, length)) {
    const changed = frame !== now;
    at = length;
    now = frame;
    if (changed) show(frame);
    const place = path.walk(at);
    labels.name(at);
    const [cx, cy] = at === frames[now].at ? frames[now].place : place;
    set($("robot"), { cx, cy });
    words.tell(at, now);
    document.body.dataset.frame = now;
    moved(cx, cy);
  }

  const go = (frame) => move(frames[frame].at, frame);

  /** Goes to the next (or previous) frame with an event; the previous one of a robot in between is the last. */
  function step(forward) {
    const found = forward
      ? words.eventful.find((frame) => frame > now)
      : words.eventful.findLast((frame) => frame < now || (frame === now && at > frames[now].at));
    if (found !== undefined) go(found);
  }

  const seconds = clamp(6 + 0.4 * frames.filter((frame) => !frame.passing).length, 10, 60); // of the whole run at speed 1

  function play() {
    if (!path.total) return;
    if (at >= path.total) go(0);
    playing = true;
    label();
    let [before, waited] = [null, 0];
    requestAnimationFrame(function tick(time) {
      if (!playing) return;
      // A window that was out of sight does not jump ahead.
      const elapsed = Math.min(time - (before ?? time), 100) * $("speed").value;
      before = time;
      waited += elapsed;
      if (!STILL.matches) move(Math.min(at + (elapsed * path.total) / (1000 * seconds), path.total));
      else if (waited >= PAUSE) {
        waited = 0;
        step(true);
      }
      if (at >= path.total) pause();
      else requestAnimationFrame(tick);
    });
  }

  function pause() {
    playing = false;
    label();
  }

  function label() {
    $("verb").textContent = playing ? "Pause" : "Play";
    set($("icon"), { d: playing ? "M3 2h4v12H3zM9 2h4v12H9z" : "M3 2v12l11-6z" });
    document.body.dataset.playing = playing;
  }

  const actions = {
    play: () => (playing ? pause() : play()),
    previous: () => (pause(), step(false)),
    next: () => (pause(), step(true)),
    first: () => (pause(), go(0)),
    last: () => (pause(), go(frames.length - 1)),
  };
  for (const name of ["play", "previous", "next"]) listen($(name), "click", actions[name]);
  listen($("slider"), "input", (event) => {
    pause();
    move(Number(event.target.value));
  });
  listen(document, "click", (event) => {
    // After a click with a mouse (not by keyboard) the space bar plays again, instead of clicking once more.
    if (event.detail) event.target.closest("button")?.blur();
  });
  listen(document, "keydown", (event) => {
    const action = KEYS[event.key];
    const taken = event.target.closest("select, dialog, input:not([type=range])") || (event.key === " " && event.target.closest("button"));
    if (!action || taken || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    actions[action]();
  });

  let shown = [0, 0, width, height];

  /** Shows a part of the drawing: left, top, width and height in page units. */
  function look(...box) {
    shown = box;
    set($("stage"), { viewBox: box.join(" ") });
    arrange();
  }

  function arrange() {
    const stage = $("stage").getBoundingClientRect();
    if (!stage.width || !stage.height) return; // It is not shown, as when the page is left.
    const px = Math.max(shown[2] / stage.width, shown[3] / stage.height) || 1;
    labels.arrange(px, Math.max(stage.width * px - width, 0) / 2);
    labels.name(at);
  }

  function end() {
    pause();
    ending.abort();
    resizing.disconnect();
  }

  const resizing = new ResizeObserver(arrange);
  resizing.observe($("stage"));
  look(...shown);
  set($("slider"), { max: path.total || 1 });
  $("ticks").replaceChildren();
  if (words.eventful.length <= TICKS) {
    for (const frame of words.eventful) add($("ticks"), "option", { value: frames[frame].at });
  }
  $("slider").disabled = $("play").disabled = !path.total;
  label();
  go(0);
  return { facts: words.facts, look, move, play, pause, end, place: () => at };
}
