"""The command line as a whole: its commands, and what an error becomes."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from importlib.metadata import version
from io import StringIO
from typing import Annotated

import typer

from exactacq.cli.check import check
from exactacq.cli.compare import compare
from exactacq.cli.convert import convert
from exactacq.cli.explore import explore
from exactacq.cli.gallery import gallery
from exactacq.cli.isovist import isovist
from exactacq.cli.manual import epilog, statuses
from exactacq.cli.path import path
from exactacq.cli.play import play
from exactacq.errors import ExactacqError, InvalidScene, Undecided
from exactacq.study.campaign.command import verify
from exactacq.study.search.command import search

REFUSED, INTERNAL, UNDECIDED, INTERRUPTED = 2, 1, 3, 130
"""Exit statuses; `exactacq.cli.manual.STATUSES` has their words."""
VIOLATIONS = 3
"""Most violations of a scene that the one line of an error names."""
UsageError: type[Exception] = typer.BadParameter.__bases__[0]
"""What typer raises for a wrong command line; where it lives depends on typer's release."""

app = typer.Typer(
    name="exactacq",
    help="Exact sensor-based terrain acquisition. Numbers are exact: 10, 0.1 or 21/2.",
    epilog=statuses(),
    pretty_exceptions_enable=False,
)


def _print_version(asked: bool) -> None:
    if asked:
        from exactacq.kernel import DESCRIPTION

        print(f"exactacq {version('exactacq')} ({DESCRIPTION})")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _top(
    context: typer.Context,
    _: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        print(context.get_help())


for command in (explore, compare, play, check, gallery, convert, isovist, path, verify, search):
    # A point may begin with a minus sign, so it must not be taken for an option that there is not.
    settings = {"ignore_unknown_options": command is path}
    app.command(epilog=epilog(command.__name__), context_settings=settings)(command)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line (default: the process's own) and return its exit status; never raises."""
    for name in ("stdout", "stderr"):
        if (stream := getattr(sys, name)) is None:  # It was closed before the process began.
            setattr(sys, name, StringIO())
        elif hasattr(stream, "reconfigure"):  # Names of files and obstacles may be beyond the encoding.
            stream.reconfigure(errors="backslashreplace")
    try:
        status = _perform(arguments)
        sys.stdout.flush()
    except (KeyboardInterrupt, typer.Abort):
        status = INTERRUPTED
    except BrokenPipeError:  # The reader has seen enough; spare the interpreter its own flush.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return REFUSED
    except Undecided as error:
        return _refuse(_one_line(error), UNDECIDED)
    except (ExactacqError, UsageError, OSError) as error:
        return _refuse(_one_line(error), REFUSED)
    except Exception as error:
        if isinstance(error, ImportError) and error.name == "exactacq.kernel":
            return _refuse(_one_line(error), REFUSED)
        if sys.flags.dev_mode:
            raise
        fault = f"internal error, please report it ({type(error).__name__}: {_one_line(error)})"
        return _refuse(f"{fault}; python -X dev -m exactacq shows where", INTERNAL)
    if status == INTERRUPTED:  # Raised, or returned: typer's releases differ.
        return _refuse("interrupted", INTERRUPTED)
    return status if isinstance(status, int) else 0


def _perform(arguments: Sequence[str] | None) -> object:
    """Run a command, or tell a shell how to complete one; the status, if typer returns one."""
    try:
        return app(args=arguments, prog_name="exactacq", standalone_mode=False)
    except (
        SystemExit
    ) as end:  # Typer ends so after completing, and with a code if the reader has seen enough.
        if end.code:
            raise BrokenPipeError from None
        return 0


def _one_line(error: BaseException) -> str:
    """What is wrong, on one line."""
    if isinstance(error, UsageError) and hasattr(error, "format_message"):
        text = error.format_message().replace("Value error, ", "", 1)  # Some releases of typer say so.
    elif isinstance(error, InvalidScene) and len(error.violations) > VIOLATIONS:
        shown = "; ".join(error.violations[:VIOLATIONS])
        more = len(error.violations) - VIOLATIONS
        text = f"{len(error.violations)} violations: {shown}; and {more} more, all told by exactacq check"
        text += f"; {error.cure}" if error.cure else ""
    elif isinstance(error, OSError) and error.strerror is not None:
        place = "" if error.filename is None else f"{error.filename}: "
        text = f"{place}{error.strerror}"
    else:
        text = str(error) or type(error).__name__
    return " ".join(text.split())


def _refuse(line: str, status: int) -> int:
    print(f"exactacq: {line}", file=sys.stderr)
    return status
