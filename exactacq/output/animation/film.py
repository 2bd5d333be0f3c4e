"""A run as a film: GIF by pillow, MP4 by ffmpeg; frames are the figures of moments at equal distances.

All frames show the same rectangle and one scale of colours. They are aligned at the top, where the drawing
begins; below it the legend grows with what there is to be seen.
"""

from __future__ import annotations

import io
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from exactacq.errors import FormatError, Undecided
from exactacq.files.extras import extra
from exactacq.files.whole_files import FILMS, check_output, write_whole
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import rational
from exactacq.output.figures.draw import png
from exactacq.output.vocabulary import Labels, colours, rgb
from exactacq.progress import Progress
from exactacq.sensing.event import Event
from exactacq.strategies.run import Run

FRAMES, FEWEST = 120, 24
"""Most and least frames of a run."""
LIGHT = 400
"""With more edges than this a film has fewer frames, so that its time stays that of a minute or two: a frame
takes a quarter of a second, and a map and a figure cost in proportion to the edges."""
DOTS = 80
"""Dots per inch: films are up to 670 dots wide and 850 high, side by side with what the figure says."""
PER_SECOND, LAST = 10, 2.5
"""Frames in a second, and how many seconds the last one stands."""
COLOURS = 256
"""Of a GIF: all frames share those chosen for one in the middle beside the last."""
SHORT = 4
"""Digits of a length after those of the whole one's first: titles stay readable."""
PAPER = (255, 255, 255)


def check_film(path: str | os.PathLike[str]) -> Path:
    """The path, if a film can be written there; `FormatError` otherwise, also if a tool is missing.

    To be called before the run is made.
    """
    target = check_output(path, FILMS)
    extra("PIL", "images")
    if target.suffix.lower() == ".mp4":
        _ffmpeg()
    return target


def film(
    run: Run,
    path: str | os.PathLike[str],
    progress: Progress | None = None,
    *,
    labels: Labels | str = Labels.ALL,
) -> int:
    """Write a film of a run to a .gif or .mp4 file, whole or not at all; the number of frames left out.

    These are moments whose map or view is beyond the library's limits. *progress* is told how many frames of
    how many are drawn; *labels* are as in figures. Raises `FormatError` as `check_film`, and `Undecided` if
    no frame is left. Cost: a map, a view and a figure for each of at most `FRAMES` frames; a megabyte of
    memory for each.

    >>> from tempfile import TemporaryDirectory
    >>> import exactacq as xa
    >>> still = xa.sightseer(xa.Scene([], start=(0, 0), radius=1))
    >>> with TemporaryDirectory() as folder:
    ...     film(still, folder + "/run.gif", lambda done, count: print(done, "of", count))
    1 of 1
    0
    """
    target, choice = check_film(path), Labels(labels)
    wanted = moments(run)
    pictures, trouble = [], None
    for number, at in enumerate(wanted, 1):
        try:
            pictures.append(_picture(run, at, choice))
        except Undecided as error:
            trouble = error
        if progress is not None:
            progress(number, len(wanted))
    if trouble is not None and not pictures:
        raise trouble
    frames = _of_one_size(pictures)
    if target.suffix.lower() == ".gif":
        write_whole(target, _gif(frames))
    else:
        _mp4(frames, target)
    return len(wanted) - len(pictures)


def moments(run: Run) -> Sequence[Length | Event]:
    """What the frames show: the start, lengths at about equal distances as short decimals, the last event."""
    total, last = float(run.length), run.events[-1]
    if not total:
        return [last]
    edges = sum(len(obstacle.edges) for obstacle in run.scene.obstacles)
    count = max(FEWEST, min(FRAMES, FRAMES * LIGHT // max(edges, 1)))
    places = max(0, SHORT - int(f"{total:e}".partition("e")[2]))
    lengths = (f"{total * k / (count - 1):.{places}f}" for k in range(count - 1))
    return [*(Length(rational(length)) for length in lengths), last]


def _picture(run: Run, at: Length | Event, labels: Labels) -> Any:
    image: Any = extra("PIL.Image", "images")
    return image.open(io.BytesIO(png(run, at, labels, DOTS))).convert("RGB")


def _of_one_size(pictures: Sequence[Any]) -> list[Any]:
    """The pictures on papers of one even size, aligned at the top."""
    image = extra("PIL.Image", "images")
    wide, high = (max(picture.size[k] for picture in pictures) for k in (0, 1))
    size = wide + wide % 2, high + high % 2
    papers = []
    for picture in pictures:
        paper = image.new("RGB", size, PAPER)
        paper.paste(picture, ((size[0] - picture.size[0]) // 2, 0))
        papers.append(paper)
    return papers


def _gif(frames: Sequence[Any]) -> bytes:
    image = extra("PIL.Image", "images")
    (wide, high), middle = frames[-1].size, frames[len(frames) // 2]
    both = image.new("RGB", (2 * wide, high))
    both.paste(middle, (0, 0))
    both.paste(frames[-1], (wide, 0))
    # By coverage, not by area: small marks keep their colours, and those of the vocabulary stay as they are.
    own = [number for colour in colours().values() for number in rgb(colour)]
    palette = both.quantize(COLOURS - len(own) // 3, method=image.Quantize.MAXCOVERAGE)
    palette.putpalette(palette.getpalette()[: 3 * COLOURS - len(own)] + own)
    first, *others = (frame.quantize(palette=palette, dither=0) for frame in frames)
    steps = [1000 // PER_SECOND] * len(others)
    out = io.BytesIO()
    stands = [*steps, int(1000 * LAST)]
    first.save(out, "GIF", save_all=True, append_images=others, duration=stands, loop=0, disposal=1)
    return out.getvalue()


def _mp4(frames: Sequence[Any], target: Path) -> None:
    wide, high = frames[0].size
    form = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{wide}x{high}", "-r", str(PER_SECOND), "-i", "-"]
    made = ["-an", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-map_metadata", "-1", "-bitexact"]
    with tempfile.TemporaryDirectory(prefix=".exactacq-", dir=target.parent) as folder:
        draft = Path(folder) / "film.mp4"
        command = [_ffmpeg(), "-loglevel", "error", "-y", *form, *made, str(draft)]
        done = subprocess.run(command, input=b"".join(_raw(frames)), capture_output=True, check=False)
        if done.returncode or not draft.exists():
            reason = done.stderr.decode(errors="replace").strip().splitlines() or ["no reason given"]
            raise FormatError(f"{target}: ffmpeg fails ({reason[-1][:120]}); write a .gif")
        write_whole(target, draft.read_bytes())


def _raw(frames: Sequence[Any]) -> Iterator[bytes]:
    for frame in frames:
        yield frame.tobytes()
    yield from [frames[-1].tobytes()] * int(PER_SECOND * LAST)


def _ffmpeg() -> str:
    found = shutil.which("ffmpeg")
    if found is None:
        raise FormatError("a .mp4 needs the program ffmpeg: install it, or write a .gif")
    return found
