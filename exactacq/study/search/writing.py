"""Drafts as JSON scenes that are pleasant to read: one obstacle a line, decimals where they are exact."""

from __future__ import annotations

import json

from flint import fmpq

from exactacq.scene.shapes import Circle, Outline, Shape
from exactacq.study.search.drafts import Draft


def scene_text(draft: Draft, name: str | None = None, notes: tuple[str, ...] = ()) -> str:
    """The scene file of a draft, valid or not, as `exactacq.load` reads it."""
    parts = [] if name is None else [f'"name": {_text(name)}']
    if draft.place is not None:
        parts.append(f'"start": {_list(draft.place)}')
    parts.append(f'"radius": {number(draft.radius)}')
    if draft.size is not None:
        parts.append(f'"terrain": {{"width": {number(draft.size[0])}, "height": {number(draft.size[1])}}}')
    parts.append('"obstacles": [\n    ' + ",\n    ".join(map(_shape, draft.shapes)) + "\n  ]")
    if notes:
        parts.append('"notes": [\n    ' + ",\n    ".join(map(_text, notes)) + "\n  ]")
    return "{\n  " + ",\n  ".join(parts) + "\n}\n"


def number(value: fmpq) -> str:
    """A JSON number if the value is a finite decimal, else the string "p/q"."""
    rest, places = int(value.q), 0
    while rest % 10 == 0:
        rest, places = rest // 10, places + 1
    for prime in (2, 5):
        while rest % prime == 0:
            rest, places = rest // prime, places + 1
    if rest != 1:
        return f'"{value.p}/{value.q}"'
    digits = str(abs(int(value.p)) * 10**places // int(value.q)).rjust(places + 1, "0")
    whole, part = digits[: len(digits) - places], digits[len(digits) - places :].rstrip("0")
    return ("-" if value < 0 else "") + whole + (f".{part}" if part else "")


def _shape(shape: Shape) -> str:
    name = "" if shape.name is None else f'"name": {_text(shape.name)}, '
    if isinstance(shape, Circle):
        return f'{{{name}"circle": {{"center": {_list(shape.center)}, "radius": {number(shape.radius)}}}}}'
    rows = [_list(vertex if vertex[2] else vertex[:2]) for vertex in shape.vertices]
    if isinstance(shape, Outline) and not any(vertex[2] for vertex in shape.vertices):
        rows[0] = _list(shape.vertices[0])
    return f'{{{name}"boundary": [{", ".join(rows)}]}}'


def _list(values: tuple[fmpq, ...]) -> str:
    return "[" + ", ".join(map(number, values)) + "]"


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
