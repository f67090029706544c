"""Lights and skies: units, directions, falloff, projected pictures."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import daguerre as dg
from daguerre.importers.mitsuba.panorama import panorama

from .peer import ours, same_blocks, theirs
from .scene_files import camera, loaded, written

FLOOR = (
    '<shape type="rectangle"><bsdf type="twosided"><bsdf type="diffuse">'
    '<spectrum name="reflectance" value="0.5"/></bsdf></bsdf>'
    '<transform name="to_world"><scale value="4"/></transform></shape>'
)
DIRECT = '<integrator type="direct"/>'
LOOK = '<transform name="to_world"><lookat origin="1 0 3" target="0 0.5 0" up="0 1 0"/></transform>'


def _emitter(plugin: str, inner: str = "") -> str:
    return f'<emitter type="{plugin}" id="lamp">{inner}</emitter>'


def test_a_unit_of_light_is_a_unit_of_ours(tmp_path: Path) -> None:
    rgb = '<rgb name="{}" value="1 2 3"/>'
    scene = loaded(
        tmp_path,
        _emitter("point", rgb.format("intensity")),
        '<emitter type="directional">' + rgb.format("irradiance") + "</emitter>",
        '<emitter type="constant">' + rgb.format("radiance") + "</emitter>",
        '<shape type="sphere"><emitter type="area">'
        + rgb.format("radiance")
        + "</emitter></shape>",
    )
    point, sun = (light for light, _ in scene.lights)
    assert isinstance(point, dg.PointLight)
    assert point.intensity == (1, 2, 3)
    assert point.name == "lamp"
    assert isinstance(sun, dg.DirectionalLight)
    assert sun.illuminance == (1, 2, 3)
    assert scene.environment is not None
    assert scene.environment.color == (1, 2, 3)
    material = scene.materials[0]
    assert material.emission == (1, 2, 3)
    assert not material.two_sided_emission
    assert material.kind == dg.Diffuse((0, 0, 0))  # lamps without a material reflect nothing


def test_a_spot_falls_off_linearly_by_angle(tmp_path: Path) -> None:
    inner = '<float name="cutoff_angle" value="30"/><float name="beam_width" value="10"/>' + LOOK
    scene = loaded(tmp_path, _emitter("spot", inner))
    light, pose = scene.lights[0]
    assert isinstance(light, dg.PointLight)
    assert light.profile is not None
    assert np.allclose(-pose[:3, 2], np.array((-1, 0.5, -3)) / math.hypot(1, 0.5, 3))
    angles = np.radians([0, 9.9, 15, 20, 25, 29.9, 30.1])
    along = np.stack([np.sin(angles), 0 * angles, -np.cos(angles)], axis=1)
    wanted = np.array([1, 1, 0.75, 0.5, 0.25, 0.005, 0])
    assert np.allclose(light.profile.factors(along)[:, 1], wanted, atol=1e-3)
    for beam in (0, 30):
        inner = '<float name="cutoff_angle" value="30"/>'
        inner += f'<float name="beam_width" value="{beam}"/>'
        lamp, _ = loaded(tmp_path, _emitter("spot", inner)).lights[0]
        assert lamp.profile.factors(along)[3, 1] == pytest.approx(1 / 3 if beam == 0 else 1, 1e-3)  # type: ignore[union-attr]


@pytest.mark.parametrize(
    "lamp",
    [
        _emitter("point", '<point name="position" x="1" y="0.5" z="1.5"/>'),
        _emitter("directional", '<vector name="direction" x="1" y="-0.4" z="-1"/>'),
        _emitter("spot", '<rgb name="intensity" value="9 5 1"/>' + LOOK),
    ],
)
def test_lamps_shine_as_those_of_mitsuba(lamp: str, tmp_path: Path) -> None:
    path = written(tmp_path, DIRECT, camera(size=(48, 48)), FLOOR, lamp)
    same_blocks(ours(path, 64), theirs(path, 64), 0.03)


def _picture(folder: Path) -> None:
    """A picture without symmetry."""
    y, x = np.mgrid[0:24, 0:32]
    rgb = np.stack([8 * x, 10 * y, 120 + 0 * x], axis=2).astype(np.uint8)
    rgb[:6, :8] = (255, 0, 0)
    Image.fromarray(rgb).save(folder / "slide.png")


@pytest.mark.parametrize(
    ("plugin", "inner"),
    [
        ("projector", '<float name="fov" value="50"/><float name="scale" value="3"/>'),
        (
            "spot",
            '<float name="cutoff_angle" value="25"/><rgb name="intensity" value="20 20 20"/>',
        ),
    ],
)
@pytest.mark.parametrize("turn", ["", '<rotate z="1" angle="50"/>', '<scale x="-1"/>'])
def test_pictures_are_projected_as_by_mitsuba(
    plugin: str, inner: str, turn: str, tmp_path: Path
) -> None:
    _picture(tmp_path)
    slot = "irradiance" if plugin == "projector" else "texture"
    texture = f'<texture type="bitmap" name="{slot}"><string name="filename" value="slide.png"/>'
    look = LOOK.replace("<lookat", turn + "<lookat")
    lamp = _emitter(plugin, inner + texture + "</texture>" + look)
    path = written(tmp_path, DIRECT, camera(size=(48, 48)), FLOOR, lamp)
    same_blocks(ours(path, 256), theirs(path, 64), 0.05)


def test_projectors_need_a_picture_or_a_colour_but_no_more(tmp_path: Path) -> None:
    white = loaded(tmp_path, _emitter("projector", '<float name="fov" value="50"/>'))
    assert len(white.lights) == 1
    texture = '<texture type="bitmap" name="irradiance"><string name="filename" value="x"/>'
    missing = loaded(tmp_path, _emitter("projector", texture + "</texture>"))
    assert len(missing.lights) == 1
    assert any("file is missing" in note for note in missing.warnings)


def _sky(folder: Path, width: int = 128) -> None:
    """A smooth sky without symmetry."""
    height = width // 2
    y, x = np.mgrid[0:height, 0:width]
    theta, phi = y / (height - 1) * math.pi, (x + 0.5) / width * 2 * math.pi
    east, north, up = np.sin(theta) * np.sin(phi), np.sin(theta) * np.cos(phi), np.cos(theta)
    colors = np.stack([np.exp(3 * east), np.exp(3 * up), np.exp(2 * north - up)], axis=2)
    import OpenImageIO as oiio

    made: Any = oiio.ImageOutput.create(str(folder / "sky.exr"))
    made.open(str(folder / "sky.exr"), oiio.ImageSpec(width, height, 3, oiio.FLOAT))
    made.write_image(colors.astype(np.float32))
    made.close()


@pytest.mark.parametrize(
    "turn",
    [
        "",
        '<rotate y="1" angle="70"/>',
        '<rotate x="1" angle="90"/>',
        # along (1, 2, 3); Mitsuba takes an axis of another length for no rotation
        '<rotate value="0.2672612419 0.5345224838 0.8017837257" angle="50"/>',
        '<scale x="-1"/><rotate y="1" angle="70"/>',
        '<scale x="-1"/><rotate x="1" angle="90"/>',
    ],
)
def test_skies_stand_as_those_of_mitsuba(turn: str, tmp_path: Path) -> None:
    _sky(tmp_path)
    inner = '<string name="filename" value="sky.exr"/><float name="scale" value="0.5"/>'
    inner += f'<transform name="to_world">{turn}</transform>'
    for eye in ("0 0.5 5", "3 -4 1"):
        seen = camera(eye, fov=100, size=(64, 64))
        path = written(tmp_path, DIRECT, seen, _emitter("envmap", inner))
        same_blocks(ours(path, 16), theirs(path, 16), 0.05)


def test_a_panorama_has_its_poles_half_a_row_away() -> None:
    rows = np.linspace(0, 1, 9, dtype=np.float32)
    pixels = np.repeat(np.repeat(rows[:, None, None], 16, axis=1), 3, axis=2)
    made, rotation = panorama(pixels, np.eye(3))
    assert rotation == 0
    # the value at the angle theta is theta / pi, here and there
    count = len(made)
    assert np.allclose(made[:, 0, 0], (np.arange(count) + 0.5) / count, atol=1e-6)


def test_a_panorama_stays_sharp_toward_its_poles() -> None:
    stripes = (np.arange(64) % 2).astype(np.float32)
    made, _ = panorama(
        np.repeat(np.repeat(stripes[:, None, None], 8, axis=1), 3, axis=2), np.eye(3)
    )
    at = np.linspace(0, 1, 64) * len(made) - 0.5  # where the first and last row are the poles
    found = np.interp(at, np.arange(len(made)), made[:, 0, 0])
    assert np.abs(found - stripes).max() < 0.2


def test_what_is_around_a_scene_is_one(tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match=r"line 3, column \d+: .*a second environment"):
        loaded(tmp_path, _emitter("constant"), '<emitter type="constant"/>')


@pytest.mark.parametrize(
    ("part", "wrong"),
    [
        (_emitter("spot", '<float name="cutoff_angle" value="95"/>'), "cutoff_angle < 90"),
        (_emitter("spot", '<float name="beam_width" value="25"/>'), "beam_width <= cutoff_angle"),
        (
            _emitter("directional", '<vector name="direction" value="0"/>'),
            "the direction must not have zero length",
        ),
        (_emitter("point", '<point name="position" value="0"/>' + LOOK), "either position or"),
        (_emitter("point", '<rgb name="intensity" value="-1"/>'), "values of at least 0, got -1"),
        (_emitter("envmap", ""), "the property 'filename' is missing"),
    ],
)
def test_wrong_lights(part: str, wrong: str, tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match=rf"line 2, column \d+: .*{wrong}"):
        loaded(tmp_path, part)
