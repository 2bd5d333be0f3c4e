"""What `check` says of a file: in lines and tables for a terminal, and as JSON data."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any

from flint import fmpq
from rich.table import Table

from exactacq.files.checking.inspection import Flaw, Inspection
from exactacq.files.checking.lines import OpenChain
from exactacq.files.loops.chains import scientific_above
from exactacq.geometry.curves import Arc
from exactacq.numbers.rationals import plain
from exactacq.output.report import scene_rows
from exactacq.output.report_data import scene_data

LISTED = 50
"""Most violations that are told one by one; as JSON all are."""
CHAINS, PIECES = 20, 3
"""Most open chains that are told, and most pieces that are named of each."""
LAYERS = 24
"""Most layers that are named."""
ROLES = {
    "wall": "wall",
    "outer": "outer loop",
    "hole": "hole",
    "nested": "nested loop",
    "single": "single loop",
}
"""What loops are called: outer ones have others within, holes lie in one other, nested ones in several."""


def inspection_report(found: Inspection) -> Iterator[str | Table]:
    """Lines, each to be printed as one, and tables; the last line says whether all is well."""
    table = Table.grid(padding=(0, 2))
    for row in _rows(found).items():
        table.add_row(*row)
    yield table
    if found.open_chains:
        count = len(found.open_chains)
        yield f"\n{_counted(count, 'open chain')} (left out of the scene)"
        yield _chains(found.open_chains[:CHAINS])
        if count > CHAINS:
            yield f"... and {count - CHAINS} shorter ones"
    if found.violations:
        yield f"\n{_counted(len(found.violations), 'violation')}"
        yield from (f"- {_told(flaw)}" for flaw in found.violations[:LISTED])
        if len(found.violations) > LISTED:
            yield f"... and {len(found.violations) - LISTED} more: --json lists all"
    if found.notes:
        yield "\nimport notes"
        yield from (f"- {note}" for note in found.notes)
    yield ""
    yield from _proposal(found)
    yield f"{found.name}: not OK: {found.trouble}" if found.trouble else f"{found.name}: OK"


def inspection_data(found: Inspection) -> dict[str, Any]:
    """An inspection for programs: rationals as text, floats where nothing is decided by them."""
    contents = found.contents
    return {
        "name": found.name,
        "ok": found.ok,
        "trouble": found.trouble,
        "format": found.format,
        "unit": contents.unit or None,
        "layers": [
            {"name": name, "entities": count, "read": contents.layers.read(name)}
            for name, count in contents.layers.counts.most_common()
        ],
        "extent": None if found.extent is None else [list(corner) for corner in found.extent],
        "loops": [
            {
                "label": loop.label,
                "name": loop.obstacle.name,
                "role": loop.role,
                "inside": loop.depth,
                "holds": loop.holds,
                "segments": sum(not isinstance(edge, Arc) for edge in loop.obstacle.edges),
                "arcs": sum(isinstance(edge, Arc) for edge in loop.obstacle.edges),
            }
            for loop in found.loops
        ],
        "open_chains": [
            {
                "pieces": list(chain.pieces),
                "edges": chain.edges,
                "length": chain.length,
                "ends": [list(map(str, end)) for end in chain.ends],
                "gap": str(chain.gap),
                "encloses": chain.encloses,
                "cures": list(chain.cures),
            }
            for chain in found.open_chains
        ],
        "violations": [
            {
                "rule": flaw.text,
                "kind": None if flaw.kind is None else flaw.kind.value,
                "loops": [found.loops[k].label for k in flaw.loops],
                "places": [list(place.xy) for place in flaw.places],
                "cures": list(flaw.cures),
            }
            for flaw in found.violations
        ],
        "notes": list(found.notes),
        "start": None if found.start is None else list(map(str, found.start)),
        "radius": None if found.radius is None else str(found.radius),
        "gap": found.gap,
        "scene": None if found.scene is None else scene_data(found.scene),
        "command": found.command or None,
    }


def _rows(found: Inspection) -> dict[str, str]:
    contents = found.contents
    rows = {"format": found.format}
    if contents.unit:
        rows["unit"] = contents.unit
    if counts := contents.layers.counts:
        named = [
            f"{name} ({count}{'' if contents.layers.read(name) else ', not read'})"
            for name, count in counts.most_common(LAYERS)
        ]
        more = f" and {len(counts) - LAYERS} more" if len(counts) > LAYERS else ""
        rows["layers"] = ", ".join(named) + more
    if found.extent is not None:
        (x0, y0), (x1, y1) = found.extent
        rows["extents"] = f"x {x0:.6g} to {x1:.6g}, y {y0:.6g} to {y1:.6g}"
    roles = Counter(loop.role for loop in found.loops)
    rows["loops"] = ", ".join(_counted(roles[role], ROLES[role]) for role in ROLES if roles[role]) or "none"
    if found.scene is not None and not found.violations and found.contents.start is not None:
        return rows | scene_rows(found.scene)
    edges = [edge for loop in found.loops for edge in loop.obstacle.edges]
    arcs = sum(isinstance(edge, Arc) for edge in edges)
    rows["edges"] = f"{_counted(len(edges) - arcs, 'segment')}, {_counted(arcs, 'arc')}"
    return rows


def _chains(chains: Iterable[OpenChain]) -> Table:
    table = Table(box=None, padding=(0, 3, 0, 0), header_style="bold", pad_edge=False)
    for column in ("chain", "pieces", "length", "gap", "closes with"):
        table.add_column(column, overflow="fold")
    for chain in chains:
        names = ", ".join(chain.pieces[:PIECES]) + (" ..." if len(chain.pieces) > PIECES else "")
        cures = " or ".join(chain.cures) or "nothing that was tried"
        around = "; it would enclose other loops" if chain.encloses else ""
        table.add_row(
            names,
            str(len(chain.pieces)),
            f"{chain.length:.6g}",
            scientific_above(chain.gap),
            f"{cures}{around}",
        )
    return table


def _told(flaw: Flaw) -> str:
    """A violation and what cures it, on one line."""
    return (
        f"{flaw.text}; cured by {' or '.join(flaw.cures)}"
        if flaw.cures
        else f"{flaw.text}; no option that was tried cures it"
    )


def _proposal(found: Inspection) -> Iterator[str]:
    """The start and the radius, how they were chosen, and the command line."""
    scene, contents = found.scene, found.contents
    if scene is None or found.start is None or found.radius is None:
        yield "no start was found around which there is a scene"
        return
    told = []
    if contents.start is None:
        count = _counted(len(scene.obstacles), "boundary", "boundaries")
        told.append(f"S = ({', '.join(map(_number, found.start))}) is a roomy place in a scene of {count}")
    if contents.radius is None and found.gap is not None:
        wide = f"{found.gap:.3g}"
        told.append(f"R = {_number(found.radius)} is half more than the widest gap to be bridged, {wide}")
    if told:
        yield "; ".join(told)
    if found.command:
        yield found.command


def _number(value: fmpq) -> str:
    return plain(value)


def _counted(count: int, what: str, plural: str = "") -> str:
    return f"{count} {what if count == 1 else plural or what + 's'}"
