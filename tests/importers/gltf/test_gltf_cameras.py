"""Cameras and lights of glTF in the units of a photographer."""

from __future__ import annotations

import math

import numpy as np
import pytest

from daguerre.camera.camera import Camera
from daguerre.errors import InputError
from daguerre.importers.gltf import reader as gltf
from daguerre.importers.gltf.cameras import _EXTRAS, _snake
from daguerre.scene.lights import DirectionalLight, PointLight, SpotLight
from tests.support.formats.make_gltf import Builder, triangle


def with_camera(perspective=None, node=None, **camera) -> Builder:
    b = triangle()
    values = {"yfov": 0.8, "znear": 0.1} | (perspective or {})
    b.add("cameras", {"type": "perspective", "perspective": values, **camera})
    b.node(camera=0, **({"name": "cam"} | (node or {})))
    return b


def read(b: Builder, tmp_path):
    return gltf.read(b.glb(tmp_path / "a.glb"))


def test_focal_length_comes_from_yfov_on_24_mm(tmp_path):
    camera = read(with_camera(), tmp_path).cameras["cam"]
    assert camera.sensor_size == (36, 24)
    assert camera.focal_length == pytest.approx(12 / math.tan(0.4))
    assert camera.f_stop is None
    assert camera.focus_distance is None


@pytest.mark.parametrize("aspect", [1.5, 1.0, 16 / 9])
def test_aspect_ratio_shapes_the_sensor_so_that_yfov_holds(tmp_path, aspect):
    camera = read(with_camera({"aspectRatio": aspect}), tmp_path).cameras["cam"]
    assert camera.sensor_size == pytest.approx((24 * aspect, 24))
    yfov = 2 * math.atan(camera.sensor_size[1] / 2 / camera.focal_length)
    assert yfov == pytest.approx(0.8)


def test_physical_camera_extension(tmp_path):
    physical = {"focalLength": 85, "sensorSize": [23.5, 15.6], "focusDistance": 2, "fStop": 1.4}
    b = with_camera(extensions={"EXT_camera_physical": physical})
    b.json["extensionsRequired"] = ["EXT_camera_physical"]
    scene = read(b, tmp_path)
    camera = scene.cameras["cam"]
    assert (camera.focal_length, camera.sensor_size) == (85, (23.5, 15.6))
    assert (camera.f_stop, camera.focus_distance) == (1.4, 2)
    assert scene.warnings == []


def test_sensor_size_alone_keeps_yfov(tmp_path):
    b = with_camera(extensions={"EXT_camera_physical": {"sensorSize": [36, 20]}})
    assert read(b, tmp_path).cameras["cam"].focal_length == pytest.approx(10 / math.tan(0.4))


def test_extras_win_over_the_extension(tmp_path):
    ours = {
        "fStop": 2.8,
        "focalLength": 35,
        "shutterTime": 0.02,
        "blades": 7,
        "bladeRotation": 12.5,
        "lens": "double-gauss-50mm-f2",
        "sensorFit": "vertical",
        "shift": [1, -2],
        "focusBreathing": True,
        "focusOn": "tri",
        "colour": 3,
        "focusDistance": None,
    }
    b = with_camera(
        extensions={"EXT_camera_physical": {"fStop": 8, "focusDistance": 3}},
        extras={"daguerre": ours, "other": {"fStop": "x"}},
    )
    scene = read(b, tmp_path)
    camera = scene.cameras["cam"]
    assert (camera.f_stop, camera.focal_length, camera.focus_distance) == (2.8, 35, 3)
    assert (camera.shutter_time, camera.blades, camera.blade_rotation) == (0.02, 7, 12.5)
    assert (camera.lens, camera.sensor_fit) == ("double-gauss-50mm-f2", "vertical")
    assert (camera.shift, camera.focus_breathing, camera.focus_on) == ((1, -2), True, "tri")
    assert scene.warnings == ["unknown camera parameter 'colour' in extras.daguerre (1 use)"]


def test_every_extra_is_a_parameter_of_camera():
    assert {_snake(name) for name in _EXTRAS} <= set(Camera.__dataclass_fields__)


def test_the_exposure_mode_is_light_unless_an_extra_names_one(tmp_path):
    assert read(with_camera(), tmp_path).camera().exposure == "light"
    extras = {"daguerre": {"iso": 400, "exposureCompensation": 1}}
    assert read(with_camera(extras=extras), tmp_path).camera().exposure == "light"
    extras = {"daguerre": {"iso": 400, "exposure": "manual", "meter": "center"}}
    camera = read(with_camera(extras=extras), tmp_path).camera()
    assert (camera.exposure, camera.iso, camera.meter) == ("manual", 400, "centre")


