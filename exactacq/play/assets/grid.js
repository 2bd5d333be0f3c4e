/** The grid, to whose points what is drawn snaps: rational steps, so that all coordinates are rational. */

import { float, mul, parse, snapped } from "./rational.js";
import { set } from "./player/dom.js";

const CLOSEST = 22; // pixels between two lines at least
const FINE = parse("1/100"); // of a step, where nothing snaps to the grid

/** The largest of 1, 2 and 5 times a power of ten whose lines are so far apart. */
function stepFor(scale) {
  const least = CLOSEST / scale;
  const power = Math.floor(Math.log10(least));
  const digit = [1, 2, 5, 10].find((digit) => digit * 10 ** power >= least * (1 - 1e-9)) ?? 10;
  const [up, down] = power < 0 ? [digit, 10n ** BigInt(-power)] : [BigInt(digit) * 10n ** BigInt(power), 1n];
  return parse(`${up}/${down}`);
}

/** `chosen` is a text like "1/2", or "auto"; `isOn` says whether places snap to the grid. */
export function grid(camera) {
  const settings = { chosen: "auto", isOn: true };
  const step = () => (settings.chosen === "auto" ? stepFor(camera.view.scale) : parse(settings.chosen));
  const fineness = () => (settings.isOn ? step() : mul(step(), FINE));

  /** The place of the grid nearest to a place in the plane. */
  const snap = ([x, y]) => [snapped(x, fineness()), snapped(y, fineness())];

  /** Draws the lines: every one if they are not too close, every fifth one strongly. */
  function draw(thin, thick, axes) {
    const { width, height } = camera.view;
    let apart = float(step());
    while (apart * camera.view.scale < CLOSEST / 2) apart *= 5;
    const [left, top] = camera.toPlane([0, 0]);
    const [right, bottom] = camera.toPlane([width, height]);
    const lines = { thin: "", thick: "" };
    for (let k = Math.ceil(left / apart); k * apart <= right; k += 1) {
      const u = Math.round(camera.toWindow([k * apart, 0])[0]) + 0.5;
      lines[k % 5 ? "thin" : "thick"] += `M${u} 0V${height}`;
    }
    for (let k = Math.ceil(bottom / apart); k * apart <= top; k += 1) {
      const v = Math.round(camera.toWindow([0, k * apart])[1]) + 0.5;
      lines[k % 5 ? "thin" : "thick"] += `M0 ${v}H${width}`;
    }
    set(thin, { d: lines.thin });
    set(thick, { d: lines.thick });
    const [u, v] = camera.toWindow([0, 0]).map((value) => Math.round(value) + 0.5);
    set(axes, { d: `M${u} 0V${height}M0 ${v}H${width}` });
  }

  return { settings, step, fineness, snap, draw };
}
