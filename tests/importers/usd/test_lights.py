"""Lights of UsdLux against closed forms: luminance that a camera sees, illuminance of a card."""

from __future__ import annotations

import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux
from scipy.integrate import trapezoid

import daguerre as dg
from daguerre.importers.usd.lighting import glows, unlit
from daguerre.importers.usd.lights import MOST, Emission, bounded, cone_size
from daguerre.motion.values import keys
from tests.support.formats import stages

_KINDS = {
    "sphere": UsdLux.SphereLight,
    "rect": UsdLux.RectLight,
    "disk": UsdLux.DiskLight,
    "cylinder": UsdLux.CylinderLight,
}
_SIZES = ("radius", "width", "height", "length")


@pytest.fixture
def stage(tmp_path: Path) -> Usd.Stage:
    return stages.new_stage(tmp_path / "lights.usda")


def _light(stage: Usd.Stage, kind: Any, name: str = "/light", **inputs: Any) -> Any:
    made = kind.Define(stage, name)
    for key, value in inputs.items():
        _set(made, key, value)
    return made


def _set(light: Any, key: str, value: Any) -> None:
    """Sets an input; a dictionary gives values by time code."""
    prim = light.GetPrim()
    attribute = prim.GetAttribute(f"inputs:{key}") or prim.GetAttribute(key)
    for code, one in value.items() if isinstance(value, dict) else ((None, value),):
        attribute.Set(one) if code is None else attribute.Set(one, code)


def _seen(scene: Any, at: Any = (0, 0, -3), **options: Any) -> Any:
    return stages.seen(scene, stages.looking(at), **options)


@pytest.mark.parametrize("kind", _KINDS)
def test_an_intensity_of_1_is_seen_as_1_nit(stage: Usd.Stage, kind: str) -> None:
    light = _light(stage, _KINDS[kind], intensity=1.0)
    stages.place(light, at=(0, 0, -3), turn=(0, 180, 0))
    assert np.allclose(_seen(stages.read(stage)), 1, rtol=0.01)


def test_six_rectangles_of_1_nit_are_a_furnace(stage: Usd.Stage) -> None:
    for i, turn in enumerate(((0, 0), (90, 0), (180, 0), (270, 0), (0, 90), (0, -90))):
        box = UsdGeom.Xform.Define(stage, f"/side{i}")
        stages.place(box, turn=(*turn, 0))
        light = _light(stage, UsdLux.RectLight, f"/side{i}/light", width=2.0, height=2.0)
        stages.place(light, at=(0, 0, 1))
    assert np.allclose(stages.illuminance(stages.read(stage), spp=1024), math.pi, rtol=0.01)


def test_exposure_colour_and_temperature_multiply(stage: Usd.Stage) -> None:
    light = _light(stage, UsdLux.SphereLight, intensity=3.0, exposure=-2.0)
    _set(light, "color", Gf.Vec3f(0.5, 1.0, 0.25))
    _set(light, "enableColorTemperature", True)
    _set(light, "colorTemperature", 3200.0)
    scene = stages.read(stage)
    ((lamp, _),) = scene.lights
    tint = np.array(UsdLux.BlackbodyTemperatureAsRgb(3200))
    assert np.ptp(tint) > 1
    assert np.allclose(lamp.luminance, 0.75 * np.array([0.5, 1, 0.25]) * tint, rtol=1e-6)


def test_a_colour_temperature_that_is_not_enabled_has_no_effect(stage: Usd.Stage) -> None:
    _light(stage, UsdLux.SphereLight, colorTemperature=2000.0)
    assert stages.read(stage).lights[0][0].luminance == (1, 1, 1)


@pytest.mark.parametrize("kelvin", [-5.0, 300.0, 1000.0, 40000.0])
def test_colour_temperatures_beyond_usds_range_are_its_ends(kelvin: float) -> None:
    end = UsdLux.BlackbodyTemperatureAsRgb(min(max(kelvin, 1000), 10000))
    assert np.allclose(Emission(temperature=kelvin).at(0), tuple(end))


# --- Normalization ---------------------------------------------------------------------------


