"""Thousands of hostile files of each format, read by a process of limited memory and time.

``python tests/fuzz_files.py WAY NAME [COUNT [FIRST]]`` reads files from the first one on and tells how each
kind of outcome was met, which were slowest, and each that did not end as it must: read, or refused by an
`ExactacqError` whose message is one line. ``NAME`` may be "all". ``WAY`` says how samples are changed: by
"bytes" as in `hostile_files`, by "structure" as in `hostile_structures`.
"""

from __future__ import annotations

import faulthandler
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

MEMORY = 1536 << 20
"""Bytes of address space that the reading process may take."""
SECONDS = 10
"""Most processor time for one file."""
PATIENCE = 60
"""Seconds after which the reading process is ended, on a busy machine too."""


LONGEST = 1000
"""Most characters of a message; that of an invalid scene lists all violations."""


def work(way: str, name: str, first: int, end: int) -> None:
    """Read files from *first* to *end*, and tell of each by one line of JSON."""
    from hostile_files import hostile, kinds, put, read
    from hostile_structures import structured

    import exactacq as xa

    kind, made = kinds()[name], {"bytes": hostile, "structure": structured}[way]
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    with tempfile.TemporaryDirectory() as folder:
        for n in range(first, end):
            data, options = made(kind, n, name)
            path = put(kind, Path(folder), data)
            faulthandler.dump_traceback_later(PATIENCE, exit=True)
            begun, told = time.process_time(), ""
            try:
                read(name, path, options)
                outcome = "read"
            except xa.ExactacqError as error:
                is_refused, told = isinstance(error, xa.FormatError), str(error)
                outcome = "FormatError" if is_refused else type(error).__name__
                long = len(told) > LONGEST and outcome == "FormatError"
                if "\n" in told or not told.strip() or long:
                    outcome = "FLAW of the message"
            except BaseException as error:
                outcome, told = f"FLAW {type(error).__name__}", str(error)[:300]
            seconds = time.process_time() - begun
            faulthandler.cancel_dump_traceback_later()
            if seconds > SECONDS:
                outcome = "FLAW too slow"
            flawed = outcome not in ("read", "FormatError", "InvalidScene", "Undecided")
            row = {"n": n, "outcome": outcome, "seconds": seconds, "told": told[:300] if flawed else ""}
            print(json.dumps(row), flush=True)


def fuzz(way: str, name: str, count: int, first: int = 0) -> int:
    """Read *count* files of a format; returns how many ended otherwise than they must."""
    outcomes: Counter[str] = Counter()
    slowest: list[tuple[float, int]] = []
    flaws = 0
    n, end = first, first + count
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONWARNINGS": "error"}
    while n < end:
        command = [sys.executable, __file__, "--work", way, name, str(n), str(end)]
        done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
        for line in done.stdout.splitlines():
            row = json.loads(line)
            n = row["n"] + 1
            outcomes[row["outcome"]] += 1
            slowest = sorted([*slowest, (row["seconds"], row["n"])], reverse=True)[:5]
            if row["told"] or row["outcome"].startswith("FLAW"):
                flaws += 1
                print(f"{way} {name} {row['n']}: {row['outcome']}: {row['told']}", flush=True)
        if done.returncode or done.stderr.strip():
            lines = done.stderr.strip().splitlines()
            print(
                f"{way} {name} {n}: the process said ({done.returncode}):",
                *lines[:12],
                sep="\n  ",
                flush=True,
            )
            flaws += 1
            n += bool(done.returncode)
    times = ", ".join(f"{seconds:.2f} s (no. {k})" for seconds, k in slowest)
    print(f"{way} {name}: {dict(outcomes)}; slowest {times}; {flaws} flaws", flush=True)
    return flaws


if __name__ == "__main__":
    if sys.argv[1] == "--work":
        work(*sys.argv[2:4], *map(int, sys.argv[4:]))
    else:
        from hostile_files import kinds

        way, chosen, *words = sys.argv[1:]
        names = list(kinds()) if chosen == "all" else [chosen]
        numbers = [int(word) for word in words] or [10_000]
        sys.exit(bool(sum(fuzz(way, name, *numbers) for name in names)))
