/** Plays a run: moves the robot along its path, by the clock, the slider, the keys or the list of events. */

import { clock } from "./clock.js";
import { $, add, clamp } from "./dom.js";
import { legend } from "./legend.js";
import { staging } from "./stage.js";
import { wording } from "./words.js";

const TICKS = 60; // most marks on the slider

/** Seconds that a run takes at speed 1. */
export const seconds = ({ frames }) => clamp(6 + 0.4 * frames.filter((frame) => !frame.passing).length, 10, 60);

/** What tells a run's lengths in the scene's unit. */
export const numbers = ({ scale }) => (length) => String(Number((length / scale).toPrecision(5)));

/**
 * Shows a run's data on the page and makes it playable, until `end` is called.
 *
 * The page has the elements of the stage, the controls, the list of events and the legend. The whole drawing is
 * in the window at first; `look` chooses another part of it. `moved` is told the robot's place.
 */
export function player(data, { colours = data.colours, away = data.away, moved = () => {} } = {}) {
  const { frames } = data;
  const number = numbers(data);
  const stage = staging($, data, number, { colours, away });
  legend([data], colours);
  const words = wording(data, number, (frame) => {
    timer.pause();
    go(frame);
  });
  let now = 0; // the last frame passed

  function move(length, frame) {
    const found = stage.move(length, frame);
    now = found.now;
    timer.set(length);
    words.tell(length, now);
    document.body.dataset.frame = now;
    moved(...found.place);
  }

  const go = (frame) => move(frames[frame].at, frame);

  /** Goes to the next (or previous) frame with an event; the previous one of a robot in between is the last. */
  function step(forward) {
    const at = timer.place();
    const found = forward
      ? words.eventful.find((frame) => frame > now)
      : words.eventful.findLast((frame) => frame < now || (frame === now && at > frames[now].at));
    if (found !== undefined) go(found);
  }

  const timer = clock({
    total: stage.total,
    seconds: seconds(data),
    move,
    first: () => go(0),
    last: () => go(frames.length - 1),
    previous: () => step(false),
    next: () => step(true),
  });

  function end() {
    timer.end();
    stage.end();
  }

  $("ticks").replaceChildren();
  if (words.eventful.length <= TICKS) {
    for (const frame of words.eventful) add($("ticks"), "option", { value: frames[frame].at });
  }
  go(0);
  const { play, pause, place } = timer;
  return { facts: words.facts, look: stage.look, move, play, pause, end, place };
}
