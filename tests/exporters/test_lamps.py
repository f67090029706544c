"""Lamps on their way out: the falloff is the core's, frames shine where ours do."""

from __future__ import annotations

import math

import numpy as np
import pytest

import daguerre as dg
from daguerre.exporters.outgoing.lamps import plain, reach_of, spot_factors, turned
from daguerre.files.notes import Notes


def test_the_falloff_of_a_spot_is_that_of_our_pictures() -> None:
    """Light of a spot on a screen of white, drawn by the core without noise."""
    light = dg.SpotLight((1.0, 1.0, 1.0), inner_angle=10.0, outer_angle=35.0)
    scene = dg.Scene()
    corners = [(-2, -2, -1), (2, -2, -1), (2, 2, -1), (-2, 2, -1)]
    screen = scene.add_mesh(corners, [(0, 1, 2), (0, 2, 3)])
    scene.add_instance(screen, dg.Diffuse((1.0, 1.0, 1.0)))
    scene.add_light(light)
    camera = dg.Camera(lens="pinhole", focal_length=18.0)  # 90 degrees across
    frame = dg.render(scene, camera, resolution=(60, 40), spp=64, filter="box")
    x = (np.arange(60) + 0.5) / 30 - 1
    cosine = 1 / np.sqrt(1 + x**2)
    row = frame.rgb[19:21, :, 1].mean(axis=0)
    expected = spot_factors(light, cosine) * cosine**3 / math.pi
    np.testing.assert_allclose(row, expected, atol=0.02 * expected.max())


def test_a_frame_shines_where_the_lamp_does() -> None:
    rng = np.random.default_rng(0)
    for _ in range(20):
        matrix = np.eye(4)
        matrix[:3] = rng.normal(size=(3, 4))
        for ahead, sign in (("-z", -1), ("+z", 1)):
            made = turned(matrix, ahead)
            np.testing.assert_allclose(made[:3, :3] @ made[:3, :3].T, np.eye(3), atol=1e-12)
            assert np.linalg.det(made[:3, :3]) == pytest.approx(1)
            shines = -matrix[:3, 2] / np.linalg.norm(matrix[:3, 2])
            np.testing.assert_allclose(sign * made[:3, 2], shines, atol=1e-12)
            np.testing.assert_array_equal(made[:3, 3], matrix[:3, 3])


def test_what_other_lamps_lack_is_noted_and_balls_keep_their_intensity() -> None:
    notes = Notes()
    made = plain(dg.PointLight((2.0, 4.0, 6.0), radius=0.5, range=3.0), notes)
    assert isinstance(made, dg.SphereLight)
    seen = np.array(made.luminance) * math.pi * 0.25  # cd, from afar
    np.testing.assert_allclose(seen, (2, 4, 6))
    sun = plain(dg.DirectionalLight((1.0, 1.0, 1.0), angle=0.5), notes)
    assert isinstance(sun, dg.DirectionalLight)
    assert sun.angle == 0
    assert [text.split(" ")[0] for text in notes.sentences()] == ["range", "angle"]


def test_the_reach_of_a_profile_is_the_cone_around_its_light() -> None:
    table = dg.LightProfile.table
    assert reach_of(table([0, 30], [1.0, 0.0])) == pytest.approx(30, abs=0.1)
    one_side = table([0, 20, 60], [[1.0, 1, 1, 1], [0, 1, 0, 0], [0, 0, 0, 0]], [0, 90, 180, 270])
    assert reach_of(one_side) == pytest.approx(60, abs=0.1)
    assert reach_of(dg.LightProfile.cone(45.0)) == pytest.approx(45, abs=0.1)
    assert reach_of(dg.LightProfile()) == 180
    assert reach_of(table([0, 10], [0.0, 0.0])) == 0