def _power(scene: Any) -> float:
    """Area times luminance of all that shines in a scene, cd."""
    total = 0.0
    for lamp, _ in scene.lights:
        total += 4 * math.pi * lamp.radius**2 * lamp.luminance[0]
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        corners = mesh.positions.astype(float) @ instance.transform[:3, :3].T
        a, b, c = (corners[mesh.indices[:, k]] for k in range(3))
        size = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
        total += size * scene.materials[instance.material].emission[0]
    return total


@pytest.mark.parametrize("scale", [(1, 1, 1), (3, 3, 3), (1, 2, 0.5)])
@pytest.mark.parametrize("metres", [1.0, 0.01])
@pytest.mark.parametrize("kind", _KINDS)
def test_normalized_power_does_not_depend_on_size_or_units(
    tmp_path: Path, kind: str, metres: float, scale: Any
) -> None:
    stage = stages.new_stage(tmp_path / "x.usda", metres=metres)
    light = _light(stage, _KINDS[kind], normalize=True, intensity=7.0)
    for name in _SIZES:
        if light.GetPrim().HasAttribute(f"inputs:{name}"):
            _set(light, name, 0.3 / metres)
    stages.place(light, scale=scale)
    assert _power(stages.read(stage)) == pytest.approx(7, rel=1e-5)


@pytest.mark.parametrize("kind", _KINDS)
def test_power_without_normalization_is_the_area(stage: Usd.Stage, kind: str) -> None:
    light = _light(stage, _KINDS[kind], intensity=2.0)
    stages.place(light, scale=(3, 3, 3))
    area = {"sphere": math.pi, "rect": 1, "disk": math.pi / 4, "cylinder": math.pi}[kind]
    assert _power(stages.read(stage)) == pytest.approx(2 * 9 * area, rel=1e-3)


@pytest.mark.parametrize("kind", _KINDS)
def test_negative_sizes_mean_positive_ones(tmp_path: Path, kind: str) -> None:
    powers = []
    for i, sign in enumerate((1, -1)):
        stage = stages.new_stage(tmp_path / f"{i}.usda")
        light = _light(stage, _KINDS[kind])
        for name in _SIZES:
            if light.GetPrim().HasAttribute(f"inputs:{name}"):
                _set(light, name, sign * 0.7)
        powers.append(_power(stages.read(stage)))
    assert powers[0] == powers[1] > 0


def test_a_stretched_sphere_light_has_the_area_of_the_ellipsoid(stage: Usd.Stage) -> None:
    stages.place(_light(stage, UsdLux.SphereLight, radius=1.0), scale=(1, 1, 3))
    e = math.sqrt(1 - 1 / 9)
    prolate = 2 * math.pi * (1 + 3 / e * math.asin(e))
    assert _power(stages.read(stage)) == pytest.approx(prolate, rel=3e-3)


# --- Illuminance -----------------------------------------------------------------------------


def _distant_lux(stage: Usd.Stage, normal: Any = (0, 0, 1), **inputs: Any) -> Any:
    _light(stage, UsdLux.DistantLight, **inputs)
    return stages.illuminance(stages.read(stage), normal=normal)


@pytest.mark.parametrize(
    ("inputs", "lux"),
    [
        ({"angle": 0.0, "intensity": 5.0}, 5.0),
        ({"angle": 0.0, "intensity": 5.0, "normalize": True}, 5.0),
        ({"angle": 2.0, "intensity": 5.0, "normalize": True}, 5.0),
        ({"angle": 2.0, "intensity": 5.0}, 5 * math.pi * math.sin(math.radians(1)) ** 2),
        ({}, 50000 * math.pi * math.sin(math.radians(0.265)) ** 2),
    ],
)
def test_illuminance_by_a_distant_light(stage: Usd.Stage, inputs: Any, lux: float) -> None:
    assert np.allclose(_distant_lux(stage, **inputs), lux, rtol=0.01)


