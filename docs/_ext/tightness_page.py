"""The table of how tight the corrected bounds are: the best scene of the gallery, and the family of each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from claims_page import plain

from exactacq.study.claims.model import Case, Subject
from exactacq.study.claims.tightness import Portion, Reach, Yardstick, best

ARGUMENT = "_generated/arguments/tight.md"
"""The written proof for all families, as the page sees it."""


def write(folder: Path, yardsticks: Sequence[Yardstick], cases: Iterable[tuple[str, Subject, Case]]) -> None:
    """Write tightness.md: each bound with the largest share on the *cases*, and on members of its family."""
    by_subject: dict[Subject, list[tuple[str, Case]]] = {subject: [] for subject in Subject}
    for name, subject, case in cases:
        by_subject[subject].append((name, case))
    lines = [*table((y, best(y, by_subject[y.subject])) for y in yardsticks), "", *gaps(yardsticks)]
    (folder / "tightness.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


def table(found: Iterable[tuple[Yardstick, tuple[str, Portion] | None]]) -> Iterator[str]:
    """The lines of the table, in Markdown."""
    yield "| bound | ratio of | largest in the gallery | family | what is proved | some members |"
    yield "| --- | --- | --- | --- | --- | --- |"
    for yardstick, top in found:
        largest = f"{top[1]} on `{top[0]}`" if top else "no scene speaks of it"
        reach = yardstick.reach.value
        proved = reach if yardstick.reach is Reach.OPEN else f"[{reach}]({ARGUMENT})"
        columns = plain(yardstick.words), largest, plain(yardstick.family), proved, members(yardstick)
        yield f"| {plain(yardstick.claim)} | {' | '.join(columns)} |"


def members(yardstick: Yardstick) -> str:
    """The exact shares of some members of the family."""
    shares = ((scene.name, yardstick.measure(Case(scene))) for scene in yardstick.members())
    return ", ".join(f"`{name}`: {share}" for name, share in shares)


def gaps(yardsticks: Iterable[Yardstick]) -> Iterator[str]:
    """What is open, bound by bound."""
    yield from ("## What is open", "")
    for yardstick in yardsticks:
        if yardstick.gap:
            yield f"- *{plain(yardstick.claim)}* ({plain(yardstick.words)}): {plain(yardstick.gap)}"
