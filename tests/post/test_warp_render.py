"""The map of a lens against a picture that was rendered through it."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.analysis.bench import set_up
from daguerre.distortion.lens import LensDistortion
from daguerre.post.effects.distortion import CHANNEL_NM
from tests.support.scene import scenes

LENS = "canon-ef-11-24mm-f4"
SIZE, PITCH = (300, 200), 36 / 300
DISTANCE, HALF = 2.0, 0.06  # m
DOTS = np.array([(0.0, 0.0), (0.6, -0.4), (-1.2, 0.7), (1.9, 0.1), (2.6, -1.7), (-2.7, 1.75)])


@pytest.fixture(scope="module")
def chart() -> dg.Frame:
    scene = dg.Scene()
    corners, faces = scenes.quad(HALF)
    lamp = dg.Material(dg.Diffuse((0, 0, 0)), emission=(1, 1, 1))
    mesh = scene.add_mesh(corners, faces)
    for x, y in DOTS:
        scene.add_instance(mesh, lamp, scenes.at(x, -y, -DISTANCE))
    camera = dg.Camera(lens=LENS, f_stop=8, focus_distance=DISTANCE)
    return dg.render(scene, camera, resolution=SIZE, spp=48, light_paths="off")


def centre_of_light(image: np.ndarray, guess: np.ndarray) -> np.ndarray:
    """Centre of light of the dot next to a point, px."""
    x, y = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    near = image * (np.hypot(x - guess[0], y - guess[1]) < 10)
    return np.array([(near * x).sum(), (near * y).sum()]) / near.sum()


def test_dots_are_where_the_map_says(chart):
    bench = set_up(lenses.load(LENS), focus_m=DISTANCE, f_stop=8, by="paraxial")
    for channel, nm in enumerate(CHANNEL_NM):
        model = LensDistortion(bench, 22.0, nm)
        focal = model.focal_length_mm / PITCH
        wanted = model.distort(DOTS / DISTANCE) * focal + np.array(SIZE) / 2
        straight = DOTS / DISTANCE * focal + np.array(SIZE) / 2
        assert np.abs(wanted - straight).max() > 0.5  # px: there is something to be seen
        for point in wanted:
            found = centre_of_light(chart.rgb[:, :, channel], point)
            assert found == pytest.approx(point, abs=0.08)


def test_the_picture_straightened_is_that_of_a_pinhole(chart):
    straight = dg.post.distort(
        chart.rgb,
        [
            LensDistortion(set_up(lenses.load(LENS), focus_m=DISTANCE, by="paraxial"), 22.0, nm)
            for nm in CHANNEL_NM
        ],
        focal_px=(focal := focal_px()),
        inverse=True,
    )
    for point in DOTS / DISTANCE * focal + np.array(SIZE) / 2:
        found = centre_of_light(straight[:, :, 1], point)
        assert found == pytest.approx(point, abs=0.08)


def focal_px() -> float:
    bench = set_up(lenses.load(LENS), focus_m=DISTANCE, by="paraxial")
    return LensDistortion(bench, 22.0).focal_length_mm / PITCH