@pytest.mark.parametrize(
    ("inputs", "angle"),
    [
        ({}, 0.53),
        ({"angle": 0.0}, 0.0),
        ({"angle": 12.5, "normalize": True}, 12.5),
        ({"angle": 500.0}, 360.0),
        ({"angle": -4.0}, 0.0),
    ],
)
def test_a_distant_light_keeps_its_angle(stage: Usd.Stage, inputs: Any, angle: float) -> None:
    _light(stage, UsdLux.DistantLight, **inputs)
    scene = stages.read(stage)
    assert scene.lights[0][0].angle == pytest.approx(angle, rel=1e-6)
    assert [note for note in scene.warnings if "distant" in note] == []


@pytest.mark.parametrize(
    ("inputs", "normal", "lux"),
    [
        ({"angle": 180.0, "intensity": 1.0}, (1, 0, 0), math.pi / 2),
        ({"angle": 360.0, "intensity": 1.0}, (0, 0, -1), math.pi),
        ({"angle": 500.0, "intensity": 1.0, "normalize": True}, (0, 1, 0), 0.5),
        ({"angle": 60.0, "intensity": 2.0, "normalize": True}, (0.5, 0, 0.75**0.5), 3**0.5),
        ({"angle": 60.0, "intensity": 1.0}, (0.1, 0, -1), 0.0),
    ],
)
def test_a_wide_distant_light_is_a_cap_of_sky_of_even_luminance(
    stage: Usd.Stage, inputs: Any, normal: Any, lux: float
) -> None:
    assert np.allclose(_distant_lux(stage, normal, **inputs), lux, rtol=0.015)


def test_a_distant_light_shines_along_minus_z(stage: Usd.Stage) -> None:
    light = _light(stage, UsdLux.DistantLight, angle=0.0, intensity=1.0)
    stages.place(light, turn=(60, 0, 0), scale=(2, 5, 1))
    slant = stages.illuminance(stages.read(stage))
    assert np.allclose(slant, 0.5, rtol=0.01)
    stage.GetPrimAtPath("/light").GetAttribute("xformOp:rotateXYZ").Set(Gf.Vec3f(180, 0, 0))
    assert np.allclose(stages.illuminance(stages.read(stage)), 0)


@pytest.mark.parametrize("degrees", [0.0, 1.0, 90.0, 180.0, 270.0, 360.0, 500.0, -4.0])
def test_the_cone_of_a_distant_light(degrees: float) -> None:
    half = math.radians(min(max(degrees, 0), 360)) / 2
    theta = np.linspace(0, half, 200_001)
    facing = trapezoid(2 * math.pi * np.sin(theta) * np.maximum(np.cos(theta), 0), theta)
    both = trapezoid(2 * math.pi * np.sin(theta) * np.abs(np.cos(theta)), theta)
    expected = (facing, both) if half > 0 else (1, 1)
    assert np.allclose(cone_size(degrees), expected, rtol=1e-6)


@pytest.mark.parametrize(
    ("inputs", "candela"),
    [
        ({"radius": 0.0}, 6.0),
        ({"radius": 0.0, "normalize": True}, 6 / 4),
        ({"radius": 0.1, "treatAsPoint": True}, 6 * math.pi * 0.01),
        ({"radius": 0.1, "treatAsPoint": True, "normalize": True}, 6 / 4),
        ({"radius": 0.1, "normalize": True}, 6 / 4),
        ({"radius": 0.1}, 6 * math.pi * 0.01),
    ],
)
def test_illuminance_by_spheres_and_points(stage: Usd.Stage, inputs: Any, candela: float) -> None:
    light = _light(stage, UsdLux.SphereLight, intensity=6.0, **inputs)
    stages.place(light, at=(0, 3, 4))
    found = stages.illuminance(stages.read(stage))
    assert np.allclose(found, candela / 25 * 0.8, rtol=0.01)


def test_a_point_of_a_stretched_sphere_has_its_mean_intensity(stage: Usd.Stage) -> None:
    light = _light(stage, UsdLux.SphereLight, radius=1.0, treatAsPoint=True)
    stages.place(light, scale=(1, 1, 3))
    e = math.sqrt(1 - 1 / 9)
    prolate = 2 * math.pi * (1 + 3 / e * math.asin(e))
    assert stages.read(stage).lights[0][0].intensity[0] == pytest.approx(prolate / 4, rel=3e-3)


