"""Sends hostile requests to a server, faults or not: ``python tests/play/fuzz_requests.py COUNT [FIRST]``.

It prints how many of them got which answer, the one that took longest, and each fault with its number.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from urllib.parse import urlsplit

sys.path[:0] = [str(Path(__file__).parents[1])]

from hostile_requests import attack  # noqa: E402
from test_play_hostile import PATIENCE, answer, check, good, httpx, saved, started, written  # noqa: E402

TOLD = 500
"""After so many requests it says how far it is."""


def sent(count: int, first: int = 0) -> tuple[Counter[int], dict[int, str], float]:
    """The answers by their status (0: none, and none need be), the faults, and the most seconds one took."""
    kinds: Counter[int] = Counter()
    faults: dict[int, str] = {}
    longest = 0.0
    with tempfile.TemporaryDirectory() as place, httpx.Client(timeout=PATIENCE) as client:
        folder = Path(place)
        with started(folder) as server:
            parts = urlsplit(server.address)
            token = parts.path.strip("/")
            for n in range(first, first + count):
                request = attack(n, parts.netloc, token)
                began = time.monotonic()
                try:
                    status, body, headers = answer(server, request)
                    longest = max(longest, time.monotonic() - began)
                    kinds[status] += 1
                    check(request, status, body, headers, request.may_be_answered(parts.netloc, token))
                    if status == 202:
                        saved(server, client, json.loads(body)["number"])
                    good(server, client)
                except Exception as error:
                    faults[n] = f"{type(error).__name__}: {error}"[:600]
                    print(f"request {n}: {faults[n]}\n  {str(request)[:300]}", flush=True)
                if n % TOLD == TOLD - 1:
                    print(f"{n + 1} sent, {len(faults)} faults, {dict(sorted(kinds.items()))}", flush=True)
            print(f"{server.megabytes():.0f} MB, {len(server.processes())} processes")
            written(folder)
        assert not any((folder / "tmp").iterdir())
    return kinds, faults, longest


if __name__ == "__main__":
    kinds, faults, longest = sent(*map(int, sys.argv[1:3]))
    print(f"{dict(sorted(kinds.items()))}, {len(faults)} faults, the longest took {longest:.1f} s")
    sys.exit(bool(faults))
