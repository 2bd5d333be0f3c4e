"""The options of all file formats, as the registry has them, for the commands that read a scene."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Annotated, Any, TypeVar

import typer

from exactacq.cli.completion import among
from exactacq.errors import FormatError
from exactacq.files.formats import FileOption, formats, options

Command = TypeVar("Command", bound=Callable[..., None])
PANEL = "How the file is read"


def reads_files(command: Command) -> Command:
    """Give a command, whose last parameter is ``**options``, an option for each that a format has."""
    signature = inspect.signature(command, eval_str=True)
    own = [p for p in signature.parameters.values() if p.kind is not inspect.Parameter.VAR_KEYWORD]
    added = [
        inspect.Parameter(
            option.name,
            inspect.Parameter.KEYWORD_ONLY,
            default=False if option.kind == "flag" else None,
            annotation=_annotation(option),
        )
        for option in options().values()
    ]
    vars(command)["__signature__"] = signature.replace(parameters=[*own, *added])
    for parameter in added:
        command.__annotations__[parameter.name] = parameter.annotation
    return command


def _annotation(option: FileOption) -> Any:
    owners = ", ".join(known.name for known in formats() if option in known.options)
    text = f"{option.help} ({owners})"
    if option.kind == "flag":
        return Annotated[bool, typer.Option(f"--{option.name}", help=text, rich_help_panel=PANEL)]
    metavar = {"number": "N", "names": "A,B", "choice": "|".join(option.choices)}[option.kind]
    offered = among(option.choices) if option.kind == "choice" else None
    return Annotated[
        str | None,
        typer.Option(metavar=metavar, help=text, rich_help_panel=PANEL, autocompletion=offered),
    ]


def read_from_text(values: Mapping[str, Any]) -> dict[str, object]:
    """The options that a command line gave, as `exactacq.load` takes them; an error names ``--option``."""
    found = {}
    for name, value in values.items():
        option = options()[name]
        if value is None or value is False:
            continue
        try:
            found[name] = option.checked(value if value is True else option.of_text(value))
        except FormatError as error:
            raise FormatError(f"--{error}") from None
    return found
