"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const { frames, events, obstacles } = data;
  const LABEL = 13; // pixels of a name's height, as in the style
  const WIDEST = (2 * Math.PI) / 3; // angle of an arc: the centre of a wider one would shift by rounding
  const CROWDED = 150; // among more obstacles, names that do not fit inside are left to tooltips
  const TOLD = 3; // events at one place that are told in full
  const TICKS = 60; // most marks on the slider
  const STILL = matchMedia("(prefers-reduced-motion: reduce)");

  const $ = (id) => document.getElementById(id);
  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  /** A new element with attributes, in a parent. Text that a user wrote comes in by textContent only. */
  function add(parent, tag, attributes = {}, text = null) {
    const space = parent instanceof SVGElement ? "http://www.w3.org/2000/svg" : "http://www.w3.org/1999/xhtml";
    const element = document.createElementNS(space, tag);
    set(element, attributes);
    if (text !== null) element.textContent = text;
    parent.append(element);
    return element;
  }

  function set(element, attributes) {
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  }

  /** Index of the last entry whose key is at most the value; 0 if there is none. */
  function last(entries, key, value) {
    let low = 0;
    let high = entries.length;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (key(entries[middle]) <= value) low = middle;
      else high = middle;
    }
    return low;
  }

  // -- the path ---------------------------------------------------------------------------------

  /** Pieces with their own start: arcs turn from `angle` by `turn` about a centre `radius` away. */
  const pieces = data.path.map(([end, x, y, radius = 0, angle = 0, turn = 0], k) => {
    const [from, x0, y0] = k ? data.path[k - 1] : [0, ...data.start];
    return { from, end, x0, y0, x, y, radius, angle, turn };
  });
  const total = pieces.length ? pieces.at(-1).end : 0;

  /** The place at a fraction of a piece, reckoned from its start: flat arcs lose no digits. */
  function along({ x0, y0, x, y, radius, angle, turn }, u) {
    if (u >= 1) return [x, y];
    if (!radius) return [x0 + u * (x - x0), y0 + u * (y - y0)];
    const half = (turn * u) / 2;
    const chord = 2 * radius * Math.sin(half);
    return [x0 - chord * Math.sin(angle + half), y0 + chord * Math.cos(angle + half)];
  }

  /** Path data from one fraction of a piece to another. */
  function drawn(piece, from, to) {
    if (!piece.radius) return `L${along(piece, to).join(" ")}`;
    const { radius, turn } = piece;
    const count = Math.ceil((Math.abs(turn) * (to - from)) / WIDEST) || 1;
    const places = Array.from({ length: count }, (_, k) => along(piece, from + ((to - from) * (k + 1)) / count));
    return places.map(([x, y]) => `A${radius} ${radius} 0 0 ${turn > 0 ? 1 : 0} ${x} ${y}`).join("");
  }

  /** The path in chunks of one colour: those of the scale of lengths, and that of diversions. */
  const isAway = pieces.map((_, k) => data.diversions.some(([from, to]) => from <= k && k < to));
  const chunks = [];
  pieces.forEach((piece, k) => {
    const size = piece.end - piece.from || 1;
    for (let from = piece.from; ; ) {
      const step = clamp(Math.floor((from / (total || 1)) * data.colours.length + 1e-9), 0, data.colours.length - 1);
      const to = step + 1 < data.colours.length ? Math.min(((step + 1) * total) / data.colours.length, piece.end) : piece.end;
      const part = { piece, k, u: (from - piece.from) / size, v: to >= piece.end ? 1 : (to - piece.from) / size };
      const before = chunks.at(-1);
      if (before && before.away === isAway[k] && (isAway[k] || before.step === step)) before.parts.push(part);
      else chunks.push({ from, step, away: isAway[k], parts: [part] });
      chunks.at(-1).to = to;
      if (to >= piece.end) break;
      from = to;
    }
  });
  const data_of = (parts) =>
    parts.length ? `M${along(parts[0].piece, parts[0].u).join(" ")}` + parts.map(({ piece, u, v }) => drawn(piece, u, v)).join("") : "";
  const look = ({ away, step }) => ({ class: away ? "away" : "", stroke: away ? data.away : data.colours[step] });
  const drawings = chunks.map((chunk) =>
    add($("walked"), "path", { d: data_of(chunk.parts), visibility: "hidden", ...look(chunk) }),
  );
  const tail = add($("walked"), "path");
  data.colours.filter((_, k) => k % 8 === 4).forEach((stroke, k) => {
    add($("scale"), "path", { class: "walked", d: `M${3 + 2.75 * k} 7h2.75`, stroke });
  });

  /** Draws the path up to a length; returns the robot's place. */
  function walk(length) {
    if (!pieces.length) return data.start;
    const k = last(pieces, (piece) => piece.from, length);
    const piece = pieces[k];
    const u = clamp((length - piece.from) / (piece.end - piece.from || 1), 0, 1);
    const now = last(chunks, (chunk) => chunk.from, length);
    drawings.forEach((drawing, c) => set(drawing, { visibility: c < now ? "visible" : "hidden" }));
    const whole = chunks[now].parts.filter((part) => part.k < k || (part.k === k && part.v <= u));
    const cut = chunks[now].parts.find((part) => part.k === k && part.u <= u && u < part.v);
    set(tail, { d: data_of(cut ? [...whole, { ...cut, v: u }] : whole), ...look(chunks[now]) });
    return along(piece, u);
  }

  // -- the map ----------------------------------------------------------------------------------

  const outlines = obstacles.map(({ name, outline }) => {
    const path = add($("obstacles"), "path", { d: outline });
    add(path, "title", {}, name);
    return path;
  });
  const strokes = obstacles.map(() => add($("known"), "path"));
  const stretches = obstacles.map((_, k) => data.known.filter(([obstacle]) => obstacle === k));
  const perimeter = obstacles.reduce((sum, obstacle) => sum + obstacle.perimeter, 0);

  /** Shows what was known and seen at a frame. */
  function map(frame) {
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
  }

  /** A length in the scene's unit. */
  const number = (length) => String(Number((length / data.scale).toPrecision(5)));

  // -- where the robot is -----------------------------------------------------------------------

  /** The frames at which something happens, and the events of each. */
  const happenings = new Map();
  events.forEach((event, k) => happenings.set(event[4], [...(happenings.get(event[4]) ?? []), k]));
  const eventful = [...happenings.keys()];

  const [named, counted] = [["all", "names"], ["all", "numbers"]].map((some) => some.includes(data.labels));
  const visits = new Map(data.visits.map(([obstacle, begins], k) => [obstacle, { sign: `#${k + 1}`, begins }]));
  const labels = obstacles.map(({ name, heart, above }, k) => {
    return { name: named ? name : "", visit: counted ? visits.get(k) : undefined, heart, above, text: add($("names"), "text") };
  });
  $("order").hidden = !counted || !visits.size;
  $("start").lastElementChild.textContent = data.labels === "none" ? "" : "S";

  /** Obstacles' names, and the order of the visits that have begun by a length. */
  function name(length = at) {
    for (const { name, visit, text } of labels) {
      const words = [name, visit && visit.begins <= length ? visit.sign : ""].filter((word) => word).join(" ");
      if (text.textContent !== words) text.textContent = words;
    }
  }

  let at = 0; // path length
  let now = -1; // the last frame passed
  let playing = false;

  /** Moves the robot. Frames closer together than the page's digits are told apart by their number. */
  function move(length, frame = last(frames, (entry) => entry.at, length)) {
    const changed = frame !== now;
    at = length;
    now = frame;
    if (changed) map(frame);
    const path = walk(at);
    name();
    const [cx, cy] = at === frames[now].at ? frames[now].place : path;
    set($("robot"), { cx, cy });
    tell();
    document.body.dataset.frame = now;
  }

  const go = (frame) => move(frames[frame].at, frame);

  /** Goes to the next (or previous) frame with an event; the previous one of a robot in between is the last. */
  function step(forward) {
    const found = forward
      ? eventful.find((frame) => frame > now)
      : eventful.findLast((frame) => frame < now || (frame === now && at > frames[now].at));
    if (found !== undefined) go(found);
  }

  // -- words ------------------------------------------------------------------------------------

  const count = (number, what) => `${number} ${what}${number === 1 ? "" : "s"}`;

  document.title = data.title;
  $("title").textContent = data.title;
  $("facts").textContent = `${data.length} long, ${count(obstacles.length, "obstacle")}, ${count(data.happened, "event")}`;
  $("radius").textContent = data.radius;
  $("exact").textContent = frames.length;
  if (data.left_out) {
    const [shown, all] = data.left_out;
    $("note").textContent = `Only ${shown} of its ${all} events and corners are shown, to keep this page small.`;
  }

  /** Kind, name and note of an event, and all in one line. */
  const words = ([, kind, obstacle, note]) => [kind, obstacle === null ? "" : obstacles[obstacle].name, note];
  function line(event) {
    const [kind, name, note] = words(event);
    return `${event[0]}. ${kind}${name && ` ${name}`}${note && `, ${note}`}`;
  }

  const buttons = events.map((event, k) => {
    const button = add(add($("list"), "li"), "button", { type: "button", "data-event": k });
    const [kind, name, note] = words(event);
    add(button, "span", { class: "number" }, event[0]);
    const what = add(button, "span", { class: "what" });
    add(what, "span", { class: "kind" }, kind);
    what.append(name && " ");
    add(what, "span", { class: "name" }, name);
    what.append(note && ", ");
    add(what, "span", { class: "name" }, note);
    add(button, "span", { class: "at" }, `at ${frames[event[4]].exact}`);
    button.addEventListener("click", () => {
      pause();
      go(event[4]);
    });
    return button;
  });

  /** Says in numbers, words and the list of events where the robot is. */
  function tell() {
    const here = happenings.get(now) ?? [];
    const before = happenings.get(eventful[last(eventful, (frame) => frame, now)]) ?? [];
    const exact = here.length > 0 && at === frames[now].at;
    const length = exact ? frames[now].exact : `≈ ${number(at)}`;
    $("length").textContent = length;
    $("slider").value = at;
    set($("slider"), { "aria-valuetext": `${length} of ${data.length}` });
    $("previous").disabled = now === 0 && at === 0;
    $("next").disabled = !(eventful.at(-1) > now);
    const more = here.length > TOLD ? `; and ${here.length - TOLD} more` : "";
    const status = exact
      ? here.slice(0, TOLD).map((k) => line(events[k])).join("; ") + more
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

  // -- playing ----------------------------------------------------------------------------------

  const SECONDS = clamp(6 + 0.4 * frames.filter((frame) => !frame.passing).length, 10, 60); // of the whole run at speed 1
  const PAUSE = 900; // milliseconds at an event where motion is not wanted

  function play() {
    if (!total) return;
    if (at >= total) go(0);
    playing = true;
    label();
    let [before, waited] = [null, 0];
    requestAnimationFrame(function tick(time) {
      if (!playing) return;
      // A window that was out of sight does not jump ahead.
      const elapsed = Math.min(time - (before ?? time), 100) * $("speed").value;
      before = time;
      waited += elapsed;
      if (!STILL.matches) move(Math.min(at + (elapsed * total) / (1000 * SECONDS), total));
      else if (waited >= PAUSE) {
        waited = 0;
        step(true);
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

  const actions = {
    play: () => (playing ? pause() : play()),
    previous: () => (pause(), step(false)),
    next: () => (pause(), step(true)),
    first: () => (pause(), go(0)),
    last: () => (pause(), go(frames.length - 1)),
  };
  const keys = { " ": "play", ArrowLeft: "previous", ArrowRight: "next", Home: "first", End: "last" };

  for (const name of ["play", "previous", "next"]) $(name).addEventListener("click", actions[name]);
  $("slider").addEventListener("input", (event) => {
    pause();
    move(Number(event.target.value));
  });
  document.addEventListener("click", (event) => {
    // After a click with a mouse (not by keyboard) the space bar plays again, instead of clicking once more.
    if (event.detail) event.target.closest("button")?.blur();
  });
  document.addEventListener("keydown", (event) => {
    const action = keys[event.key];
    const taken = event.target.closest("select") || (event.key === " " && event.target.closest("button"));
    if (!action || taken || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    actions[action]();
  });

  // -- layout -----------------------------------------------------------------------------------

  const [width, height] = data.box;
  set($("stage"), { viewBox: `0 0 ${width} ${height}` });
  document.documentElement.style.setProperty("--tall", height / width);
  if (data.terrain) {
    const [x, y, across, down] = data.terrain;
    set($("terrain"), { x, y, width: across, height: down });
  }
  if (data.mline) {
    set($("mline"), { d: data.mline });
    set($("beyond"), { d: data.beyond });
    for (const entry of document.querySelectorAll(".swept")) entry.hidden = false;
  }
  set($("start").firstElementChild, { x: data.start[0], y: data.start[1] });
  set($("start").lastElementChild, { x: data.start[0], y: data.start[1] });


  const sizes = obstacles.map((obstacle) => obstacle.perimeter / Math.PI).sort((a, b) => a - b);
  const medium = sizes.length ? sizes[sizes.length >> 1] : width;

  /** Names at a readable size: inside their obstacle, or above it if there is no room; none over another. */
  function arrange() {
    const stage = $("stage").getBoundingClientRect();
    const px = Math.max(width / stage.width, height / stage.height) || 1;
    const beside = Math.max(stage.width * px - width, 0) / 2; // how far the window is wider than the drawing
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
    name();
  }

  new ResizeObserver(arrange).observe($("stage"));
  set($("slider"), { max: total || 1 });
  if (eventful.length <= TICKS) for (const frame of eventful) add($("ticks"), "option", { value: frames[frame].at });
  $("slider").disabled = $("play").disabled = !total;
  label();
  go(0);
})();
