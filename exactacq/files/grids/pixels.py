"""The pixels of an image file: PGM by a reader of its own, PNG, BMP, GIF and JPEG by pillow."""

from __future__ import annotations

import re
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any
from warnings import catch_warnings

import numpy as np
from numpy.typing import NDArray

from exactacq.errors import FormatError
from exactacq.files.extras import extra
from exactacq.files.grids.outlines import check_cells
from exactacq.files.source import one_line, read_bytes

KINDS = ("PNG", "BMP", "GIF", "JPEG")
"""What pillow is asked to read."""
MAX_HEADER = 1 << 16
"""Longest header of a PGM, comments included."""
MAX_PLAIN = 1 << 22
"""Most pixels of a PGM whose numbers are text."""
_HEADER = re.compile(rb"P([25])" + 3 * rb"(?:\s+(?:#[^\n]*\n\s*)*)(\d{1,9})" + rb"\s")
"""One blank ends it: a # after that is a pixel, or begins a comment among the numbers of a P2."""


@dataclass(frozen=True, slots=True)
class Pixels:
    """Brightness of each pixel, 0 to *most*, rows from the top down, and which pixels are see-through."""

    values: NDArray[np.int32]
    most: int
    clear: NDArray[np.bool_] | None = None


def read_pixels(path: Path) -> Pixels:
    """The pixels of an image; the brightness of colours is the sum of red, green and blue.

    Raises `FormatError` for what is no image, or for one of too many pixels, before these are unpacked.
    """
    data = read_bytes(path)
    return _pgm(data) if data[:2] in (b"P2", b"P5") else _pillow(data)


def _pgm(data: bytes) -> Pixels:
    header = _HEADER.match(data[:MAX_HEADER])
    if header is None:
        raise FormatError("not a PGM image (P2 or P5, width, height, most); save it again")
    width, height, most = (int(number) for number in header.groups()[1:])
    check_cells(width, height)
    if not 0 < most < 1 << 16:
        raise FormatError(f"a PGM image whose brightest value is {most}; it is 1 to 65535")
    body = data[header.end() :]
    if header[1] == b"2":
        values = _plain(body, width * height)
    else:
        kind = np.dtype(">u2" if most > 255 else "u1")
        if len(body) < width * height * kind.itemsize:
            raise FormatError(f"a PGM image of {width} x {height} pixels is truncated; save it again")
        values = np.frombuffer(body, kind, width * height)
    if int(values.max()) > most:
        raise FormatError(f"a PGM image with a value of {int(values.max())}, above its most of {most}")
    return Pixels(values.reshape(height, width).astype(np.int32), most)


def _plain(body: bytes, number: int) -> NDArray[np.int32]:
    """The numbers of a PGM in text."""
    if number > MAX_PLAIN:
        raise FormatError(
            f"{number} pixels in text are more than the {MAX_PLAIN} that are read; save it as P5"
        )
    words = re.sub(rb"#[^\n]*", b"", body).split(maxsplit=number)[:number]
    if len(words) < number or not all(word.isdigit() and len(word) < 6 for word in words):
        raise FormatError(f"a PGM image without {number} values that are numbers; save it again")
    return np.array(words, dtype="S5").astype(np.int32)


def _pillow(data: bytes) -> Pixels:
    library: Any = extra("PIL.Image", "images")
    try:
        with catch_warnings(action="error"), library.open(BytesIO(data), formats=KINDS) as image:
            check_cells(*image.size)
            if image.mode.startswith("I") or image.mode == "F":
                raise FormatError(f"an image of mode {image.mode}; save it with 8 bits a channel")
            see_through = "A" in image.getbands() or "transparency" in image.info
            array = np.asarray(image.convert("RGBA" if see_through else "RGB"))
    except FormatError:
        raise
    except library.UnidentifiedImageError:  # its message names an object of Python
        raise FormatError(
            "not a readable image (of no known kind, or damaged); save it as PNG or PGM"
        ) from None
    except Exception as error:  # decoders meet damage in many ways: OSError, ValueError ...
        raise FormatError(f"not a readable image ({one_line(error)}); save it as PNG or PGM") from None
    clear = array[:, :, 3] == 0 if see_through else None
    return Pixels(array[:, :, :3].sum(axis=2, dtype=np.int32), 3 * 255, clear)
