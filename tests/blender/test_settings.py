"""Render settings of Blender, and the rule of light."""

from types import SimpleNamespace

import numpy as np
import pytest

from daguerre.blender.settings import LUMENS_PER_WATT, factor_of, settings_of
from tests.support.blender import blender_pictures as blender

bpy = blender.bpy


def test_settings_are_blenders():
    scene = blender.empty((40, 30), samples=32)
    scene.render.resolution_percentage = 55
    scene.cycles.seed, scene.frame_current = 5, 7
    found = settings_of(scene)
    assert found.film.resolution == (22, 16)
    assert (found.sampling.spp, found.sampling.seed, found.threads) == (32, 5, 1)
    assert found.backdrop.background == "environment"
    assert found.film.crop is None
    scene.cycles.use_animated_seed = scene.render.film_transparent = True
    scene.render.threads_mode = "AUTO"
    found = settings_of(scene)
    assert (found.sampling.seed, found.backdrop.background) == (12, "transparent")
    assert found.threads == 0


@pytest.mark.parametrize("border", [(0.26, 0.13, 0.77, 0.62), (0.0, 0.5, 0.5, 1.0)])
def test_the_region_is_the_one_that_cycles_draws(border):
    scene = blender.empty((30, 22), samples=1)
    scene.cycles.filter_width = 0.01
    tree = scene.world.node_tree
    coordinate = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinate.outputs["Window"], tree.nodes["Background"].inputs["Color"])
    tree.nodes["Background"].inputs["Strength"].default_value = 1.0
    blender.camera()
    whole = blender.picture()
    render = scene.render
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_min_y, render.border_max_x, render.border_max_y = border
    part = blender.picture()
    x0, y0, x1, y1 = settings_of(scene).film.crop
    assert part.shape[:2] == (y1 - y0, x1 - x0)
    np.testing.assert_allclose(part, whole[y0:y1, x0:x1], atol=2e-3)


def test_a_region_of_nothing_is_a_pixel():
    scene = blender.empty((30, 22))
    render = scene.render
    render.use_border = True
    render.border_min_x = render.border_max_x = 1.0
    render.border_min_y = render.border_max_y = 0.0
    assert settings_of(scene).film.crop == (29, 21, 30, 22)


def test_the_exposure_of_the_film_multiplies():
    scene = blender.empty()
    assert factor_of(scene) == pytest.approx(1 / LUMENS_PER_WATT)
    scene.cycles.film_exposure = 2.5
    assert factor_of(scene) == pytest.approx(2.5 / LUMENS_PER_WATT)


def test_panels_take_precedence():
    scene = blender.empty((8, 8))
    group = SimpleNamespace(spp=17, noise=0.02, light_paths="off")
    switches = SimpleNamespace(lens="thin", flare=True, scatter=False, diffraction=False)
    camera = SimpleNamespace(data=SimpleNamespace(daguerre=switches))
    shot = SimpleNamespace(
        render=scene.render, cycles=scene.cycles, camera=None, frame_current=1, daguerre=group
    )
    found = settings_of(shot, camera)
    assert (found.sampling.spp, found.sampling.noise) == (17, 0.02)
    assert found.light.light_paths == "off"
    assert (found.light.flare, found.light.scatter) == ("auto", "off")
