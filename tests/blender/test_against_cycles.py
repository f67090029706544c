"""Whole scenes: triangles against Blender's glTF, pictures by the engine's way against Cycles.

Both renderers draw the same samples in boxes of a pixel, with all bounces and caustics, and without
clamping. Where Cycles offers a choice that Daguerre does not have, the scenes take Daguerre's side
(``twelve_scenes.py`` says where): rough surfaces scatter once, bumps keep their shadows.
"""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre.blender import settings
from daguerre.blender.translate import scene_of
from tests.support.blender import blender_pictures as blender

from . import building, triangles, twelve_scenes

BLOCK = 8
#: Largest differences of the median block, and of the mean of the picture.
BLOCKS, MEAN = 0.03, 0.01


def taken(camera_change=None, **options):
    """Picture of the file by Daguerre, in Blender's values."""
    graph = building.graph()
    scene = scene_of(graph)
    camera = scene.camera() if camera_change is None else scene.camera().with_(**camera_change)
    wanted = settings.settings_of(graph.scene).with_(
        filter="box", max_depth=twelve_scenes.BOUNCES + 1, light_paths="off", **options
    )
    return dg.render(scene, camera, settings=wanted).rgb * settings.factor_of(graph.scene)


def apart(ours, theirs):
    """Median relative difference of blocks, and that of the mean, largest of the colours."""
    blocks = []
    for image in (ours, theirs):
        rows, columns = (side // BLOCK for side in image.shape[:2])
        cut = np.asarray(image, float).reshape(rows, BLOCK, columns, BLOCK, 3)
        blocks.append(cut.mean(axis=(1, 3)))
    assert blocks[1].min() > 0
    means = [block.mean(axis=(0, 1)) for block in blocks]
    return (
        float(np.median(np.abs(blocks[0] / blocks[1] - 1))),
        float(np.abs(means[0] / means[1] - 1).max()),
    )


def compare(make, samples):
    """Both renderers photograph a scene; they agree within the limits."""
    twelve_scenes.stage(samples=samples)
    make()
    theirs = blender.picture()
    median, mean = apart(taken(), theirs)
    assert median < BLOCKS, (median, mean)
    assert mean < MEAN, (median, mean)


def named(scenes):
    return pytest.mark.parametrize("make", scenes, ids=lambda make: make.__name__)


@named(twelve_scenes.SCENES)
def test_triangles_are_those_of_the_gltf_export(make, tmp_path, monkeypatch):
    """Positions, normals and texture coordinates in the world, within 1e-6; lamps aside."""
    twelve_scenes.stage()
    make()
    ours, theirs = building.translated(), dg.load(building.exported(tmp_path, monkeypatch))
    found = triangles.farthest(triangles.of(ours), triangles.of(theirs))
    assert max(found) < 1e-6, found


@named(twelve_scenes.SCENES)
def test_pictures_are_those_of_cycles(make):
    compare(make, 64)


@named(twelve_scenes.BLURRED)
def test_depth_of_field_and_motion_blur_are_those_of_cycles(make):
    compare(make, 64)


@pytest.mark.slow
@named([*twelve_scenes.SCENES, *twelve_scenes.BLURRED])
def test_pictures_of_many_samples_are_those_of_cycles(make):
    compare(make, 384)


@pytest.mark.parametrize(
    ("make", "change"),
    [
        (twelve_scenes.deep_rows, {"f_stop": 0.05}),
        (twelve_scenes.sliding_boxes, {"shutter_offset": 0.0}),
        (twelve_scenes.travelling_camera, {"shutter_offset": 0.0}),
        (twelve_scenes.travelling_camera, {"shutter_time": 0.005}),
    ],
)
def test_the_comparison_knows_another_blur(make, change):
    """Another stop or shutter is farther from Cycles than the right one, by far."""
    twelve_scenes.stage(samples=64)
    make()
    theirs = blender.picture()
    right, wrong = apart(taken(), theirs), apart(taken(change), theirs)
    assert wrong[0] > 2 * right[0]
