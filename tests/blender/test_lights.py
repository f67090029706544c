"""Lamps of Blender against pictures by Cycles, and against the formulas of their units."""

import math

import numpy as np
import pytest

import daguerre as dg
from daguerre.blender import lights
from daguerre.blender.settings import LUMENS_PER_WATT
from daguerre.files.notes import Notes
from daguerre.scene.scene import Scene
from tests.support.blender import blender_pictures as blender

bpy = blender.bpy

#: Size of the card, height of the lamp above it, Blender's units.
CARD, HEIGHT = 3.0, 1.0
CASES = {
    "point": ("POINT", {"energy": 100, "shadow_soft_size": 0.0}),
    "ball": ("POINT", {"energy": 100, "shadow_soft_size": 0.2, "use_soft_falloff": False}),
    "ball, not normalized": (
        "POINT",
        {"energy": 100, "shadow_soft_size": 0.2, "use_soft_falloff": False, "normalize": False},
    ),
    "point, not normalized": ("POINT", {"shadow_soft_size": 0.0, "normalize": False}),
    "soft point": ("POINT", {"energy": 100, "shadow_soft_size": 0.05}),
    "sun": ("SUN", {"energy": 2, "angle": 0.1}),
    "sun, not normalized": ("SUN", {"energy": 2, "angle": 0.1, "normalize": False}),
    "parallel sun, not normalized": ("SUN", {"energy": 2, "angle": 0.0, "normalize": False}),
    "spot": ("SPOT", {"energy": 100, "shadow_soft_size": 0.0, "spot_blend": 0.5}),
    "wide spot": ("SPOT", {"shadow_soft_size": 0.0, "spot_size": 2.5, "spot_blend": 1.0}),
    "hard spot": ("SPOT", {"shadow_soft_size": 0.0, "spot_size": 1.5, "spot_blend": 0.0}),
    "square": ("AREA", {"energy": 10, "size": 0.3}),
    "rectangle": ("AREA", {"shape": "RECTANGLE", "size": 0.2, "size_y": 0.6}),
    "disk": ("AREA", {"shape": "DISK", "size": 0.5}),
    "ellipse": ("AREA", {"shape": "ELLIPSE", "size": 0.7, "size_y": 0.3}),
    "ellipse, not normalized": (
        "AREA",
        {"shape": "ELLIPSE", "size": 0.7, "size_y": 0.3, "normalize": False},
    ),
    "narrow area": ("AREA", {"size": 0.2, "spread": math.radians(60)}),
    "wide area": ("AREA", {"size": 0.2, "spread": math.radians(150)}),
    "exposed": ("POINT", {"shadow_soft_size": 0.0, "exposure": 1.5, "color": (1, 0.5, 0.2)}),
    "candle": ("SUN", {"use_temperature": True, "temperature": 1900.0}),
}


def lamp(kind, rotation=(0, 0, 0), scale=(1, 1, 1), **values):
    """A lamp above the card, and its object."""
    light = bpy.data.lights.new(kind, kind)
    for name, value in values.items():
        setattr(light, name, value)
    made = blender.linked(light, (0, 0, HEIGHT), rotation, scale, "lamp")
    bpy.context.view_layer.update()
    return light, made


def stage(samples=64, scale_length=1.0):
    """A card on the floor, seen from above through a pinhole that is off to the side."""
    scene = blender.empty(samples=samples)
    scene.unit_settings.scale_length = scale_length
    blender.card(CARD)
    blender.camera((4, 0, 3), (0, math.atan2(3.5, 3), 0), lens=110)


def ours(light, thing, scale_length=1.0, samples=64, notes=None):
    """Picture of the same stage by Daguerre, in Blender's values."""
    scene = Scene()
    half = CARD / 2 * scale_length
    corners = [(-half, 0, half), (half, 0, half), (half, 0, -half), (-half, 0, -half)]
    floor = scene.add_mesh(corners, [(0, 1, 2), (0, 2, 3)])
    scene.add_instance(floor, dg.Material(dg.Diffuse((1.0, 1.0, 1.0))))
    matrix = blender.y_up(thing.matrix_world, scale_length)
    lights.add_light(scene, matrix, light, "lamp", notes or Notes(), metres_per_unit=scale_length)
    eye = blender.rigid(blender.y_up(bpy.context.scene.camera.matrix_world, scale_length))
    camera = dg.Camera(
        eye, lens="pinhole", focal_length=110, sensor_size=(36, 36), natural_vignetting=False
    )
    frame = dg.render(
        scene, camera, resolution=(16, 16), spp=samples, max_depth=1, filter="box", threads=1
    )
    return frame.rgb.astype(float) / LUMENS_PER_WATT


def assert_alike(theirs, found):
    """Means agree within 1 %, rows and columns of blocks within 3 % of the brightest."""
    assert theirs.max() > 0
    np.testing.assert_allclose(
        found.mean(axis=(0, 1)), theirs.mean(axis=(0, 1)), rtol=0.01, atol=1e-3
    )
    blocks = [p.reshape(4, 4, 4, 4, 3).mean(axis=(1, 3)) for p in (theirs, found)]
    np.testing.assert_allclose(blocks[1], blocks[0], atol=0.03 * blocks[0].max())


