"""Flags of scene files for scenes of Mitsuba."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli.flags.scene_file import SceneFileFlags

from .scene_files import written


def test_flags_set_parameters_and_the_unit(tmp_path: Path) -> None:
    ball = '<shape type="sphere" id="ball"><float name="radius" value="$r"/></shape>'
    path = written(tmp_path, ball)
    scene = SceneFileFlags(define=["r=3"], scene_unit="cm").read(path)
    assert np.allclose(np.diag(scene.instances[0].transform), (0.03, 0.03, 0.03, 1))
    with pytest.raises(dg.InputError, match=r"\$r has no value"):
        SceneFileFlags().read(path)
    with pytest.raises(dg.UsageError, match="wanted name=value"):
        SceneFileFlags(define=["r"]).read(path)
    with pytest.raises(dg.UsageError, match="--scene-unit: wanted a unit"):
        SceneFileFlags(define=["r=3"], scene_unit="leagues").read(path)


def test_other_formats_have_no_parameters(tmp_path: Path) -> None:
    with pytest.raises(dg.UsageError, match="no option 'define'"):
        SceneFileFlags(define=["r=3"]).read(tmp_path / "a.glb")
