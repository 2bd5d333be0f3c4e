"""Families of drawings: legal, as large as promised, the same for the same seed, symmetric where promised."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from hashlib import sha256

import pytest
from flint import fmpq
from nightly import some

import exactacq as xa
from exactacq.files.scene_json import scene_to_json
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.loops import signed_area
from exactacq.geometry.points import Location, Point
from exactacq.scene.scene import Obstacle, Scene
from exactacq.scene.shapes import Shape, shape_edges
from exactacq.strategies.options import Strategy
from exactacq.study.dice import Dice
from exactacq.study.families.gears import gear
from exactacq.study.families.letters import HEIGHT, LETTERS, WIDTH
from exactacq.study.families.names import SIZES, Family
from exactacq.study.families.parts import moved, rounded, slot
from exactacq.study.families.plan import Rectangle
from exactacq.study.families.scenes import PLANS, family_scene
from exactacq.study.families.stairs import band, pyramid, stairs

BY_EDGES = (Family.GEARS, Family.STAIRCASES)
DIGESTS = {
    (Family.PLATES, Strategy.SIGHTSEER): "a9db492a14b7",
    (Family.PLATES, Strategy.SEED_SPREADER): "ba921bdf1d44",
    (Family.BOARDS, Strategy.SIGHTSEER): "444ec149dd86",
    (Family.BOARDS, Strategy.SEED_SPREADER): "aeb69c4ad45a",
    (Family.FLOOR_PLANS, Strategy.SIGHTSEER): "ab4b3bd9fdb1",
    (Family.FLOOR_PLANS, Strategy.SEED_SPREADER): "4767a2640461",
    (Family.GEARS, Strategy.SIGHTSEER): "c7f344b2695a",
    (Family.GEARS, Strategy.SEED_SPREADER): "61453cc54f45",
    (Family.SLOTS, Strategy.SIGHTSEER): "8fca69ffd263",
    (Family.SLOTS, Strategy.SEED_SPREADER): "b3d1374f7b55",
    (Family.WORDS, Strategy.SIGHTSEER): "b31db81bc595",
    (Family.WORDS, Strategy.SEED_SPREADER): "c719ed229809",
    (Family.STAIRCASES, Strategy.SIGHTSEER): "8989d002cd0a",
    (Family.STAIRCASES, Strategy.SEED_SPREADER): "3222da7ce219",
}
"""Of some scenes: a change of a family changes the scenes of its seeds, and must be meant."""


@pytest.fixture(params=list(Family), ids=str)
def family(request: pytest.FixtureRequest) -> Family:
    return Family(request.param)


def written(scene: Scene) -> str:
    return json.dumps(scene_to_json(scene))


Told = tuple[object, ...]


def told(edges: Iterable[Curve]) -> set[Told]:
    """The edges, each by its ends in their order and its centre; a circle by its centre and radius."""
    return {_told(edge, str) for edge in edges}


def mirrored(edges: Iterable[Curve], axis: fmpq) -> set[Told]:
    """The edges in the mirror of x = axis, each from its other end, so that the same side is blocked."""

    def image(place: Point) -> str:
        return str(Point(2 * axis - place.x, place.y))

    return {_told(edge.reversed(), image) for edge in edges}


def _told(edge: Curve, text: Callable[[Point], str]) -> Told:
    if not isinstance(edge, Arc):
        return text(edge.start), text(edge.end)
    if edge.full:
        return text(edge.center), str(edge.radius_sq)
    # Reversed and mirrored, an arc turns as before.
    return text(edge.start), text(edge.end), text(edge.center)


class TestEveryFamily:
    @pytest.mark.parametrize("walled", [False, True])
    def test_draws_what_is_legal_and_of_that_size(self, family: Family, walled: bool) -> None:
        """Without a robot nothing but the drawing itself can be at fault."""
        for n in (5, 6, 13, 30):
            for seed in range(2):
                plan = PLANS[family](Dice(seed), n, walled)
                scene = Scene(plan.shapes, enclosure=plan.wall)
                assert (plan.wall is not None) == walled
                inner = [o for o in scene.obstacles if not o.is_enclosure]
                assert n == (sum(len(o.edges) for o in inner) if family in BY_EDGES else len(inner))
                assert all(e.start.rational is not None for o in inner for e in o.edges)

    def test_of_the_largest_size(self, family: Family) -> None:
        shapes = PLANS[family](Dice(0), SIZES[-1], True).shapes
        assert (len(edges_of(shapes)) if family in BY_EDGES else len(shapes)) == SIZES[-1]

    def test_bounds_what_it_draws(self, family: Family) -> None:
        for seed in range(4):
            plan = PLANS[family](Dice(seed), 12, False)
            west, south, east, north = xa.terrain_around(Scene(plan.shapes)).limits
            assert plan.box.left <= west and plan.box.bottom <= south
            assert east <= plan.box.right and north <= plan.box.top

    @pytest.mark.parametrize("strategy", list(Strategy), ids=str)
    def test_is_the_same_everywhere(self, family: Family, strategy: Strategy) -> None:
        text = "\n".join(written(family_scene(family, 9, seed, strategy)) for seed in range(3))
        assert sha256(text.encode()).hexdigest()[:12] == DIGESTS[family, strategy]

    @pytest.mark.parametrize("strategy", list(Strategy), ids=str)
    def test_differs_from_seed_to_seed(self, family: Family, strategy: Strategy) -> None:
        scenes = [family_scene(family, 8, seed, strategy) for seed in range(6)]
        assert len({written(scene.replace(name="")) for scene in scenes}) == 6
        assert scenes[3].name == f"{family.value}-8-{strategy.value}-3"

    @pytest.mark.parametrize("strategy", some(list(Strategy), 1), ids=str)
    def test_is_explored_and_passes_the_audit(self, family: Family, strategy: Strategy) -> None:
        scene = family_scene(family, SIZES[0], 0, strategy)
        run = xa.sightseer(scene) if strategy is Strategy.SIGHTSEER else xa.seed_spreader(scene)
        xa.audit(run, samples=4)

    def test_terrains_are_of_all_kinds(self, family: Family) -> None:
        scenes = [family_scene(family, 5, seed, "seed-spreader") for seed in range(20)]
        found = Counter(_borders(scene) for scene in scenes)
        assert min(found[kind] for kind in ("clear", "cut")) >= 1, found

    def test_takes_no_other_sizes_and_no_negative_seeds(self, family: Family) -> None:
        for n, seed in ((4, 0), (301, 0), (5, -1)):
            with pytest.raises(ValueError, match="from 5 to 300"):
                family_scene(family, n, seed, "sightseer")

    def test_has_a_name(self) -> None:
        with pytest.raises(ValueError, match="houses"):
            family_scene("houses", 5, 0, "sightseer")
        with pytest.raises(ValueError, match="walker"):
            family_scene("plates", 5, 0, "walker")


def test_radii_and_starts_are_of_all_kinds() -> None:
    found: Counter[str] = Counter()
    for family in Family:
        for seed in range(5):
            scene = family_scene(family, 6, seed, "sightseer")
            assert scene.start is not None and scene.radius is not None
            whole = xa.terrain_around(scene)
            places = {o.locate(scene.start) for o in scene.obstacles}
            found["on a boundary"] += Location.BOUNDARY in places
            found["free"] += places == {Location.OUTSIDE}
            found["in a room"] += scene.enclosure is not None
            found["far"] += scene.radius > whole.width + whole.height
            found["near"] += 3 * scene.radius < whole.width + whole.height
    assert min(found.values()) >= 3 and len(found) == 5, found


class TestSymmetry:
    @pytest.mark.parametrize("n", [5, 6, 13, 30])
    def test_plates(self, n: int) -> None:
        for seed in range(8):
            plan = PLANS[Family.PLATES](Dice(seed), n, True)
            assert plan.wall is not None
            for edges in (edges_of(plan.shapes), edges_of([plan.wall])):
                assert mirrored(edges, fmpq(0)) == told(edges)

    @pytest.mark.parametrize("teeth", [1, 2, 3, 7, 12])
    def test_gears(self, teeth: int) -> None:
        edges = shape_edges(gear((fmpq(3), fmpq(1)), teeth, fmpq(4), fmpq(5), fmpq(3, 4)))
        assert mirrored(edges, fmpq(3)) == told(edges)
        assert len(edges) == 4 * teeth

    def test_teeth_are_alike(self) -> None:
        """But for the fineness of rational directions."""
        edges = shape_edges(gear((fmpq(0), fmpq(0)), 9, fmpq(4), fmpq(5), fmpq(1)))
        tips = [float(edge.length) for edge in edges[1::4]]
        assert max(tips) - min(tips) < 0.02 * min(tips)
        for flank in edges[::4]:
            assert flank.start.x * flank.end.y == flank.start.y * flank.end.x, "flanks lead to the centre"

    @pytest.mark.parametrize("letter", "AOTUVIH")
    def test_letters(self, letter: str) -> None:
        edges = shape_edges(LETTERS[letter])
        middle = {"I": fmpq(1, 2), "O": fmpq(2), "U": fmpq(2), "H": fmpq(2)}.get(letter, fmpq(5, 2))
        assert mirrored(edges, middle) == told(edges)


class TestParts:
    def test_a_rounded_rectangle(self) -> None:
        for width, height, radius, edges in ((6, 4, 1, 8), (6, 4, 2, 6), (4, 4, 2, 4)):
            place = Rectangle(fmpq(1), fmpq(2), fmpq(1 + width), fmpq(2 + height))
            shape = rounded(place, fmpq(radius))
            (whole,) = Scene([shape]).obstacles
            assert len(whole.edges) == edges
            # The square of the corners' circles less the circle.
            assert whole.area == xa.Length.sum([_pi(radius), xa.Length(width * height - 4 * radius**2)])

    def test_a_slot(self) -> None:
        for width, height in ((6, 2), (2, 6), (4, 4)):
            (whole,) = Scene([slot(Rectangle(fmpq(0), fmpq(0), fmpq(width), fmpq(height)))]).obstacles
            half, long = min(width, height) // 2, abs(width - height)
            assert whole.area == xa.Length.sum([_pi(half), xa.Length(2 * half * long)])
            terrain = xa.terrain_around(Scene([whole.shape]))
            assert (terrain.width, terrain.height, terrain.origin) == (width, height, (0, 0))

    def test_what_is_moved_is_the_same_elsewhere(self) -> None:
        for shape in LETTERS.values():
            there = shape_edges(moved(shape, fmpq(7, 3), -2))
            assert signed_area(there) == signed_area(shape_edges(shape))
            assert [e.length for e in there] == [e.length for e in shape_edges(shape)]

    @pytest.mark.parametrize("letter", LETTERS)
    def test_a_letter_has_its_size(self, letter: str) -> None:
        terrain = xa.terrain_around(Scene([LETTERS[letter]]))
        assert terrain.origin[1] == 0 and terrain.height == HEIGHT
        assert terrain.origin[0] >= 0 and terrain.width <= WIDTH
        assert signed_area(shape_edges(LETTERS[letter])).sign() > 0

    def test_steps_are_counted(self) -> None:
        for steps in range(1, 9):
            assert len(stairs(steps)) == 2 * steps + 2
            assert len(band(steps)) == len(pyramid(steps)) == 4 * steps
            for corners in (stairs(steps), band(steps), pyramid(steps)):
                assert all((a[0] == b[0]) != (a[1] == b[1]) for a, b in _sides(corners))
                turns = [(a[0] == b[0]) for a, b in _sides(corners)]
                assert turns[1:] == [not turn for turn in turns[:-1]], "edges across and along take turns"


def _sides(corners: list[tuple[int, int]]) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    return zip(corners, [*corners[1:], corners[0]], strict=True)


def _pi(radius: int) -> xa.Length:
    return Scene([xa.Circle((0, 0), radius)]).obstacles[0].area


def edges_of(shapes: Iterable[Shape]) -> list[Curve]:
    """All edges, the inside on their left."""
    return [edge for shape in shapes for edge in Obstacle.of(0, shape).oriented().edges]


def _borders(scene: Scene) -> str:
    """Whether obstacles lie over the border, or touch it only, or neither."""
    if not scene.meets_border():
        return "clear"
    assert scene.terrain is not None
    within = xa.terrain_around(scene).limits
    west, south, east, north = scene.terrain.limits
    fits = west <= within[0] and south <= within[1] and within[2] <= east and within[3] <= north
    return "touched" if fits else "cut"
