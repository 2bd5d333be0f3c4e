/** The page that plays several runs of one scene side by side, on one clock: all have gone equally far. */

import { clock } from "./player/clock.js";
import { $, add, counted, last, set } from "./player/dom.js";
import { legend } from "./player/legend.js";
import { numbers, seconds } from "./player/player.js";
import { staging } from "./player/stage.js";
import { line, planned } from "./player/words.js";

const { title, runs } = JSON.parse($("data").textContent);
const number = numbers(runs[0]);
const whole = Math.max(...runs.map(({ path }) => path.at(-1)?.[0] ?? 0));

/** The panel of a run, which stands in a tree of its own; returns what moves its robot to a length, or to its end. */
function panel(data) {
  const root = add($("runs"), "div", { class: "run" }).attachShadow({ mode: "open" });
  root.append($("panel").content.cloneNode(true), document.querySelector("style").cloneNode(true));
  const find = (id) => root.getElementById(id);
  find("name").textContent = data.strategy;
  const { events, frames, obstacles } = data;
  const stage = staging(find, data, number, { colours: data.colours, away: data.away, whole });

  return (clocked) => {
    const ended = clocked >= stage.total;
    const length = Math.min(clocked, stage.total);
    const { now } = stage.move(length, ended ? frames.length - 1 : undefined);
    const exact = frames[now].exact !== null && (ended || length === frames[now].at);
    find("length").textContent = exact ? frames[now].exact : `≈ ${number(length)}`;
    const event = events[last(events, (entry) => entry[4], now)];
    find("why").textContent = planned(data.plans, now);
    find("happened").textContent = line(event, obstacles);
    root.host.dataset.ended = ended;
    root.host.dataset.frame = now;
    return ended;
  };
}

document.title = title;
const [across, down] = runs[0].box;
document.documentElement.style.setProperty("--tall", down / across);
$("title").textContent = title;
$("facts").textContent = `All robots have gone equally far. The longest path is ${number(whole)} long.`;
legend(runs, runs[0].colours);
const panels = runs.map(panel);

/** The lengths at which something happens in any run. */
const marks = [...new Set(runs.flatMap(({ events, frames }) => events.map((event) => frames[event[4]].at)))].sort((a, b) => a - b);

/** Moves all robots. */
function move(length) {
  timer.set(length);
  const ended = panels.map((step) => step(length)).filter((is) => is).length;
  $("slider").value = length;
  set($("slider"), { "aria-valuetext": `${number(length)} of ${number(whole)}` });
  $("previous").disabled = length <= 0;
  $("next").disabled = length >= marks.at(-1);
  const status = ended === runs.length ? "All runs have ended" : `${ended} of ${counted(runs.length, "run")} ended`;
  if ($("status").textContent !== status) $("status").textContent = status;
  document.body.dataset.length = length;
}

const timer = clock({
  total: whole,
  seconds: Math.max(...runs.map(seconds)),
  move,
  first: () => move(0),
  last: () => move(whole),
  previous: () => move(marks.findLast((mark) => mark < timer.place()) ?? 0),
  next: () => move(marks.find((mark) => mark > timer.place()) ?? whole),
});
move(0);
