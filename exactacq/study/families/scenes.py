"""The families of drawings by name, and scenes of them with a robot for either strategy."""

from __future__ import annotations

from collections.abc import Callable

from flint import fmpq

from exactacq.errors import InvalidScene
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Shape, Terrain
from exactacq.scene.terrain_components import ground_of
from exactacq.strategies.options import Strategy
from exactacq.study.dice import Dice
from exactacq.study.families.boards import board
from exactacq.study.families.floors import floor_plan
from exactacq.study.families.gears import gears
from exactacq.study.families.names import SIZES, Family
from exactacq.study.families.plan import Corner, Plan
from exactacq.study.families.plates import plate
from exactacq.study.families.slots import slots
from exactacq.study.families.stairs import staircases
from exactacq.study.families.words import words

PLANS: dict[Family, Callable[[Dice, int, bool], Plan]] = {
    Family.PLATES: plate,
    Family.BOARDS: board,
    Family.FLOOR_PLANS: floor_plan,
    Family.GEARS: gears,
    Family.SLOTS: slots,
    Family.WORDS: words,
    Family.STAIRCASES: staircases,
}
"""What draws each, of a size and with or without a wall."""


def family_scene(name: str, n: int, seed: int, strategy: str) -> Scene:
    """A valid scene of a family with its radius, the same on every platform for the same arguments.

    *n* is the number of obstacles, of gears and staircases that of their edges; an enclosure is not counted.
    The radius equals a gap, a pitch or twice that, is generic, or exceeds the scene. The Sightseer starts
    where ties are, on a boundary or anywhere, in half of the scenes within a wall. The Seed Spreader's
    terrain leaves some room on each side, or has obstacles that touch its border there, or cuts them.
    ValueError for an unknown family or strategy, a size outside `SIZES`, or a negative seed. Near linear in
    *n*: 10 milliseconds for each ten.

    >>> from exactacq.study.families.scenes import family_scene
    >>> family_scene("plates", 12, 1, "seed-spreader")
    <Scene 'plates-12-seed-spreader-1': 12 obstacles>
    """
    family, way = Family(name), Strategy(strategy)
    if n not in SIZES or seed < 0:
        raise ValueError(f"n is from {SIZES[0]} to {SIZES[-1]} and a seed not negative, not {n} and {seed}")
    # Neighbouring seeds give unlike streams; no two arguments share one.
    number = (seed * len(SIZES) + n) * len(Family) + list(Family).index(family)
    dice = Dice(2 * number + (way is Strategy.SIGHTSEER))
    label = f"{family.value}-{n}-{way.value}-{seed}"
    while True:
        try:
            if way is Strategy.SIGHTSEER:
                return _seen(dice, PLANS[family](dice, n, dice.chance(50)), label)
            return _swept(dice, PLANS[family](dice, n, False), label)
        except InvalidScene:
            continue  # A start may lie inside an obstacle, or an obstacle on the corner: throw again.


def _seen(dice: Dice, plan: Plan, name: str) -> Scene:
    radius = _radius(dice, plan)
    return Scene(plan.shapes, _start(dice, plan), enclosure=plan.wall, radius=radius, name=name)


def _start(dice: Dice, plan: Plan) -> Corner:
    kind = dice.below(10)
    if kind < 5:
        return dice.choice(plan.places)
    if kind < 7:
        return _vertex(dice.choice(plan.shapes), dice)
    left, bottom, right, top = plan.box.wider(plan.gap / 2)
    return left + (right - left) * fmpq(dice.below(98), 97), bottom + (top - bottom) * fmpq(
        dice.below(102), 101
    )


def _vertex(shape: Shape, dice: Dice) -> Corner:
    if isinstance(shape, Circle):
        return shape.center[0] + shape.radius, shape.center[1]
    return dice.choice(shape.vertices)[:2]


def _radius(dice: Dice, plan: Plan) -> fmpq:
    left, bottom, right, top = plan.box
    return dice.choice(
        (
            plan.gap,
            plan.pitch,
            2 * plan.pitch,
            plan.gap + plan.pitch * fmpq(dice.between(20, 97), 31),
            4 * (right - left + top - bottom),
        )
    )


def _swept(dice: Dice, plan: Plan, name: str) -> Scene:
    west, south, east, north = plan.box
    rooms = (plan.gap, plan.pitch / 2, fmpq(0), -plan.bite)
    west, south = west - dice.choice(rooms), south - dice.choice(rooms)
    east, north = east + dice.choice(rooms), north + dice.choice(rooms)
    terrain = Terrain(east - west, north - south, (west, south))
    scene = Scene(plan.shapes, terrain=terrain, radius=_radius(dice, plan), name=name)
    ground_of(scene)
    return scene
