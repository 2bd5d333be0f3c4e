"""``exactacq search``: find a scene that breaks a statement, make it small, say how to see it again.

What the command needs is imported when it runs.
"""

from __future__ import annotations

import shlex
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from exactacq.errors import FormatError
from exactacq.strategies.options import Strategy

if TYPE_CHECKING:
    from exactacq.study.search.annealing import Search
    from exactacq.study.search.goals import Goal
    from exactacq.study.search.referee import Referee, Ruling

SECONDS = 60.0
"""How long a search takes if neither --seconds nor --steps is given."""
STEPS = "Candidates in place of seconds, and as many to shrink: repeatable."
"""What --steps does."""
SHRINKING = 0.3
"""The share of the seconds that is kept for shrinking; steps are all given to it once more."""


class Method(StrEnum):
    """How candidates are made."""

    LOCAL = "local"
    HYPOTHESIS = "hypothesis"
    BOTH = "both"


class Wording(StrEnum):
    """Which statement of a claim."""

    PRINTED = "printed"
    CORRECTED = "corrected"


def claims(incomplete: str) -> list[str]:
    """The claims that begin so, for a shell to offer."""
    from exactacq.study.claims import CLAIMS

    return [claim.name for claim in CLAIMS if claim.name.startswith(incomplete)]


def search(
    claim: Annotated[
        str,
        typer.Argument(metavar="CLAIM", help="A claim, or a bound like (6) or 6.", autocompletion=claims),
    ],
    statement: Annotated[Wording, typer.Option(help="As printed, or as corrected.")] = Wording.PRINTED,
    strategy: Annotated[
        Strategy | None, typer.Option(help="Checks that the claim speaks of this strategy.")
    ] = None,
    method: Annotated[Method, typer.Option(help="How candidates are made.")] = Method.LOCAL,
    begin: Annotated[
        str | None, typer.Option("--from", metavar="SCENE", help="A scene to begin with; default: random.")
    ] = None,
    obstacles: Annotated[int, typer.Option(min=1, metavar="N", help="Most obstacles.")] = 4,
    least: Annotated[int, typer.Option(min=1, metavar="N", help="Least number of obstacles.")] = 1,
    edges: Annotated[int, typer.Option(min=3, metavar="N", help="Most edges of all obstacles.")] = 40,
    strips: Annotated[int, typer.Option(min=1, metavar="N", help="Seed Spreader: most strips.")] = 40,
    seated: Annotated[bool, typer.Option(help="Sightseer: starts on boundaries only.")] = False,
    convex: Annotated[bool, typer.Option(help="Convex obstacles only.")] = False,
    seconds: Annotated[
        float | None, typer.Option(min=0, metavar="T", help=f"Time for everything; default: {SECONDS:.0f}.")
    ] = None,
    steps: Annotated[int | None, typer.Option(min=1, metavar="N", help=STEPS)] = None,
    limit: Annotated[float, typer.Option(min=0.01, metavar="T", help="Seconds for one candidate.")] = 10.0,
    seed: Annotated[int, typer.Option(help="The same seed and steps find the same scene.")] = 0,
    keep: Annotated[
        float, typer.Option(min=0, max=1, metavar="SHARE", help="Share of the ratio that shrinking keeps.")
    ] = 0.99,
    out: Annotated[str | None, typer.Option(metavar="F", help="Write the scene as .json.")] = None,
    figure: Annotated[str | None, typer.Option(metavar="F", help="Write its run: .svg, .pdf, .png.")] = None,
) -> None:
    """Search for a scene that breaks a claim or comes closest, and make it small.

    Every candidate is decided exactly; floats only tell which way to go on.
    """
    from exactacq.files.load import load
    from exactacq.files.whole_files import FIGURES, TRACES, check_output
    from exactacq.study.claims.model import Subject
    from exactacq.study.search.annealing import Budget, Search
    from exactacq.study.search.drafts import Draft
    from exactacq.study.search.goals import goal
    from exactacq.study.search.moves import Rules
    from exactacq.study.search.referee import Referee
    from exactacq.study.search.shrinking import shrink

    target = goal(claim, statement is Wording.CORRECTED)
    if strategy is not None and strategy.value != target.subject.value:
        raise FormatError(f"--strategy: {target.name} speaks of the {target.subject.value}")
    if least > obstacles:
        raise FormatError(f"--least: no scene has at least {least} and at most {obstacles} obstacles")
    for path, kinds in ((out, TRACES), (figure, FIGURES)):
        if path is not None:
            check_output(path, kinds)
    rules = Rules(obstacles, edges, strips, seated and target.subject is Subject.SIGHTSEER, convex, least)
    first = None if begin is None else Draft.of(load(begin))
    if seconds is None and steps is None:
        seconds = SECONDS
    with Referee(target.check, limit) as referee:
        hunt = Search(referee, target.subject, rules, seed, first)
        found = _found(hunt, method, seconds, steps)
        if found is not None and found.score > 0:
            budget = Budget(steps, None if seconds is None else max(seconds * SHRINKING, 1.0))
            found = shrink(referee, found, budget, rules, keep)
        _report(target, referee, found, out)
    if found is not None:
        _write(target, found, out, figure)


