"""A photograph of the set as light: objects see in it what they see in the set itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import daguerre as dg
from daguerre.cli import main
from daguerre.frame.over import change_of_rgb
from daguerre.plates.photo_light import photo_light
from tests.plates.test_catchers import ground_and_ball
from tests.plates.test_truth import BATCHES, GLASS, MATTE, SIZE, SPP, Case, real, shifted, thin
from tests.support.pictures.statistical import differences

MIRROR = dg.Material(dg.Conductor((0.9, 0.8, 0.7), 0.0))
CASES = {
    "mirror": Case(thin(), MATTE, MIRROR),
    "glass": Case(thin(), MATTE, GLASS),
    "matte": Case(thin(), MATTE, dg.Diffuse((0.8, 0.8, 0.8))),
    "vignetted": Case(real(), MATTE, MIRROR, shifted(-0.9, 0.5, -1)),
}
#: Wrong by so much: the set's material, which must not be what objects see.
WRONG = dg.Diffuse((0.9, 0.1, 0.9))


@pytest.mark.parametrize("name", CASES)
def test_objects_see_the_set_in_the_plate(name: str) -> None:
    case = CASES[name]
    whole = np.array([f.rgb for f in case.frames("full", 100)], np.float64)
    plates = [f.rgb for f in case.frames("empty", 200)]
    sharp = dg.render(
        case.scene("empty"), case.camera, resolution=(288, 192), spp=256, seed=7, light_paths="off"
    )
    scene = case.scene("caught")
    scene.set_plate(sharp.rgb)
    made = []
    for i in range(BATCHES):
        frame = dg.render(scene, case.camera, resolution=SIZE, spp=SPP, seed=300 + i)
        made.append(change_of_rgb(frame).of(plates[i]))
    assert differences(np.array(made, np.float64), whole, alpha=1e-3) == []


def test_the_photograph_counts_and_not_the_material() -> None:
    """A ground that is modelled in another colour: its photograph is what the mirror shows."""
    case = CASES["mirror"]
    sharp = dg.render(case.scene("empty"), case.camera, resolution=(144, 96), spp=256, seed=7)
    seen = {}
    for kind in ("right", "wrong", "wrong with plate"):
        given = case if kind == "right" else replace(case, ground=WRONG)
        scene = given.scene("caught")
        if kind == "wrong with plate":
            scene.set_plate(sharp.rgb, case.camera)
        seen[kind] = dg.render(scene, case.camera, resolution=SIZE, spp=64, light_paths="off")
    # The lower middle of the ball, which sees the ground before it, within the frame.
    part = (slice(27, 30), slice(33, 39))
    right, wrong, mended = (seen[kind].rgb[part].mean(axis=(0, 1)) for kind in seen)
    assert np.linalg.norm(wrong - right) > 0.3 * np.linalg.norm(right)
    # The material still colours the ball's own shadow there.
    assert np.linalg.norm(mended - right) < 0.2 * np.linalg.norm(wrong - right)


def test_bad_plates_are_refused() -> None:
    scene = CASES["mirror"].scene("caught")
    with pytest.raises(
        dg.InputError, match=r"plate: pixels: wanted shape \(H, W, 3\), got \(4, 4\)"
    ):
        scene.set_plate(np.zeros((4, 4)))
    with pytest.raises(
        dg.InputError, match="wanted finite numbers, got NaN or infinity in 1 pixels"
    ):
        scene.set_plate(
            np.where(np.indices((3, 4, 5))[0].transpose(1, 2, 0) > 9, 0, np.nan)[:1, :1]
        )
    with pytest.raises(dg.UsageError, match="camera: wanted a Camera"):
        scene.set_plate(np.zeros((4, 4, 3)), "there")  # type: ignore[arg-type]


def test_the_matched_camera_says_what_exif_lacks(tmp_path: Path) -> None:
    """ISO 12232: 1 is 4 / pi * 10 / 0.18 * N^2 / (t S) cd/m2."""
    path = tmp_path / "plate.png"
    Image.fromarray(np.full((8, 12, 3), 255, np.uint8)).save(path)
    light, notes = photo_light(path)
    assert light.max() == pytest.approx(1, rel=1e-3)
    assert "EXIF lacks exposure time, f-number, ISO" in notes[0]
    assert "--plate-scale sets it" in notes[0]
    taken = dg.Camera(f_stop=2.8, shutter_time=1 / 60, iso=400)
    light, notes = photo_light(path, taken=taken)
    assert light.max() == pytest.approx(70.7355 * 2.8**2 * 60 / 400, rel=1e-3)
    assert not any("lacks" in note for note in notes)
    light, _ = photo_light(path, 3.0, taken)
    assert light.max() == pytest.approx(3, rel=1e-3)


def test_the_command_takes_the_exposure_of_the_matched_camera(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    scene, plate, camera = (str(tmp_path / name) for name in ("a.gltf", "plate.png", "c.json"))
    ground_and_ball(tmp_path / "a.gltf", {})
    dice = np.random.default_rng(1)
    Image.fromarray(dice.integers(90, 99, (48, 72, 3), np.uint8).astype(np.uint8)).save(plate)
    facts = [
        "--f-stop=2.8",
        "--shutter=1/60",
        "--iso=400",
        "--sensor=ff",
        "--focal-length=35",
        "-q",
    ]
    assert main(["match-plate", plate, "-o", camera, *facts]) == 0
    flags = ["--like-plate", camera, "--plate", plate, "--catcher", "ground", "--sky", "9,9,9"]
    assert main(["render", scene, *flags, "--spp", "1", "-o", str(tmp_path / "o.exr")]) == 0
    assert "EXIF lacks" not in capfd.readouterr().err
