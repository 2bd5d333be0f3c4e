/** Exact rational numbers {n, d} of BigInts, d > 0, in lowest terms: what is drawn is what is explored. */

const FORM = /^([+-]?)(\d*)(?:\.(\d*))?(?:[eE]([+-]?\d{1,3}))?(?:\/(\d+))?$/;
const LONGEST = 400; // characters of a number that is typed
const DECIMALS = 24; // of a number that is written as a decimal

function gcd(a, b) {
  while (b) [a, b] = [b, a % b];
  return a < 0n ? -a : a;
}

function ratio(n, d) {
  const g = gcd(n, d) || 1n;
  return d < 0n ? { n: -n / g, d: -d / g } : { n: n / g, d: d / g };
}

export const ZERO = ratio(0n, 1n);
export const add = (a, b) => ratio(a.n * b.d + b.n * a.d, a.d * b.d);
export const sub = (a, b) => ratio(a.n * b.d - b.n * a.d, a.d * b.d);
export const mul = (a, b) => ratio(a.n * b.n, a.d * b.d);
export const negative = (a) => ({ n: -a.n, d: a.d });
export const equal = (a, b) => a.n === b.n && a.d === b.d;
export const whole = (value) => ratio(BigInt(value), 1n);

/** The number that a text like "10", "0.1", "-3e2" or "21/2" stands for; null if it stands for none. */
export function parse(text) {
  const told = String(text).trim().replace("\u2212", "-").replace(",", ".");
  const found = told.length <= LONGEST && FORM.exec(told);
  if (!found) return null;
  const [, sign, digits, rest = "", power = "0", below = "1"] = found;
  if (!(digits + rest) || !/[^0]/.test(below)) return null;
  const exponent = Number(power) - rest.length;
  const value = BigInt(digits + rest) * (sign === "-" ? -1n : 1n);
  const [up, down] = exponent < 0 ? [1n, 10n ** BigInt(-exponent)] : [10n ** BigInt(exponent), 1n];
  return ratio(value * up, down * BigInt(below));
}

/** A decimal where that is finite and not long, else "p/q". */
export function text({ n, d }) {
  if (d === 1n) return n.toString();
  let [rest, places] = [d, 0];
  while (rest % 10n === 0n) [rest, places] = [rest / 10n, places + 1];
  for (const p of [2n, 5n]) while (rest % p === 0n && places <= DECIMALS) [rest, places] = [rest / p, places + 1];
  if (rest !== 1n || places > DECIMALS) return `${n}/${d}`;
  const digits = ((n < 0n ? -n : n) * 10n ** BigInt(places) / d).toString().padStart(places + 1, "0");
  return `${n < 0n ? "-" : ""}${digits.slice(0, -places)}.${digits.slice(-places)}`;
}

/** The nearest float, but for an error in its last digits. */
export function float({ n, d }) {
  const excess = Math.max(n.toString(16).length, d.toString(16).length) * 4 - 900;
  if (excess <= 0) return Number(n) / Number(d);
  return Number(n >> BigInt(excess)) / Number(d >> BigInt(excess));
}

/** The multiple of a step, a rational, that is nearest to a float. */
export const snapped = (value, step) => mul(whole(Math.round(value / float(step))), step);