def test_illuminance_by_a_rectangle_above(stage: Usd.Stage) -> None:
    stages.place(_light(stage, UsdLux.RectLight, width=1.0, height=3.0), at=(0, 0, 2))
    x, y = 0.5 / 2, 1.5 / 2
    p, q = math.sqrt(1 + x * x), math.sqrt(1 + y * y)
    factor = 2 / math.pi * (x / p * math.atan(y / p) + y / q * math.atan(x / q))
    assert np.allclose(stages.illuminance(stages.read(stage)), math.pi * factor, rtol=0.01)


def test_illuminance_by_a_disk_above(stage: Usd.Stage) -> None:
    stages.place(_light(stage, UsdLux.DiskLight, radius=1.5), at=(0, 0, 2))
    expected = math.pi * 1.5**2 / (1.5**2 + 4)
    assert np.allclose(stages.illuminance(stages.read(stage)), expected, rtol=0.01)


def test_illuminance_by_a_cylinder_across_from_afar(stage: Usd.Stage) -> None:
    stages.place(_light(stage, UsdLux.CylinderLight, radius=0.01, length=0.1), at=(0, 0, 5))
    expected = 2 * 0.01 * 0.1 / 25  # its silhouette
    assert np.allclose(stages.illuminance(stages.read(stage)), expected, rtol=0.02)


def test_a_cylinder_has_no_ends(stage: Usd.Stage) -> None:
    light = _light(stage, UsdLux.CylinderLight, radius=0.5, length=1.0)
    stages.place(light, at=(0, 0, 3), turn=(0, 90, 0))  # its axis points to the card
    scene = stages.read(stage)
    assert np.allclose(stages.illuminance(scene), 0, atol=1e-6)
    assert np.allclose(stages.seen(scene, stages.looking((0, 0, 3), (0, 0, 0.1))), 0, atol=1e-6)


@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1), (2, 1, 1)])
@pytest.mark.parametrize("kind", ["rect", "disk"])
def test_rectangles_and_disks_shine_along_minus_z_only(
    stage: Usd.Stage, kind: str, scale: Any
) -> None:
    stages.place(_light(stage, _KINDS[kind]), scale=scale)
    scene = stages.read(stage)
    assert np.allclose(stages.seen(scene, stages.looking((0, 0, 0), (0.1, 0.1, -2))), 1, rtol=0.01)
    assert np.allclose(stages.seen(scene, stages.looking((0, 0, 0), (0.1, 0.1, 2))), 0, atol=1e-6)


# --- Pictures --------------------------------------------------------------------------------


def test_a_picture_of_a_rectangle_is_upright_for_whom_it_lights(
    stage: Usd.Stage, tmp_path: Path
) -> None:
    """Its top left lies at (+x, +y), as the documentation of UsdLuxRectLight has it."""
    pixels = np.array([[(0.5, 0, 0), (0, 0.5, 0)], [(0, 0, 0.5), (1, 1, 0)]], np.float32)
    stages.picture(tmp_path / "a.exr", pixels.repeat(32, axis=0).repeat(32, axis=1))
    light = _light(stage, UsdLux.RectLight, intensity=2.0)
    _set(light, "texture:file", Sdf.AssetPath("./a.exr"))
    scene = stages.read(stage)
    for x, y, color in ((1, 1, 0), (-1, 1, 1), (1, -1, 2), (-1, -1, 3)):
        spot = np.array((0.25 * x, 0.25 * y, 0))
        found = stages.seen(scene, stages.looking(spot, (0, 0, -2)))
        assert np.allclose(found, 2 * pixels.reshape(4, 3)[color], atol=0.02), (x, y)
    # It mirrors nothing where it is dark.
    scene.set_environment(color=(1, 1, 1))
    grazing = stages.seen(scene, stages.looking((-0.25, 0.25, 0), (-5, 0.25, -0.3), 0.2))
    assert np.allclose(grazing, (0, 1, 0), atol=0.02)


