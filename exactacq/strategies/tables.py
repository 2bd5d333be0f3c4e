"""What runs say in rows, in floats and words: for data frames and spreadsheets."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from typing import Any, TypeAlias, overload

from exactacq.files.extras import extra
from exactacq.sensing.event import Event

Row: TypeAlias = "dict[str, str | int | float | bool | None]"


SHOWN = 100
"""Rows of a table that a notebook shows."""


class Table(Sequence[Row]):
    """Rows with the same columns, as `Run.event_table` and `Run.bound_table` give them.

    Entries are texts, integers, truth values, floats, or None. A table is a sequence of dicts.

    >>> import exactacq as xa
    >>> table = xa.sightseer(xa.load("circles")).bound_table
    >>> table.columns
    ('name', 'source', 'value', 'closed', 'holds', 'ratio', 'applies')
    >>> len(table), table[0]["closed"]
    (4, '4 + 15*pi')
    """

    def __init__(self, columns: Sequence[str], rows: Iterable[Row]) -> None:
        self.columns, self._rows = tuple(columns), tuple(rows)

    def __len__(self) -> int:
        return len(self._rows)

    @overload
    def __getitem__(self, index: int) -> Row: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Row]: ...
    def __getitem__(self, index: int | slice) -> Row | Sequence[Row]:
        return self._rows[index]

    def __repr__(self) -> str:
        return f"<Table of {len(self)} rows: {', '.join(self.columns)}>"

    def _repr_html_(self) -> str:
        """For notebooks: the first rows as a table; all is text, whatever an obstacle's name contains."""
        head = "".join(f"<th>{escape(name)}</th>" for name in self.columns)
        rows = (_cells(row[name] for name in self.columns) for row in self._rows[:SHOWN])
        body = "".join(f"<tr>{row}</tr>" for row in rows)
        left_out = len(self) - SHOWN
        more = f"<p>and {left_out} rows more</p>" if left_out > 0 else ""
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"

    def to_dicts(self) -> list[Row]:
        """The rows as dicts, which may be changed.

        >>> import exactacq as xa
        >>> [row["kind"] for row in xa.sightseer(xa.load("circles")).event_table.to_dicts()][:3]
        ['start', 'sight', 'hit']
        """
        return [dict(row) for row in self._rows]

    def to_pandas(self) -> Any:
        """The table as a pandas DataFrame; `FormatError` that says what to install without pandas."""
        return extra("pandas", "tables").DataFrame(self.to_dicts(), columns=list(self.columns))

    def to_polars(self) -> Any:
        """The table as a polars DataFrame; `FormatError` that says what to install without polars.

        Columns have the type of their entries; a column without any is one of nulls.
        """
        frame = extra("polars", "tables").DataFrame
        return frame({name: [row[name] for row in self._rows] for name in self.columns}, strict=False)


def _cells(entries: Iterable[str | int | float | bool | None]) -> str:
    texts = ("" if e is None else f"{e:.6g}" if isinstance(e, float) else str(e) for e in entries)
    return "".join(f"<td>{escape(text)}</td>" for text in texts)


EVENTS = (
    "number",
    "kind",
    "obstacle",
    "name",
    "at",
    "x",
    "y",
    "occasion",
    "other",
    "reason",
    "ending",
    "note",
    "why",
)


def event_table(events: Iterable[Event], names: Sequence[str]) -> Table:
    """The events of a run, whose obstacles have these names: see `Run.event_table`."""
    return Table(EVENTS, _event_rows(events, names))


def _event_rows(events: Iterable[Event], names: Sequence[str]) -> Iterator[Row]:
    for number, event in enumerate(events):
        x, y = event.point.xy
        yield {
            "number": number,
            "kind": event.kind.value,
            "obstacle": event.obstacle,
            "name": None if event.obstacle is None else names[event.obstacle],
            "at": float(event.at),
            "x": x,
            "y": y,
            "occasion": None if event.occasion is None else event.occasion.value,
            "other": None if event.other is None else str(event.other),
            "reason": None if event.reason is None else event.reason.value,
            "ending": None if event.ending is None else event.ending.value,
            "note": event.describe(names),
            "why": event.why(names),
        }
