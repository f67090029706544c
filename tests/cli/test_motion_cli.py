"""Motion at the command line, on a real file and the real core: what it draws, adds and refuses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenEXR
import pytest

import daguerre as dg
from daguerre.cli import main
from tests.support.formats.motion_files import SPAN, YFOV, animate, glowing_card

SMALL = ["--res", "24x16", "--lens", "pinhole", "--quiet"]
BLURRED = ["--time", "1", "--shutter", "0.4"]


@pytest.fixture(autouse=True)
def _scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A card that runs through the frame in half a second, and the camera that sees it."""
    monkeypatch.chdir(tmp_path)
    b = glowing_card()
    b.add("cameras", {"type": "perspective", "perspective": {"yfov": YFOV}})
    b.node(camera=0, name="eye")
    animate(b, 0, "translation", SPAN, [[-1, 0, -3], [1, 0, -3]])
    b.glb(tmp_path / "s.glb")


def run(name: str, *flags: str) -> np.ndarray:
    """The picture of a command, (H, W, 3)."""
    assert main(["render", "s.glb", "-o", name, *SMALL, *flags]) == 0
    return read(name)


def read(name: str) -> np.ndarray:
    with OpenEXR.File(name, separate_channels=True) as file:
        return np.stack([file.channels()[c].pixels for c in "RGB"], axis=-1)


def test_a_file_that_moves_is_blurred_as_from_python():
    shot = run("a.exr", "--spp", "16", *BLURRED)
    scene = dg.load("s.glb", time=1.0)
    camera = scene.camera().with_(lens="pinhole", shutter_time=0.4)
    assert np.array_equal(shot, dg.render(scene, camera, spp=16, resolution=(24, 16)).rgb)
    frozen = run("b.exr", "--spp", "16", "--time", "1", "--shutter", "0")
    # the card is 1 m wide and runs 1.6 m: blurred it reaches further, and is dimmer
    assert (shot.sum(axis=2) > 1e-4).any(axis=0).sum() > (
        5 + (frozen.sum(axis=2) > 1e-4).any(axis=0).sum()
    )
    assert shot.max() < 0.8 * frozen.max()


def test_a_shutter_is_open_by_default():
    """180 degrees at 24 frames per second."""
    usual = run("a.exr", "--spp", "8", "--time", "1")
    assert np.array_equal(usual, run("b.exr", "--spp", "8", "--time", "1", "--shutter", "1/48"))
    assert not np.array_equal(usual, run("c.exr", "--spp", "8", "--time", "1", "--shutter", "0"))


def test_passes_of_a_blurred_frame_add():
    run("whole.exr", "--spp", "12", *BLURRED)
    run("a.exr", "--samples", "0:5", "--threads", "1", *BLURRED)
    run("b.exr", "--samples", "5:12", "--threads", "3", *BLURRED)
    assert main(["merge", "b.exr", "a.exr", "-o", "sum.exr", "-q"]) == 0
    assert Path("sum.exr").read_bytes() == Path("whole.exr").read_bytes()


@pytest.mark.parametrize(
    "other", [["--shutter", "0.3"], ["--time", "1.1"], ["--rolling", "top,9ms"]]
)
def test_passes_of_another_exposure_are_refused(other, capsys):
    run("a.exr", "--samples", "0:2", *BLURRED)
    run("b.exr", "--samples", "2:4", *(other if "--time" in other else ["--time", "1"]), *other)
    assert main(["merge", "a.exr", "b.exr", "-o", "sum.exr"]) == 4
    assert "wanted" in capsys.readouterr().err


def test_each_frame_of_a_sequence_is_the_frame_of_its_time():
    flags = ["--spp", "4", "--shutter-angle", "270", "--fps", "8"]
    main(["render", "s.glb", "-o", "f.##.exr", "--frames", "7-9x2", *SMALL, *flags])
    for frame in (7, 9):
        assert np.array_equal(
            read(f"f.{frame:02d}.exr"), run("one.exr", "--time", f"{frame}/8", *flags)
        )


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (["--shutter=-1/48"], "--shutter): wanted a number of at least 0"),
        (["--shutter", "0/0"], "--shutter: wanted a time"),
        (["--shutter", "1/48", "--shutter-angle", "90"], "wanted one of them, got both"),
        (["--fps", "0"], "--fps): wanted a number of at least"),
        (["--shutter-offset", "nan"], "--shutter-offset: wanted frames"),
        (["--shutter-type", "lefa"], "did you mean 'leaf'"),
        (["--shutter-type", "leaf", "--rolling", "top,9ms"], "a leaf shutter exposes all lines"),
        (["--rolling", "top,-9ms"], "readout_time: wanted a number of at least 0"),
        (["--rolling", "diagonal,9ms"], "scan_order: wanted top, bottom, left, right"),
        (["--shutter-curve", "trapezoid:0.2"], "efficiency: wanted"),
        (["--time", "1e17"], "scene: time: 1e+17 s is too large for an exposure"),
        (["--frames", "1-2"], "wanted a name with #"),
        (["--gt-time", "noon"], "wanted open, mid, close"),
    ],
)
def test_what_no_shutter_does(flags, message, capsys):
    assert main(["render", "s.glb", "-o", "a.exr", "--spp", "1", *SMALL, *flags]) == 2
    assert message in capsys.readouterr().err
    assert not list(Path.cwd().glob("*.exr"))


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("/dev/zero", "not a regular file"),
        ("0,0\n0.5,1\n0.2,1\n", "line 3: times must not decrease"),
        ("0,0\n1\n", "line 2: wanted time and opening"),
        ("", "wanted at least two points"),
        ("\n".join(f"{i},1" for i in range(5000)), "wanted at most 4096 points"),
    ],
)
def test_what_no_curve_is(table, message, capsys):
    path = Path(table if table.startswith("/dev") else "curve.csv")
    if not path.is_absolute():
        path.write_text(table)
    elif not path.exists():
        pytest.skip(f"no {path} here")
    flags = ["--spp", "1", "--shutter-curve", str(path)]
    assert main(["render", "s.glb", "-o", "a.exr", *SMALL, *flags]) == 3
    assert message in capsys.readouterr().err
