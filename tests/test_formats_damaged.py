"""Damaged files of every format: each mutation is read, or refused in one line, in bounded time.

Samples are mutated by bytes (flipped, cut, doubled, inserted) and by structure (words swapped, repeated, or
replaced by numbers that hurt). `EXACTACQ_MUTATIONS` asks for more than the everyday number.
"""

from __future__ import annotations

import os
import re
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from random import Random

import numpy as np
import PIL.Image
import pytest

import exactacq as xa

DATA = Path(__file__).parent / "data"
COUNT = int(os.environ.get("EXACTACQ_MUTATIONS", "300"))
SECONDS = 20
"""More than any mutation may take, on a busy machine too; most take milliseconds."""
NUMBERS = (
    b"0", b"-1", b"1e308", b"-1e-308", b"1e99999", b"nan", b"Infinity", b"9" * 400, b"0.1", b"4294967296",
    b"99999999", b"1/0", b"", b"true", b"\xff", b"\x00", b"1.5.5", b"--3", b"\xd9\xa3",
)  # fmt: skip
RING = "[[0, 0], [4, 0.25], [4, 4], [0, 4], [0, 0]], [[1, 1], [1, 3], [3, 3], [1, 1]]"
TEXTS = {
    "a.json": """{"name": "a", "start": [0, 0], "radius": "21/2", "terrain": {"width": 20, "height": 10},
 "obstacles": [{"name": "O1", "boundary": [[2, -1], [4, -1, "1/2"], ["4", "1.25"], [2, 1,
 {"through": [1, 0]}]]},
 {"circle": {"center": [8, 0], "radius": 2}},
 {"boundary": [[9, 9, {"center": [9, 8], "clockwise": true}], [10, 8]]}]}""",
    "a.wkt": """SRID=1;CURVEPOLYGON(COMPOUNDCURVE((0 0, 4 0), CIRCULARSTRING(4 0, 5 1, 4 2), (4 2, 0 2,
 0 0)), CIRCULARSTRING(1 1, 2 1, 1 1)) MULTIPOLYGON Z (((9 9 1, 10 9 1, 10 10 1, 9 9 1)), EMPTY)
 LINESTRING(0 0, 1e1 -.5)""",
    "a.geojson": f"""{{"type": "FeatureCollection", "features": [{{"type": "Feature", "properties":
 {{"name": "a", "kind": "x"}}, "geometry": {{"type": "Polygon", "coordinates": [{RING}]}}}}, {{"type":
 "Feature", "geometry": {{"type": "GeometryCollection", "geometries": [{{"type": "MultiPolygon",
 "coordinates": [[[[9, 9], [10, 9, 7], [10, 10], [9, 9]]]]}}, {{"type": "Point", "coordinates": [1,
 2]}}]}}}}]}}""",
    "a.environment": "//Model\n//Outer\n0 0\n10.0 0\n10 10\n0 10\n//Hole\n2 2\n2 3\n4 3\n//\n7 3\n6 4\n8 5\n",
    "a.map": "type octile\nheight 4\nwidth 5\nmap\n.....\n.T.@W\n.@.SG\n.O...\n",
    "a.pgm": "P2\n# plan\n4 3\n255\n0 0 255 255\n255 0 128 0\n0 255 255 0\n",
    "curves.svg": """<svg viewBox="0 0 100 100"><g transform="rotate(30) scale(2 1)"><path
 d="M10 10C15 30 30 30 30 10S50 -10 50 10V50H10z"/><ellipse cx="20" cy="70" rx="4" ry="3"/><path
 d="M60 60q5 9 9 0t9 0M10 20A10 5 30 0 1 20 20L30 80"/></g></svg>""",
    "a.svg": """<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 40"><g id="a"
 transform="translate(1 2) rotate(30) scale(2)"><path d="M2.5 5a.5.5 0 1 0 0-1 .5.5 0 0 0 0 1m4.5
 -3h1v3H6z"/><rect x="15" y="9" width="4" height="3" rx="1"/></g><circle cx="3" cy="30" r="2"
 style="fill:red"/><text>x</text><polygon points="30,30 35,30 35,35"/><!-- note --><line x1="3" y1="35"
 x2="9" y2="35"/></svg>""",
}


