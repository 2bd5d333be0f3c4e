"""What the help tells beside options: examples of each command, and what exit statuses mean."""

from __future__ import annotations

from typing import NamedTuple

STATUSES = {
    0: "done",
    1: "fault: of exactacq itself; of verify also a statement that is called true and fails",
    2: "refused: a wrong command line, a scene that is not legal, a file that cannot be read or written, or "
    "a failed audit",
    3: "undecided: a comparison is beyond the limits; explore has told and written the run up to there",
    130: "interrupted: by control-C; no file is half written",
}
"""The exit statuses. All but 0 come with one line on standard error, but for 1 of verify."""


class Example(NamedTuple):
    """A command line, without the program's name, and what it is for."""

    line: str
    words: str
    ends: bool = True
    """Whether it ends by itself, without control-C."""


EXAMPLES = {
    "explore": (
        Example(
            "explore circles --audit --trace run.json",
            "Explore a scene of the gallery, check the run, and keep it with its exact numbers.",
        ),
        Example(
            "explore part.dxf --start=-30,-60 --radius 60 --figure part.svg --out path.dxf",
            "Explore a drawing; draw the run, and write its path for a CAD program.",
        ),
        Example(
            "explore m20-3 --strategy seed-spreader --figure moment.svg --at 20 --animate sweep.html",
            "Sweep a terrain; draw the moment after 20 units of the path; write a page that plays the run.",
        ),
    ),
    "compare": (
        Example(
            "compare figure3 --figure both.svg --animate both.html",
            "Both strategies on one terrain: drawn side by side, and a page that plays both on one clock.",
        ),
        Example(
            "compare figure2 --strategy sightseer --strategy nearest-frontier",
            "The Sightseer beside a baseline: to the nearest end of what is known.",
        ),
        Example(
            "compare circles --terrain bbox:2",
            "A scene without a terrain gets one: the rectangle about what there is, 2 units wider.",
        ),
    ),
    "play": (
        Example("play", "Draw a scene in the browser, and watch the robot explore it.", ends=False),
        Example(
            "play figure3 --no-browser --port 8421",
            "Begin with a scene of the gallery, and open the address that is printed oneself.",
            ends=False,
        ),
    ),
    "check": (
        Example("check part.dxf --start=-30,-60", "What a drawing holds, and what the import did to it."),
        Example("check m4 --json", "The same of a gallery scene, for programs."),
    ),
    "gallery": (
        Example("gallery", "All scenes that ship, and what each of them shows."),
        Example("gallery relay --figure relay.svg", "Draw a scene with the names of its obstacles."),
    ),
    "convert": (
        Example(
            "convert part.dxf part.wkt --start=-30,-60",
            "A drawing as well-known text, arcs kept.",
        ),
        Example(
            "convert run.json path.csv --only path --at 10",
            "The first 10 units of the path of a run that explore has written, as a table.",
        ),
    ),
    "isovist": (
        Example("isovist plate --at=-30,-60", "How much is seen from a place, and of what."),
        Example(
            "isovist figure2 --at 15,13 --radius 8 --out view.dxf", "The region that is seen, as a drawing."
        ),
    ),
    "path": (
        Example("path circles 0,0 16,0", "The shortest way past two discs."),
        Example(
            "path figure2 23,3 8,25 --figure way.svg",
            "Out of one hollow and into another: a drawing of the way.",
        ),
    ),
    "verify": (
        Example(
            "verify --scenes 3 --seed 2 --out night.sqlite",
            "A small campaign that can be stopped, and goes on when the same line is given again.",
        ),
        Example("verify --replay seed-spreader:2000040", "One scene of a campaign, judged again."),
        Example(
            "verify --family gears --size 8..12 --scenes 2 --no-claims",
            "Scenes like drawings, of several sizes, run and audited.",
        ),
    ),
    "search": (
        Example(
            "search T1 --obstacles 2 --steps 30 --out found.json",
            "A scene that breaks Theorem 1 as printed, made small.",
        ),
        Example(
            "search L3 --statement corrected --obstacles 1 --seconds 3",
            "The same for what is proved instead: none is found, but how close one comes is told.",
        ),
    ),
}
"""Examples of each command, to be run in this order; `part.dxf` is the drawing behind the scene `plate`."""


def epilog(command: str) -> str:
    """What the help of a command ends with: its examples, a paragraph each."""
    return "\n\n".join(["Examples:", *(f"exactacq {example.line}" for example in EXAMPLES[command])])


def statuses() -> str:
    """What the help as a whole ends with: the exit statuses, a paragraph each."""
    return "\n\n".join(["Exit status:", *(f"{number} {words}" for number, words in STATUSES.items())])
