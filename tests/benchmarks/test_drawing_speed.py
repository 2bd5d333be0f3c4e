"""What runs on the drawings of the tests cost, each with the start and the radius that `check` proposes.

``pytest tests/benchmarks/test_drawing_speed.py --benchmark-enable -s`` prints one line for each drawing: the
README's table. Without that option only the first is explored.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from measuring import measured

DATA = Path(__file__).resolve().parents[1] / "data"
DRAWINGS = {
    "issue21.dxf": ((700, 60), "140"),
    "vslot-2020_1.dxf": ((-8, -8), "3.1"),
    "forms.dxf": ((680, -730), "140"),
    "list-columns.svg": (("10.5", "8.4"), "3.9"),
    "issue39.dxf, outer='drop'": (("2923.7", "3183.6"), "4.8"),
    "gear.dxf": ((0, 0), "17"),
    "turtlebot3.yaml": ((-2, 0), "1.2"),
    "mousebites.dxf, thicken='0.46'": ((69, 41), "37"),
    "outline.dxf, union=True": ((33, 33), "22"),
    "inpa.wkt": ((550, 170), "95"),
}
"""Files with the options to load them with; start and radius."""


@pytest.mark.parametrize("drawing", DRAWINGS)
def test_drawings(benchmark: object, drawing: str) -> None:
    if benchmark.disabled and drawing != "issue21.dxf":
        pytest.skip("takes too long for the everyday suite: run with --benchmark-enable")
    name, _, options = drawing.partition(", ")
    (path,) = DATA.rglob(name)
    start, radius = DRAWINGS[drawing]
    load = f"scene = xa.load({str(path)!r}, start={start!r}, {options})"
    found = measured(benchmark, load, f"xa.sightseer(scene, {radius!r}).sense()")
    print(f"\n{drawing}: {found.seconds:.2f} s, {found.loops:.1f} loops, {found.megabytes:.0f} MB")
    assert found.loops > 0
