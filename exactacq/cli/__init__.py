"""The command line. Errors are one line on standard error and exit status 2; files are written whole.

What a command needs is imported when it runs: help and refusals of wrong options wait for none of it.
"""

from exactacq.cli.entry import app, main

__all__ = ["app", "main"]
