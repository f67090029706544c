"""Cameras of Blender: where points are seen, panoramas and blur against Cycles, and their panel."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import daguerre as dg
from daguerre.blender.camera_panel import CameraPanel
from daguerre.blender.cameras import camera_of
from daguerre.blender.film import resolution_of
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.scene.scene import Scene
from tests.support.blender import blender_pictures as blender

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


def test_a_perspective_camera_has_blenders_values():
    blender.empty()
    thing = blender.camera()
    data = thing.data
    data.clip_start, data.lens = 0.25, 35.0
    sharp = made(thing, metres=0.5)
    assert (sharp.lens, sharp.focal_length) == ("pinhole", 35)
    assert sharp.near_clip == pytest.approx(0.125)
    assert sharp.shutter_time == 0
    data.dof.use_dof = True
    data.dof.aperture_fstop, data.dof.focus_distance = 2.0, 3.0
    notes = Notes()
    blurred = made(thing, metres=0.5, notes=notes)
    assert (blurred.lens, blurred.f_stop, blurred.focus_distance) == ("thin", 2.0, 1.5)
    assert len(notes.sentences()) == 1


def test_an_object_in_focus_counts_along_the_axis():
    blender.empty()
    thing = blender.camera((0, 0, 5))
    thing.data.dof.use_dof = True
    thing.data.dof.focus_object = blender.linked(None, (3, 1, 1))
    assert made(thing).focus_distance == pytest.approx(4.0)


@pytest.mark.parametrize(("position", "offset"), [("START", 0.0), ("CENTER", -0.3), ("END", -0.6)])
def test_the_shutter_of_motion_blur(position, offset):
    scene = blender.empty()
    render = scene.render
    render.fps, render.fps_base, render.use_motion_blur = 30, 1.001, True
    render.motion_blur_shutter, render.motion_blur_position = 0.6, position
    camera = made(blender.camera())
    assert camera.fps == pytest.approx(30 / 1.001)
    assert camera.shutter_time == pytest.approx(0.6 * 1.001 / 30)
    assert camera.shutter_offset == pytest.approx(offset)
    assert camera.shutter_curve is None
    points = render.motion_blur_shutter_curve.curves[0].points
    points[0].location = (0.0, 0.0)
    render.motion_blur_shutter_curve.update()
    curve = made(blender.camera()).shutter_curve
    assert curve[0] == pytest.approx((0, 0), abs=1e-6)
    assert curve[-1] == pytest.approx((1, 1), abs=1e-3)


@pytest.mark.parametrize("blades", [0, 3])
def test_blur_and_blades_are_those_of_cycles(blades):
    """An out-of-focus ball; the polygon of Blender has a smaller area than its circle."""
    scene = blender.empty((32, 32), 256)
    thing = blender.camera((0, 0, 0))
    ball = blender.glowing_ball((0.02, 0.01, -2), 0.02, 1000.0)
    data = thing.data
    data.sensor_width, data.dof.use_dof, data.dof.focus_distance = 8.0, True, 1.0
    data.dof.aperture_fstop, data.dof.aperture_blades = 0.4, blades
    data.dof.aperture_rotation = 0.3
    theirs = blender.picture()[..., 0]
    camera = made(thing)
    if blades:
        inscribed = blades / 2 * math.sin(2 * math.pi / blades) / math.pi
        camera = camera.with_(f_stop=camera.f_stop / math.sqrt(inscribed))
    assert ball.name in scene.objects

    def drawn(eye):
        place = np.eye(4)
        place[:3, 3] = (0.02, -2, -0.01)
        ours = Scene()
        ours.add_light(dg.SphereLight((1000.0,) * 3, 0.02), place)
        return dg.render(ours, eye, resolution=(32, 32), spp=256, filter="box").rgb[..., 0]

    def apart(picture):
        return np.abs(picture / picture.sum() - theirs / theirs.sum()).sum()

    right = apart(drawn(camera))
    assert right < 0.35
    other = {"blade_rotation": camera.blade_rotation + 60} if blades else {"f_stop": 0.6}
    assert apart(drawn(camera.with_(**other))) > right + 0.2


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"type": "ORTHO"}, "type: wanted PERSP or PANO, got ORTHO"),
        ({"type": "PANO", "panorama_type": "MIRRORBALL"}, "panorama_type: wanted EQUIRECT"),
        (
            {"type": "PANO", "panorama_type": "FISHEYE_LENS_POLYNOMIAL",
             "fisheye_polynomial_k1": 0.1},
            "fisheye_polynomial_k0, _k1: wanted",
        ),
        (
            {"type": "PANO", "panorama_type": "EQUIRECTANGULAR", "longitude_min": 3.0,
             "longitude_max": -1.0},
            "longitude_min, longitude_max: wanted",
        ),
    ],
)  # fmt: skip
def test_cameras_that_no_lens_can_be_are_one_error(values, words):
    blender.empty()
    thing = blender.camera()
    for name, value in values.items():
        setattr(thing.data, name, value)
    with pytest.raises(InputError, match="camera 'camera': ") as raised:
        made(thing)
    assert words in str(raised.value)


def with_panel(thing, **values):
    """The camera with properties of Daguerre's panel."""
    names = ("type", "dof", "lens", "sensor_fit", "sensor_width", "sensor_height", "shift_x")
    data = {name: getattr(thing.data, name) for name in (*names, "shift_y", "clip_start")}
    made_of = SimpleNamespace(**data, daguerre=SimpleNamespace(**values))
    return SimpleNamespace(name="camera", data=made_of, matrix_world=thing.matrix_world)


