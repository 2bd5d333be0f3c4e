"""Maps of ROS, as map_server writes them: a YAML file that names an image, and says how to read it.

The darkness p of a pixel is (255 - value) / 255, or value / 255 if negate is set. It is occupied if p >
occupied_thresh, free if p < free_thresh, and unknown otherwise; only occupied cells block, and on request
unknown ones. The image's SW corner lies at the origin, its pixels are as wide as the resolution, and it is
turned by the yaw, in radians. Cosine and sine of a yaw are irrational, so a rational rotation near it is
taken, which keeps the shape exactly.
"""

from __future__ import annotations

import re
from pathlib import Path

from flint import fmpq

from exactacq.errors import FormatError, about, shown
from exactacq.files.grids.outlines import JOIN
from exactacq.files.grids.pixels import read_pixels
from exactacq.files.grids.world import Placement, grid_contents
from exactacq.files.loops.chains import scientific_above
from exactacq.files.loops.contents import Contents
from exactacq.files.loops.rational_arcs import FIXED_BITS, nearly_pi, rational_turn
from exactacq.files.source import one_line, read_text
from exactacq.numbers.rationals import rational

MAX_LINES = 200
"""Most lines of such a YAML file; real ones have seven."""
MAX_YAW = 1000
"""Largest yaw, in radians: a few turns are legal, more are a mistake."""
IMAGES = (".pgm", ".png", ".bmp", ".gif", ".jpg", ".jpeg")
_ENTRY = re.compile(r"([A-Za-z_]\w*)\s*:(?:\s+(.*))?")
_COMMENT = re.compile(r"""((?<![^\s\[,])(?:"[^"]*"|'[^']*'))|(?:^|\s)#.*""")
"""A comment, or a value in quotation marks, in which "#" begins none."""


def load_ros_map(
    path: Path,
    start: tuple[fmpq, fmpq] | None,
    *,
    corners: str = JOIN,
    border: str | None = None,
    unknown: str = "free",
    simplify: fmpq | None = None,
) -> Contents:
    """The rings of a map: occupied cells block, and with *unknown* "blocked" unknown ones do too.

    See `grid_contents` for *corners*, *border* and *simplify*.

    Raises `FormatError`.
    """
    said = _entries(read_text(path))
    image = path.parent / _one(said, "image")
    if image.suffix.lower() not in IMAGES:
        raise FormatError(f"image: {one_line(repr(image.name))} does not end in {', '.join(IMAGES)}")
    mode = _one(said, "mode", "trinary")
    if mode not in ("trinary", "scale"):
        raise FormatError(f"mode: trinary or scale is read, not {one_line(mode)}")
    placement, notes = _placement(said)
    occupied, free = _level(said, "occupied_thresh", "0.65"), _level(said, "free_thresh", "0.196")
    negate = _one(said, "negate", "0").lower()
    if negate not in ("0", "1", "true", "false"):
        raise FormatError(f"negate: 0 or 1 is needed, not {one_line(repr(negate))}")
    with about(f"image {one_line(image.name)}"):
        pixels = read_pixels(image)
    dark = pixels.values if negate in ("1", "true") else pixels.most - pixels.values
    if unknown == "blocked":
        blocked = dark >= int((free * pixels.most).ceil())
    else:
        blocked = dark > int((occupied * pixels.most).floor())
        if pixels.clear is not None:
            blocked &= ~pixels.clear
    return grid_contents(
        blocked[::-1],
        placement,
        path.stem,
        start,
        corners=corners,
        border=border or "open",
        tolerance=simplify,
        notes=notes,
    )


def _placement(said: dict[str, list[str]]) -> tuple[Placement, tuple[str, ...]]:
    origin = said.get("origin", ["0", "0", "0"])
    if len(origin) not in (2, 3):
        raise FormatError(f"origin: [x, y, yaw] is needed, not {len(origin)} values")
    with about("origin"):
        x, y, yaw = (rational(number) for number in (*origin, "0")[:3])
    with about("resolution"):
        size = rational(_one(said, "resolution"))
    if abs(yaw) > MAX_YAW:
        raise FormatError(f"origin: a yaw of {shown(yaw)} radians; give one of at most {MAX_YAW}")
    turn, error = rational_turn(yaw * 180 / nearly_pi())
    far = scientific_above(error + abs(yaw) / 2**FIXED_BITS)
    notes = (f"turned by a rational rotation within {far} of the yaw",) if yaw else ()
    return Placement(size, (x, y), turn), notes


def _level(said: dict[str, list[str]], key: str, default: str) -> fmpq:
    with about(key):
        level = rational(_one(said, key, default))
    if not 0 <= level <= 1:
        raise FormatError(f"{key}: a number from 0 to 1 is needed, not {shown(level)}")
    return level


def _one(said: dict[str, list[str]], key: str, default: str | None = None) -> str:
    values = said.get(key, [] if default is None else [default])
    if not values:
        raise FormatError(f"there is no {key}: is this a map of map_server?")
    if len(values) > 1:
        raise FormatError(f"{key}: one value is needed, not {len(values)}; is this a map of map_server?")
    return values[0]


def _entries(text: str) -> dict[str, list[str]]:
    """The entries of a flat YAML file: a value, or a list in brackets or with dashes on lines of its own."""
    lines = text.splitlines()
    if len(lines) > MAX_LINES:
        raise FormatError(f"{len(lines)} lines are no map of map_server, which has seven")
    found: dict[str, list[str]] = {}
    open_list: list[str] | None = None
    for number, line in enumerate(lines, 1):
        content = _COMMENT.sub(lambda found: found[1] or "", line).strip()
        entry = _ENTRY.fullmatch(content)
        if not content or content in ("---", "..."):
            continue
        if content.startswith("- ") and open_list is not None:
            open_list.append(_bare(content[2:]))
        elif entry is None:
            raise FormatError(f"line {number}: an entry like resolution: 0.05 is needed")
        elif entry[1] in found:
            raise FormatError(f"line {number}: {one_line(entry[1])} stands twice; keep one")
        else:
            value = (entry[2] or "").strip()
            listed = value.startswith("[") and value.endswith("]")
            values = value[1:-1].split(",") if listed else [value] if value else []
            found[entry[1]] = [_bare(part) for part in values]
            open_list = None if value else found[entry[1]]
    return found


def _bare(text: str) -> str:
    """A value without quotation marks."""
    text = text.strip()
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] and text[0] in "'\"" else text
