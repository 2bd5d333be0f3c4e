"""The command ``exactacq convert``; what it needs is imported when it runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from exactacq.cli.arguments import Start, check_outputs, naming, number_of, scene_of
from exactacq.cli.completion import scenes
from exactacq.cli.options import read_from_text, reads_files
from exactacq.errors import FormatError
from exactacq.files.formats import written_suffixes

if TYPE_CHECKING:
    from exactacq.scene.scene import Scene
    from exactacq.strategies.run import Run


@reads_files
def convert(
    source: Annotated[
        str, typer.Argument(metavar="IN", help="A scene, or a run that --trace wrote.", autocompletion=scenes)
    ],
    target: Annotated[str, typer.Argument(metavar="OUT", help=f"A file: {', '.join(written_suffixes())}.")],
    start: Start = None,
    at: Annotated[
        str | None, typer.Option(metavar="L", help="Of a run: as it was after this length of the path.")
    ] = None,
    only: Annotated[
        str | None, typer.Option(metavar="A,B", help="Kinds of things to write, as path,links; default: all.")
    ] = None,
    **options: Any,
) -> None:
    """Write a scene or a run in another format; say how far any point moved at most."""
    from exactacq.output.report import console, remarks_report
    from exactacq.output.results import write
    from exactacq.output.run_json import is_run_file, load_run

    length = None if at is None else number_of("--at", at)
    kinds = None if only is None else [kind.strip() for kind in only.split(",")]
    check_outputs(source, (target, written_suffixes()))
    given = read_from_text(options)
    subject: Run | Scene
    if is_run_file(source):
        if start is not None or given:
            raise FormatError(f"{source}: a run takes no options for reading scenes; leave them out")
        subject = load_run(source)
    elif at is not None:
        raise FormatError("--at: names a moment of a run; give a run that explore --trace wrote")
    else:
        subject = scene_of(source, start, options)
    remarks = naming("--at", lambda: write(subject, target, at=length, only=kinds))
    out = console()
    out.print(f"{target} written", soft_wrap=True)
    out.print(remarks_report(remarks))
