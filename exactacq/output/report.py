"""Runs and scenes in words and tables, for a terminal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from flint import fmpq
from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table
from rich.text import Text

from exactacq.errors import without_controls
from exactacq.files.whole_files import readable
from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import plain
from exactacq.numbers.real import Real
from exactacq.output.turns import turns
from exactacq.output.vocabulary import Word, missed_word, ordinal
from exactacq.scene.scene import Scene
from exactacq.sensing.event import Ending
from exactacq.strategies.bounds import census
from exactacq.strategies.run import Bound, OwnRun, Run, SeedSpreaderRun, SightseerRun
from exactacq.strategies.standing import LowerBound, standing
from exactacq.visibility.isovist import Isovist, ViewKind
from exactacq.visibility.shortest_path import ShortestPath

CLOSED_FORM = 60
"""Closed forms of at most this many characters are shown; longer ones are in the trace."""
WORDS = {ViewKind.EDGE: "boundary piece", ViewKind.WINDOW: "window", ViewKind.RANGE: "range arc"}
"""What the kinds of pieces of a view are called."""
FAR = 1e5
"""Coordinates from here on are often those of maps in metres, far from the origin."""
ROWS = 60
"""Most rows of a table, and most names of a list; a trace has them all."""


def console() -> Console:
    """Standard output as given: no markup, no guesses; 110 columns where it is not a terminal."""
    out = Console(highlight=False, markup=False, emoji=False)
    return out if out.is_terminal else Console(highlight=False, markup=False, emoji=False, width=110)


def progress_bar(what: str) -> Progress:
    """A bar on standard error that tells how much is done and how long it took, and then goes away."""
    columns = (TextColumn(what), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    return Progress(*columns, console=Console(stderr=True), transient=True)


def run_report(run: Run) -> RenderableType:
    """What a run did, in the order: visits and links, length, bounds, what was missed, import notes."""
    names = list(run.names())
    parts: list[RenderableType] = [
        Text(f"{run.title} on {without_controls(run.scene.name or 'a scene')}", style="bold"),
        f"S = {_place(run.start)}, {_range(run.radius)}, {_counted(len(run.obstacles), 'obstacle')}",
        "",
    ]
    if isinstance(run, SeedSpreaderRun):
        parts += _sweep(run, names)
    if isinstance(run, OwnRun):
        parts.append(f"ended because {run.events[-1].describe(names)}\n")
    if not run.map.seen and run.scene.obstacles:
        parts.append(f"nothing is in sight of S within {_range(run.radius)}\n")
    if run.visits:
        parts += [_links(run, names), ""] if isinstance(run, SightseerRun) else []
        parts.append(_listed(Word.ORDER, (names[k] for k in run.visits), " → "))
    parts.append(
        Text.assemble(f"{Word.LENGTH}  ", ("  ".join(readable(run.length, CLOSED_FORM, 20)), "bold"))
    )
    if run.ending is Ending.UNDECIDED:
        parts.append(f"given up at {_place(run.events[-1].point)}: a comparison is undecided")
    if run.bounds:
        parts += ["", _bounds(run)]
    if any(event.decided is not None for event in run.events):
        parts += ["", _decisions(run, names)]
    return Group(*parts, *_missed(run, names), *_notes(run.scene))


def comparison(runs: Sequence[Run]) -> RenderableType:
    """Runs on one scene side by side: how long, what they know and missed, and how near the bounds.

    There are the lower bounds of any path (`exactacq.strategies.offline`), and upper ones of the strategies.
    Below, the lengths of all but the first one over that of the first one.
    """
    first, *others = runs
    table = _table("", *(run.title for run in runs))
    whole = float(first.length) if first.length.sign() else float("nan")
    ratios = [f"{_short(run)} / {_short(first)}  {float(run.length) / whole:.6f}" for run in others]
    counts = [(len(run.visits), len(run.map.acquired), len(run.obstacles)) for run in runs]
    beside = [standing(run) for run in runs]
    beyond = [0 if run.ground is None else len(run.ground.unreached) for run in runs]
    rows: dict[str, list[str]] = {
        Word.LENGTH: ["\n".join(readable(run.length, CLOSED_FORM // 2, 12)) for run in runs],
        Word.VISITED: [f"{visits} of {count}" for visits, _, count in counts],
        Word.ACQUIRED: [f"{known} of {count}" for _, known, count in counts],
        Word.UNSEEN: [str(len(run.unseen)) for run in runs],
        **({Word.UNREACHABLE: list(map(str, beyond))} if any(beyond) else {}),
        Word.UNKNOWN: [_share(one.unknown, one.boundary) for one in beside],
        f"{Word.DIVERSION}s": [
            str(len(run.diversions)) if isinstance(run, SeedSpreaderRun) else "-" for run in runs
        ],
        Word.SEEING: [_least(one.seeing) for one in beside],
        Word.CIRCLING: [_least(one.circling) for one in beside],
    }
    for name, cells in rows.items():
        table.add_row(name, *cells)
    for number in range(max(len(run.bounds) for run in runs)):
        bounds = [run.bounds[number] if number < len(run.bounds) else None for run in runs]
        table.add_row(
            "bounds" if number == 0 else "",
            *("" if b is None else f"{b.name}: {_verdict(b, f'{b.ratio:.4f}')}" for b in bounds),
        )
    how_many = "Both" if len(runs) == 2 else str(len(runs))
    title = Text(f"{how_many} strategies on {without_controls(first.scene.name or 'a scene')}", style="bold")
    return Group(title, "", table, "", *ratios)


def _share(part: Length, whole: Length) -> str:
    """A part of a length, and how much of the whole it is."""
    if part.sign() == 0:
        return "0"
    return f"{float(part):.6g} of {float(whole):.6g} ({float(part) / float(whole):.2%})"


def _least(bound: LowerBound) -> str:
    """A lower bound, and below the run's length over it."""
    value = readable(bound.value, CLOSED_FORM // 2, 12)[-1]
    if bound.value.sign() == 0:
        return value
    return f"{value}\n{bound.ratio:.4f}" + ("" if bound.applies else f" ({Word.UNAPPLIED})")


def _short(run: Run) -> str:
    """What a run's strategy is called where there is little room."""
    return run.name if isinstance(run, OwnRun) else run.title.removesuffix(" Strategy")


def scene_report(scene: Scene) -> RenderableType:
    """What a valid scene holds."""
    table = Table.grid(padding=(0, 2))
    for row in scene_rows(scene).items():
        table.add_row(*row)
    return Group(Text(f"{without_controls(scene.name or 'scene')}: OK", style="bold"), table, *_notes(scene))


def scene_rows(scene: Scene) -> dict[str, str]:
    """What a valid scene holds, by what it is called."""
    edges = [edge for obstacle in scene.obstacles for edge in obstacle.edges]
    arcs = sum(isinstance(edge, Arc) for edge in edges)
    total = Length.sum(obstacle.perimeter for obstacle in scene.obstacles)
    solid = sum(not obstacle.is_enclosure for obstacle in scene.obstacles)
    rows = {
        "obstacles": f"{solid}" + (", and the enclosure" if scene.enclosure is not None else ""),
        "edges": f"{_counted(len(edges) - arcs, 'segment')}, {_counted(arcs, 'arc')}",
        "perimeters": "  ".join(readable(total, CLOSED_FORM, 20)),
        "start": _place(scene.start) if scene.start is not None else "none: give one with --start X,Y",
        "radius": _rational(scene.radius) if scene.radius is not None else "none: give one with --radius R",
    }
    if scene.terrain is not None:
        terrain = scene.terrain
        from_corner = f", from {_place(terrain.south_west)}" if any(terrain.origin) else ""
        rows["terrain"] = f"{_rational(terrain.width)} x {_rational(terrain.height)}{from_corner}"
    return rows


def view_report(view: Isovist) -> RenderableType:
    """What a view holds."""
    kinds = Counter(piece.kind.value for piece in view.pieces)
    seen = sorted({piece.obstacle for piece in view.pieces if piece.obstacle is not None})
    table = Table.grid(padding=(0, 2))
    rows = {
        "area": "  ".join(readable(view.area, CLOSED_FORM, 20)),
        "perimeter": "  ".join(readable(view.perimeter, CLOSED_FORM, 20)),
        "pieces": ", ".join(_counted(kinds[kind.value], WORDS[kind]) for kind in ViewKind) or "none",
        "bounded by": _listed("", (view.scene.obstacles[k].label for k in seen), ", ").strip() or "nothing",
    }
    if view.rays:
        rows["rays"] = str(len(view.rays))
    for row in rows.items():
        table.add_row(*row)
    title = f"View from {_place(view.point)} within {_rational(view.radius)}"
    return Group(Text(title, style="bold"), table)


def path_report(found: ShortestPath) -> RenderableType:
    """What a shortest path is made of."""
    arcs = sum(isinstance(piece, Arc) for piece in found.path)
    table = Table.grid(padding=(0, 2))
    rows = {
        "length": "  ".join(readable(found.length, CLOSED_FORM, 20)),
        "pieces": f"{_counted(len(found.path) - arcs, 'segment')}, {_counted(arcs, 'arc')}",
        "by way of": ", ".join(map(_place, found.points[1:-1])) or "nothing",
    }
    if found.count > 1:
        rows["equally short"] = f"{found.count} paths"
    for row in rows.items():
        table.add_row(*row)
    title = f"Shortest path from {_place(found.start)} to {_place(found.end)}"
    return Group(Text(title, style="bold"), table)


def remarks_report(remarks: Iterable[str]) -> RenderableType:
    """Remarks, one a line."""
    return Group(*(Padding(f"- {remark}", (0, 0, 0, 2), expand=False) for remark in remarks))


def scene_list(scenes: dict[str, str]) -> RenderableType:
    """The gallery's names and what they show."""
    table = Table.grid(padding=(0, 2))
    for name, line in scenes.items():
        table.add_row(Text(name, style="bold"), line)
    return table


def _sweep(run: SeedSpreaderRun, names: list[str]) -> Iterator[RenderableType]:
    """How the Seed Spreader ended, its diversions, and what it met."""
    yield f"ended because {run.events[-1].describe(names)}"
    counts = census(run.ground, run.radius)
    for what, numbers in (("inside strips", counts.inside), (f"crossing the {Word.M_LINE}", counts.crossing)):
        yield f"{what}  {sum(numbers)}: by strip {', '.join(map(str, numbers))}"
    yield (_listed("met", (names[k] for k in run.encounters), " → ") if run.encounters else "met nothing")
    if run.again:
        yield _listed(f"met again on the {Word.M_LINE}", (names[k] for k in run.again), ", ")
    if run.unreached:
        parts = (run.scene.obstacles[k].label for k in run.unreached)
        yield _listed(f"{Word.UNREACHABLE}, parts of", parts, ", ")
    if run.diversions:
        table = _table(Word.DIVERSION, Word.OBSTACLE, f"from {Word.D}", f"to {Word.Q}", "because")
        for order, d in enumerate(run.diversions[:ROWS], 1):
            table.add_row(str(order), names[d.obstacle], _place(d.leave), _place(d.hit), d.reason)
        yield table
    yield ""


def _links(run: SightseerRun, names: list[str]) -> Table:
    table = _table(Word.VISIT, Word.OBSTACLE, "from", Word.LEAVE, Word.HIT, Word.LINK, "walked")
    for order, link in enumerate(run.links[:ROWS], 1):
        source = link.source if isinstance(link.source, str) else names[link.source]
        length = "\n".join(readable(link.length, CLOSED_FORM // 2, 12))
        ends = _place(link.leave), _place(link.hit)
        times = "once" if link.traversals == 1 else "twice"
        table.add_row(ordinal(order), names[link.target], source, *ends, length, times)
    if len(run.links) > ROWS:
        table.add_row("...", f"{len(run.links) - ROWS} more: see --trace")
    return table


def _decisions(run: Run, names: list[str]) -> Table:
    """Why the robot went on from each place as it did, and where it turned on the M-line."""
    told = [(turn.after, 0, run.path.length_after(turn.after), "turn", turn.words) for turn in turns(run)]
    for number, event in enumerate(run.events, 1):
        if why := event.why(names):
            about = "" if event.obstacle is None else f" {names[event.obstacle]}"
            told.append((event.after, number, event.at, f"{event.kind}{about}", why))
    table = _table(Word.LENGTH, "", Word.WHY)
    for _, _, at, what, why in sorted(told, key=lambda row: row[:2])[:ROWS]:
        table.add_row(f"{float(at):.6g}", what, why)
    if len(told) > ROWS:
        table.add_row("...", "", f"{len(told) - ROWS} more: see --trace")
    return table


def _bounds(run: Run) -> Table:
    table = _table("bound", "value", "holds", "length / bound", "")
    for bound in run.bounds:
        value = "\n".join(readable(bound.value, CLOSED_FORM // 2, 12))
        holds = Word.UNAPPLIED if not bound.applies else "yes" if bound.holds else "no"
        table.add_row(bound.name, value, holds, f"{bound.ratio:.6f}", bound.source)
    return table


def _verdict(bound: Bound, ratio: str) -> str:
    """A bound's ratio, and whether it is broken or does not speak of the run."""
    return (
        f"{ratio} ({Word.UNAPPLIED})" if not bound.applies else ratio if bound.holds else f"{ratio} (broken)"
    )


def _missed(run: Run, names: list[str]) -> Iterator[RenderableType]:
    if run.complete:
        return
    yield ""
    left = missed_word(not isinstance(run, SightseerRun))
    for which, what in ((run.unseen, Word.UNSEEN), (run.unvisited, left)):
        if which:
            yield Text(_listed(what, (names[k] for k in which), ", "), style="bold red")
    if not isinstance(run, SightseerRun):
        return
    yield (
        f"So this scene does not satisfy the paper's model (a) for {_range(run.radius)}: "
        "no chain of links of at most R leads from S to every obstacle."
    )


def _notes(scene: Scene) -> Iterator[RenderableType]:
    if scene.notes:
        yield ""
        yield "import notes"
        yield remarks_report(scene.notes)


def _table(*columns: str) -> Table:
    table = Table(box=None, padding=(0, 3, 0, 0), header_style="bold", pad_edge=False)
    for column in columns:
        table.add_column(column, overflow="fold")
    return table


def _listed(what: str, names: Iterable[str], separator: str) -> str:
    every = list(names)
    more = f"{separator}... {len(every) - ROWS} more" if len(every) > ROWS else ""
    return f"{what}  {separator.join(every[:ROWS])}{more}"


def _place(point: Point) -> str:
    return f"({_number(point.x)}, {_number(point.y)})"


def _number(value: Real) -> str:
    """A coordinate: rational if that is short, else in six digits; far from the origin in ten."""
    exact = plain(value.rational) if value.rational is not None else ""
    near = float(value)
    return exact if 0 < len(exact) <= 8 else f"{near:.{6 if abs(near) < FAR else 10}g}"


def _rational(value: fmpq) -> str:
    """A number as given, unless that takes too much room."""
    exact = plain(value)
    return exact if len(exact) <= CLOSED_FORM // 2 else f"≈ {Real(value).decimal(12)}"


def _range(radius: fmpq) -> str:
    return f"{Word.RADIUS} = {_rational(radius)}".replace("= ≈", "≈")


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" + "s" * (count != 1)