def test_a_picture_that_is_missing_is_a_note(stage: Usd.Stage) -> None:
    _set(_light(stage, UsdLux.RectLight), "texture:file", Sdf.AssetPath("./none.exr"))
    scene = stages.read(stage)
    assert any("a picture of a light is missing" in note for note in scene.warnings)
    assert scene.materials[-1].emission == (1, 1, 1)


# --- Motion ----------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["sphere", "rect"])
def test_animated_intensity_exposure_and_colour_blur(stage: Usd.Stage, kind: str) -> None:
    light = _light(stage, _KINDS[kind], intensity={0: 0.0, 24: 2.0}, exposure={0: 0.0, 24: 1.0})
    _set(light, "color", {0: Gf.Vec3f(1, 0, 1), 24: Gf.Vec3f(1, 1, 1)})
    stages.place(light, at=(0, 0, -3), turn=(0, 180, 0))
    scene = stages.read(stage, time=0.5)
    camera = stages.looking((0, 0, -3)).with_(shutter_time=1.0)
    found = stages.seen(scene, camera, spp=1024)
    t = (np.arange(1000) + 0.5) / 1000
    gain = 2 * t * 2**t
    assert np.allclose(found, (gain.mean(), (gain * t).mean(), gain.mean()), rtol=0.02)


@pytest.mark.parametrize("kind", ["sphere", "rect"])
def test_a_light_that_is_dark_at_the_time_of_the_scene_shines_later(
    stage: Usd.Stage, kind: str
) -> None:
    light = _light(stage, _KINDS[kind], intensity={0: 0.0, 24: 4.0})
    stages.place(light, at=(0, 0, -3), turn=(0, 180, 0))
    scene = stages.read(stage)
    assert np.allclose(_seen(scene), 0)
    assert np.allclose(_seen(scene.at(0.5)), 2, rtol=0.01)


@pytest.mark.parametrize("kind", ["sphere", "rect", "distant"])
def test_animated_visibility_switches_a_light(stage: Usd.Stage, kind: str) -> None:
    parent = UsdGeom.Xform.Define(stage, "/top")
    light = _light(stage, (_KINDS | {"distant": UsdLux.DistantLight})[kind], "/top/light")
    stages.place(light, at=(0, 0, 2))
    for code, shown in ((0, "invisible"), (12, "inherited")):
        parent.GetVisibilityAttr().Set(shown, code)
    dark, lit = (stages.illuminance(stages.read(stage, time=t)) for t in (0.0, 0.6))
    assert np.allclose(dark, 0)
    assert (lit > 0.1).all()
    half = stages.illuminance(stages.read(stage, time=0.5), shutter_time=1.0, spp=2048)
    assert np.allclose(half, lit / 2, rtol=0.05)


def test_a_moving_sphere_light_and_one_that_grows(stage: Usd.Stage) -> None:
    light = _light(stage, UsdLux.SphereLight, radius=0.2)
    move, grow = light.AddTranslateOp(), light.AddScaleOp()
    for code, x in ((0, -1.0), (24, 1.0)):
        move.Set(Gf.Vec3d(x, 0, -3), code)
    scene = stages.read(stage)
    assert len(scene.lights) == 1
    assert np.allclose(_seen(scene.at(1.0), (1, 0, -3)), 1, rtol=0.01)
    assert np.allclose(_seen(scene.at(1.0), (-1, 0, -3)), 0)
    for code, size in ((0, 1.0), (24, 5.0)):
        grow.Set(Gf.Vec3f(size, size, size), code)
    scene = stages.read(stage)
    assert np.allclose(_seen(scene.at(1.0), (1.8, 0, -3)), 1, rtol=0.01)
    assert np.allclose(_seen(scene.at(0.0), (-1.8, 0, -3)), 0)


