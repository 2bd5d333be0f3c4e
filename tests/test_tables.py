"""Runs as rows and arrays: what other tools take."""

from __future__ import annotations

import json
import math
import sys
from itertools import pairwise
from types import ModuleType

import numpy as np
import pytest
from flint import fmpq

import exactacq as xa
from exactacq.geometry.geo import FLATNESS
from exactacq.sensing.path import Path, Piece


@pytest.fixture(scope="module", params=["sightseer", "seed spreader"])
def run(request: pytest.FixtureRequest) -> xa.Run:
    return (
        xa.sightseer(xa.load("circles"))
        if request.param == "sightseer"
        else xa.seed_spreader(xa.load("case3"))
    )


def test_corners_of_a_path(run: xa.Run) -> None:
    corners = run.path.to_numpy()
    assert corners.tolist() == [list(place) for place in run.path.__geo_interface__["coordinates"]]
    lengths = np.hypot(*np.diff(corners, axis=0).T)
    assert lengths.min() > 0
    assert 1 - FLATNESS < lengths.sum() / float(run.length) <= 1 + 1e-12


@pytest.mark.parametrize("spacing", ["1/3", 0.25, 7, 1000])
def test_waypoints_lie_on_the_path(run: xa.Run, spacing: object) -> None:
    """At a spacing of the path's own length; each is the place that the run knows after that length."""
    poses = run.path.waypoints(spacing)
    step, total = float(xa.Length(spacing)), float(run.length)
    assert len(poses) == math.ceil(total / step) + 1
    assert poses[:-1, 3] == pytest.approx(step * np.arange(len(poses) - 1))
    assert poses[-1, 3] == pytest.approx(total)
    for x, y, heading, at in poses[:: max(1, len(poses) // 7)]:
        place = run.near(min(xa.Length(at), run.length)).point
        assert (x, y) == pytest.approx(place.xy, abs=1e-9)
        assert -math.pi < heading <= math.pi
    x, y = run.path[-1].end.xy
    assert poses[-1, :2] == pytest.approx((x, y))


@pytest.mark.parametrize("pieces, unit, parts", [(30, 10, 100), (50, 3, 1000), (50, 7, 3000)])
def test_the_end_of_a_path_is_one_waypoint(pieces: int, unit: int, parts: int) -> None:
    """In floats 30 tenths are more than 3: what was beyond a whole number of steps was a place too."""
    corners = [xa.Point(fmpq(k, unit), 0) for k in range(pieces + 1)]
    path = Path(Piece("straight", None, xa.Segment(p, q)) for p, q in pairwise(corners))
    poses = path.waypoints(fmpq(1, unit * parts))
    assert len(poses) == pieces * parts + 1
    assert poses[-1].tolist() == [pieces / unit, 0, 0, pytest.approx(pieces / unit)]


def test_headings_are_those_of_travel(run: xa.Run) -> None:
    poses = run.path.waypoints("1/100")
    chords = np.diff(poses[:, :2], axis=0)
    along = np.arctan2(chords[:, 1], chords[:, 0])
    off = np.abs((along - poses[:-1, 2] + math.pi) % (2 * math.pi) - math.pi)
    assert np.median(off) < 0.01 and np.mean(off < 0.02) > 0.95  # corners lie between two places


def test_paths_that_go_nowhere() -> None:
    still = xa.sightseer(xa.Scene([], start=(1, 2), radius=1)).path
    assert len(still) == 0
    assert still.to_numpy().shape == (0, 2) and still.waypoints(1).shape == (0, 4)


def test_spacings_that_make_no_sense(run: xa.Run) -> None:
    for spacing in (0, -1, "1e-9"):
        with pytest.raises(ValueError, match="a spacing is positive and makes at most 10000000 places"):
            run.path.waypoints(spacing)


def test_events_in_rows(run: xa.Run) -> None:
    table = run.event_table
    assert len(table) == len(run.events) and table.columns == tuple(table[0])
    for row, event in zip(table, run.events, strict=True):
        assert (row["kind"], row["obstacle"], row["at"]) == (event.kind, event.obstacle, float(event.at))
        assert (row["x"], row["y"]) == event.point.xy
        assert type(row["kind"]) is str
    assert json.loads(json.dumps(table.to_dicts())) == table.to_dicts()
    assert table[:2] == tuple(table.to_dicts()[:2]) and "rows" in repr(table)


def test_bounds_in_rows(run: xa.Run) -> None:
    for row, bound in zip(run.bound_table, run.bounds, strict=True):
        assert (row["name"], row["holds"], row["value"]) == (bound.name, bound.holds, float(bound.value))
        assert row["closed"] is None or row["closed"] == str(bound.value)


def test_changes_to_dicts_stay_outside(run: xa.Run) -> None:
    run.event_table.to_dicts()[0]["kind"] = "none"
    assert run.event_table[0]["kind"] == "start"


@pytest.mark.parametrize("library", ["pandas", "polars"])
def test_data_frames(run: xa.Run, library: str) -> None:
    pytest.importorskip(library)
    for table, numbers in ((run.event_table, "at"), (run.bound_table, "value")):
        frame = getattr(table, f"to_{library}")()
        assert list(frame.columns) == list(table.columns) and len(frame) == len(table)
        assert frame[numbers].to_list() == [row[numbers] for row in table]


@pytest.mark.parametrize("library", ["pandas", "polars"])
def test_what_is_missing_is_named(run: xa.Run, library: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    how = r"in a clone of exactacq, pip install '\.\[tables\]'"
    with pytest.raises(xa.FormatError, match=f"this needs {library}: {how}"):
        getattr(run.event_table, f"to_{library}")()


def test_a_frame_gets_columns_and_rows(run: xa.Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is handed over, without the libraries themselves."""
    fake = ModuleType("pandas")
    fake.DataFrame = lambda rows, columns: (rows, columns)  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "pandas", fake)
    assert run.bound_table.to_pandas() == (run.bound_table.to_dicts(), list(run.bound_table.columns))


def test_decimals_stand_beside_exact_points(run: xa.Run) -> None:
    """They are for readers: a run file without them is the same run."""
    document = run.to_json()
    for piece, told in zip(run.path, document["path"], strict=True):
        assert told["start_decimal"] == list(piece.start.xy) and told["end_decimal"] == list(piece.end.xy)
    for event, told in zip(run.events, document["events"], strict=True):
        assert told["point_decimal"] == list(event.point.xy)
    assert xa.load_run(document) == run

    def bare(value: object) -> object:
        if isinstance(value, dict):
            return {key: bare(part) for key, part in value.items() if not key.endswith("_decimal")}
        return [bare(part) for part in value] if isinstance(value, list) else value

    assert xa.load_run(bare(document)) == run  # type: ignore[arg-type]
