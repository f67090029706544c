"""Cones, focus and photometric files of USD's lights."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Gf, Sdf, UsdLux

import daguerre as dg
from tests.support.formats import stages

#: A photometric file: 100 cd straight down, 40 cd at 30 degrees, nothing from 60 degrees on.
_IES = """IESNA:LM-63-2002
TILT=NONE
1 1000 1 4 1 1 2 0 0 0
1 1 10
0 30 60 90
0
100 40 0 0
"""


def _lamp(tmp_path: Path, change: Any, kind: Any = UsdLux.SphereLight) -> dg.Scene:
    """A lamp 2 m above the origin of a z-up stage in centimetres, shining down."""
    number = len(list(tmp_path.glob("*.usda")))  # USD keeps layers by name
    stage = stages.new_stage(tmp_path / f"lamp{number}.usda", metres=0.01, up="Z")
    light = kind.Define(stage, "/lamp")
    light.CreateIntensityAttr(1.0)
    stages.place(light, at=(0, 0, 200))
    if kind is UsdLux.SphereLight:
        light.CreateRadiusAttr(0.0)
    change(light.GetPrim())
    return dg.load(stages.save(stage))


def _shaped(prim: Any) -> Any:
    return UsdLux.ShapingAPI.Apply(prim)


def _below(scene: dg.Scene, degrees: float) -> float:
    """Intensity toward the floor at an angle from straight down, cd, from its illuminance."""
    angle = math.radians(degrees)
    x = 2 * math.tan(angle)
    lux = stages.illuminance(scene, (x, 0, 0), (0, 1, 0)).mean()
    return float(lux * 4 / math.cos(angle) ** 3)


def test_a_photometric_file_is_the_intensity_of_a_point(tmp_path: Path) -> None:
    (tmp_path / "lamp.ies").write_text(_IES)

    def change(prim: Any) -> None:
        _shaped(prim).CreateShapingConeAngleAttr(180.0)
        _shaped(prim).CreateShapingIesFileAttr(Sdf.AssetPath("./lamp.ies"))

    for degrees, wanted in ((0.01, 100.0), (15, 70.0), (30, 40.0), (45, 20.0), (62, 0.0)):
        assert _below(_lamp(tmp_path, change), degrees) == pytest.approx(wanted, rel=0.01, abs=0.05)


def test_a_normalized_file_keeps_the_power(tmp_path: Path) -> None:
    (tmp_path / "lamp.ies").write_text(_IES)

    def change(prim: Any) -> None:
        api = _shaped(prim)
        api.CreateShapingConeAngleAttr(180.0)
        api.CreateShapingIesFileAttr(Sdf.AssetPath("./lamp.ies"))
        api.CreateShapingIesNormalizeAttr(True)

    (light, _), *_ = _lamp(tmp_path, change).lights
    assert light.profile.peak * 40 / 100 == pytest.approx(
        light.profile.factors([(math.sin(math.pi / 6), 0, -math.cos(math.pi / 6))])[0, 0], rel=1e-4
    )
    assert light.profile.power < 4 * math.pi + 1e-3


def test_a_cone_cuts_off_and_a_focus_narrows(tmp_path: Path) -> None:
    def cone(prim: Any) -> None:
        _shaped(prim).CreateShapingConeAngleAttr(30.0)

    def focus(prim: Any) -> None:
        _shaped(prim).CreateShapingConeAngleAttr(180.0)
        _shaped(prim).CreateShapingFocusAttr(8.0)

    assert _below(_lamp(tmp_path, cone), 29) == pytest.approx(1, rel=0.02)
    assert _below(_lamp(tmp_path, cone), 31) == 0
    wanted = math.cos(math.radians(25)) ** 8
    assert _below(_lamp(tmp_path, focus), 25) == pytest.approx(wanted, rel=0.02)


def test_the_api_alone_is_a_cone_of_90_degrees(tmp_path: Path) -> None:
    (light, _), *_ = _lamp(tmp_path, _shaped).lights
    assert np.allclose(light.profile.factors([(0, 0, -1), (0, 0.1, 1)])[:, 0], (1, 0))
    (bare, _), *_ = _lamp(tmp_path, lambda prim: None).lights
    assert bare.profile is None


def test_area_lights_are_shaped_in_their_own_frame(tmp_path: Path) -> None:
    def change(prim: Any) -> None:
        light = UsdLux.RectLight(prim)
        light.CreateWidthAttr(1.0)
        light.CreateHeightAttr(1.0)
        light.CreateIntensityAttr(1e4)
        _shaped(prim).CreateShapingConeAngleAttr(20.0)

    scene = _lamp(tmp_path, change, UsdLux.RectLight)
    assert _below(scene, 5) == pytest.approx(math.cos(math.radians(5)), rel=0.03)
    scene = _lamp(tmp_path, change, UsdLux.RectLight)
    assert _below(scene, 24) == 0


def test_a_missing_file_is_noted_and_one_outside_refused(tmp_path: Path) -> None:
    def missing(prim: Any) -> None:
        _shaped(prim).CreateShapingIesFileAttr(Sdf.AssetPath("./none.ies"))

    def outside(prim: Any) -> None:
        _shaped(prim).CreateShapingIesFileAttr(Sdf.AssetPath("../../secret.ies"))

    assert any("photometric file" in note for note in _lamp(tmp_path, missing).warnings)
    with pytest.raises(dg.InputError, match=r"leaves the stage's folder"):
        _lamp(tmp_path, outside)


def test_broken_files_and_numbers_are_refused(tmp_path: Path) -> None:
    (tmp_path / "lamp.ies").write_text(_IES.replace("0 30 60 90", "0 60 30 90"))

    def broken(prim: Any) -> None:
        _shaped(prim).CreateShapingIesFileAttr(Sdf.AssetPath("./lamp.ies"))

    def wild(prim: Any) -> None:
        _shaped(prim).CreateShapingFocusAttr(float("nan"))

    with pytest.raises(dg.InputError, match=r"lamp\.ies"):
        _lamp(tmp_path, broken)
    with pytest.raises(dg.InputError, match=r"shaping:focus: wanted a finite number"):
        _lamp(tmp_path, wild)


def test_the_shaping_of_a_distant_light_is_noted(tmp_path: Path) -> None:
    scene = _lamp(tmp_path, _shaped, UsdLux.DistantLight)
    assert any("shaping of a distant light" in note for note in scene.warnings)


def test_the_tint_of_a_focus_stays_off_the_axis(tmp_path: Path) -> None:
    def change(prim: Any) -> None:
        api = _shaped(prim)
        api.CreateShapingConeAngleAttr(180.0)
        api.CreateShapingFocusAttr(4.0)
        api.CreateShapingFocusTintAttr(Gf.Vec3f(1, 0, 0))

    (light, _), *_ = _lamp(tmp_path, change).lights
    side = light.profile.factors([(1, 0, 0)])[0]
    assert np.allclose(side, (1, 0, 0), atol=1e-6)
