"""Cameras of Blender: where points are seen, panoramas and blur against Cycles, and their panel."""

import math

import numpy as np
import pytest

import daguerre as dg
from daguerre.blender.cameras import camera_of
from daguerre.blender.film import resolution_of
from daguerre.files.notes import Notes
from tests.support import blender_pictures as blender

bpy = blender.bpy


def made(thing, metres=1.0, notes=None):
    """Our camera of an object, in a scene of units of so many metres."""
    bpy.context.view_layer.update()
    bpy.context.scene.unit_settings.scale_length = metres
    matrix = blender.y_up(thing.matrix_world, metres)
    return camera_of(thing, bpy.context.scene.render, matrix, notes or Notes())


def random_camera(rng):
    """A random camera, and its render settings."""
    data = bpy.data.cameras.new("camera")
    data.lens, data.sensor_width, data.sensor_height = rng.uniform((10, 8, 8), (150, 50, 40))
    data.sensor_fit = rng.choice(["AUTO", "HORIZONTAL", "VERTICAL"])
    data.shift_x, data.shift_y = rng.uniform(-0.5, 0.5, 2)
    thing = blender.linked(data, rng.uniform(-5, 5, 3), rng.uniform(-3, 3, 3), (1, 1, 1))
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = (2 * int(n) for n in rng.integers(5, 30, 2))
    render.resolution_percentage = int(rng.choice([50, 100, 150]))
    render.pixel_aspect_x, render.pixel_aspect_y = rng.choice([(1, 1), (1, 1.5), (2, 1)])
    bpy.context.scene.camera = thing
    return thing


def test_points_are_seen_where_blender_sees_them():
    from bpy_extras.object_utils import world_to_camera_view

    blender.empty()
    rng, worst = np.random.default_rng(7), 0.0
    for _ in range(100):
        thing = random_camera(rng)
        camera = made(thing)
        size = resolution_of(bpy.context.scene.render)
        rays = dg.raymap(camera, size, frame="world")
        row, column = rng.integers(0, size[1]), rng.integers(0, size[0])
        point = rays.origin[row, column] + rng.uniform(1, 3) * rays.direction[row, column]
        x, y, z = point
        from mathutils import Vector

        seen = world_to_camera_view(bpy.context.scene, thing, Vector((x, -z, y)))
        wanted = ((column + 0.5) / size[0], 1 - (row + 0.5) / size[1])
        worst = max(worst, abs(seen.x - wanted[0]), abs(seen.y - wanted[1]))
        bpy.data.objects.remove(thing)
    assert worst < 1e-5  # Blender computes in single precision


def sky_of_directions():
    """A world that shows (d + 1) / 2 of each direction d."""
    tree = bpy.context.scene.world.node_tree
    background = tree.nodes["Background"]
    background.inputs["Strength"].default_value = 1.0
    coordinate = tree.nodes.new("ShaderNodeTexCoord")
    half = tree.nodes.new("ShaderNodeVectorMath")
    half.operation = "MULTIPLY_ADD"
    half.inputs[1].default_value = half.inputs[2].default_value = (0.5, 0.5, 0.5)
    tree.links.new(coordinate.outputs["Generated"], half.inputs[0])
    tree.links.new(half.outputs[0], background.inputs["Color"])


PANORAMAS = {
    "EQUIRECTANGULAR": [
        {},
        {"longitude_min": -1.0, "longitude_max": 2.0, "latitude_max": 1.0},
        {"shift_x": 0.1, "shift_y": 0.2},
    ],
    "FISHEYE_EQUIDISTANT": [
        {"fisheye_fov": math.pi},
        {"fisheye_fov": 1.5, "shift_x": 0.2, "shift_y": -0.1},
    ],
    "FISHEYE_EQUISOLID": [
        {"fisheye_fov": math.pi, "fisheye_lens": 10.5},
        {"fisheye_lens": 20.0, "shift_x": 0.1, "shift_y": -0.2, "sensor_width": 30.0},
    ],
    "FISHEYE_LENS_POLYNOMIAL": [{}, {"fisheye_polynomial_k2": 1e-3, "sensor_width": 24.0}],
}


@pytest.mark.parametrize("resolution", [(24, 24), (32, 16), (16, 28)])
@pytest.mark.parametrize(
    ("kind", "which"), [(k, i) for k, cases in PANORAMAS.items() for i in range(len(cases))]
)
def test_panoramas_look_where_those_of_cycles_look(kind, which, resolution):
    scene = blender.empty(resolution, samples=1)
    scene.cycles.filter_width = 0.01
    sky_of_directions()
    thing = blender.camera((1, 2, 3), (0.3, 0.4, 0.5))
    thing.data.type, thing.data.panorama_type = "PANO", kind
    for name, value in PANORAMAS[kind][which].items():
        setattr(thing.data, name, value)
    theirs = 2 * blender.picture() - 1
    ours = dg.raymap(made(thing), resolution, frame="world").direction
    seen = (np.abs(np.linalg.norm(theirs, axis=2) - 1) < 1e-3) & np.isfinite(ours).all(axis=2)
    assert seen.mean() > 0.3
    turned = np.stack([ours[..., 0], -ours[..., 2], ours[..., 1]], axis=2)
    np.testing.assert_allclose(turned[seen], theirs[seen], atol=2e-3)