@pytest.mark.parametrize(
    ("extras", "message"),
    [
        ({"exposure": "M"}, "exposure: wanted light, manual, auto, A, S, P; got 'M'"),
        ({"exposure": 3}, "exposure: wrong type"),
        ({"meter": "sky"}, "meter: wanted centre, spot"),
        ({"exposure": "auto", "iso": 400}, "auto chooses the ISO, but iso is set"),
        ({"exposureCompensation": 1000}, "at least -64 and at most 64, got 1000"),
    ],
)
def test_a_wrong_exposure_is_one_error(tmp_path, extras, message):
    with pytest.raises(InputError, match=r"a\.glb: cameras\[0\]") as error:
        read(with_camera(extras={"daguerre": extras}), tmp_path)
    assert message in str(error.value)


@pytest.mark.parametrize("extras", [3, [], "text", {"daguerre_": 1}])
def test_foreign_extras_are_left_alone(tmp_path, extras):
    assert read(with_camera(extras=extras), tmp_path).warnings == []


def test_doubtful_units_are_told(tmp_path):
    b = with_camera(
        extensions={"EXT_camera_physical": {"focalLength": 0.05, "sensorSize": [0.036, 0.024]}}
    )
    text = " ".join(read(b, tmp_path).warnings)
    assert "a focal length of 0.05 mm" in text
    assert "a sensor 0.036 mm wide" in text


def test_orthographic_is_reported_and_kept_out(tmp_path):
    b = with_camera()
    ortho = {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}
    b.json["cameras"][0] = {"type": "orthographic", "orthographic": ortho}
    scene = read(b, tmp_path)
    assert scene.cameras == {}
    assert scene.default_camera is None
    assert "an orthographic camera is left out" in scene.warnings[0]


def test_names_default_and_alias(tmp_path):
    b = with_camera(name="lens cap")
    b.node(camera=0, name="cam", translation=[1, 2, 3])
    scene = read(b, tmp_path)
    assert list(scene.cameras) == ["cam", "cam.001"]
    assert scene.default_camera == "cam"
    assert scene.camera("lens cap") is scene.cameras["cam"]
    assert scene.camera("cam.001").transform[:3, 3].tolist() == [1, 2, 3]
    with pytest.raises(InputError, match="did you mean 'cam'"):
        scene.camera("cma")


@pytest.mark.parametrize("scale", [[2, 2, 2], [0.1, 5, 3], [-1, 1, 1]])
def test_scale_of_the_node_is_ignored(tmp_path, scale):
    half = math.sqrt(0.5)
    b = with_camera(node={"rotation": [0, half, 0, half], "scale": scale, "translation": [1, 0, 0]})
    transform = read(b, tmp_path).cameras["cam"].transform
    assert transform[:3, :3] @ transform[:3, :3].T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(transform[:3, :3]) == pytest.approx(1)
    assert -transform[:3, 2] == pytest.approx(np.array([-1, 0, 0]), abs=1e-12)
    assert transform[:3, 1] == pytest.approx(np.array([0, 1, 0]), abs=1e-12)
    assert transform[:3, 3].tolist() == [1, 0, 0]


def with_light(light, **node) -> Builder:
    b = triangle()
    b.json["extensionsRequired"] = ["KHR_lights_punctual"]
    b.json["extensions"] = {"KHR_lights_punctual": {"lights": [light]}}
    b.node(name="lamp", extensions={"KHR_lights_punctual": {"light": 0}}, **node)
    return b


def test_point_light(tmp_path):
    light = {"type": "point", "color": [1, 0.5, 0.25], "intensity": 40, "range": 7, "name": "x"}
    scene = read(with_light(light, translation=[1, 2, 3], scale=[2, 2, 2]), tmp_path)
    value, transform = scene.lights[0]
    assert value == PointLight((40, 20, 10), range=7, name="lamp")
    assert transform[:3, 3].tolist() == [1, 2, 3]
    assert transform[:3, :3].tolist() == np.eye(3).tolist()


def test_spot_light_and_its_defaults(tmp_path):
    cone = {"innerConeAngle": math.pi / 6, "outerConeAngle": math.pi / 3}
    light, _ = read(with_light({"type": "spot", "spot": cone}), tmp_path).lights[0]
    assert isinstance(light, SpotLight)
    assert (light.inner_angle, light.outer_angle) == pytest.approx((30, 60))
    assert light.range == math.inf
    light, _ = read(with_light({"type": "spot", "spot": {}}), tmp_path).lights[0]
    assert (light.inner_angle, light.outer_angle) == pytest.approx((0, 45))
    # pi / 2 as float32 is a little more than pi / 2.
    cone = {"outerConeAngle": 1.5707963705062866}
    light, _ = read(with_light({"type": "spot", "spot": cone}), tmp_path).lights[0]
    assert light.outer_angle == 90


def test_directional_light_shines_along_minus_z_of_its_node(tmp_path):
    light = {"type": "directional", "intensity": 3}
    half = math.sqrt(0.5)
    scene = read(with_light(light, rotation=[-half, 0, 0, half]), tmp_path)
    value, transform = scene.lights[0]
    assert value == DirectionalLight((3, 3, 3), name="lamp")
    assert -transform[:3, 2] == pytest.approx(np.array([0, -1, 0]), abs=1e-12)
