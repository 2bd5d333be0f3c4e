"""Simple letters of strokes of width 1 and height 6, of lines and arcs: in one piece, and without holes."""

from __future__ import annotations

from flint import fmpq

from exactacq.scene.bends import Around
from exactacq.scene.shapes import Outline

HEIGHT, WIDTH = 6, 5
"""Of the largest letter."""
LOW, MID, HIGH, TOP = (fmpq(n, 2) for n in (3, 5, 7, 9))

# fmt: off
LETTERS: dict[str, Outline] = {
    "A": Outline([(0, 0), (1, 0), (MID, TOP), (4, 0), (5, 0), (3, 6), (2, 6)]),
    "B": Outline([(0, 0), (2, 0, 1), (2, 3, 1), (2, 6), (0, 6)]),
    "C": Outline([(3, 6, 1), (3, 0), (4, 0), (4, 1), (3, 1, -1), (3, 5), (4, 5), (4, 6)]),
    "D": Outline([(0, 0), (1, 0, 1), (1, 6), (0, 6)]),
    "E": Outline([
        (0, 0), (4, 0), (4, 1), (1, 1), (1, MID), (3, MID),
        (3, HIGH), (1, HIGH), (1, 5), (4, 5), (4, 6), (0, 6),
    ]),
    "H": Outline([
        (0, 0), (1, 0), (1, MID), (3, MID), (3, 0), (4, 0),
        (4, 6), (3, 6), (3, HIGH), (1, HIGH), (1, 6), (0, 6),
    ]),
    "I": Outline([(0, 0), (1, 0), (1, 6), (0, 6)]),
    "J": Outline([
        (0, 0), (2, 0, Around((2, 2))), (4, 2), (4, 6), (3, 6), (3, 2, Around((2, 2), False)), (2, 1), (0, 1),
    ]),
    "L": Outline([(0, 0), (4, 0), (4, 1), (1, 1), (1, 6), (0, 6)]),
    "N": Outline([(0, 0), (1, 0), (1, 4), (4, 0), (5, 0), (5, 6), (4, 6), (4, 2), (1, 6), (0, 6)]),
    "O": Outline([
        (4, 2), (4, 4, Around((2, 4))), (2, 6, Around((2, 4))),
        (0, 4), (0, 2, Around((2, 2))), (2, 0, Around((2, 2))),
    ]),
    "P": Outline([(0, 0), (1, 0), (1, 2), (2, 2, 1), (2, 6), (0, 6)]),
    "S": Outline([
        (0, 0), (2, 0, 1), (2, HIGH, -1), (2, 5), (4, 5), (4, 6), (2, 6, 1), (2, MID, -1), (2, 1), (0, 1),
    ]),
    "T": Outline([(2, 0), (3, 0), (3, 5), (5, 5), (5, 6), (0, 6), (0, 5), (2, 5)]),
    "U": Outline([(0, 6), (0, 2, 1), (4, 2), (4, 6), (3, 6), (3, 2, -1), (1, 2), (1, 6)]),
    "V": Outline([(0, 6), (2, 0), (3, 0), (5, 6), (4, 6), (MID, LOW), (1, 6)]),
    "Z": Outline([(0, 0), (4, 0), (4, 1), (1, 1), (4, 5), (4, 6), (0, 6), (0, 5), (3, 5), (0, 1)]),
}
# fmt: on
"""With their left ends at x = 0. The bowls of B meet in a cusp; the bows of S are pairs of half circles."""
