"""The command ``exactacq check``; what it needs is imported when it runs."""

from __future__ import annotations

import sys
from typing import Any

from exactacq.cli.arguments import AsJson, SceneName, Start, scene_of
from exactacq.cli.file_options import reads_files


@reads_files
def check(
    scene: SceneName,
    start: Start = None,
    as_json: AsJson = False,
    **options: Any,
) -> None:
    """Validate a scene; print its contents and what the import did."""
    from exactacq.output.report import console, scene_report
    from exactacq.output.report_data import scene_data, text_of

    world = scene_of(scene, start, options)
    if as_json:
        sys.stdout.write(text_of(scene_data(world)))
    else:
        console().print(scene_report(world))
