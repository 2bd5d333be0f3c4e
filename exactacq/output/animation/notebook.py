"""A run to be played in a notebook: the animated page, in a frame of its own."""

from __future__ import annotations

import os
from html import escape

from exactacq.cached import cached_property
from exactacq.files.whole_files import PAGES, check_output, write_whole
from exactacq.output.animation.frames import frames_of
from exactacq.output.animation.page import page
from exactacq.output.vocabulary import Labels
from exactacq.progress import Progress
from exactacq.strategies.run import Run

HEIGHT = 640
"""Height of the frame in a notebook, in pixels: drawing and controls are in sight together."""


class Player:
    """The page that plays a run, as `Run.animate` gives it; made when it is first shown, read or saved.

    *labels* are as in figures; *progress* is told how many of how many frames are done. Cost: a map and a
    view for each place where something happens, and for some between them.

    >>> import exactacq as xa
    >>> player = xa.sightseer(xa.load("circles")).animate()
    >>> player.html[:15]
    '<!doctype html>'
    """

    def __init__(
        self, run: Run, *, labels: Labels | str = Labels.ALL, progress: Progress | None = None
    ) -> None:
        self.run, self._labels, self._progress = run, Labels(labels), progress

    @cached_property
    def html(self) -> str:
        """The page, which needs nothing else. `FormatError` for a scene that is too small where it lies."""
        return page(self.run, frames_of(self.run, progress=self._progress), labels=self._labels)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page to an .html file, whole or not at all. `FormatError` for another suffix."""
        target = check_output(path, PAGES)
        write_whole(target, self.html.encode())

    def _repr_html_(self) -> str:
        """A frame that holds the page. Scripts run in it, but it cannot reach the notebook around it."""
        return (
            f'<iframe srcdoc="{escape(self.html)}" sandbox="allow-scripts" title="{escape(repr(self.run))}" '
            f'style="width: 100%; height: {HEIGHT}px; border: 0"></iframe>'
        )

    def __repr__(self) -> str:
        return f"<Player of {self.run!r}>"