def _found(hunt: Search, method: Method, seconds: float | None, steps: int | None) -> Ruling | None:
    """The best of one method, or of both, which then share the budget."""
    from exactacq.study.search.annealing import Budget
    from exactacq.study.search.hypothesis_search import hypothesis_search

    methods = (Method.HYPOTHESIS, Method.LOCAL) if method is Method.BOTH else (method,)
    share = (1 - SHRINKING) / len(methods)
    for each in methods:
        budget = Budget(
            None if steps is None else -(-steps // len(methods)), None if seconds is None else seconds * share
        )
        if each is Method.LOCAL:
            hunt.run(budget)
        else:
            hypothesis_search(hunt, budget)
    return hunt.best


def _report(target: Goal, referee: Referee, found: Ruling | None, out: str | None) -> None:
    """What was found, exactly; how many candidates there were; how to see it again."""
    from exactacq.files.counting import count
    from exactacq.output.report import console
    from exactacq.study.claims.model import Outcome

    show = console()
    dropped = ", ".join(f"{n} {kind}" for kind, n in sorted(referee.dropped.items()))
    show.print(f"{target.name}: {target.statement.words}")
    show.print(f"judged {count(referee.judged, 'scene')}" + (f", dropped: {dropped}" if dropped else ""))
    for fault in referee.faults[:1]:
        show.print(f"first fault: {fault.reason} on {' '.join(fault.draft.text().split())}", soft_wrap=True)
    if found is None or found.finding is None:
        show.print("no scene that it speaks of was found")
        return
    broken = found.finding.outcome is Outcome.FAILS
    show.print("BROKEN" if broken else "it held on all of them")
    ratio = found.finding.ratio
    if ratio is not None:
        relation = "> 1" if broken else "<= 1"
        show.print(f"best ratio {relation} (exactly), ≈ {ratio:.12g}")
    if found.finding.detail:
        show.print(found.finding.detail)
    draft = found.draft
    show.print(
        f"{count(len(draft.shapes), 'obstacle')}, {count(draft.edges, 'edge')}, "
        f"{count(draft.digits, 'digit')}, R = {draft.radius}"
    )
    if out is None:
        show.print("--out F.json keeps the scene")
    else:
        show.print(
            f"see it: exactacq explore {shlex.quote(out)} --strategy {target.subject.value}", soft_wrap=True
        )


def _write(target: Goal, found: Ruling, out: str | None, figure: str | None) -> None:
    if out is not None:
        from exactacq.files.whole_files import write_whole

        write_whole(out, found.draft.text(Path(out).stem).encode())
    if figure is not None:
        from exactacq.output.figures import save
        from exactacq.study.claims.model import Case, Subject

        case = Case(found.draft.scene(Path(figure).stem))
        save(case.sightseer if target.subject is Subject.SIGHTSEER else case.spreader, figure)
