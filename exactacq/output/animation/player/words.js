/** Words: the list of events, and where the robot is. */

import { $, add, counted, last, set } from "./dom.js";

const TOLD = 3; // events at one place that are told in full

/** Kind, name and note of an event. */
const words = ([, kind, obstacle, note], obstacles) => [kind, obstacle === null ? "" : obstacles[obstacle].name, note];

/** An event in one line. */
export function line(event, obstacles) {
  const [kind, name, note] = words(event, obstacles);
  return `${event[0]}. ${kind}${name && ` ${name}`}${note && `, ${note}`}`;
}

/** Why the robot does what it is about to do in a frame. */
export function planned(plans, now) {
  const plan = plans[last(plans, ([frame]) => frame, now)];
  return plan && plan[0] <= now ? plan[1] : "";
}

/** The list of a run's events, whose buttons call `chosen`; and what tells where the robot is. */
export function wording(data, number, chosen) {
  const { frames, events, obstacles, plans } = data;

  /** The frames at which something happens, and the events of each. */
  const happenings = new Map();
  events.forEach((event, k) => happenings.set(event[4], [...(happenings.get(event[4]) ?? []), k]));
  const eventful = [...happenings.keys()];

  $("list").replaceChildren();
  const buttons = events.map((event, k) => {
    const button = add(add($("list"), "li"), "button", { type: "button", "data-event": k });
    const [kind, name, note] = words(event, obstacles);
    add(button, "span", { class: "number" }, event[0]);
    const what = add(button, "span", { class: "what" });
    add(what, "span", { class: "kind" }, kind);
    what.append(name && " ");
    add(what, "span", { class: "name" }, name);
    what.append(note && ", ");
    add(what, "span", { class: "name" }, note);
    add(button, "span", { class: "at" }, `at ${frames[event[4]].exact}`);
    if (event[5]) add(button, "span", { class: "because name" }, event[5]);
    button.addEventListener("click", () => chosen(event[4]));
    return button;
  });

  /** Says in numbers, words and the list of events where the robot is: after a length, past a frame. */
  function tell(at, now) {
    const here = happenings.get(now) ?? [];
    const before = happenings.get(eventful[last(eventful, (frame) => frame, now)]) ?? [];
    const exact = here.length > 0 && at === frames[now].at;
    const length = exact ? frames[now].exact : `≈ ${number(at)}`;
    $("length").textContent = length;
    $("slider").value = at;
    set($("slider"), { "aria-valuetext": `${length} of ${data.length}` });
    $("previous").disabled = now === 0 && at === 0;
    $("next").disabled = !(eventful.at(-1) > now);
    $("why").textContent = planned(plans, now);
    const more = here.length > TOLD ? `; and ${here.length - TOLD} more` : "";
    const status = exact
      ? here.slice(0, TOLD).map((k) => line(events[k], obstacles)).join("; ") + more
      : `On the way after event ${before.length ? events[before.at(-1)][0] : 0} of ${data.happened}`;
    if ($("status").textContent === status) return;
    $("status").textContent = status;
    highlight(before);
  }

  function highlight(current) {
    buttons.forEach((button, k) => {
      if (current.includes(k)) set(button, { "aria-current": "step" });
      else button.removeAttribute("aria-current");
      button.classList.toggle("later", k > current.at(-1));
    });
    if (!current.length) return;
    const [list, top] = [$("list"), buttons[current[0]].parentElement.offsetTop];
    const bottom = buttons[current.at(-1)].parentElement;
    const end = bottom.offsetTop + bottom.offsetHeight;
    if (end > list.scrollTop + list.clientHeight) list.scrollTop = end - list.clientHeight;
    if (top < list.scrollTop) list.scrollTop = top;
  }

  const facts = `${data.length} long, ${counted(obstacles.length, "obstacle")}, ${counted(data.happened, "event")}`;
  return { eventful, tell, facts };
}
