"""Worlds of Blender against panoramas by Cycles."""

import math

import numpy as np
import pytest

import daguerre as dg
from daguerre.blender import world_bake
from daguerre.blender.cameras import camera_of
from daguerre.blender.settings import LUMENS_PER_WATT, factor_of
from daguerre.blender.world import set_world
from daguerre.files.notes import Notes
from daguerre.scene.scene import Scene
from tests.support.blender import blender_pictures as blender

bpy = blender.bpy

SIZE = (64, 32)


def picture_of_hills(columns=256, rows=128, *, floats=True, space=None):
    """A smooth picture without symmetry, as an image of Blender."""
    x, y = np.meshgrid(np.linspace(0, 1, columns, endpoint=False), np.linspace(0, 1, rows))
    waves = [
        0.3 + 0.25 * np.sin(2 * np.pi * x + p) * np.sin(np.pi * y) ** 2 + 0.1 * (p + 1) * y
        for p in range(3)
    ]
    image = bpy.data.images.new("hills", columns, rows, float_buffer=floats)
    if space is not None:
        image.colorspace_settings.name = space
    image.pixels.foreach_set(np.stack([*waves, np.ones_like(x)], -1).astype(np.float32).ravel())
    image.update()
    return image


def textured(image, projection="EQUIRECTANGULAR", mappings=(), coordinate=True):
    """Sets a world of an environment texture behind Mapping nodes, the last one first."""
    tree = bpy.context.scene.world.node_tree
    background = tree.nodes["Background"]
    background.inputs["Strength"].default_value = 2.5
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image, texture.projection = image, projection
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    socket = texture.inputs["Vector"]
    for kind, place, angles, scale in mappings:
        node = tree.nodes.new("ShaderNodeMapping")
        node.vector_type = kind
        if kind in ("POINT", "TEXTURE"):
            node.inputs["Location"].default_value = place
        node.inputs["Rotation"].default_value = angles
        node.inputs["Scale"].default_value = scale
        tree.links.new(node.outputs["Vector"], socket)
        socket = node.inputs["Vector"]
    if coordinate:
        source = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(source.outputs["Generated"], socket)
    return bpy.context.scene.world


def theirs(world):
    """Panorama of a world by Cycles, its middle along +y."""
    return world_bake.bake(world, SIZE)


def ours(world, notes):
    """Panorama of the scene in Blender's values, of the same size."""
    scene = Scene()
    set_world(scene, world, notes)
    sky = scene.environment
    if sky is None:
        return np.zeros((SIZE[1], SIZE[0], 3))
    assert sky.rotation == 0
    if sky.image is None:
        return np.broadcast_to(np.array(sky.color) / LUMENS_PER_WATT, (SIZE[1], SIZE[0], 3))
    picture = sky.image * (sky.scale / LUMENS_PER_WATT)
    if not picture.any():
        return np.zeros((SIZE[1], SIZE[0], 3))
    down, across = picture.shape[0] // SIZE[1], picture.shape[1] // SIZE[0]
    return picture.reshape(SIZE[1], down, SIZE[0], across, 3).mean(axis=(1, 3))


def assert_alike(world, notes=None, most=0.02):
    wanted, found = theirs(world), ours(world, notes or Notes())
    assert wanted.max() > 0.1
    # Cycles mixes the first and the last row of a picture at the poles.
    error = np.abs(found - wanted).max(axis=2)
    assert np.quantile(error, 0.97) < most * wanted.max()
    np.testing.assert_allclose(found.mean(axis=(0, 1)), wanted.mean(axis=(0, 1)), rtol=0.01)


MAPPINGS = {
    "none": [],
    "about z": [("POINT", (0, 0, 0), (0, 0, 0.7), (1, 1, 1))],
    "about all": [("POINT", (0, 0, 0), (0.5, -0.4, 0.7), (1, 1, 1))],
    "texture": [("TEXTURE", (0.2, 0.1, 0), (0.5, -0.4, 0.7), (1, 2, 0.5))],
    "scaled and moved": [("POINT", (0.1, 0.2, -0.3), (0.1, 0, 0.3), (1.5, 1, -1))],
    "vector": [("VECTOR", (0, 0, 0), (0.3, 0.2, 0.1), (1, 2, 1))],
    "two": [
        ("POINT", (0, 0, 0.2), (0, 0.3, 0.7), (1, 1, 2)),
        ("TEXTURE", (0, 0.1, 0), (0.4, 0, 0.2), (1, 1, 1)),
    ],
}


