"""Search for counterexamples by hypothesis instead of annealing.

Hypothesis draws small scenes, steers towards high scores (`hypothesis.target`) and shrinks what breaks.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.extras import installing
from exactacq.scene.shapes import Circle, Polygon, Shape
from exactacq.study.claims.model import Subject
from exactacq.study.search.annealing import Budget, Search
from exactacq.study.search.drafts import Draft, Seat
from exactacq.study.search.moves import Rules

if TYPE_CHECKING:
    from hypothesis.strategies import SearchStrategy

GRID, CELLS = fmpq(1, 2), 16
"""Drawn scenes have corners on a grid of halves, over a square of so many cells each way."""
MOST_EXAMPLES = 10**6
"""Examples if only the clock ends the search."""
DRAWN = (
    ((0, 0), (1, 0), (1, 1), (0, 1)),
    ((0, 0), (1, 0), (0, 1)),
    ((0, 1), (1, 0), (1, 1)),
    ((0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)),
    ((0, 0), (5, 0), (5, 4), (4, 4), (4, 1), (1, 1), (1, 4), (0, 4)),
)
"""Shapes to be stretched: rectangle, triangles, an L, a U."""


def drafts(subject: Subject, rules: Rules) -> SearchStrategy[Draft]:
    """A strategy of drafts for one of the two runs; many of them break the rules of scenes."""
    st = _hypothesis().strategies
    cell = st.integers(0, CELLS).map(lambda k: k * GRID)
    span = st.integers(1, CELLS // 2).map(lambda k: k * GRID)

    def shape(draw: Any) -> Shape:
        x, y, wide, high = (draw(s) for s in (cell, cell, span, span))
        kind = draw(st.integers(0, len(DRAWN)))
        if kind == len(DRAWN) or (rules.convex and kind > 2):
            return Circle((x, y), min(wide, high) / 2)
        scale = max(max(corner) for corner in DRAWN[kind])
        return Polygon([(x + wide * a / scale, y + high * b / scale) for a, b in DRAWN[kind]])

    def draft(draw: Any) -> Draft:
        shapes = tuple(draw(st.lists(st.composite(shape)(), min_size=1, max_size=rules.obstacles)))
        radius = draw(st.sampled_from([fmpq(1), fmpq(2), fmpq(3), fmpq(5), fmpq(40)]))
        if subject is Subject.SEED_SPREADER:
            return Draft(shapes, radius, size=(draw(span) + 2, draw(span) + 2))
        if rules.seated or draw(st.booleans()):
            k = draw(st.integers(0, len(shapes) - 1))
            return Draft(shapes, radius, seat=Seat(k, 0, fmpq(0)))
        return Draft(shapes, radius, start=(draw(cell) - 1, draw(cell) - 1))

    found: SearchStrategy[Draft] = st.composite(draft)().filter(rules.allow)
    return found


def hypothesis_search(search: Search, budget: Budget) -> None:
    """Spend the budget on scenes that hypothesis draws; the best goes to *search*.

    The score is its target, and a violation its failing example, which it then shrinks. Raises `FormatError`
    if hypothesis is not installed.
    """
    library = _hypothesis()
    examples = MOST_EXAMPLES if budget.steps is None else max(budget.steps - budget.used, 1)
    phases = [library.Phase.generate, library.Phase.target, library.Phase.shrink]

    def trial(draft: Draft) -> None:
        if not budget.spend():
            raise _Spent
        ruling = search.referee.judge(draft)
        search.note(ruling)
        if not ruling.speaks:
            library.reject()
        library.target(min(ruling.score, _MOST_TARGET))
        if ruling.fails:
            raise _Broken

    settings = library.settings(
        max_examples=examples,
        deadline=None,
        database=None,
        phases=phases,
        suppress_health_check=list(library.HealthCheck),
        print_blob=False,
    )
    given = library.given(drafts(search.subject, search.rules))
    try:
        library.seed(search.seed)(settings(given(trial)))()
    except (_Broken, _Spent, library.errors.Flaky, library.errors.Unsatisfiable):
        # Flaky: a violation took too long when it was judged again. What was found is noted already.
        return


_MOST_TARGET = 1e9
"""Targets must be finite."""


class _Broken(Exception):
    """A violation."""


class _Spent(BaseException):
    """The budget is spent. No Exception, which hypothesis would take for a violation."""


def _hypothesis() -> Any:
    try:
        import hypothesis
        import hypothesis.errors
        import hypothesis.strategies
    except ImportError:
        raise FormatError(
            f"hypothesis is not installed: {installing('search')}; or take --method local"
        ) from None
    return hypothesis
