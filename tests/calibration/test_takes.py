"""Cameras that were followed: poses over time, by the clock or by the numbers of pictures."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import daguerre as dg
from daguerre import calibration
from daguerre.calibration import Take
from daguerre.calibration.take import label
from daguerre.cli import main
from daguerre.files.numbered import numbers_in
from tests.plates.test_catchers import ground_and_ball
from tests.support.formats import tracked

MOMENTS = tracked.path(4)


def by_time(folder: Path) -> str:
    return str(tracked.opentrackio(folder / "take.jsonl", MOMENTS))


def by_colmap(folder: Path) -> str:
    return f"{tracked.colmap(folder / 'model', MOMENTS)}:IMG_####.jpg"


def by_nerfstudio(folder: Path) -> str:
    file = tracked.nerfstudio(folder / "transforms.json", MOMENTS)
    return f"{file}:./images/frame_#####.png"


WAYS = {"OpenTrackIO": by_time, "COLMAP": by_colmap, "Nerfstudio": by_nerfstudio}
Way = Callable[[Path], str]


def camera_of(text: str, **base: Any) -> dg.Camera:
    """The camera of a file, as the command line names it."""
    file, _, name = text.partition(":")
    return calibration.read(file, name or None).camera(dg.Camera(**base))


@pytest.fixture(params=WAYS)
def file(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    return WAYS[request.param](tmp_path)


def test_the_camera_stands_where_it_was_tracked(file: str) -> None:
    """At each frame in its pose; between two of them on the way, and turned half of it."""
    camera = camera_of(file)
    assert camera.fps == 24
    for n, moment in enumerate(MOMENTS):
        now = camera.frozen_at(n / 24)
        np.testing.assert_allclose(now.transform, moment.pose, atol=1e-8)
        assert now.projection is not None
        assert now.projection.focal == pytest.approx((70, 70))
    a, b = MOMENTS[1].pose, MOMENTS[2].pose
    half = camera.frozen_at(1.5 / 24).transform
    np.testing.assert_allclose(half[:3, 3], (a[:3, 3] + b[:3, 3]) / 2, atol=1e-6)
    turn = Rotation.from_matrix(a[:3, :3].T @ half[:3, :3]).as_rotvec()
    whole = Rotation.from_matrix(a[:3, :3].T @ b[:3, :3]).as_rotvec()
    np.testing.assert_allclose(turn, whole / 2, atol=1e-6)


def test_pictures_count_by_frames_of_the_camera(tmp_path: Path) -> None:
    camera = camera_of(by_colmap(tmp_path), fps=30)
    np.testing.assert_allclose(camera.frozen_at(3 / 30).transform, MOMENTS[3].pose, atol=1e-9)
    take = calibration.read(tmp_path / "model", "IMG_####.jpg")
    assert isinstance(take, Take)
    assert take.name == "IMG"
    later = take.starting(7.0).camera(dg.Camera(fps=30))
    np.testing.assert_allclose(later.frozen_at(7 + 2 / 30).transform, MOMENTS[2].pose, atol=1e-9)
    same = dg.Camera.from_colmap(tmp_path / "model", "IMG_####.jpg", camera=dg.Camera(fps=30))
    assert np.array_equal(same.frozen_at(0.05).transform, camera.frozen_at(0.05).transform)


def test_a_take_is_a_list_lines_or_samples(tmp_path: Path) -> None:
    samples = [tracked.sample(one, n / 24) for n, one in enumerate(MOMENTS)]
    (tmp_path / "take.json").write_text(json.dumps(samples))
    cameras = [
        dg.Camera.from_opentrackio(samples),
        dg.Camera.from_opentrackio(tmp_path / "take.json"),
        dg.Camera.from_opentrackio(by_time(tmp_path)),
    ]
    poses = [camera.frozen_at(0.06).transform for camera in cameras]
    assert np.array_equal(poses[0], poses[1])
    assert np.array_equal(poses[0], poses[2])
    assert not np.array_equal(poses[0], cameras[0].frozen_at(0.07).transform)


def test_a_take_says_how_many_frames_a_second_has() -> None:
    samples = [tracked.sample(one, n / 24) for n, one in enumerate(MOMENTS)]
    rated = samples[0]["static"]["camera"].pop("captureFrameRate")
    base = dg.Camera(fps=30)
    assert dg.Camera.from_opentrackio(samples, camera=base).fps == 24  # of the second sample
    for one in samples[1:]:
        del one["static"]
    assert dg.Camera.from_opentrackio(samples, camera=base).fps == 30
    samples[0]["static"]["camera"]["captureFrameRate"] = rated | {"num": 24000, "denom": 1001}
    assert dg.Camera.from_opentrackio(samples, camera=base).fps == 24000 / 1001


def render(folder: Path, file: str, *flags: str) -> int:
    scene = folder / "set.gltf"
    if not scene.exists():
        ground_and_ball(scene, {})
    shown = ["--lens", "pinhole", "--sky", "1,1,1", "--spp", "4", "--res", "36x24", "-q"]
    out = ["-o", str(folder / "o.##.exr")]
    return int(main(["render", str(scene), "--calibration", file, *shown, *out, *flags]))


ROLLING = ("--shutter", "1/100", "--rolling", "top,30ms")


def drawn(folder: Path, file: str, time: float, start: float = 0.0) -> NDArray[np.float32]:
    """The same picture by Python."""
    scene = dg.load(folder / "set.gltf", time=time)
    scene.set_environment(color=(1, 1, 1))
    path, _, name = file.partition(":")
    one = calibration.read(path, name or None).starting(start)
    camera = one.camera(scene.camera()).with_(
        f_stop=None, shutter_time=0.01, rolling_shutter=dg.RollingShutter(readout_time=0.03)
    )
    return np.asarray(dg.render(scene, camera, resolution=(36, 24), spp=4).rgb)


def test_frames_are_drawn_from_where_the_camera_was(tmp_path: Path, file: str) -> None:
    assert render(tmp_path, file, "--frames", "1-2", *ROLLING) == 0
    found = [dg.load_frame(tmp_path / f"o.0{n}.exr").rgb for n in (1, 2)]
    for n in (1, 2):
        assert np.array_equal(found[n - 1], drawn(tmp_path, file, n / 24))
    assert not np.array_equal(found[0], found[1])


def test_numbers_of_pictures_hold_whenever_the_scene_begins(tmp_path: Path) -> None:
    file = by_nerfstudio(tmp_path)
    assert render(tmp_path, file, "--frames", "2", "--time", "5", *ROLLING) == 0
    assert np.array_equal(
        dg.load_frame(tmp_path / "o.02.exr").rgb, drawn(tmp_path, file, 5 + 2 / 24, 5)
    )


@pytest.mark.parametrize(
    ("way", "flags", "code", "message"),
    [
        ("COLMAP", ("--frames", "2-5"), 3, "model: frame 4: no pose for IMG_0004.jpg"),
        ("Nerfstudio", ("--frames", "-1"), 3, "no pose for ./images/frame_-0001.png"),
        ("OpenTrackIO", ("--frames", "0-4"), 3, "frame 4 is at 0.166667 s: wanted a time of the"),
        ("OpenTrackIO", ("--frames", "1", "--time", "1"), 3, "0 .. 0.125 s (--time moves frames)"),
    ],
)
def test_frames_without_a_pose_are_named(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    way: str,
    flags: tuple[str, ...],
    code: int,
    message: str,
) -> None:
    assert render(tmp_path, WAYS[way](tmp_path), *flags) == code
    assert message in capsys.readouterr().err
    assert not list(tmp_path.glob("o.*"))


def test_a_number_needs_frames(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = by_colmap(tmp_path)
    assert render(tmp_path, file, "--frames", "1") == 0
    shown = ["--calibration", file, "-o", str(tmp_path / "one.exr"), "--lens", "pinhole"]
    assert main(["render", str(tmp_path / "set.gltf"), *shown]) == 2
    assert "# in the name needs --frames" in capsys.readouterr().err


def test_a_hole_in_a_take_of_pictures_is_named(tmp_path: Path) -> None:
    """Its neighbours are known, but nobody knows where the camera was."""
    file = by_colmap(tmp_path)
    model = tmp_path / "model" / "images.txt"
    model.write_text(model.read_text().replace("IMG_0002.jpg", "other.jpg"))
    take = calibration.read(tmp_path / "model", "IMG_####.jpg")
    take.check(1, 1 / 24, 24)
    with pytest.raises(
        dg.InputError, match=r"frame 2: .*no pose for IMG_0002.jpg; the take has 3 frames"
    ):
        take.check(2, 2 / 24, 24)
    with pytest.raises(dg.UsageError, match="# in the name needs --frames"):
        take.check(None, 0, 24)
    assert render(tmp_path, file, "--frames", "2") == 3


def test_faults_of_takes_have_a_place(tmp_path: Path) -> None:
    path = tmp_path / "take.jsonl"
    first, last = (json.dumps(tracked.sample(MOMENTS[n], n / 24)) for n in (0, 1))
    for text, message in [
        (f"{last}\n\n{first}\n", "line 3: timing: times must increase"),
        (f"{first}\n{last[:-1]}\n", "line 2: JSON"),
        (f"{first}\n[1]\n", "line 2"),
        ("\n", "no samples"),
    ]:
        path.write_text(text)
        with pytest.raises(dg.InputError, match=message) as error:
            calibration.read(path)
        assert str(path) in str(error.value)
    tracked.colmap(tmp_path / "model", MOMENTS)
    with pytest.raises(dg.UsageError, match=r"wanted pictures named IMG_#+.jpg, got IMG_0003.jpg"):
        calibration.read(tmp_path / "model", "IMG_#####.jpg")
    take = calibration.read(by_time(tmp_path))
    with pytest.raises(dg.UsageError, match="wanted a single calibration, got a take"):
        calibration.write(tmp_path / "x.json", take, "opentrackio")


def test_names_with_numbers() -> None:
    names = ["a.001.jpg", "a.12.jpg", "a.1000.jpg", "b.002.jpg", "a.1.jpg"]
    assert numbers_in(names, "a.###.jpg") == {1: "a.001.jpg", 1000: "a.1000.jpg"}
    assert numbers_in(names, "a.#.jpg") == {1: "a.1.jpg", 12: "a.12.jpg", 1000: "a.1000.jpg"}
    assert label("left/IMG_####.jpg") == "left/IMG"
    assert label("####.png") == "camera"
