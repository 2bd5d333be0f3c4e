"""Work in a process of its own, timed in loops of 10 million additions of integers in plain Python."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from os import environ, pathsep
from pathlib import Path
from typing import NamedTuple

MEASURE = """
import json, resource, time
import exactacq as xa
from exactacq.files.octagons import random_octagons

def loop():
    start, total = time.process_time(), 0
    for k in range(10_000_000):
        total += k
    return time.process_time() - start

{make}
xa.sightseer(random_octagons(2, 1), radius=3)
before = loop()
start = time.process_time()
done = {work}
spent = time.process_time() - start
most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(json.dumps([2 * spent / (before + loop()), spent, most, str(done)]))
"""
HERE = {"PYTHONPATH": pathsep.join([str(Path(__file__).parent), environ.get("PYTHONPATH", "")])}
"""The programs import modules beside this one."""


class Measured(NamedTuple):
    """CPU time in loops and in seconds, the most memory that the process held, and what came of it."""

    loops: float
    seconds: float
    megabytes: float
    result: str


def measured(benchmark: object, make: str, work: str, wish: Mapping[str, str] | None = None) -> Measured:
    """The cost of an expression after some statements; the loop is timed before and after it."""
    program = MEASURE.replace("{make}", make).replace("{work}", work)
    answer = benchmark.pedantic(
        subprocess.run,
        ([sys.executable, "-c", program],),
        {"capture_output": True, "check": True, "env": {**environ, **HERE, **(wish or {})}},
        rounds=1,
    )
    return Measured(*json.loads(answer.stdout))
