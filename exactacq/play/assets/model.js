/**
 * What is drawn: an immutable value, so that every edit makes a new one and undoing is going back.
 *
 * A drawing has a name, a start [x, y] or null, a radius or null, a terrain {x, y, width, height} or null, and
 * shapes: {id, name, wall, vertices: [{x, y, bend}]} or {id, name, wall, center, radius}. A bend is null for a
 * straight edge, {bulge}, or {center, clockwise}. All numbers are rationals.
 */

import { add, equal, mul, negative, parse, snapped, sub, text, whole, ZERO } from "./rational.js";

let count = 0;
export const fresh = (shape) => ({ id: `s${++count}`, name: "", wall: false, ...shape });

export const EMPTY = {
  name: "", start: [ZERO, ZERO], radius: whole(10), terrain: null, shapes: [], notes: [],
  strategy: "sightseer", lookahead: true, target: "known",
};

const pair = ([x, y]) => [parse(x), parse(y)];
const told = ([x, y]) => [text(x), text(y)];

// -- documents -----------------------------------------------------------------------------------

function bendOf(told) {
  if (told === undefined) return null;
  if (typeof told === "object") return { center: pair(told.center), clockwise: told.clockwise ?? false };
  const bulge = parse(told);
  return equal(bulge, ZERO) ? null : { bulge };
}

function shapeOf(told, wall = false) {
  const { name = "", circle, boundary } = Array.isArray(told) ? { boundary: told } : told;
  if (circle) return fresh({ name, wall, center: pair(circle.center), radius: parse(circle.radius) });
  return fresh({ name, wall, vertices: boundary.map(([x, y, bend]) => ({ x: parse(x), y: parse(y), bend: bendOf(bend) })) });
}

/** The drawing of a document whose numbers are texts; what is not told stays as in `before`. */
export function fromDocument(document, before = EMPTY) {
  const { terrain, enclosure } = document;
  const [x, y] = pair(terrain?.origin ?? ["0", "0"]);
  return {
    ...before,
    name: document.name ?? "",
    notes: document.notes ?? [],
    start: document.start ? pair(document.start) : null,
    radius: document.radius ? parse(document.radius) : null,
    terrain: terrain ? { x, y, width: parse(terrain.width), height: parse(terrain.height) } : null,
    shapes: [...document.obstacles.map((shape) => shapeOf(shape)), ...(enclosure ? [shapeOf(enclosure, true)] : [])],
  };
}

function documentOf(shape) {
  const name = shape.name ? { name: shape.name } : {};
  if (shape.center) return { ...name, circle: { center: told(shape.center), radius: text(shape.radius) } };
  const row = ({ x, y, bend }) => {
    if (!bend) return told([x, y]);
    return [...told([x, y]), bend.bulge ? text(bend.bulge) : { center: told(bend.center), clockwise: bend.clockwise }];
  };
  return { ...name, boundary: shape.vertices.map(row) };
}

/** The document of a drawing, and how it is to be explored: what the server is asked with. */
export function toRequest(drawing) {
  const { terrain, strategy, lookahead, target } = drawing;
  const scene = { obstacles: obstacles(drawing).map(documentOf) };
  const wall = drawing.shapes.find((shape) => shape.wall);
  if (drawing.name) scene.name = drawing.name;
  if (drawing.start) scene.start = told(drawing.start);
  if (drawing.radius) scene.radius = text(drawing.radius);
  if (terrain) {
    scene.terrain = { width: text(terrain.width), height: text(terrain.height), origin: told([terrain.x, terrain.y]) };
  }
  if (wall) scene.enclosure = documentOf(wall);
  if (drawing.notes.length) scene.notes = drawing.notes;
  return { scene, strategy, lookahead, target };
}

export const obstacles = (drawing) => drawing.shapes.filter((shape) => !shape.wall);

/** What a shape is called: its name, or "O" and its number; the wall. */
export function labelOf(drawing, shape) {
  return shape.name || (shape.wall ? "wall" : `O${obstacles(drawing).findIndex(({ id }) => id === shape.id) + 1}`);
}

