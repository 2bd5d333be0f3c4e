/** The path: where the robot is after a length, and the part that lies behind it, in chunks of one colour. */

import { add, clamp, last, set } from "./dom.js";

const WIDEST = (2 * Math.PI) / 3; // angle of an arc: the centre of a wider one would shift by rounding

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

const lineOf = (parts) =>
  parts.length ? `M${along(parts[0].piece, parts[0].u).join(" ")}` + parts.map(({ piece, u, v }) => drawn(piece, u, v)).join("") : "";

/**
 * The path of a run; `colours` are those of the scale of lengths, which ends at `whole` or with the path, `away` is
 * that of diversions.
 */
export function journey($, data, { colours, away, whole }) {
  /** Pieces with their own start: arcs turn from `angle` by `turn` about a centre `radius` away. */
  const pieces = data.path.map(([end, x, y, radius = 0, angle = 0, turn = 0], k) => {
    const [from, x0, y0] = k ? data.path[k - 1] : [0, ...data.start];
    return { from, end, x0, y0, x, y, radius, angle, turn };
  });
  const total = pieces.length ? pieces.at(-1).end : 0;
  const scale = whole ?? total;

  const isAway = pieces.map((_, k) => data.diversions.some(([from, to]) => from <= k && k < to));
  const chunks = [];
  pieces.forEach((piece, k) => {
    const size = piece.end - piece.from || 1;
    for (let from = piece.from; ; ) {
      const step = clamp(Math.floor((from / (scale || 1)) * colours.length + 1e-9), 0, colours.length - 1);
      const to = step + 1 < colours.length ? Math.min(((step + 1) * scale) / colours.length, piece.end) : piece.end;
      const part = { piece, k, u: (from - piece.from) / size, v: to >= piece.end ? 1 : (to - piece.from) / size };
      const before = chunks.at(-1);
      if (before && before.away === isAway[k] && (isAway[k] || before.step === step)) before.parts.push(part);
      else chunks.push({ from, step, away: isAway[k], parts: [part] });
      chunks.at(-1).to = to;
      if (to >= piece.end) break;
      from = to;
    }
  });
  const look = ({ away: is, step }) => ({ class: is ? "away" : "", stroke: is ? away : colours[step] });
  $("walked").replaceChildren();
  const drawings = chunks.map((chunk) =>
    add($("walked"), "path", { d: lineOf(chunk.parts), visibility: "hidden", ...look(chunk) }),
  );
  const tail = add($("walked"), "path");

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
    set(tail, { d: lineOf(cut ? [...whole, { ...cut, v: u }] : whole), ...look(chunks[now]) });
    return along(piece, u);
  }

  return { total, walk };
}
