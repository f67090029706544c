"""A photograph of the set as light: objects see in it what they see in the set itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import daguerre as dg
from daguerre.frame.over import change_of_rgb
from tests.plates.test_truth import BATCHES, GLASS, MATTE, SIZE, SPP, Case, real, shifted, thin
from tests.support.statistical import differences

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
    with pytest.raises(dg.InputError, match="wanted finite numbers, got others at 1 pixels"):
        scene.set_plate(
            np.where(np.indices((3, 4, 5))[0].transpose(1, 2, 0) > 9, 0, np.nan)[:1, :1]
        )
    with pytest.raises(dg.UsageError, match="camera: wanted a Camera"):
        scene.set_plate(np.zeros((4, 4, 3)), "there")  # type: ignore[arg-type]
