/** Labels in the drawing: names of obstacles, and the order of the visits that have begun. */

import { add, clamp, set } from "./dom.js";

const LABEL = 13; // pixels of a name's height, as in the style
const CROWDED = 150; // among more obstacles, names that do not fit inside are left to tooltips

/** The labels of a run of some length; `name` says what is visited by a length, `arrange` finds them places. */
export function labelling($, data, total) {
  const { obstacles } = data;
  const [width] = data.box;
  const [named, numbered] = [["all", "names"], ["all", "numbers"]].map((some) => some.includes(data.labels));
  const visits = new Map(data.visits.map(([obstacle, begins], k) => [obstacle, { sign: `#${k + 1}`, begins }]));
  $("names").replaceChildren();
  const labels = obstacles.map(({ name, heart, above }, k) => {
    return { name: named ? name : "", visit: numbered ? visits.get(k) : undefined, heart, above, text: add($("names"), "text") };
  });
  $("start").lastElementChild.textContent = data.labels === "none" ? "" : "S";
  const sizes = obstacles.map((obstacle) => obstacle.perimeter / Math.PI).sort((a, b) => a - b);
  const medium = sizes.length ? sizes[sizes.length >> 1] : width;

  function name(length) {
    for (const { name, visit, text } of labels) {
      const words = [name, visit && visit.begins <= length ? visit.sign : ""].filter((word) => word).join(" ");
      if (text.textContent !== words) text.textContent = words;
    }
  }

  /**
   * Names at a readable size: inside their obstacle, or above it if there is no room; none over another.
   * A page unit is `1 / px` pixels wide; the window is wider than the drawing by `beside` on each side.
   */
  function arrange(px, beside) {
    $("stage").style.setProperty("--px", px);
    $("stage").style.setProperty("--bold", `${clamp((0.12 * medium) / px, 2.6, 4.5)}px`);
    const line = LABEL * px;
    const [x, y] = data.start;
    const taken = [[x - line / 2, x + line / 2, y - 1.6 * line, y]];
    name(total);
    const halves = labels.map(({ text }) => text.getComputedTextLength() / 2);
    labels.forEach(({ heart, above, text }, k) => {
      const half = halves[k];
      const inside = heart && heart[2] > 0.7 * Math.max(line, half);
      const [x, y] = inside ? [heart[0], heart[1] + 0.35 * line] : [above[0], above[1] - 0.6 * line];
      const middle = clamp(x, half - beside, width + beside - half);
      const base = Math.max(y, line);
      const [left, right, top, bottom] = [middle - half, middle + half, base - line, base];
      const free = taken.every((box) => right < box[0] || left > box[1] || bottom < box[2] || top > box[3]);
      const shown = free && 2 * half < width / 2 && (inside || labels.length <= CROWDED);
      set(text, { x: middle, y: base, visibility: shown ? "visible" : "hidden" });
      if (shown) taken.push([left, right, top, bottom]);
    });
  }

  return { name, arrange };
}
