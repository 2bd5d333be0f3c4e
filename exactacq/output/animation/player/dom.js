/**
 * Elements and numbers: what all parts of a page need.
 *
 * What shows one run is given its own `$`, as a page may show several: each stands in a tree of its own then.
 */

export const $ = (id) => document.getElementById(id);
export const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
export const counted = (number, what) => `${number} ${what}${number === 1 ? "" : "s"}`;

export function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
}

/** A new element with attributes, in a parent. Text that a user wrote comes in by textContent only. */
export function add(parent, tag, attributes = {}, text = null) {
  const space = parent instanceof SVGElement ? "http://www.w3.org/2000/svg" : "http://www.w3.org/1999/xhtml";
  const element = document.createElementNS(space, tag);
  set(element, attributes);
  if (text !== null) element.textContent = text;
  parent.append(element);
  return element;
}

/** Index of the last entry whose key is at most the value; 0 if there is none. */
export function last(entries, key, value) {
  let low = 0;
  let high = entries.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (key(entries[middle]) <= value) low = middle;
    else high = middle;
  }
  return low;
}
