"""Stages without a camera that can be used: framed, or refused where there is nothing to see."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdShade

import daguerre as dg
from daguerre.cli import main
from tests.support.formats import stages

_FRAMED = "the file has no usable camera; the camera 'framing' shows everything"


@pytest.fixture
def stage(tmp_path: Path) -> Usd.Stage:
    return stages.new_stage(tmp_path / "x.usda")


def test_a_stage_whose_only_camera_is_orthographic_is_framed(stage: Usd.Stage) -> None:
    stages.cube(stage, "/box")
    UsdGeom.Camera.Define(stage, "/Top").CreateProjectionAttr("orthographic")
    scene = stages.read(stage)
    assert scene.default_camera == "framing"
    assert "an orthographic camera is left out: no lens makes parallel rays (1 use)" in (
        scene.warnings
    )
    assert _FRAMED in scene.warnings
    scene.set_environment(color=(1, 1, 1))
    picture = dg.render(scene, resolution=(32, 18), spp=4).rgb
    assert np.ptp(picture.mean(axis=2)) > 0.1  # the box stands before the sky


def _materials(stage: Usd.Stage) -> None:
    UsdShade.Material.Define(stage, "/Looks/red")


def _hidden(stage: Usd.Stage) -> None:
    stages.cube(stage, "/box").CreateVisibilityAttr("invisible")


def _guides(stage: Usd.Stage) -> None:
    stages.cube(stage, "/box").CreatePurposeAttr("guide")


def _patch(stage: Usd.Stage) -> None:
    UsdGeom.NurbsPatch.Define(stage, "/patch")


@pytest.mark.parametrize("write", [_materials, _hidden, _guides, _patch])
def test_a_stage_with_nothing_to_see_is_one_error(
    stage: Usd.Stage,
    write: Callable[[Usd.Stage], None],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    write(stage)
    path = stages.save(stage)
    with pytest.raises(dg.InputError, match="no camera and nothing visible"):
        dg.load(path).camera()
    assert main(["render", str(path), "--quiet", "-o", str(tmp_path / "x.exr")]) == 3
    told = [line for line in capsys.readouterr().err.splitlines() if "error" in line]
    assert len(told) == 1
    assert told[0].startswith(f"daguerre: error: {path}: no camera and nothing visible")


def test_geometry_without_a_camera_still_asks_for_one() -> None:
    scene = dg.Scene()
    card = scene.add_mesh(np.array(stages.SQUARE, float), np.array([(0, 1, 2), (0, 2, 3)]))
    scene.add_instance(card, dg.Material(dg.Diffuse((1, 1, 1))))
    with pytest.raises(dg.InputError, match="no camera: the file has none; use add_camera"):
        scene.camera()
