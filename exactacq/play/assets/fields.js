/** Inputs of exact numbers: what is typed is taken when the input is left, if it is a number. */

import { parse, text } from "./rational.js";

/**
 * Makes an input show `read()`, a rational or null, and `write` what is typed. An empty one writes null if
 * `optional`; a text that is no number stays, is marked, and writes nothing. Returns what shows it anew.
 */
export function numberField(input, read, write, { optional = false } = {}) {
  function mark(why) {
    input.setCustomValidity(why);
    if (why) input.setAttribute("aria-invalid", "true");
    else input.removeAttribute("aria-invalid");
  }
  input.addEventListener("change", () => {
    const told = input.value.trim();
    const value = told ? parse(told) : null;
    mark(value || (optional && !told) ? "" : "A number is needed, like 10, 0.1 or 21/2");
    if (!input.validity.customError) write(value);
  });
  input.addEventListener("keydown", (event) => {
    if (event.key === "Enter") input.blur();
  });
  return () => {
    if (document.activeElement === input || input.validity.customError) return;
    const value = read();
    input.value = value ? text(value) : "";
  };
}
