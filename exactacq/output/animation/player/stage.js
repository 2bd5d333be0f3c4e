/** One run on its stage: the map, the path, the labels and the robot. */

import { chart } from "./chart.js";
import { last, set } from "./dom.js";
import { journey } from "./journey.js";
import { labelling } from "./labels.js";

/**
 * Shows a run on the stage that `$` finds; `number` tells lengths, `paint` colours the path (see `journey`).
 *
 * The whole drawing is in the window at first; `look` chooses another part of it.
 */
export function staging($, data, number, paint) {
  const { frames } = data;
  const [width, height] = data.box;
  const show = chart($, data, number);
  const path = journey($, data, paint);
  const labels = labelling($, data, path.total);

  let at = 0; // path length
  let now = -1; // the last frame passed

  /**
   * Moves the robot; returns the last frame passed and the robot's place. Frames closer together than the page's
   * digits are told apart by their number.
   */
  function move(length, frame = last(frames, (entry) => entry.at, length)) {
    const changed = frame !== now;
    at = length;
    now = frame;
    if (changed) show(frame);
    const place = path.walk(at);
    labels.name(at);
    const [cx, cy] = at === frames[now].at ? frames[now].place : place;
    set($("robot"), { cx, cy });
    return { now, place: [cx, cy] };
  }

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

  const resizing = new ResizeObserver(arrange);
  resizing.observe($("stage"));
  look(...shown);
  return { total: path.total, move, look, end: () => resizing.disconnect() };
}
