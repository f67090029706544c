"""Objects in the pictures of tracked cameras that move, against pictures of the whole scene.

The camera comes from a file, frame by frame; its lines are exposed in turn, and within a frame it
travels and pans by several pixels, so object, alpha and catchers must have the same motion.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre import calibration
from daguerre.cli import main
from daguerre.frame.over import change_of_rgb
from tests.plates.test_catchers import ground_and_ball
from tests.plates.test_truth import ALPHA, Case
from tests.support.formats import tracked
from tests.support.pictures.statistical import differences

MOMENTS = tracked.path(4)
FRAMES = (1, 2)
BATCHES, SPP = 6, 32
ROLLING: dict[str, Any] = {
    "shutter_time": 1 / 100,
    "shutter_type": "electronic",
    "rolling_shutter": dg.RollingShutter(readout_time=1 / 40),
}
#: Distortion of the stage's lens, and its iris: blur that moves.
STAGE = {
    "distortion": [{"model": "Brown-Conrady U-D", "radial": [-2e-4], "tangential": [0, 0]}],
    "fStop": 2.8,
    "focusDistance": 3.4,
}


def opentrackio(folder: Path) -> calibration.Calibration:
    return calibration.read(tracked.opentrackio(folder / "take.jsonl", MOMENTS, **STAGE))


def colmap(folder: Path) -> calibration.Calibration:
    return calibration.read(tracked.colmap(folder / "model", MOMENTS), "IMG_####.jpg")


def nerfstudio(folder: Path) -> calibration.Calibration:
    file = tracked.nerfstudio(folder / "transforms.json", MOMENTS)
    return calibration.read(file, "./images/frame_#####.png")


WAYS: dict[str, Callable[[Path], calibration.Calibration]] = {
    "OpenTrackIO": opentrackio,
    "COLMAP": colmap,
    "Nerfstudio": nerfstudio,
}


def frames(case: Case, kind: str, frame: int, seed: int) -> list[dg.Frame]:
    """Independent pictures of a frame of the sequence."""
    scene = case.scene(kind)
    scene.time = frame / case.camera.fps
    return [
        dg.render(
            scene, case.camera, resolution=tracked.SIZE, spp=SPP, seed=seed + i, light_paths="off"
        )
        for i in range(BATCHES)
    ]


def light(found: list[dg.Frame]) -> NDArray[np.float64]:
    return np.array([f.rgb for f in found], np.float64)


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("way", WAYS)
def test_the_composite_is_the_picture_of_the_whole(way: str, frame: int, tmp_path: Path) -> None:
    base = WAYS[way](tmp_path).camera(dg.Camera(f_stop=None))
    case = Case(base.with_(**ROLLING))
    assert case.camera.motion.keys() >= {"transform"}
    whole = light(frames(case, "full", frame, 100))
    plates = [f.rgb for f in frames(case, "empty", frame, 200)]
    caught = frames(case, "caught", frame, 300)
    made = [change_of_rgb(f).of(p) for f, p in zip(caught, plates, strict=True)]
    assert differences(np.array(made, np.float64), whole, alpha=ALPHA) == []
    # The same camera, standing still in the middle of the frame, is told apart.
    still = Case(case.camera.frozen_at(frame / case.camera.fps))
    stands = [
        change_of_rgb(f).of(p)
        for f, p in zip(frames(still, "caught", frame, 300), plates, strict=True)
    ]
    assert differences(np.array(stands, np.float64), whole, alpha=ALPHA) != []


def test_commands_of_a_tracked_sequence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Plates, objects and composites by the command line: frame by frame what Python makes."""
    monkeypatch.chdir(tmp_path)
    ground_and_ball(tmp_path / "set.gltf", {})
    tracked.colmap(tmp_path / "model", MOMENTS)
    shown = ["--calibration", "model:IMG_####.jpg", "--lens", "pinhole", "--sky", "1,1,1"]
    how = [*shown, "--shutter", "1/100", "--rolling", "top,25ms", "--spp", "4", "-q"]
    run = ["--frames", "1-2", "-o"]
    caught = ["--catcher", "ground", "--background", "transparent"]
    assert main(["render", "set.gltf", *how, *run, "plate.##.exr", "--seed", "9"]) == 0
    assert main(["render", "set.gltf", *how, *caught, *run, "object.####.exr"]) == 0
    assert main(["composite", "plate.##.exr", "object.####.exr", *run, "shot.#.exr", "-q"]) == 0
    for n in FRAMES:
        objects, plate = (
            dg.load_frame(f"{name}.exr") for name in (f"object.000{n}", f"plate.0{n}")
        )
        wanted = change_of_rgb(objects).of(plate.rgb)
        assert np.array_equal(dg.load_frame(f"shot.{n}.exr").rgb, wanted)
    one, two = (dg.load_frame(f"shot.{n}.exr").rgb for n in FRAMES)
    assert np.abs(one - two).mean() > 0.01 * one.mean()


def test_each_frame_sees_its_own_plate(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """Plates that are thrown onto the catchers go with the frames, as a call for each would."""
    monkeypatch.chdir(tmp_path)
    ground_and_ball(tmp_path / "set.gltf", {})
    how = ["--sky", "1,1,1", "--spp", "4", "--res", "36x24", "--lens", "pinhole", "-q"]
    how += ["--catcher", "ground"]
    for n, value in ((0, 0.5), (1, 0.2), (2, 2.0)):
        plate = np.full((24, 36, 3), value, np.float32)
        dg.Frame(rgb=plate, xyz=plate, metadata={}).save(f"plate.{n:02d}.exr")
    run = ["render", "set.gltf", *how, "--plate", "plate.##.exr", "-o", "o.#.exr"]
    assert main([*run, "--frames", "0-2"]) == 0
    found = [dg.load_frame(f"o.{n}.exr").rgb for n in (0, 1, 2)]
    for n in (0, 1, 2):
        one = ["--plate", f"plate.{n:02d}.exr", "--frames", str(n), "-o", "one.#.exr"]
        assert main(["render", "set.gltf", *how, *one]) == 0
        assert np.array_equal(found[n], dg.load_frame(f"one.{n}.exr").rgb)
    assert not np.array_equal(found[1], found[2])
    assert not np.array_equal(found[0], found[1])
    assert main([*run, "--frames", "1-4"]) == 3
    assert "frame 3: plate.03.exr: no such file" in capfd.readouterr().err
    alone = ["--plate", "plate.##.exr", "-o", "o.exr"]
    assert main(["render", "set.gltf", *how, *alone]) == 2
    assert "--plate plate.##.exr: # stands for the frame number" in capfd.readouterr().err