def sample(folder: Path, name: str) -> Path:
    """An undamaged file."""
    path = folder / name
    if name in TEXTS:
        path.write_text(TEXTS[name])
    elif name == "a.kicad_pcb":
        shutil.copy(DATA / "board.kicad_pcb", path)
    elif name == "a.dxf":
        shutil.copy(DATA / "issue21.dxf", path)
    elif name == "a.yaml":
        PIL.Image.fromarray(np.arange(48, dtype=np.uint8).reshape(6, 8) * 5).save(folder / "plan.png")
        path.write_text(
            "image: plan.png\nresolution: 0.05\norigin: [-1.0, 2, 0.3]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n"
        )
    else:
        PIL.Image.fromarray(np.arange(48, dtype=np.uint8).reshape(6, 8) * 5).save(path)
    return path


def by_bytes(data: bytes, rng: Random) -> bytes:
    """One to four bytes changed, a piece cut out, doubled or moved, or noise put in."""
    out = bytearray(data)
    kind, i, j = rng.randrange(6), rng.randrange(len(out)), rng.randrange(len(out))
    i, j = min(i, j), min(max(i, j), i + 40) if kind != 3 else j
    if kind == 0:
        for _ in range(rng.randint(1, 4)):
            out[rng.randrange(len(out))] = rng.randrange(256)
    elif kind == 1:
        del out[i:j]
    elif kind == 2:
        out[i:i] = out[i:j]
    elif kind == 3:
        del out[i:]
    elif kind == 4:
        out[i:i] = rng.randbytes(rng.randint(1, 8))
    else:
        out[rng.randrange(len(out))] ^= 1 << rng.randrange(8)
    return bytes(out)


def by_structure(data: bytes, rng: Random) -> bytes:
    """Words, numbers and signs of the text exchanged for others, repeated, or left out."""
    words = re.findall(rb"[A-Za-z_.]+|[-+]?\d[\d.eE]*|\s+|.", data, re.DOTALL)
    for _ in range(rng.randint(1, 3)):
        i, j = rng.randrange(len(words)), rng.randrange(len(words))
        kind = rng.randrange(6)
        numbers = [k for k, word in enumerate(words) if word[-1:].isdigit()]
        if kind < 2 and numbers:
            words[rng.choice(numbers)] = rng.choice(NUMBERS)
        elif kind == 2:
            words[i], words[j] = words[j], words[i]
        elif kind == 3:
            words[i:i] = words[i : i + rng.randint(1, 12)] * rng.choice((1, 1, 30))
        elif kind == 4:
            del words[i : i + rng.randint(1, 12)]
        elif numbers:
            words[rng.choice(numbers)] = words[rng.choice(numbers)]
        words = words or [b"x"]
    return b"".join(words)


NAMES = [*TEXTS, "a.kicad_pcb", "a.dxf", "a.yaml", "a.png", "a.gif", "a.bmp", "a.jpg"]


@pytest.mark.parametrize("name", NAMES)
def test_the_samples_are_read(tmp_path: Path, name: str) -> None:
    path = sample(tmp_path, name)
    options = {"start": (1000, 1000)} | ({"border": "open"} if name == "a.map" else {})
    options |= {"flatten": 1} if name == "curves.svg" else {}
    try:
        assert xa.load(path, **options).obstacles
    except xa.InvalidScene as error:  # the start lies outside the wall: the file itself is read
        assert name == "a.environment" and "start" in str(error)


@pytest.mark.parametrize("mutate", [by_bytes, by_structure])
@pytest.mark.parametrize("name", NAMES)
def test_damaged_files_end_in_one_line(
    tmp_path: Path, name: str, mutate: Callable[[bytes, Random], bytes], capfd: pytest.CaptureFixture[str]
) -> None:
    path = sample(tmp_path, name)
    data, rng = path.read_bytes(), Random(f"{name} {mutate.__name__}")
    known = next(f for f in xa.formats() if path.suffix in f.suffixes)
    count = COUNT // 4 if name == "a.dxf" else COUNT // 2
    refused = 0
    for n in range(count):
        damaged = mutate(data, rng)
        path.write_bytes(damaged)
        options = {o.name: o.choices[n % len(o.choices)] for o in known.options if o.choices}
        options |= {"flatten": 1, "thicken": n % 2 + 1} if name == "curves.svg" else {}
        start = rng.choice([None, (1000, 1000), (3, "7/2"), (0, 0)])
        begun = time.process_time()
        try:
            xa.load(path, start=start, **options)
        except xa.ExactacqError as error:
            refused += 1
            assert "\n" not in str(error), damaged
        except Exception as error:
            error.add_note(f"{n}: {damaged!r}, {start}, {options}")
            raise
        assert time.process_time() - begun < SECONDS, damaged
    assert refused, "no mutation did harm: the test is void"
    assert capfd.readouterr() == ("", "")
