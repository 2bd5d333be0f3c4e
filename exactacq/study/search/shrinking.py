"""Making a find small: fewer obstacles, fewer vertices, shorter numbers, as long as it says as much."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from flint import fmpq

from exactacq.scene.shapes import Loop
from exactacq.study.search.annealing import Budget
from exactacq.study.search.drafts import Draft
from exactacq.study.search.moves import Rules, rounded, without_vertex
from exactacq.study.search.referee import Referee, Ruling

Key = tuple[int, str, str]

MOST_DIGITS = 8
"""Numbers are rounded to at most so many decimals; what needs more stays as it is."""


def shrink(referee: Referee, found: Ruling, budget: Budget, rules: Rules, share: float = 0.9) -> Ruling:
    """The smallest find reached by single simplifications, each of which is judged exactly.

    A violation stays one, and *share* of the score is kept. It ends where no simplification is left that does
    both, or with the budget. A draft counts as simpler with fewer obstacles, then edges, then digits.
    """
    floor = found.score * share
    tried = {found.draft}
    before: Draft | None = None
    while before != found.draft:
        before = found.draft
        for change in _changes(found.draft):
            draft = change(found.draft)
            if draft is None or draft in tried or size(draft) >= size(found.draft) or not rules.allow(draft):
                continue
            if not budget.spend():
                return found
            tried.add(draft)
            ruling = referee.judge(draft)
            if ruling.speaks and ruling.score >= floor and (ruling.fails or not found.fails):
                found = ruling
    return found


def size(draft: Draft) -> tuple[int, int, int]:
    """Obstacles, edges and digits: what shrinking makes smaller, in this order."""
    return len(draft.shapes), draft.edges, draft.digits


def _changes(draft: Draft) -> Iterator[Callable[[Draft], Draft | None]]:
    """What to try in turn on what the draft has become: from behind, so that numbers keep their sense."""
    for k in reversed(range(len(draft.shapes))):
        yield partial(_fewer, k)
    for k in reversed(range(len(draft.shapes))):
        for i in reversed(range(len(getattr(draft.shapes[k], "vertices", ())))):
            yield partial(_plainer, k, i)
    for digits in range(-1, MOST_DIGITS):
        yield partial(_shorter, None, digits)
    for key in _values(draft):
        for digits in range(-1, MOST_DIGITS):
            yield partial(_shorter, key, digits)


def _fewer(k: int, draft: Draft) -> Draft | None:
    return draft.without(k) if k < len(draft.shapes) else None


def _plainer(k: int, i: int, draft: Draft) -> Draft | None:
    shape = draft.shapes[k] if k < len(draft.shapes) else None
    return without_vertex(draft, k, i) if isinstance(shape, Loop) and i < len(shape.vertices) else None


def _shorter(key: Key | None, digits: int, draft: Draft) -> Draft:
    """All numbers rounded, or one with those of its kind and value on its obstacle: edges stay upright."""

    def change(shape: int, kind: str, value: fmpq) -> fmpq:
        return rounded(value, digits) if key is None or key == (shape, kind, str(value)) else value

    return draft.mapped(change)


def _values(draft: Draft) -> list[Key]:
    """The different numbers: of which obstacle, of what kind, and their values."""
    found: dict[Key, None] = {}

    def note(shape: int, kind: str, value: fmpq) -> fmpq:
        found[shape, kind, str(value)] = None
        return value

    draft.mapped(note)
    return list(found)
