"""Attributes for which a stage states another type than their schema does."""

from __future__ import annotations

from pathlib import Path

import pytest

import daguerre as dg

_STAGE = """#usda 1.0
( defaultPrim = "W" )
def Xform "W" {{
  def Mesh "m" {{
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    uniform token subdivisionScheme = "catmullClark"
    {mesh}
  }}
  def Sphere "s" {{
    {sphere}
  }}
  def SphereLight "l" {{
    {light}
  }}
  def BasisCurves "c" {{
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]
    float[] widths = [0.1]
    {curves}
  }}
}}
"""
_OPERATIONS = ("translate", "scale", "rotateXYZ", "rotateX", "orient", "transform")
_ODD = (
    "asset {} = @x@",
    'token {} = "text"',
    'string[] {} = ["a"]',
    "double[] {} = []",
    "double[] {} = [1, 2]",
    "timecode {} = 3",
    "point3f[] {} = [(1, 2, 3)]",
    "matrix2d {} = ((1, 0), (0, 1))",
)


def _read(folder: Path, **parts: str) -> dg.Scene:
    file = folder / f"x{len(list(folder.iterdir()))}.usda"
    empty = dict.fromkeys(("mesh", "sphere", "light", "curves"), "")
    file.write_text(_STAGE.format(**(empty | parts)))
    return dg.load(file)


@pytest.mark.parametrize("operation", _OPERATIONS)
@pytest.mark.parametrize("odd", _ODD)
def test_an_operation_of_another_type_is_one_error(
    odd: str, operation: str, tmp_path: Path
) -> None:
    name = f"xformOp:{operation}"
    text = odd.format(name) + f'\n    uniform token[] xformOpOrder = ["{name}"]'
    with pytest.raises(dg.InputError, match=rf"/W/s\.{name}: wanted "):
        _read(tmp_path, sphere=text)


@pytest.mark.parametrize(
    ("part", "name"),
    [
        ("mesh", "holeIndices"),
        ("mesh", "cornerIndices"),
        ("mesh", "creaseIndices"),
        ("mesh", "creaseLengths"),
        ("curves", "curveVertexCounts"),
    ],
)
def test_indices_of_another_type_are_one_error(part: str, name: str, tmp_path: Path) -> None:
    for text in ("double {} = 1e300", "asset[] {} = [@x@]", "float[] {} = [0.5]"):
        with pytest.raises(dg.InputError, match=rf"/W/.\.{name}: wanted whole numbers, got "):
            _read(tmp_path, **{part: text.format(name)})


def test_a_lamp_beyond_the_limits_is_one_error(tmp_path: Path) -> None:
    for size in ("1e300", "-1e19"):
        with pytest.raises(
            dg.InputError, match=r"/W/l\.inputs:radius: wanted a number below 1e\+18"
        ):
            _read(tmp_path, light=f"double inputs:radius = {size}")