def test_a_distant_light_that_turns_blurs(stage: Usd.Stage) -> None:
    turn = _light(stage, UsdLux.DistantLight, angle=0.0, intensity=1.0).AddRotateXOp()
    for code, degrees in ((0, 0.0), (24, 60.0)):
        turn.Set(degrees, code)
    found = stages.illuminance(stages.read(stage, time=0.5), shutter_time=1.0, spp=1024)
    assert np.allclose(found, math.sin(math.pi / 3) / (math.pi / 3), rtol=0.01)


def test_an_emission_is_pure_and_travels() -> None:
    light = Emission(keys([(0, 1.0), (1, 3.0)]), exposure=1.0, color=(1, 0.5, 0))
    assert pickle.loads(pickle.dumps(light)) == light
    assert light.at(0.5) == (4, 2, 0)
    assert light.breaks(-1, 2) == [0, 1]
    assert light.scaled(2).at(1) == (12, 6, 0)


# --- Meshes and copies -----------------------------------------------------------------------


def _mesh_light(stage: Usd.Stage, name: str = "/card", **inputs: Any) -> UsdGeom.Mesh:
    mesh = stages.mesh(stage, name)
    UsdLux.MeshLightAPI.Apply(mesh.GetPrim())
    for key, value in inputs.items():
        _set(mesh, key, value)
    return mesh


def test_a_mesh_light_shines_from_its_front(stage: Usd.Stage) -> None:
    stages.place(_mesh_light(stage, intensity=3.0), at=(0, 0, -3))
    scene = stages.read(stage)
    assert scene.materials[scene.instances[0].material].emission == (3, 3, 3)
    assert (_seen(scene) >= 2.97).all()
    behind = stages.seen(scene, stages.looking((0, 0, -3), (0, 0, -6)), max_depth=1)
    assert np.allclose(behind, 0, atol=1e-6)


def test_a_mesh_light_shines_without_the_glow_of_its_material() -> None:
    slot = dg.TextureSlot(0)
    glowing = dg.Material(dg.Gltf((0.2, 0.3, 0.4), emissive=(0, 1, 0), emissive_texture=slot))
    assert glows(glowing)
    assert glows(dg.Material(dg.Diffuse(), emission=(0, 0, 1)))
    assert not glows(dg.Material(dg.Gltf((0.2, 0.3, 0.4))))
    assert unlit(glowing.kind) == dg.Gltf((0.2, 0.3, 0.4))


