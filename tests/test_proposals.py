"""The options with which a start is proposed: those that bring what is drawn into the scene."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import ezdxf
import numpy as np
from test_inspection import box, drawing

import exactacq as xa


def test_a_plan_of_lines_is_read_with_walls(tmp_path: Path) -> None:
    """Tolerances would shut the doors, and leave the other walls out."""
    outline = [(4, 0), (0, 0), (0, 8), (10, 8), (10, 0), (5, 0)]
    closet = [(7, 1), (6, 1), (6, 4), (9, 4), (9, 1), (8.3, 1)]
    inner = ([(3, 1.3), (3, 6)], [(5, 5), (8, 5)], [(1, 6), (1, 7)], [(1, 1), (1, 4)])
    found = xa.inspect(drawing(tmp_path / "d.dxf", outline, closet, *inner))
    told = {cure.split()[0] for chain in found.open_chains for cure in chain.cures}
    assert told == {"--tolerance", "--thicken"}
    assert len(found.violations) == 0
    assert found.options is not None and set(found.options) == {"thicken"}
    assert found.scene is not None and len(found.scene.obstacles) == 6


def slots(path: Path, *lines: Iterable[tuple[float, float]]) -> Path:
    """A plate with slots that are turned, and whose coordinates are rounded; and further lines."""
    drawing(path, box(-75, -50, 150, 100), *lines)
    document = ezdxf.readfile(path)
    m = document.modelspace()
    for x in (-45, -15, 15, 45):
        along = np.array([3**0.5 / 2, 0.5])
        across = 3.333 * np.array([-0.5, 3**0.5 / 2])
        ends = [np.array([x, 7]) + 6 * k * along for k in (-1, 1)]
        for side in (-1, 1):
            m.add_line(*(np.round(end + side * across, 3).tolist() for end in ends))
        for end, angle in zip(ends, (120, -60), strict=True):
            m.add_arc(np.round(end, 3).tolist(), 3.333, angle, angle + 180)
    document.saveas(path)
    return path


def test_what_a_tolerance_closes_is_in_the_scene(tmp_path: Path) -> None:
    """The plate alone is a legal scene, but there is more with a tolerance; a line is no wall for that."""
    for lines in ((), ([(-10, 30), (10, 30)],)):
        found = xa.inspect(slots(tmp_path / "d.dxf", *lines))
        assert len(found.loops) == 1 and len(found.open_chains) == 16 + len(lines)
        assert found.options is not None and set(found.options) == {"tolerance"}
        assert found.scene is not None and len(found.scene.obstacles) == 5


def test_what_is_read_by_arcs_is_in_the_scene(tmp_path: Path) -> None:
    """The plate is legal without what an ellipse and a line enclose."""
    path = drawing(tmp_path / "d.dxf", box(0, 0, 40, 20), box(4, 4, 5, 5))
    document = ezdxf.readfile(path)
    document.modelspace().add_ellipse((20, 10), (2, 0), 0.5, 0, np.pi)
    document.modelspace().add_line((18, 10), (22, 10))
    document.saveas(path)
    found = xa.inspect(path)
    assert found.options is not None and set(found.options) == {"flatten"}
    assert found.scene is not None and len(found.scene.obstacles) == 3
