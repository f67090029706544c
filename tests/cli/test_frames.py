"""``--frames``: which frames, which files, what resumes, on a fake session."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.cli.render.frames import frame_numbers
from daguerre.rendering.names import numbered
from tests.support.program import fake_session

SMALL = ["--res", "8x6", "--spp", "1"]


@pytest.fixture(autouse=True)
def _fake(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(
        sys.modules, "daguerre.rendering.session", sys.modules.get("daguerre.rendering.session")
    )
    fake_session.install(lambda where, name, value: monkeypatch.setattr(where, name, value))
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def times(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Scene times of the sessions that are opened."""
    seen: list[float] = []
    session = sys.modules["daguerre.rendering.session"].Session

    def opened(scene: dg.Scene, camera: dg.Camera, **options: object) -> object:
        seen.append(scene.time)
        return session(scene, camera, **options)

    monkeypatch.setattr(sys.modules["daguerre.rendering.session"], "Session", opened)
    return seen


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("7", [7]),
        ("1-4", [1, 2, 3, 4]),
        ("1-8x3", [1, 4, 7]),
        ("3, 1-2,2", [3, 1, 2]),
        ("-2-1", [-2, -1, 0, 1]),
    ],
)
def test_frames_as_people_write_them(text: str, expected: list[int]) -> None:
    assert frame_numbers("--frames", text) == expected


@pytest.mark.parametrize(
    "text", ["", "a", "4-1", "1-4x0", "1:4", "1-", "1-2-3", "0-99999999", "1.5"]
)
def test_what_is_no_range_is_refused(text: str) -> None:
    with pytest.raises(dg.UsageError, match="--frames: wanted"):
        frame_numbers("--frames", text)


def test_numbers_fill_the_place_of_the_hashes() -> None:
    assert numbered(Path("a#/shot.####.exr"), 12).as_posix() == "a#/shot.0012.exr"
    assert numbered(Path("s#2.##.exr"), 123).name == "s#2.123.exr"
    assert numbered(Path("plain.exr"), 3).name == "plain.exr"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ["-o", "shot.exr", "--frames", "1-3"],
            "wanted a name with # for 3 frames, such as shot.####",
        ),
        (["-o", "shot.###.exr"], "needs --frames"),
        (["-o", "s.#.exr", "--frames", "3-1"], "--frames: wanted frames such as 1-48"),
    ],
)
def test_names_and_frames_belong_together(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["render", "s.glb", *arguments, *SMALL]) == 2
    assert message in capsys.readouterr().err


def test_each_frame_has_its_time_and_its_files(tmp_path: Path, times: list[float]) -> None:
    files = ["-o", "s.##.exr", "-o", "s.##.png"]
    assert main(["render", "s.glb", *files, *SMALL, "--frames", "0-6x3", "--fps", "10"]) == 0
    expected = [f"s.{n:02}.{end}" for n in (0, 3, 6) for end in ("exr", "png")]
    assert sorted(p.name for p in tmp_path.iterdir()) == expected
    assert times == pytest.approx([0, 0.3, 0.6])


def test_resume_leaves_complete_frames(
    tmp_path: Path, times: list[float], capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["render", "s.glb", "-o", "s.#.exr", *SMALL, "--frames", "1-3"]
    assert main(command) == 0
    (tmp_path / "s.2.exr").unlink()
    del times[:]
    assert main([*command, "--resume"]) == 0
    assert times == pytest.approx([2 / 24])
    assert "s.1.exr is complete" in capsys.readouterr().err
    assert (tmp_path / "s.2.exr").exists()
    del times[:]
    assert main(command) == 0
    assert len(times) == 3
