"""A campaign as one Parquet table, for data frames; needs pyarrow, an optional part of exactacq."""

from __future__ import annotations

import os
from importlib import import_module
from typing import Any

from exactacq.files.extras import installing
from exactacq.files.whole_files import write_whole
from exactacq.study.campaign.settings import CampaignError
from exactacq.study.campaign.store import Store

SUFFIXES = (".parquet",)
"""File types of tables."""
COLUMNS = {
    "strategy": "string", "seed": "int64", "result": "string", "seconds": "float64", "length": "float64",
    "claim": "string", "statement": "string", "called": "string", "outcome": "string", "ratio": "float64",
    "detail": "string",
}  # fmt: skip
"""A row is what one scene says of one statement; a scene that says nothing has one row, without a claim."""


def arrow() -> Any:
    """The library pyarrow; `CampaignError` if it is not installed."""
    try:
        return import_module("pyarrow")
    except ImportError:
        raise CampaignError(f"--export needs pyarrow: {installing('parquet')}") from None


def export(store: Store, path: str | os.PathLike[str]) -> int:
    """Write all findings, with the campaign's settings as metadata; the number of rows.

    The file is written whole or not at all. Raises `CampaignError` without pyarrow, `OSError`.
    """
    pa = arrow()
    rows = store.rows(
        "SELECT s.strategy, s.seed, s.outcome, s.seconds, s.length, f.claim, f.statement, t.called,"
        " f.outcome, f.ratio, coalesce(f.detail, s.detail) FROM scenes s"
        " LEFT JOIN findings f ON s.strategy = f.strategy AND s.seed = f.seed"
        " LEFT JOIN statements t ON f.claim = t.claim AND f.statement = t.statement ORDER BY 2, 1, 6, 7"
    )
    settings = dict(store.rows("SELECT key, value FROM campaign"))
    schema = pa.schema([(name, getattr(pa, kind)()) for name, kind in COLUMNS.items()], metadata=settings)
    columns = [list(column) for column in zip(*rows, strict=True)] or [[] for _ in COLUMNS]
    table = pa.table(columns, schema=schema)
    sink = pa.BufferOutputStream()
    import_module("pyarrow.parquet").write_table(table, sink)
    write_whole(path, sink.getvalue().to_pybytes())
    return len(rows)
