/** The legend of a page, for one run or for several on one scene. */

import { $, add } from "./dom.js";

/** Says what is drawn, and where the maps of some runs are exact; `colours` are those of the scale of lengths. */
export function legend(runs, colours) {
  $("radius").textContent = runs[0].radius;
  $("exact").textContent = runs.map(({ frames }) => frames.length).join(", ");
  const left = runs.filter((data) => data.left_out).map(({ left_out: [shown, all] }) => `${shown} of ${all}`);
  $("note").textContent = left.length ? `Only ${left.join(", ")} events and corners are shown, to keep this page small.` : "";
  $("order").hidden = !runs.some((data) => data.visits.length && ["all", "numbers"].includes(data.labels));
  for (const entry of document.querySelectorAll(".swept")) entry.hidden = !runs.some((data) => data.mline);
  $("scale").replaceChildren();
  colours.filter((_, k) => k % 8 === 4).forEach((stroke, k) => {
    add($("scale"), "path", { class: "walked", d: `M${3 + 2.75 * k} 7h2.75`, stroke });
  });
}
