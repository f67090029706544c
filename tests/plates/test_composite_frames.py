"""``composite --frames``: which files make a frame, the noise of each, and what is missing."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from daguerre.cli import main
from daguerre.plates.composite.shots import SEEDS, seed_of
from tests.support.pictures.plate_frames import of_light, ramp

SHAPE = (150, 240)
SENSOR, ISO = "sony-a7r-ii", 3200
LUX_S = 0.6 * 78 / ISO


def save_objects(folder: Path, count: int) -> None:
    """Half a veil over a part of the picture: its place moves from frame to frame."""
    for n in range(1, count + 1):
        alpha = np.zeros(SHAPE, np.float32)
        alpha[40:110, 60 + n : 180 + n] = 0.5
        frame = of_light(0.2 * alpha, LUX_S, isoSpeed=ISO)
        replace(frame, alpha=alpha, channels=None).save(folder / f"object.{n:04d}.exr")


@pytest.fixture(params=["dng", "png"])
def shot(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A photograph, three frames of objects and the camera file; the ending of the photograph."""
    monkeypatch.chdir(tmp_path)
    frame = of_light(0.8 * ramp(SHAPE) + 0.02, LUX_S, isoSpeed=ISO, focus=3.0)
    raw = frame.expose(SENSOR, ISO, seed=1)
    raw.save(tmp_path / f"plate.{request.param}")
    facts = [
        "--f-stop",
        "5.6",
        "--shutter",
        "1/125",
        "--iso",
        str(ISO),
        "--sensor",
        "ff",
        "--quiet",
    ]
    facts = [] if request.param == "dng" else facts
    assert main(["match-plate", f"plate.{request.param}", "-o", "c.json", "-q", *facts]) == 0
    save_objects(tmp_path, 3)
    return str(request.param)


def composite(plate: str, objects: str, out: str, *flags: str) -> int:
    return int(main(["composite", plate, objects, "-o", out, "--like-plate", "c.json", *flags]))


def numbers(path: str) -> NDArray[np.int64]:
    """Numbers of a picture, or photosites of a raw one."""
    if path.endswith(".dng"):
        from daguerre.plates.files import read

        raw = read(path).raw
        assert raw is not None
        return np.asarray(raw.mosaic, np.int64)
    return np.asarray(Image.open(path), np.int64)


def test_a_frame_has_the_bits_of_a_single_call_with_its_seed(shot: str) -> None:
    plate, out = f"plate.{shot}", f"out.####.{shot}"
    assert composite(plate, "object.####.exr", out, "--frames", "1-3", "--seed", "5") == 0
    found = {n: numbers(f"out.{n:04d}.{shot}") for n in (1, 2, 3)}
    for n, one in found.items():
        single = f"single.{shot}"
        assert composite(plate, f"object.{n:04d}.exr", single, "--seed", str(5 + n)) == 0
        assert np.array_equal(one, numbers(single))
    assert (
        composite(plate, "object.####.exr", f"again.##.{shot}", "--frames", "2,3", "--seed=5") == 0
    )
    for n in (2, 3):
        assert np.array_equal(found[n], numbers(f"again.{n:02d}.{shot}"))
    # Noise of what is added, where objects lie over the same part of the plate in both.
    both = (slice(45, 105), slice(70, 170))
    noise = found[1][both] - found[2][both]
    assert (noise != 0).mean() > 0.3
    assert np.array_equal(found[1][:30], found[2][:30])  # beside objects the plate's own


def test_plates_have_numbers_too(shot: str) -> None:
    for n in (1, 2, 3):
        Path(f"plate.{n}.{shot}").write_bytes(Path(f"plate.{shot}").read_bytes())
    flags = ("--frames", "1-3x2")
    assert composite(f"plate.#.{shot}", "object.####.exr", f"a.#.{shot}", *flags) == 0
    assert composite(f"plate.{shot}", "object.####.exr", f"b.#.{shot}", *flags) == 0
    assert np.array_equal(numbers(f"a.3.{shot}"), numbers(f"b.3.{shot}"))
    assert composite(f"plate.#.{shot}", "object.0001.exr", f"c.#.{shot}", *flags) == 0
    assert not np.array_equal(numbers(f"c.1.{shot}"), numbers(f"c.3.{shot}"))
    assert not Path(f"a.2.{shot}").exists()


@pytest.mark.parametrize("shot", ["png"], indirect=True)
def test_what_is_missing_is_named_before_anything_is_made(
    shot: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("object.0002.exr").unlink()
    assert composite("plate.png", "object.####.exr", "out.#.png", "--frames", "1-3") == 3
    said = capsys.readouterr().err
    assert "frame 2: object.0002.exr: no such file (only this frame)" in said
    assert not list(Path().glob("out.*"))
    assert composite("plate.#.png", "object.####.exr", "out.#.png", "--frames", "1-3") == 3
    assert "frame 1: plate.1.png: no such file (3 of 3" in capsys.readouterr().err
    Path("object.0002.exr").write_bytes(b"no picture")
    assert composite("plate.png", "object.####.exr", "out.#.png", "--frames", "1-3") == 3
    assert "error: frame 2: object.0002.exr" in capsys.readouterr().err


@pytest.mark.parametrize("shot", ["png"], indirect=True)
@pytest.mark.parametrize(
    ("objects", "out", "flags", "message"),
    [
        ("object.####.exr", "out.png", ("--frames", "1-3"), "wanted a name with # for 3 frames"),
        ("object.####.exr", "out.png", (), "# stands for the frame number and needs --frames"),
        (
            "object.0001.exr",
            "out.#.png",
            ("--frames", "1-3"),
            "wanted # for the frame number in the name",
        ),
        ("object.0001.exr", "out.png", ("--resume",), "--resume needs --frames"),
        (
            "object.####.exr",
            "object.####.exr",
            ("--frames", "1-3"),
            "this command reads this file",
        ),
        ("object.####.exr", "out.#.png", ("--frames", "3-1"), "--frames: wanted frames such as"),
    ],
)
def test_names_that_cannot_be_meant_are_refused(
    shot: str,
    objects: str,
    out: str,
    flags: tuple[str, ...],
    message: str,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert composite(f"plate.{shot}", objects, out, *flags) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("shot", ["png"], indirect=True)
def test_frames_that_are_there_are_skipped(shot: str, capfd: pytest.CaptureFixture[str]) -> None:
    Path("out.2.png").write_bytes(b"kept")
    flags = ("--frames", "1-3", "--resume", "--json-progress")
    assert composite("plate.png", "object.####.exr", "out.#.png", *flags) == 0
    assert Path("out.2.png").read_bytes() == b"kept"
    lines = [json.loads(line) for line in capfd.readouterr().out.splitlines()]
    done = [line["frame"] for line in lines if line["event"] == "done"]
    assert done == [1, 3]
    assert "out.2.png is complete" in str(lines)
    progress = [line for line in lines if line["event"] == "progress"]
    assert (progress[-1]["fraction"], progress[-1]["frames"]) == (1, 3)
    assert composite("plate.png", "object.####.exr", "out.#.png", "--frames", "2", "-q") == 0
    assert Path("out.2.png").read_bytes() != b"kept"


def test_seeds_of_frames_differ_and_are_valid() -> None:
    assert [seed_of(7, n) for n in (0, 1, -2)] == [7, 8, 5]
    assert seed_of(0, -1) == SEEDS - 1
