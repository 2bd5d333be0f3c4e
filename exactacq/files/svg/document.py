"""The elements of an SVG file as a tree, within limits; nothing outside the file is read."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from exactacq.errors import FormatError
from exactacq.files.source import MAX_EDGES, one_line

MAX_ELEMENTS = 2 * MAX_EDGES
"""Most elements of a file, and most that are drawn where some are used again: each takes microseconds."""
MAX_DEPTH = 64
"""Deepest nesting of elements that is followed."""
PROPERTIES = ("display", "visibility", "clip-path", "mask", "transform")
"""What is asked of styles."""


@dataclass(slots=True)
class Element:
    """An element: its kind without a prefix, its attributes, what is in it, and the line where it begins."""

    kind: str
    attributes: dict[str, str]
    line: int
    parts: list[Element] = field(default_factory=list)
    styled: dict[str, str] = field(init=False)
    """What the style attribute says of the `PROPERTIES`."""

    def __post_init__(self) -> None:
        rules = (rule.partition(":") for rule in self.attributes.get("style", "").split(";"))
        named = ((key.strip(), value) for key, _, value in rules)
        self.styled = {
            name: value.replace("!important", "").strip() for name, value in named if name in PROPERTIES
        }

    def style(self, name: str) -> str:
        """The value of one of the `PROPERTIES`, from the style or an attribute of its own; "" if not said."""
        return self.styled.get(name, self.attributes.get(name, "").strip())


def parse(data: bytes) -> Element:
    """The root element of a file.

    Raises `FormatError` with the line for what is no SVG, and for a file that declares an entity: a few of
    them expand to gigabytes.
    """
    parser, builder = expat.ParserCreate(), _Builder()
    parser.StartElementHandler = lambda tag, attributes: builder.begin(
        tag, attributes, parser.CurrentLineNumber
    )
    parser.EndElementHandler = lambda _: builder.stack.pop()
    parser.EntityDeclHandler = _refuse_entity
    # Values that a DTD gives to all elements of a kind say nothing of a drawing, and expand as entities do.
    parser.specified_attributes = True
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        reason = one_line(expat.errors.messages.get(error.code, error))
        raise FormatError(f"line {error.lineno}: not XML ({reason}); export the drawing again") from None
    except FormatError as error:
        raise FormatError(f"line {parser.CurrentLineNumber}: {error}") from None
    except (LookupError, ValueError) as error:  # an encoding that Python does not know
        raise FormatError(f"not XML ({one_line(error)}); save it as UTF-8") from None
    return builder.top.parts[0]


def named(root: Element) -> dict[str, Element]:
    """The elements that have an id; the first one of each."""
    found: dict[str, Element] = {}
    for element in _all(root):
        if element.attributes.get("id"):
            found.setdefault(element.attributes["id"], element)
    return found


def _all(root: Element) -> Iterator[Element]:
    stack = [root]
    while stack:
        element = stack.pop()
        yield element
        stack += reversed(element.parts)


def _refuse_entity(name: str, *_: object) -> None:
    raise FormatError(f"it declares the entity {one_line(repr(name))}; save it without")


class _Builder:
    """The tree, as elements come."""

    def __init__(self) -> None:
        self.top = Element("", {}, 0)
        self.stack, self.count = [self.top], 0

    def begin(self, tag: str, attributes: dict[str, str], line: int) -> None:
        """An element begins."""
        self.count += 1
        if self.count > MAX_ELEMENTS:
            raise FormatError(f"more than {MAX_ELEMENTS} elements; export only the part that matters")
        kind = tag.removeprefix("svg:")
        if len(self.stack) == 1 and kind != "svg":
            raise FormatError(f"not an SVG drawing, but one of {one_line(repr(tag))}")
        if len(self.stack) > MAX_DEPTH:
            raise FormatError(f"elements are nested more than {MAX_DEPTH} deep; flatten the groups")
        element = Element(kind, attributes, line)
        self.stack[-1].parts.append(element)
        self.stack.append(element)
