"""Films of runs: frames of one size, from the start to the end, and what is missing is named."""

from __future__ import annotations

import shutil
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import exactacq as xa
from exactacq import cli
from exactacq.output.animation import film as films
from exactacq.output.animation.film import FEWEST, FRAMES, film, moments


@pytest.fixture(scope="module")
def run() -> xa.Run:
    return xa.sightseer(xa.load("squares"))


@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(films, "FRAMES", 5)
    monkeypatch.setattr(films, "FEWEST", 5)


@pytest.fixture
def recorder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A program ffmpeg that keeps its arguments and what it reads."""
    tools = tmp_path / "tools"
    tools.mkdir()
    script = tools / "ffmpeg"
    kept = f"{tools}/arguments", f"{tools}/frames"
    script.write_text(
        f"#!{sys.executable}\nimport shutil, sys\n"
        f"open({kept[0]!r}, 'w').write(' '.join(sys.argv))\n"
        f"shutil.copyfileobj(sys.stdin.buffer, open({kept[1]!r}, 'wb'))\n"
        "open(sys.argv[-1], 'wb').write(b'film')\n"
    )
    script.chmod(0o755)
    monkeypatch.setenv("PATH", str(tools))
    return tools


@pytest.mark.usefixtures("short")
def test_a_gif_plays_the_run(run: xa.Run, tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    film(run, tmp_path / "run.gif", lambda done, count: told.append((done, count)))
    assert told == [(k, 5) for k in range(1, 6)]
    with Image.open(tmp_path / "run.gif") as image:
        assert image.n_frames == 5 and image.info["loop"] == 0
        frames, stands = [], []
        for number in range(5):
            image.seek(number)
            frames.append(np.asarray(image.convert("RGB"), dtype=int))
            stands.append(image.info["duration"])
    assert stands == [100, 100, 100, 100, 2500]
    assert all((a != b).any() for a, b in pairwise(frames))
    red = [int(((f[..., 0] > 180) & (f[..., 1] < 90) & (f[..., 2] < 110)).sum()) for f in frames]
    assert max(red) > 20, "small marks keep their colour"
    film(run, tmp_path / "again.gif")
    assert (tmp_path / "again.gif").read_bytes() == (tmp_path / "run.gif").read_bytes()


def test_moments_are_at_equal_distances(run: xa.Run) -> None:
    places = moments(run)
    assert len(places) == FRAMES and places[-1] is run.events[-1]
    lengths = [float(place) for place in places[:-1]]  # type: ignore[arg-type]
    assert np.diff([*lengths, float(run.length)]) == pytest.approx(
        float(run.length) / (FRAMES - 1), abs=1e-4 * float(run.length)
    )
    assert all(len(str(place)) < 12 for place in places[:-1])


def test_heavy_scenes_get_fewer_frames(run: xa.Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(films, "LIGHT", 4)  # the squares have 8 edges
    assert len(moments(run)) == FRAMES // 2
    monkeypatch.setattr(films, "LIGHT", 0)
    assert len(moments(run)) == FEWEST


@pytest.mark.usefixtures("short")
def test_frames_beyond_the_limits_are_left_out(
    run: xa.Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn, calls = films.png, iter(range(10))

    def limited(*arguments: object) -> bytes:
        if next(calls) in (1, 3):
            raise xa.Undecided("a tie")
        return drawn(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(films, "png", limited)
    assert film(run, tmp_path / "run.gif") == 2
    with Image.open(tmp_path / "run.gif") as image:
        assert image.n_frames == 3
    monkeypatch.setattr(films, "png", lambda *_: _raise())
    with pytest.raises(xa.Undecided):
        film(run, tmp_path / "none.gif")
    assert not (tmp_path / "none.gif").exists()


def _raise() -> None:
    raise xa.Undecided("a tie")


@pytest.mark.usefixtures("short")
def test_ffmpeg_gets_the_frames(run: xa.Run, tmp_path: Path, recorder: Path) -> None:
    film(run, tmp_path / "run.mp4")
    assert (tmp_path / "run.mp4").read_bytes() == b"film"
    words = (recorder / "arguments").read_text().split()
    wide, high = map(int, words[words.index("-s") + 1].split("x"))
    assert wide % 2 == high % 2 == 0, "the usual coding of colours needs even sides"
    assert (recorder / "frames").stat().st_size == wide * high * 3 * (5 + 25)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.mp4", "tools"]


@pytest.mark.usefixtures("short")
def test_an_ffmpeg_that_fails_leaves_nothing(run: xa.Run, tmp_path: Path, recorder: Path) -> None:
    (recorder / "ffmpeg").write_text(f"#!{sys.executable}\nimport sys\nsys.exit('no coder of that name')\n")
    with pytest.raises(xa.FormatError, match=r"ffmpeg fails \(no coder of that name\); write a .gif"):
        film(run, tmp_path / "run.mp4")
    assert [path.name for path in tmp_path.iterdir()] == ["tools"]


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not here")
@pytest.mark.usefixtures("short")
def test_a_true_ffmpeg_makes_a_film(run: xa.Run, tmp_path: Path) -> None:
    film(run, tmp_path / "run.mp4")
    assert (tmp_path / "run.mp4").read_bytes()[4:8] == b"ftyp"


def test_what_is_missing_is_said_before_the_run(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(target: Path) -> str:
        assert cli.main(["explore", "nowhere", "--animate", str(target)]) == 2
        return capsys.readouterr().err

    monkeypatch.setenv("PATH", str(tmp_path))
    assert "a .mp4 needs the program ffmpeg: install it, or write a .gif" in refused(tmp_path / "run.mp4")
    assert "must end in .html, .gif, .mp4" in refused(tmp_path / "run.avi")
    monkeypatch.setitem(sys.modules, "PIL", None)
    assert "this needs PIL: in a clone of exactacq, pip install '.[images]'" in refused(tmp_path / "run.gif")
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("short")
def test_the_command_line_writes_a_film(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    target = tmp_path / "run.gif"
    assert cli.main(["explore", "squares", "--animate", str(target)]) == 0
    assert f"film written to {target}" in capsys.readouterr().out
    assert target.read_bytes()[:6] == b"GIF89a"