def test_a_normalized_mesh_light_shares_its_power_among_its_materials(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda", metres=0.01)
    corners = [*stages.SQUARE, *((x + 5, 3 * y, z) for x, y, z in stages.SQUARE)]
    mesh = stages.mesh(stage, "/card", corners, (4, 4), range(8))
    UsdLux.MeshLightAPI.Apply(mesh.GetPrim())
    _set(mesh, "normalize", True)
    stages.place(mesh, scale=(2, 3, 1))
    UsdGeom.Subset.CreateGeomSubset(mesh, "half", "face", [0], "materialBind")
    assert _power(stages.read(stage)) == pytest.approx(1, rel=1e-5)


def test_a_solid_may_be_a_light(stage: Usd.Stage) -> None:
    cube = UsdGeom.Cube.Define(stage, "/cube")
    UsdLux.LightAPI.Apply(cube.GetPrim())
    _set(cube, "normalize", True)
    assert _power(stages.read(stage)) == pytest.approx(1, rel=1e-5)


@pytest.mark.parametrize("kind", _KINDS)
def test_lights_of_an_instancer_have_the_size_of_each_copy(stage: Usd.Stage, kind: str) -> None:
    instancer = UsdGeom.PointInstancer.Define(stage, "/many")
    _light(stage, _KINDS[kind], "/many/light", normalize=True)
    instancer.CreatePrototypesRel().AddTarget("/many/light")
    instancer.CreateProtoIndicesAttr([0, 0, 0])
    instancer.CreatePositionsAttr([Gf.Vec3f(x, 0, -5) for x in (-4, 0, 4)])
    instancer.CreateScalesAttr([Gf.Vec3f(s, s, s) for s in (1, 3, 1)])
    scene = stages.read(stage)
    assert len(scene.lights) + len(scene.instances) == 3
    assert len(scene.meshes) == (kind != "sphere")
    assert _power(scene) == pytest.approx(3, rel=1e-5)


@pytest.mark.parametrize("kind", ["sphere", "rect"])
def test_copies_that_are_scaled_to_nothing_are_left_out(stage: Usd.Stage, kind: str) -> None:
    instancer = UsdGeom.PointInstancer.Define(stage, "/many")
    _light(stage, _KINDS[kind], "/many/light")
    instancer.CreatePrototypesRel().AddTarget("/many/light")
    instancer.CreateProtoIndicesAttr([0, 0])
    instancer.CreatePositionsAttr([Gf.Vec3f(x, 0, -5) for x in (-4, 4)])
    instancer.CreateScalesAttr([Gf.Vec3f(0), Gf.Vec3f(1)])
    scene = stages.read(stage)
    assert len(scene.lights) + len(scene.instances) == 1
    assert any("scaled to zero is left out (1 use)" in note for note in scene.warnings)


def test_a_moving_instancer_moves_its_lights(stage: Usd.Stage) -> None:
    instancer = UsdGeom.PointInstancer.Define(stage, "/many")
    _light(stage, UsdLux.SphereLight, "/many/light", radius=0.2)
    instancer.CreatePrototypesRel().AddTarget("/many/light")
    instancer.CreateProtoIndicesAttr([0])
    instancer.CreatePositionsAttr([Gf.Vec3f(0, 0, -3)])
    move = instancer.AddTranslateOp()
    for code, x in ((0, -1.0), (24, 1.0)):
        move.Set(Gf.Vec3d(x, 0, 0), code)
    scene = stages.read(stage)
    assert np.allclose(_seen(scene.at(0.0), (-1, 0, -3)), 1, rtol=0.01)
    assert np.allclose(_seen(scene.at(1.0), (1, 0, -3)), 1, rtol=0.01)


def test_hidden_lights_and_those_of_other_purposes_are_off(stage: Usd.Stage) -> None:
    _light(stage, UsdLux.SphereLight, "/a").GetVisibilityAttr().Set("invisible")
    _light(stage, UsdLux.SphereLight, "/b").GetPurposeAttr().Set("guide")
    _light(stage, UsdLux.SphereLight, "/c", intensity=0.0)
    _light(stage, UsdLux.SphereLight, "/d").GetPurposeAttr().Set("render")
    assert [lamp.name for lamp, _ in stages.read(stage).lights] == ["d"]
    assert len(stages.read(stage, purpose=("guide",)).lights) == 1


# --- Notes and errors ------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["PortalLight", "GeometryLight", "PluginLight"])
def test_unknown_lights_are_notes(stage: Usd.Stage, kind: str) -> None:
    for i in range(2):
        stage.DefinePrim(f"/light{i}", kind)
    assert f"a light of type {kind} is left out (2 uses)" in stages.read(stage).warnings


def test_a_volume_light_is_a_note(stage: Usd.Stage) -> None:
    UsdLux.VolumeLightAPI.Apply(stage.DefinePrim("/fog", "Volume"))
    assert any("Volume" in note for note in stages.read(stage).warnings)


def _link(light: Any) -> None:
    UsdLux.LightAPI(light).GetLightLinkCollectionAPI().CreateExcludesRel().AddTarget("/x")


def _unroot(light: Any) -> None:
    UsdLux.LightAPI(light).GetShadowLinkCollectionAPI().CreateIncludeRootAttr(False)


@pytest.mark.parametrize(
    ("spoil", "note"),
    [
        (_link, "linked to some prims"),
        (_unroot, "linked to some prims"),
        (lambda light: UsdLux.LightAPI(light).CreateFiltersRel().AddTarget("/x"), "light filter"),
        (lambda light: _set(light, "diffuse", 0.5), "the diffuse and specular factors"),
        (
            lambda light: UsdLux.ShadowAPI.Apply(light).CreateShadowEnableAttr(False),
            "shadow settings",
        ),
        (lambda light: _set(light, "radius", {0: 1.0, 9: 2.0}), "size or shaping changes"),
        (lambda light: _set(light, "intensity", -1.0), "negative intensity"),
        (lambda light: _set(light, "color", Gf.Vec3f(1, -1, 1)), "negative part"),
        (lambda light: _set(light, "exposure", 1e38), "brighter than 1e+30"),
        (lambda light: stages.place(light, scale=(0, 0, 0)), "scaled to zero"),
    ],
)
def test_what_is_left_out_is_one_note(stage: Usd.Stage, spoil: Any, note: str) -> None:
    for i in range(2):
        spoil(_light(stage, UsdLux.SphereLight, f"/light{i}").GetPrim())
    found = [text for text in stages.read(stage).warnings if note in text]
    assert len(found) == 1
    assert found[0].endswith("(2 uses)")


def test_a_plain_light_has_no_note(stage: Usd.Stage) -> None:
    for i, kind in enumerate(_KINDS.values()):
        _light(stage, kind, f"/light{i}")
    found = stages.read(stage).warnings
    assert [note for note in found if "framing" not in note] == []


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("intensity", math.nan),
        ("intensity", {0: 1.0, 9: math.inf}),
        ("exposure", {0: 1.0, 9: math.nan}),
        ("color", Gf.Vec3f(0, math.nan, 0)),
        ("color", {0: Gf.Vec3f(1), 9: Gf.Vec3f(math.inf)}),
        ("colorTemperature", math.nan),
        ("radius", math.nan),
        ("radius", -math.inf),
    ],
)
def test_numbers_that_are_not_finite_are_refused(stage: Usd.Stage, key: str, value: Any) -> None:
    light = _light(stage, UsdLux.SphereLight, enableColorTemperature=True)
    _set(light, key, value)
    with pytest.raises(dg.InputError, match=rf"/light\.inputs:{key}: wanted .*finite number"):
        stages.read(stage)


