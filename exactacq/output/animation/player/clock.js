/** The clock of a page, which counts the length of paths: it runs, is set by the slider, or steps. */

import { $, set } from "./dom.js";

const PAUSE = 900; // milliseconds at an event where motion is not wanted
const STILL = matchMedia("(prefers-reduced-motion: reduce)");
const KEYS = { " ": "play", ArrowLeft: "previous", ArrowRight: "next", Home: "first", End: "last" };

/**
 * The clock of a page with the controls, until `end` is called: up to a `total` length, in so many `seconds` at speed 1.
 *
 * `move` is told the lengths that it shows; `first`, `last`, `previous` and `next` go where they say, and tell it by `set`.
 */
export function clock({ total, seconds, move, first, last, previous, next }) {
  const ending = new AbortController();
  const listen = (target, kind, act) => target.addEventListener(kind, act, { signal: ending.signal });
  let at = 0;
  let playing = false;

  function go(length) {
    at = length;
    move(length);
  }

  function play() {
    if (!total) return;
    if (at >= total) first();
    playing = true;
    label();
    let [before, waited] = [null, 0];
    requestAnimationFrame(function tick(time) {
      if (!playing) return;
      // A window that was out of sight does not jump ahead.
      const elapsed = Math.min(time - (before ?? time), 100) * $("speed").value;
      before = time;
      waited += elapsed;
      if (!STILL.matches) go(Math.min(at + (elapsed * total) / (1000 * seconds), total));
      else if (waited >= PAUSE) {
        waited = 0;
        next();
      }
      if (at >= total) pause();
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

  const stopped = (act) => () => (pause(), act());
  const actions = {
    play: () => (playing ? pause() : play()),
    previous: stopped(previous),
    next: stopped(next),
    first: stopped(first),
    last: stopped(last),
  };
  for (const name of ["play", "previous", "next"]) listen($(name), "click", actions[name]);
  listen($("slider"), "input", (event) => {
    pause();
    go(Number(event.target.value));
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

  function end() {
    pause();
    ending.abort();
  }

  set($("slider"), { max: total || 1 });
  $("slider").disabled = $("play").disabled = !total;
  label();
  return { play, pause, end, set: (length) => (at = length), place: () => at };
}
