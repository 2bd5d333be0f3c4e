/** The map: what was known and seen at a frame. */

import { add, set } from "./dom.js";

/** Draws the obstacles of a run, on the stage that `$` finds; returns what shows a frame. */
export function chart($, data, number) {
  const { frames, obstacles } = data;
  for (const group of ["obstacles", "known"]) $(group).replaceChildren();
  const outlines = obstacles.map(({ name, outline }) => {
    const path = add($("obstacles"), "path", { d: outline });
    add(path, "title", {}, name);
    return path;
  });
  const strokes = obstacles.map(() => add($("known"), "path"));
  const stretches = obstacles.map((_, k) => data.known.filter(([obstacle]) => obstacle === k));
  const perimeter = obstacles.reduce((sum, obstacle) => sum + obstacle.perimeter, 0);
  drawGround($, data);

  return (frame) => {
    let length = 0;
    let acquired = 0;
    obstacles.forEach((obstacle, k) => {
      const known = stretches[k].filter(([, from, to]) => from <= frame && (to === null || frame < to));
      const whole = obstacle.acquired !== null && obstacle.acquired <= frame;
      const line = known.map((stretch) => stretch[4]).join("");
      // Long maps change in few places from frame to frame.
      if (strokes[k].getAttribute("d") !== line) set(strokes[k], { d: line, "data-stretches": known.length });
      set(outlines[k], { class: whole ? "acquired" : known.length ? "partial" : "unseen" });
      length += whole ? obstacle.perimeter : known.reduce((sum, stretch) => sum + stretch[3], 0);
      acquired += whole;
    });
    set($("view"), { d: frames[frame].view });
    $("frontier").replaceChildren();
    for (const [x, y] of frames[frame].frontier) add($("frontier"), "rect", { x, y });
    $("learnt").textContent = `${number(length)} of ${number(perimeter)}`;
    $("acquired").textContent = `${acquired} of ${obstacles.length}`;
  };
}

/** What stays the same: the start, the terrain, and of a sweep its line. */
function drawGround($, data) {
  const [x, y, width, height] = data.terrain ?? [0, 0, 0, 0];
  set($("terrain"), { x, y, width, height, visibility: data.terrain ? "visible" : "hidden" });
  set($("mline"), { d: data.mline });
  set($("beyond"), { d: data.beyond });
  for (const part of $("start").children) set(part, { x: data.start[0], y: data.start[1] });
}