@pytest.mark.parametrize("name", CASES)
def test_lamps_give_the_light_that_cycles_gives(name):
    kind, values = CASES[name]
    stage(samples=256)
    light, thing = lamp(kind, rotation=(0.2, 0.1, 0.3), **values)
    assert_alike(blender.picture(), ours(light, thing, samples=256))


@pytest.mark.parametrize("name", ["ball", "sun", "spot", "rectangle", "ellipse, not normalized"])
def test_a_scene_in_centimetres_and_scaled_objects_keep_their_picture(name):
    kind, values = CASES[name]
    stage(samples=256, scale_length=0.01)
    scale = (1.5, 0.8, 2.0) if kind == "AREA" else (2.0, 2.0, 2.0)
    light, thing = lamp(kind, scale=scale, **values)
    assert_alike(blender.picture(), ours(light, thing, scale_length=0.01, samples=256))


def test_lamps_that_are_hidden_from_the_camera_are_noted_and_lamps_without_size_are_not():
    blender.empty()
    notes = Notes()
    for kind, size in (("POINT", 0.1), ("POINT", 0.0), ("AREA", None), ("SUN", None)):
        _, thing = lamp(kind, **({} if size is None else {"shadow_soft_size": size}))
        thing.visible_camera, thing.visible_diffuse = False, kind != "SUN"
        lights.note_visibility(thing, notes)
    assert notes.sentences() == [
        "a lamp hidden from the camera in Blender is visible in Daguerre (2 uses)",
        "a lamp hidden from diffuse surfaces in Blender is visible in Daguerre (1 use)",
    ]


def test_what_is_left_out_is_noted_once_with_its_count():
    blender.empty()
    scene, notes = Scene(), Notes()
    values = {"energy": -1.0, "use_shadow": False, "specular_factor": 0.5}
    values |= {"use_square": True, "shadow_soft_size": 0.1}
    for _ in range(2):
        light, thing = lamp("SPOT", scale=(1, 2, 1), **values)
        lights.add_light(scene, blender.y_up(thing.matrix_world), light, "lamp", notes)
    assert len(scene.lights) == 2
    assert scene.lights[0][0].intensity == (0, 0, 0)
    said = notes.sentences()
    assert len(said) == 6
    assert all(sentence.endswith("(2 uses)") for sentence in said)


@pytest.mark.parametrize(
    ("kind", "values", "scale"),
    [
        ("AREA", {"size": 0.0}, (1, 1, 1)),
        ("AREA", {"shape": "ELLIPSE", "size_y": 0.0}, (1, 1, 1)),
        ("POINT", {}, (0, 0, 0)),
    ],
)
def test_lamps_of_no_size_are_left_out_with_a_note(kind, values, scale):
    blender.empty()
    scene, notes = Scene(), Notes()
    light, thing = lamp(kind, scale=scale, **values)
    lights.add_light(scene, blender.y_up(thing.matrix_world), light, "lamp", notes)
    assert not scene.lights
    assert not scene.instances
    assert len(notes.sentences()) == 1


def test_an_emission_node_multiplies_and_other_nodes_are_noted():
    blender.empty()
    light, _ = lamp("POINT", energy=2.0)
    if light.node_tree is None:  # Blender 5.2 and later give lamps their nodes
        light.use_nodes = True
    tree = light.node_tree
    node = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeEmission")
    node.inputs["Color"].default_value = (0.5, 1.0, 0.0, 1.0)
    node.inputs["Strength"].default_value = 3.0
    notes = Notes()
    assert lights.glow_of(light, notes) == pytest.approx((3.0, 6.0, 0.0))
    assert notes.sentences() == []
    falloff = tree.nodes.new("ShaderNodeLightFalloff")
    tree.links.new(falloff.outputs["Linear"], node.inputs["Strength"])
    assert lights.glow_of(light, notes) == pytest.approx((2.0, 2.0, 2.0))
    assert notes.sentences() == ["nodes of a lamp are left out: Light Falloff (1 use)"]


@pytest.mark.parametrize("kind", ["POINT", "SUN", "SPOT", "AREA"])
def test_lamps_over_time_have_the_state_of_each_time(kind):
    blender.empty()
    light, thing = lamp(kind)
    start = blender.y_up(thing.matrix_world)
    end = start.copy()
    end[:3, 3] += (1, 2, 3)
    glow = dg.keys([(0.0, (1.0, 2.0, 3.0)), (1.0, (3.0, 2.0, 1.0))])
    scenes = []
    for time in (0.0, 0.5):
        scene = Scene(time=time)
        moving = dg.keys([(0.0, start), (1.0, end)])
        lights.add_light(scene, moving, light, "lamp", Notes(), glow=glow)
        scenes.append(scene)
    middle = start.copy()
    middle[:3, 3] += (0.5, 1, 1.5)
    still = Scene()
    lights.add_light(still, middle, light, "lamp", Notes(), glow=(2.0, 2.0, 2.0))
    if kind == "AREA":
        assert scenes[1].materials[-1].emission == pytest.approx(still.materials[-1].emission)
        np.testing.assert_allclose(scenes[1].instances[0].transform, middle, atol=1e-12)
    else:
        (one, place), (other, wanted) = scenes[1].lights[0], still.lights[0]
        assert one == other
        np.testing.assert_allclose(place, wanted, atol=1e-12)
        assert scenes[0].lights[0][0] != one
