"""Rigs on the command line: one scene, several cameras, one call."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.errors import InputError
from daguerre.setup import built_scene
from tests.support.formats.make_gltf import Builder

CHAIN = """
cam0:
  camera_model: pinhole
  intrinsics: [40, 40, 15.5, 9.5]
  distortion_model: radtan
  distortion_coeffs: [-0.1, 0.02, 0, 0]
  resolution: [32, 20]
cam1:
  camera_model: pinhole
  intrinsics: [30, 30, 11.5, 11.5]
  distortion_model: none
  resolution: [24, 24]
  T_cn_cnm1: [[1, 0, 0, -0.2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
"""
#: A fisheye that sees 122 degrees to either side.
WIDE = """
cam0:
  camera_model: pinhole
  intrinsics: [7.5, 7.5, 15.5, 9.5]
  distortion_model: equidistant
  distortion_coeffs: [0, 0, 0, 0]
  resolution: [32, 20]
"""
QUICK = ["--sky", "1,0.9,0.8", "--spp", "2", "--lens", "pinhole", "--quiet"]


def without_lens(flags: list[str]) -> list[str]:
    return [flag for flag in flags if flag not in ("--lens", "pinhole")]


@pytest.fixture(autouse=True)
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A square 2 m ahead of three cameras: A and B are the same, C stands beside them."""
    monkeypatch.chdir(tmp_path)
    made = Builder()
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
    ends = {"min": [-1, -1, 0], "max": [1, 1, 0]}
    attributes = {"POSITION": made.accessor(corners, **ends)}
    wall = made.mesh(attributes, indices=made.accessor([0, 1, 2, 0, 2, 3], "u2"))
    made.node(mesh=wall, name="Wall", translation=[0.2, 0.1, -2])
    made.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01}})
    for name, x in (("A", 0.0), ("B", 0.0), ("C", 0.3)):
        made.node(camera=0, name=name, translation=[x, 0, 0])
    made.glb(tmp_path / "s.glb")
    (tmp_path / "chain.yaml").write_text(CHAIN)


def render(*flags: str) -> int:
    return main(["render", "s.glb", *flags])


def picture(path: str) -> np.ndarray:
    return np.asarray(dg.load_frame(path).rgb)


