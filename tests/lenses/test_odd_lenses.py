"""Odd lens files through the commands that take one: a lens that is used, or a refusal in words."""

from __future__ import annotations

from pathlib import Path

import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.cli import main
from daguerre.lenses.errors import LensError
from daguerre.lenses.zoom import Position, bracket
from tests.bad_files.bases import seen
from tests.support.lenses import odd_lenses

FILES = list(odd_lenses.files())
all_files = pytest.mark.parametrize(
    ("suffix", "data"), [f[1:] for f in FILES], ids=[f"{n}.{s}" for n, s, _ in FILES]
)
DRAW = ("--spp", "1", "--res", "16x9", "--threads", "1", "--sky", "1,1,1")
ZOOM, FOCUS = ("--zoom", "47.5"), ("--focus", "2")
#: Exit codes of what was used, of a flag that no such lens takes, of a file that is refused.
TOLD = (0, 2, 3)


def written(folder: Path, name: str) -> Path:
    path = folder / "odd.json"
    path.write_bytes(next(data for n, suffix, data in FILES if (n, suffix) == (name, "json")))
    return path


def commands(folder: Path, lens: Path) -> dict[str, list[str]]:
    scene = str(seen().glb(folder / "scene.glb"))
    return {
        "lens": ["lens", str(lens)],
        "render": ["render", scene, "--lens", str(lens), "-o", str(folder / "o.exr"), *DRAW],
        "calibrate": ["calibrate", str(lens)],
    }


def test_there_are_two_hundred() -> None:
    assert len({data for _, _, data in FILES}) > 200


@all_files
def test_an_odd_lens_is_used_or_refused(tmp_path: Path, suffix: str, data: bytes) -> None:
    path = tmp_path / f"odd.{suffix}"
    path.write_bytes(data)
    try:
        lens = lenses.load(str(path))
    except dg.DaguerreError as error:
        assert str(path) in str(error)  # noqa: PT017
        return
    for focus_m, zoom_mm in ((5.0, None), (5.0, 47.5)):
        try:
            lens.focused(focus_m, zoom_mm=zoom_mm)
        except dg.DaguerreError as error:
            assert str(path) in str(error)  # noqa: PT017


@pytest.mark.slow
@all_files
def test_an_odd_lens_in_every_command(
    tmp_path: Path, suffix: str, data: bytes, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"odd.{suffix}"
    path.write_bytes(data)
    of = commands(tmp_path, path)
    for words in (
        *of.values(),
        [*of["lens"], "--json"],
        [*of["lens"], "--flare", "10"],
        [*of["lens"], "--drawing", str(tmp_path / "x.svg")],
        [*of["render"], *ZOOM, *FOCUS],
        [*of["render"], *FOCUS, "--flare", "--scatter"],
    ):
        code = main(words)
        assert code in TOLD, f"{words}: {capsys.readouterr().err}"


@pytest.mark.parametrize("command", ["lens", "render", "calibrate"])
def test_without_a_position_at_infinity_the_whole_lens_moves(
    tmp_path: Path, command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = commands(tmp_path, written(tmp_path, "near alone, twice"))[command]
    assert main([*words, *FOCUS]) == 0, capsys.readouterr().err


@pytest.mark.parametrize("command", ["lens", "render", "calibrate"])
def test_equal_positions_are_one(
    tmp_path: Path, command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its groups move the wrong way, which is said of this lens as of any other."""
    path = written(tmp_path, "near of two zoom positions that are equal")
    assert main([*commands(tmp_path, path)[command], *FOCUS]) == 3
    assert "focus distance: wanted" in capsys.readouterr().err


def test_without_a_position_at_infinity_there_is_no_zoom(tmp_path: Path) -> None:
    lens = lenses.load(str(written(tmp_path, "near alone, twice")))
    with pytest.raises(
        LensError, match="zoom: the lens has no configuration that is focused at infinity"
    ):
        lens.at_zoom(47.0)


def test_no_zoom_goes_through_infinity(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Focal lengths of two signs have an afocal lens between them."""
    lens = lenses.load(str(written(tmp_path, "two equal positions")))
    first = lens.configurations[0]
    ends = [Position(first, {}, efl, None, None) for efl in (-50.0, 50.0)]
    monkeypatch.setattr("daguerre.lenses.zoom.positions", lambda lens: ends)
    with pytest.raises(LensError, match="wanted focal lengths of one sign"):
        bracket(lens, 20.0)