def test_the_panel_takes_precedence():
    blender.empty()
    panel = {
        "lens": "double-gauss-50mm-f2", "lens_model": "polynomial", "f_stop": 4.0,
        "use_t_stop": False, "t_stop": 8.0, "focus_mode": "auto", "blades": 9,
        "blade_rotation": 10.0, "blade_curvature": 0.5, "tilt_x": 1.0, "tilt_y": 2.0,
        "sensor": "blender", "iso": 400.0, "ev": -1.0, "shutter_mode": "angle",
        "shutter_angle": 90.0, "shutter_time": 0.1, "rolling_side": "top", "rolling_time": 0.01,
    }  # fmt: skip
    camera = made(with_panel(blender.camera(), **panel))
    assert (camera.lens, camera.lens_model) == ("double-gauss-50mm-f2", "polynomial")
    assert (camera.f_stop, camera.t_stop, camera.focus_distance) == (4.0, None, None)
    assert (camera.blades, camera.blade_rotation, camera.blade_curvature) == (9, 10.0, 0.5)
    assert camera.tilt == (1.0, 2.0)
    assert (camera.iso, camera.exposure_compensation) == (400.0, -1.0)
    assert (camera.shutter_angle, camera.shutter_time) == (90.0, None)
    assert camera.rolling_shutter.readout_time == 0.01
    assert camera.focal_length is None
    assert camera.dispersion
    assert not made(with_panel(blender.camera(), **panel, dispersion=False)).dispersion
    other = made(with_panel(blender.camera(), **panel | {"use_t_stop": True}))
    assert (other.f_stop, other.t_stop) == (None, 8.0)


def test_what_a_mode_chooses_is_not_set_by_the_panel():
    blender.empty()
    panel = {
        "lens": "double-gauss-50mm-f2", "f_stop": 4.0, "use_t_stop": False, "iso": 400.0,
        "ev": 0.5, "shutter_mode": "time", "shutter_time": 0.1, "meter": "matrix",
    }  # fmt: skip
    for mode, gone in (
        ("light", ()), ("manual", ()), ("auto", ("iso",)), ("A", ("shutter_time",)),
        ("S", ("f_stop",)), ("P", ("shutter_time", "f_stop")),
    ):  # fmt: skip
        found = made(with_panel(blender.camera(), **panel, exposure_mode=mode))
        assert (found.exposure, found.meter) == (mode, "matrix")
        assert found.exposure_compensation == 0.5
        for name, value in (("iso", 400.0), ("shutter_time", 0.1), ("f_stop", 4.0)):
            kept = getattr(dg.Camera(), name) if name in gone else value
            assert getattr(found, name) == kept, (mode, name)
    assert made(blender.camera()).exposure == "light"
    assert made(with_panel(blender.camera(), exposure_mode="auto")).meter == "centre"


def test_blenders_lens_is_no_choice_even_if_a_script_sets_it():
    blender.empty()
    thing = blender.camera()
    plain = made(thing)
    assert made(with_panel(thing, lens="blender")) == plain
    found = made(with_panel(thing, lens="blender", iso=800.0))
    assert (found.lens, found.iso) == (plain.lens, 800.0)


def test_properties_that_nobody_set_leave_blenders_values():
    blender.empty()

    class Untouched(SimpleNamespace):
        def is_property_set(self, name):
            return name == "iso"

    group = Untouched(lens="double-gauss-50mm-f2", f_stop=5.6, iso=800.0)
    panel = CameraPanel(SimpleNamespace(daguerre=group))
    assert panel.chosen("lens") is None
    assert panel.chosen("f_stop") is None
    assert panel.chosen("iso") == 800.0
    assert CameraPanel(SimpleNamespace(daguerre=group), always=True).chosen("f_stop") == 5.6


def test_an_eye_of_a_stereo_pair_has_its_own_shift():
    scene = blender.empty((16, 8))
    thing = blender.camera()
    thing.data.shift_x, thing.data.shift_y = 0.1, 0.2
    place = blender.y_up(thing.matrix_world)
    camera = camera_of(thing, scene.render, place, Notes(), shift_x=-0.05)
    assert camera.shift == pytest.approx((-0.05 * 36, 0.2 * 36))
    assert made(thing).shift == pytest.approx((0.1 * 36, 0.2 * 36))