@pytest.fixture
def built(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Grows by one whenever a scene is built."""
    count, build = [], built_scene.build
    monkeypatch.setattr(built_scene, "build", lambda *given: (count.append(1), build(*given))[1])
    return count


def test_cameras_draw_the_same_numbers_and_the_scene_is_built_once(built: list[int]) -> None:
    flags = [*QUICK, "--res", "20x12", "--seed", "7"]
    assert render("-o", "rig.exr", "--camera", "A,B,C", *flags) == 0
    assert len(built) == 1
    np.testing.assert_array_equal(picture("rig.A.exr"), picture("rig.B.exr"))
    assert not np.array_equal(picture("rig.A.exr"), picture("rig.C.exr"))
    assert render("-o", "alone.exr", "--camera", "C", *flags) == 0
    assert Path("alone.exr").read_bytes() == Path("rig.C.exr").read_bytes()


def test_a_pair_stands_around_its_camera() -> None:
    flags = [*QUICK, "--res", "20x12", "--aov", "P"]
    assert render("-o", "{camera}.exr", "--stereo", "30cm", "-c", "A", *flags) == 0
    places = {name: dg.load_frame(f"{name}.exr").metadata["camera"] for name in ("left", "right")}
    x = {name: facts["world_from_camera"][0][3] for name, facts in places.items()}
    assert x == pytest.approx({"left": -0.15, "right": 0.15})
    camera = dg.load("s.glb").camera("A")
    alone = dg.stereo_pair(camera, 0.3)["right"]
    assert alone.transform[0, 3] == pytest.approx(0.15)


def test_a_pair_that_lacks_parallax_at_its_sides_has_one_note(
    capsys: pytest.CaptureFixture[str],
) -> None:
    flags = ["--sky", "1,1,1", "--spp", "1", "--res", "50%", "-c", "A", "--json-progress"]
    Path("wide.yaml").write_text(WIDE)
    for more, count in ((["--stereo", "0.06"], 1), ([], 0)):
        assert render("-o", "w.exr", "--calibration", "wide.yaml", *more, *flags) == 0
        out, err = capsys.readouterr()
        assert (out + err).count("parallax") == count


def test_disparity_of_a_pair(capsys: pytest.CaptureFixture[str]) -> None:
    flags = ["--res", "20x12", "--aov", "disparity,depth", *QUICK]
    assert render("-o", "p.exr", "--stereo", "0.2", "-c", "A", *flags) == 0
    frame = dg.load_frame("p.right.exr")
    focal = 12 / np.tan(0.3) * 20 / 36  # px: the file's yfov is of a sensor of 36 x 24 mm
    expected = np.where(frame.aovs["depth.Z"] > 0, focal * 0.2 / 2, 0)
    np.testing.assert_allclose(frame.aovs["disparity.X"], expected, rtol=1e-5)
    for more, message in (
        ([], "needs --stereo"),
        (["--stereo", "1", "--gt-lens", "mean"], "--gt-lens chief"),
        (
            ["--stereo", "1", "--samples", "0:2"],
            "--samples and --aov disparity: wanted one of them",
        ),
    ):
        assert render("-o", "x.exr", *flags, *more) == 2
        assert message in capsys.readouterr().err
    exact = [*flags, "--lens", "nikon-28mm-f2.8", "--stereo", "1", "-c", "A"]
    assert render("-o", "x.exr", *exact, "--json-progress") == 3
    out, err = capsys.readouterr()
    assert "got exact" in err
    assert "progress" not in out  # said before anything is drawn


def test_samples_are_kept_when_a_channel_cannot_be_made(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*given: object) -> None:
        raise InputError("disparity: no")

    monkeypatch.setattr("daguerre.rendering.rig.disparity", fails)
    flags = ["--res", "20x12", "--aov", "disparity", *QUICK]
    assert render("-o", "x.exr", "--stereo", "0.2", "-c", "A", *flags) == 3
    assert [str(path) for path in Path().glob("x.*")] == ["x.left.checkpoint.exr"]


def test_cameras_of_a_chain_have_sizes_of_their_own(built: list[int]) -> None:
    flags = [*without_lens(QUICK), "-c", "A", "--pixel-pitch", "5"]
    assert render("-o", "rig.exr", "--calibration", "chain.yaml:all", *flags) == 0
    assert len(built) == 1
    assert picture("rig.cam0.exr").shape == (20, 32, 3)
    assert picture("rig.cam1.exr").shape == (24, 24, 3)
    told = dg.load_frame("rig.cam1.exr").metadata["camera"]
    assert told["world_from_camera"][0][3] == pytest.approx(0.2)
    assert render("-o", "one.exr", "--calibration", "chain.yaml:cam1", *flags) == 0
    assert Path("one.exr").read_bytes() == Path("rig.cam1.exr").read_bytes()
    half = [*flags, "--res", "50%"]
    assert render("-o", "half.exr", "--calibration", "chain.yaml:cam1,cam0", *half) == 0
    assert picture("half.cam0.exr").shape == (10, 16, 3)


def test_frames_of_cameras_and_passes_of_them() -> None:
    Path("out/left").mkdir(parents=True)
    Path("out/right").mkdir()
    flags = [*QUICK, "--res", "8x6", "--stereo", "0.1"]
    assert render("-o", "out/{camera}/s.##.png", "--frames", "1-2", *flags) == 0
    assert render("-o", "s.##.png", "--frames", "1-2", *flags) == 0
    found = sorted(str(p) for p in Path().rglob("*.png"))
    inside = [f"out/{side}/s.{n:02}.png" for side in ("left", "right") for n in (1, 2)]
    assert found == sorted(
        [*inside, *(f"s.{s}.0{n}.png" for s in ("left", "right") for n in (1, 2))]
    )
    flags = [flag for flag in flags if flag not in ("--spp", "2")]
    for samples in ("0:1", "1:2"):
        assert render("-o", f"{samples[0]}.exr", "--samples", samples, *flags) == 0
    assert main(["merge", "0.left.exr", "1.left.exr", "-o", "left.exr", "-q"]) == 0
    assert render("-o", "whole.exr", "--spp", "2", *flags) == 0
    assert Path("left.exr").read_bytes() == Path("whole.left.exr").read_bytes()


def test_programs_are_told_which_camera(capsys: pytest.CaptureFixture[str]) -> None:
    flags = ["-o", "r.exr", "--calibration", "chain.yaml:all", *without_lens(QUICK)]
    assert render(*flags, "--dry-run") == 0
    told = json.loads(capsys.readouterr().out)["cameras"]
    assert told["cam1"]["outputs"] == ["r.cam1.exr"]
    assert told["cam1"]["resolution"] == [24, 24]
    assert not list(Path().glob("*.exr"))
    assert render(*flags, "--json-progress") == 0
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    done = [(e["camera"], e["outputs"]) for e in events if e["event"] == "done"]
    assert done == [("cam0", ["r.cam0.exr"]), ("cam1", ["r.cam1.exr"])]
    assert {e["camera"] for e in events if e["event"] == "progress"} == {"cam0", "cam1"}


def test_interrupted_rigs_go_on_with_the_camera_that_is_not_complete(tmp_path: Path) -> None:
    root = Path(__file__).parents[2]
    paths = os.pathsep.join(filter(None, [str(root), os.environ.get("PYTHONPATH", "")]))
    flags = ["-o", "a.exr", "--stereo", "0.1", "--spp", "24", "--res", "8x6"]

    def start(seconds: float, *more: str) -> subprocess.Popen[str]:
        command = [
            sys.executable,
            "-m",
            "tests.support.program.fake_session",
            "render",
            "s.glb",
            *flags,
            *more,
        ]
        env = {**os.environ, "FAKE_SECONDS": str(seconds), "PYTHONPATH": paths}
        pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        return subprocess.Popen([*command, "--json-progress"], text=True, env=env, **pipes)

    process = start(0.02, "--checkpoint", "50ms")
    until = time.monotonic() + 20
    while not (tmp_path / "a.right.checkpoint.exr").exists() and time.monotonic() < until:
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=20)
    assert process.returncode == 75
    assert json.loads(out.splitlines()[-1])["resume"].endswith("--resume")
    assert sorted(p.name for p in tmp_path.glob("*.exr")) == [
        "a.left.exr",
        "a.right.checkpoint.exr",
    ]
    written = Path("a.left.exr").stat().st_mtime_ns

    again = start(0.0, "--resume")
    out, err = again.communicate(timeout=20)
    assert again.returncode == 0
    assert "a.left.exr is complete" in err
    assert "resuming at" in out
    assert sorted(p.name for p in tmp_path.glob("*.exr")) == ["a.left.exr", "a.right.exr"]
    assert Path("a.left.exr").stat().st_mtime_ns == written


@pytest.mark.parametrize(
    ("flags", "code", "message"),
    [
        (["-o", "{camera}.exr"], 2, "needs --camera"),
        (["-o", "{cameras}.exr", "-c", "A"], 2, "wanted {camera}, got {cameras}"),
        (["-o", "x.exr", "-c", "A,A"], 2, "'A' appears twice"),
        (["-o", "x.exr", "-c", "A,,B"], 2, "names between commas"),
        (["-o", "x.exr", "-c", "A,Bb"], 3, "'Bb'"),
        (["-o", "x.exr", "-c", "A,B", "--stereo", "1"], 2, "--camera and --stereo"),
        (["-o", "x.exr", "--stereo", "0"], 2, "above 0"),
        (["-o", "x.exr", "--stereo", "wide"], 2, "--stereo"),
        (
            ["-o", "x.exr", "--calibration", "chain.yaml:all", "--stereo", "1"],
            2,
            "--calibration and",
        ),
        (["-o", "x.exr", "--calibration", "chain.yaml:cam2"], 2, "cam0, cam1"),
        (["-o", "x.exr", *["--calibration", "chain.yaml:cam0"] * 2], 2, "'cam0' twice"),
        (["-o", "x.exr", "--calibration", "chain.yaml:cam1,cam1"], 2, "'cam1' appears twice"),
        (["-o", "x.exr", "--calibration", "chain.yaml", "--rectified"], 2, "rectified: wanted ROS"),
        (["-o", "x.exr", "--calibration", "chain.yaml", "--calibration-unit", "1kg"], 2, "a unit"),
        (["-o", "x.exr", "--calibration", "chain.yaml", "--calibration-unit", "kg"], 2, "got 'kg'"),
        (["-o", "x.exr", "--calibration", ""], 2, "--calibration: wanted a file, got ''"),
        (
            ["-o", "x.exr", "--calibration", "chain.yaml", "--calibration-size", "4x3"],
            2,
            "kalibr takes none",
        ),
        (
            ["-o", "x.exr", "--calibration-unit", "mm"],
            2,
            "--calibration-unit needs --calibration",
        ),
        (["-o", "x.exr", "--timeshift"], 2, "--timeshift needs --calibration"),
        (["-o", "x.exr", "--calibration", "no.yaml:cam0"], 3, "no.yaml:cam0"),
        (
            [
                "-o",
                "x.exr",
                "--calibration",
                "chain.yaml:all",
                "--crop",
                "left=0,top=0,right=32,bottom=20",
            ],
            2,
            "0..24",
        ),
    ],
)
def test_bad_rigs(
    flags: list[str], code: int, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert render(*flags, "--spp", "1", "--res", "100%") == code
    err = capsys.readouterr().err
    assert message in err.splitlines()[-1]
    assert not list(Path().glob("*.exr"))


def written(name: str) -> dict[str, Any]:
    return dict(dg.load_frame(name).metadata["camera"])


def test_pairs_of_opencv_and_of_ros() -> None:
    """Two files of one camera each; a pair in millimetres that does not say its size."""
    eye = "[1, 0, 0, 0, 1, 0, 0, 0, 1]"
    for name, away in (("left", 0), ("right", -4)):
        Path(f"{name}.yaml").write_text(
            f"image_width: 32\nimage_height: 20\nK: [40, 0, 15, 0, 40, 9, 0, 0, 1]\nR: {eye}\n"
            "distortion_model: plumb_bob\nD: [-0.1, 0, 0, 0, 0]\n"
            f"P: [40, 0, 15, {away}, 0, 40, 9, 0, 0, 0, 1, 0]\n"
        )
    flags = ["-c", "A", "--rectified", *without_lens(QUICK)]
    both = ["--calibration", "left.yaml", "--calibration", "right.yaml"]
    assert render("-o", "ros.exr", *both, *flags) == 0
    assert written("ros.right.exr")["world_from_camera"][0][3] == pytest.approx(0.1)
    assert written("ros.left.exr")["projection"]["model"] == "rectilinear"
    k = "[[40, 0, 15], [0, 40, 9], [0, 0, 1]]"
    Path("pair.yml").write_text(
        f"M1: {k}\nM2: {k}\nD1: [0.01, 0, 0, 0]\nD2: [0.01, 0, 0, 0]\n"
        "R: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\nT: [-120, 0, 0]\n"
    )
    flags = ["-c", "A", "--calibration", "pair.yml:all", *without_lens(QUICK)]
    assert render("-o", "cv.exr", *flags) == 2 + 1  # no size
    flags += ["--calibration-size", "32x20", "--calibration-unit", "mm"]
    assert render("-o", "cv.exr", *flags, "--calibration-model", "fisheye") == 0
    assert written("cv.right.exr")["world_from_camera"][0][3] == pytest.approx(0.12)
    assert written("cv.left.exr")["projection"]["model"] == "kannala_brandt"


def test_a_chain_whose_cameras_are_triggered_apart(built: list[int]) -> None:
    """The scene stands still, so it is built once for both moments."""
    Path("late.yaml").write_text(CHAIN + "  timeshift_cam_imu: 0.004\n")
    flags = ["-c", "A", "--calibration", "late.yaml:all", "--fps", "50", *without_lens(QUICK)]
    assert render("-o", "s.exr", *flags, "--timeshift", "--shutter", "10ms") == 0
    assert len(built) == 1
    opens = {name: written(f"s.{name}.exr")["shutter"]["opens_s"] for name in ("cam0", "cam1")}
    assert opens == pytest.approx({"cam0": -0.005, "cam1": -0.001})


def test_a_chain_without_times_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    flags = ["-c", "A", "--calibration", "chain.yaml", "--res", "25%", "--spp", "1"]
    assert render("-o", "s.exr", *flags, "--timeshift") == 0
    assert "all cameras have the same timeshift_cam_imu" in capsys.readouterr().err


def test_info_shows_each_camera(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "s.glb", "--calibration", "chain.yaml:all", "-c", "A"]) == 0
    shown = capsys.readouterr().out
    assert "camera 'cam0'" in shown
    assert "at 24x24" in shown
    assert main(["info", "s.glb", "-c", "A,C", "--json"]) == 0
    assert list(json.loads(capsys.readouterr().out)["cameras"]) == ["A", "C"]
