/** The robot's settings: strategy, range, start, and the terrain of a sweep. */

import { $ } from "./player/dom.js";
import { numberField } from "./fields.js";
import { add, mul, parse, snapped, ZERO } from "./rational.js";
import { extentOfAll } from "./shapes.js";

const MARGIN = 1; // grid steps that a terrain about everything is wider than that

export function settings(store, grid) {
  const { state, edit } = store;
  const change = (parts) => edit({ ...state.drawing, ...parts });
  const axis = (k) => [
    () => state.drawing.start?.[k],
    (value) => change({ start: [0, 1].map((j) => (j === k ? value : (state.drawing.start?.[j] ?? ZERO))) }),
  ];
  const side = (name) => [
    () => state.drawing.terrain?.[name],
    (value) => change({ terrain: { x: ZERO, y: ZERO, width: parse("10"), height: parse("10"), ...state.drawing.terrain, [name]: value } }),
  ];
  const fields = [
    numberField($("range"), () => state.drawing.radius, (radius) => change({ radius }), { optional: true }),
    numberField($("start-x"), ...axis(0)),
    numberField($("start-y"), ...axis(1)),
    ...["x", "y", "width", "height"].map((name) => numberField($(`terrain-${name}`), ...side(name))),
  ];
  $("strategy").addEventListener("change", ({ target }) => change({ strategy: target.value }));
  $("lookahead").addEventListener("change", ({ target }) => change({ lookahead: target.checked }));
  $("target").addEventListener("change", ({ target }) => change({ target: target.value }));
  $("terrain-remove").addEventListener("click", () => change({ terrain: null }));
  $("terrain-around").addEventListener("click", () => {
    const box = extentOfAll({ ...state.drawing, terrain: null, start: null });
    if (!box) return;
    const step = grid.step();
    const margin = mul(step, parse(String(MARGIN)));
    const down = (value) => add(snapped(value, step), { n: -margin.n, d: margin.d });
    const up = (value) => add(snapped(value, step), margin);
    const [x, y, u, v] = [down(box[0]), down(box[1]), up(box[2]), up(box[3])];
    change({ terrain: { x, y, width: add(u, { n: -x.n, d: x.d }), height: add(v, { n: -y.n, d: y.d }) } });
  });

  let wasSwept = false;

  return () => {
    const { strategy, lookahead, target, terrain } = state.drawing;
    const isSwept = strategy === "seed-spreader";
    $("strategy").value = strategy;
    $("strategy-told").textContent = $("strategy").selectedOptions[0].title;
    $("lookahead").checked = lookahead;
    $("target").value = target;
    $("start-fields").hidden = isSwept;
    $("sweep-fields").hidden = !isSwept;
    $("terrain-fields").hidden = !isSwept && !terrain;
    if (isSwept !== wasSwept) $("terrain-fields").open = wasSwept = isSwept;
    $("terrain-remove").disabled = !terrain;
    for (const show of fields) show();
  };
}