// -- edits ---------------------------------------------------------------------------------------

export const find = (drawing, id) => drawing.shapes.find((shape) => shape.id === id);
export const withShape = (drawing, shape) => ({ ...drawing, shapes: [...drawing.shapes, shape] });
export const without = (drawing, id) => ({ ...drawing, shapes: drawing.shapes.filter((shape) => shape.id !== id) });

export function changed(drawing, id, change) {
  return { ...drawing, shapes: drawing.shapes.map((shape) => (shape.id === id ? { ...shape, ...change(shape) } : shape)) };
}

/** Makes one shape the wall of the room, in place of another one; or an obstacle. */
export function asWall(drawing, id, wall) {
  return { ...drawing, shapes: drawing.shapes.map((shape) => ({ ...shape, wall: shape.id === id ? wall : shape.wall && !wall })) };
}

const shifted = ([x, y], [dx, dy]) => [add(x, dx), add(y, dy)];

/** A whole shape moved by a rational step. */
export function movedBy(shape, by) {
  if (shape.center) return { center: shifted(shape.center, by) };
  return {
    vertices: shape.vertices.map(({ x, y, bend }) => {
      const [u, v] = shifted([x, y], by);
      return { x: u, y: v, bend: bend?.center ? { ...bend, center: shifted(bend.center, by) } : bend };
    }),
  };
}

/** An arc about a centre that is not equally far from ends that move gets the nearest bulge of 1024ths. */
function loosened(vertices, k, bulgeOf) {
  const { bend } = vertices[k];
  return bend?.center ? { ...vertices[k], bend: { bulge: snapped(bulgeOf(vertices, k), parse("1/1024")) } } : vertices[k];
}

/** A vertex at another place. */
export function withVertex(shape, k, [x, y], bulgeOf) {
  const [old, before] = [shape.vertices, (k + shape.vertices.length - 1) % shape.vertices.length];
  const vertices = old.map((vertex, j) => (j === k || j === before ? loosened(old, j, bulgeOf) : vertex));
  vertices[k] = { ...vertices[k], x, y };
  return { vertices };
}

export const withBend = (shape, k, bend) => ({
  vertices: shape.vertices.map((vertex, j) => (j === k ? { ...vertex, bend } : vertex)),
});

/** A new vertex in the middle of an edge, which becomes straight. */
export function divided(shape, k) {
  const [a, b] = [shape.vertices[k], shape.vertices[(k + 1) % shape.vertices.length]];
  const half = parse("1/2");
  const middle = { x: mul(add(a.x, b.x), half), y: mul(add(a.y, b.y), half), bend: null };
  return { vertices: [...shape.vertices.slice(0, k), { ...a, bend: null }, middle, ...shape.vertices.slice(k + 1)] };
}

/** A loop without one of its vertices; null if too few are left. */
export function withoutVertex(shape, k) {
  const vertices = shape.vertices.filter((_, j) => j !== k);
  const before = (k + vertices.length) % (vertices.length + 1);
  if (vertices.length < 2 || (vertices.length === 2 && vertices.every(({ bend }) => !bend))) return null;
  const at = vertices.findIndex((vertex) => vertex === shape.vertices[before]);
  return { vertices: vertices.map((vertex, j) => (j === at ? { ...vertex, bend: null } : vertex)) };
}

/** A rectangle from corner to corner, counterclockwise. */
export function rectangle([x, y], [u, v]) {
  const corners = [[x, y], [u, y], [u, v], [x, v]].map(([a, b]) => ({ x: a, y: b, bend: null }));
  return fresh({ vertices: corners });
}

/** The terrain between two corners; null if it has no area. */
export function terrainOf([x, y], [u, v]) {
  const [across, up] = [sub(u, x), sub(v, y)];
  if (!across.n || !up.n) return null;
  return {
    x: across.n < 0n ? u : x, y: up.n < 0n ? v : y,
    width: across.n < 0n ? negative(across) : across, height: up.n < 0n ? negative(up) : up,
  };
}