@pytest.mark.parametrize("mapping", MAPPINGS)
def test_a_panorama_is_turned_as_cycles_turns_it(mapping):
    blender.empty()
    notes = Notes()
    assert_alike(textured(picture_of_hills(), mappings=MAPPINGS[mapping]), notes)
    assert notes.sentences() == []


def test_a_mirror_ball_is_unwrapped():
    blender.empty()
    world = textured(picture_of_hills(128, 128), "MIRROR_BALL", MAPPINGS["about all"])
    wanted, found = theirs(world), ours(world, Notes())
    error = np.abs(found - wanted).max(axis=2)
    assert np.quantile(error, 0.98) < 0.03 * wanted.max()  # the rim shows one direction only


@pytest.mark.parametrize("space", ["sRGB", "Non-Color"])
def test_pictures_of_bytes_are_decoded(space):
    blender.empty()
    assert_alike(textured(picture_of_hills(floats=False, space=space), coordinate=False))


def test_one_colour_is_a_colour():
    scene = blender.empty()
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.2, 0.4, 0.8, 1)
    background.inputs["Strength"].default_value = 3.0
    assert_alike(scene.world)


def test_no_world_and_a_world_without_output_are_black():
    scene = blender.empty()
    assert not ours(None, Notes()).any()
    scene.world.node_tree.nodes.clear()
    assert not ours(scene.world, Notes()).any()


def test_a_missing_picture_is_noted():
    blender.empty()
    notes = Notes()
    assert not ours(textured(None), notes).any()
    assert notes.sentences() == ["the picture of a world is missing: the world is black (1 use)"]


def test_other_nodes_are_baked_with_a_note():
    scene = blender.empty()
    tree = scene.world.node_tree
    sky = tree.nodes.new("ShaderNodeTexSky")
    sky.sun_disc = False
    background = tree.nodes["Background"]
    background.inputs["Strength"].default_value = 0.3
    tree.links.new(sky.outputs["Color"], background.inputs["Color"])
    before = [len(data) for data in (bpy.data.scenes, bpy.data.objects, bpy.data.cameras)]
    notes = Notes()
    assert_alike(scene.world, notes, most=0.1)
    assert notes.sentences() == [
        "nodes of a world are baked to 1024 x 512 pixels, as the camera sees them (1 use)"
    ]
    assert [len(data) for data in (bpy.data.scenes, bpy.data.objects, bpy.data.cameras)] == before


def test_the_middle_of_a_panorama_lies_along_y_of_blender():
    scene = blender.empty()
    tree = scene.world.node_tree
    coordinate = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinate.outputs["Generated"], tree.nodes["Background"].inputs["Color"])
    tree.nodes["Background"].inputs["Strength"].default_value = 1.0
    picture = world_bake.bake(scene.world, (128, 64))
    angle = math.pi / 128
    np.testing.assert_allclose(picture[32, 64], (math.sin(angle), math.cos(angle), 0), atol=0.03)
    np.testing.assert_allclose(picture[0, 64, 2], 1, atol=0.01)


def test_a_camera_sees_a_world_as_cycles_shows_it():
    blender.empty((16, 16))
    world = textured(picture_of_hills(), mappings=MAPPINGS["about all"])
    eye = blender.camera((0, 0, 0), (1.2, 0.3, -0.7), lens=20.0)
    bpy.context.view_layer.update()
    wanted = blender.picture()
    scene = Scene()
    set_world(scene, world, Notes())
    camera = camera_of(eye, bpy.context.scene.render, blender.y_up(eye.matrix_world), Notes())
    frame = dg.render(scene, camera, resolution=(16, 16), spp=64, filter="box")
    found = frame.rgb * factor_of(bpy.context.scene)
    blocks = [p.reshape(4, 4, 4, 4, 3).mean(axis=(1, 3)) for p in (found, wanted)]
    assert np.ptp(wanted) > 0.2
    np.testing.assert_allclose(blocks[0], blocks[1], rtol=0.01)
