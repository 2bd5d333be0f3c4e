"""The command ``exactacq play``; what it needs is imported when it runs."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from exactacq.cli.arguments import Start, place_of
from exactacq.cli.completion import scenes
from exactacq.cli.options import read_from_text, reads_files


@reads_files
def play(
    scene: Annotated[
        str | None,
        typer.Argument(
            metavar="[SCENE]",
            help="A file, or the name of a gallery scene, to begin with.",
            autocompletion=scenes,
        ),
    ] = None,
    start: Start = None,
    port: Annotated[
        int, typer.Option(min=0, max=65535, metavar="N", help="Port of the page; default: one that is free.")
    ] = 0,
    ipv6: Annotated[bool, typer.Option("--ipv6", help="Serve at [::1] in place of 127.0.0.1.")] = False,
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")
    ] = True,
    seconds: Annotated[
        float, typer.Option(min=1, max=86400, metavar="T", help="Seconds that a run may take.")
    ] = 300.0,
    memory: Annotated[
        int,
        typer.Option(
            min=512, max=1 << 20, metavar="MB", help="Megabytes that each process may take (Linux)."
        ),
    ] = 2048,
    **options: Any,
) -> None:
    """Draw a scene in the browser, and watch the robot explore it; control-C ends it.

    The page is served to this machine alone, at an address that is printed and holds a secret.

    It needs the package installed with the extra play.
    """
    from exactacq.play.api import Limits
    from exactacq.play.scenes import opened
    from exactacq.play.server import serve

    place = None if start is None else place_of("--start", start)
    first = None if scene is None else opened(scene, place, read_from_text(options))
    serve(first, port=port, ipv6=ipv6, browser=browser, limits=Limits(seconds, memory))
