"""``python -m exactacq`` and the console script: control-C is heard before the command line is imported."""

import sys

INTERRUPTED = 130


def main() -> int:
    """Run the process's command line and return its exit status.

    Imports may swallow a KeyboardInterrupt, so while they run control-C ends the process at once: nothing
    is begun yet. Afterwards it is an exception, so that no file stays half-written; when all is done it is
    ignored. A process that was started with control-C ignored, as in the background, goes on ignoring it.
    """
    try:
        from signal import SIG_IGN, SIGINT, default_int_handler, getsignal, signal

        heard = getsignal(SIGINT) is default_int_handler
        if heard:
            signal(SIGINT, lambda *_: _leave())
        from exactacq.cli import main as run

        if heard:
            signal(SIGINT, default_int_handler)
        status = run()
        if heard:
            signal(SIGINT, SIG_IGN)
    except KeyboardInterrupt:
        _leave()
    exec("")  # CPython dies of an interrupt that has passed an `exec` of text, unless another one went well.
    return status


def _leave() -> None:
    """End the process, whatever it is at."""
    from os import _exit, write

    write(2, b"exactacq: interrupted\n")
    _exit(INTERRUPTED)


if __name__ == "__main__":
    sys.exit(main())