@pytest.mark.parametrize("line", ['string inputs:radius = "x"', 'token inputs:color = "x"'])
def test_values_of_another_type_are_refused(tmp_path: Path, line: str) -> None:
    path = tmp_path / "x.usda"
    path.write_text(f'#usda 1.0\n(upAxis = "Y")\ndef SphereLight "light"\n{{\n{line}\n}}\n')
    with pytest.raises(dg.InputError, match=r"/light\.inputs:(radius|color): wanted"):
        dg.load(path)


def test_a_blocked_value_is_the_schemas(tmp_path: Path) -> None:
    path = tmp_path / "x.usda"
    lines = "float inputs:intensity = None\ncolor3f inputs:color = None"
    path.write_text(f'#usda 1.0\n(upAxis = "Y")\ndef SphereLight "light"\n{{\n{lines}\n}}\n')
    assert dg.load(path).lights[0][0].luminance == (1, 1, 1)


@pytest.mark.parametrize("kind", _KINDS)
@pytest.mark.parametrize(
    "inputs",
    [
        {"intensity": 3e38},
        {"intensity": 1e38, "exposure": 3e38},
        {"intensity": 1.0, "exposure": -3e38},
        {"intensity": 1e38, "normalize": True, "radius": 1e-30, "width": 1e-30, "length": 1e-30},
        {"radius": 0.0, "width": 0.0, "length": 0.0},
        {"radius": 1e37, "width": 1e37, "length": 1e37},
        {"radius": -0.5, "width": -1.0, "length": -1.0},
    ],
)
def test_extreme_numbers_neither_fail_nor_give_nan(
    stage: Usd.Stage, kind: str, inputs: Any
) -> None:
    light = _light(stage, _KINDS[kind])
    for key, value in inputs.items():
        if light.GetPrim().HasAttribute(f"inputs:{key}"):
            _set(light, key, value)
    stages.place(light, at=(0, 0, 3))
    try:
        scene = stages.read(stage)
        assert np.isfinite(stages.illuminance(scene, spp=16)).all()
    except dg.InputError as error:
        assert "light" in str(error)  # noqa: PT017


def test_bounds_of_a_luminance() -> None:
    given = (math.nan, -1.0, 2.0, math.inf)
    assert [bounded(value) for value in given] == [0, 0, 2, MOST]
