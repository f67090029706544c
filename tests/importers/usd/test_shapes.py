"""Solids of UsdGeom: extent as USD has it, volume, area, winding, normals and images on them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Gf, Usd, UsdGeom

import daguerre as dg
from daguerre.importers.usd.shapes import ball, is_solid, solid_of
from daguerre.importers.usd.values import Clock
from daguerre.scene.shapes import ShapeMesh
from tests.support.formats import stages

_CLOCK = Clock("f.usda", 24.0, 0.0)
#: Volume and area of solids of these sizes; one radius is 2, the other 1.
_SOLIDS: dict[str, tuple[dict[str, float], float, float]] = {
    "Cube": ({"size": 3.0}, 27.0, 54.0),
    "Sphere": ({"radius": 2.0}, 32 / 3 * math.pi, 16 * math.pi),
    "Cylinder": ({"radius": 2.0, "height": 5.0}, 20 * math.pi, 28 * math.pi),
    "Cone": ({"radius": 2.0, "height": 5.0}, 20 / 3 * math.pi, math.pi * (4 + 2 * math.sqrt(29))),
    "Capsule": ({"radius": 2.0, "height": 5.0}, (20 + 32 / 3) * math.pi, (20 + 16) * math.pi),
    "Cylinder_1": (
        {"radiusBottom": 2.0, "radiusTop": 1.0, "height": 5.0},
        35 / 3 * math.pi,
        math.pi * (5 + 3 * math.sqrt(26)),
    ),
    "Capsule_1": (
        {"radiusBottom": 2.0, "radiusTop": 2.0, "height": 5.0},
        92 / 3 * math.pi,
        36 * math.pi,
    ),
}


def _prim(kind: str, **sizes: Any) -> tuple[Usd.Stage, Usd.Prim]:
    stage = Usd.Stage.CreateInMemory()
    prim = stage.DefinePrim("/solid", kind)
    for name, value in sizes.items():
        prim.GetAttribute(name).Set(value)
    return stage, prim


def _solid(kind: str, **sizes: Any) -> ShapeMesh | None:
    stage, prim = _prim(kind, **sizes)
    made = solid_of(prim, _CLOCK)
    del stage
    return made


def _made(kind: str, **sizes: Any) -> ShapeMesh:
    made = _solid(kind, **sizes)
    assert made is not None
    return made


def _corners(solid: ShapeMesh) -> Any:
    return (solid.positions[solid.triangles[:, k]] for k in range(3))


def _volume(solid: ShapeMesh) -> float:
    """Signed volume: positive if triangles are counter-clockwise seen from outside."""
    a, b, c = _corners(solid)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def _area(solid: ShapeMesh) -> float:
    a, b, c = _corners(solid)
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


@pytest.mark.parametrize("axis", ["X", "Y", "Z"])
@pytest.mark.parametrize("kind", _SOLIDS)
def test_volume_area_and_extent(kind: str, axis: str) -> None:
    sizes, volume, area = _SOLIDS[kind]
    axes = {} if kind in ("Cube", "Sphere") else {"axis": axis}
    solid = _made(kind, **sizes, **axes)
    assert _volume(solid) == pytest.approx(volume, rel=6e-3)
    assert _area(solid) == pytest.approx(area, rel=4e-3)
    stage, prim = _prim(kind, **sizes, **axes)
    low, high = UsdGeom.Boundable.ComputeExtentFromPlugins(UsdGeom.Boundable(prim), 0)
    assert stage
    assert np.allclose([solid.positions.min(axis=0), solid.positions.max(axis=0)], [low, high])


@pytest.mark.parametrize("axis", ["X", "Y", "Z"])
@pytest.mark.parametrize("kind", [*_SOLIDS, "Plane"])
def test_normals_are_unit_and_agree_with_the_winding(kind: str, axis: str) -> None:
    sizes = {} if kind == "Plane" else _SOLIDS[kind][0]
    solid = _made(kind, **sizes, **({} if kind in ("Cube", "Sphere") else {"axis": axis}))
    assert np.allclose(np.linalg.norm(solid.normals, axis=1), 1)
    a, b, c = _corners(solid)
    flat = np.cross(b - a, c - a)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    for k in range(3):
        aligned = np.einsum("ij,ij->i", flat, solid.normals[solid.triangles[:, k]])
        assert aligned.min() > 0.99


def test_normals_are_those_of_the_surface() -> None:
    solid = ball(2.0)
    assert solid is not None
    assert np.allclose(solid.normals, solid.positions / 2)
    cone = _made("Cone", radius=3.0, height=4.0)
    side = cone.normals[np.abs(cone.normals[:, 2]) < 0.99]
    assert np.allclose(side[:, 2], 0.6)
    assert np.allclose(np.hypot(side[:, 0], side[:, 1]), 0.8)


@pytest.mark.parametrize(("axis", "width", "length"), [("X", 2, 1), ("Y", 0, 2), ("Z", 0, 1)])
def test_a_plane_lies_as_its_documentation_says(axis: str, width: int, length: int) -> None:
    solid = _made("Plane", width=3.0, length=5.0, axis=axis)
    extent = np.ptp(solid.positions, axis=0)
    across = "XYZ".index(axis)
    assert (extent[width], extent[length], extent[across]) == (3, 5, 0)
    assert np.allclose(solid.normals, np.eye(3)[across])
    assert _area(solid) == 15


_HULLS = [(2.0, 1.0, 4.0), (0.5, 1.5, 2.0), (1.0, 3.0, 1.0), (2.0, 1.0, 0.0)]


@pytest.mark.parametrize(("bottom", "top", "height"), _HULLS)
def test_a_capsule_of_two_radii_is_the_hull_of_two_balls(
    bottom: float, top: float, height: float
) -> None:
    """Its farthest point in each direction is that of one of the balls."""
    solid = _made("Capsule_1", radiusBottom=bottom, radiusTop=top, height=height)
    rng = np.random.default_rng(1)
    seen = rng.normal(size=(500, 3))
    seen /= np.linalg.norm(seen, axis=1, keepdims=True)
    expected = np.maximum(top + 0.5 * height * seen[:, 2], bottom - 0.5 * height * seen[:, 2])
    assert np.allclose((seen @ solid.positions.T).max(axis=1), expected, rtol=4e-3)
    a, b, c = _corners(solid)
    lowest = np.linalg.norm(np.cross(b - a, c - a), axis=1).min()
    assert lowest > 0
    assert _volume(solid) > 0


@pytest.mark.parametrize("kind", ["Cube", "Plane"])
def test_images_on_flat_faces_are_not_mirrored(kind: str) -> None:
    """u to the right and v down have the handedness of a picture seen from outside."""
    for axis in ("X", "Y", "Z") if kind == "Plane" else ("Z",):
        solid = _made(kind, **({"axis": axis} if kind == "Plane" else {}))
        (ua, ub, uc) = (solid.uv[solid.triangles[:, k]] for k in range(3))
        du, dv = ub - ua, uc - ua
        turns = du[:, 0] * dv[:, 1] - du[:, 1] * dv[:, 0]
        assert (turns < 0).all(), axis  # v points down, so counter-clockwise is negative
        assert np.allclose([solid.uv.min(), solid.uv.max()], [0, 1])
        if kind == "Plane":
            top, up = solid.positions[solid.uv[:, 1] == 0], {"X": (0, 1, 0), "Y": (0, 0, -1)}
            assert (top @ up.get(axis, (0, 1, 0)) > 0).all()


@pytest.mark.parametrize("kind", ["Sphere", "Cylinder", "Cone", "Capsule"])
def test_images_around_solids_are_upright_and_not_mirrored(kind: str) -> None:
    solid = _made(kind)
    (ua, ub, uc) = (solid.uv[solid.triangles[:, k]] for k in range(3))
    du, dv = ub - ua, uc - ua
    assert (du[:, 0] * dv[:, 1] - du[:, 1] * dv[:, 0] < 0).all()
    side = np.abs(solid.normals[:, 2]) < 0.9
    high, v = solid.positions[side, 2], solid.uv[side, 1]
    assert np.corrcoef(high, v)[0, 1] < -0.9


# --- Sizes that are no sizes -----------------------------------------------------------------


@pytest.mark.parametrize("kind", _SOLIDS)
def test_negative_sizes_mean_positive_ones(kind: str) -> None:
    sizes, volume, _ = _SOLIDS[kind]
    solid = _made(kind, **{name: -value for name, value in sizes.items()})
    assert _volume(solid) == pytest.approx(volume, rel=6e-3)


@pytest.mark.parametrize("kind", _SOLIDS)
def test_a_solid_of_size_0_is_none(kind: str) -> None:
    assert _solid(kind, **dict.fromkeys(_SOLIDS[kind][0], 0.0)) is None


def test_solids_that_collapse_keep_what_is_left() -> None:
    assert _area(_made("Cylinder", radius=1.0, height=0.0)) == pytest.approx(2 * math.pi, rel=2e-3)
    assert _solid("Cylinder", radius=0.0, height=1.0) is None
    assert _solid("Plane", width=0.0) is None
    assert _volume(_made("Capsule", radius=1.0, height=0.0)) == pytest.approx(4.19, rel=6e-3)
    assert _solid("Capsule", radius=0.0, height=1.0) is None


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e300])
@pytest.mark.parametrize("kind", [*_SOLIDS, "Plane"])
def test_sizes_that_are_not_finite_are_refused(kind: str, value: float) -> None:
    names = _SOLIDS[kind][0] if kind in _SOLIDS else ("width", "length")
    for name in names:
        with pytest.raises(
            dg.InputError, match=rf"f\.usda: /solid\.{name}: wanted a finite number"
        ):
            _solid(kind, **{name: value})


def test_other_prims_are_no_solids() -> None:
    stage, prim = _prim("Mesh")
    assert stage
    assert not is_solid(prim)
    assert solid_of(prim, _CLOCK) is None


def test_a_size_of_another_type_is_refused_and_a_blocked_one_is_the_schemas(tmp_path: Path) -> None:
    path = tmp_path / "x.usda"
    text = '#usda 1.0\n(\nupAxis = "Y"\nmetersPerUnit = 1\n)\ndef Cube "c"\n{{\n{}\n}}\n'
    path.write_text(text.format('string size = "x"'))
    with pytest.raises(dg.InputError, match=r"/c\.size: wanted a finite number, got x"):
        dg.load(path)
    other = tmp_path / "y.usda"
    other.write_text(text.format("double size = None"))
    assert np.ptp(dg.load(other).meshes[0].positions) == 2


@pytest.mark.parametrize("kind", [*_SOLIDS, "Plane"])
def test_solids_in_a_stage(tmp_path: Path, kind: str) -> None:
    stage = stages.new_stage(tmp_path / "x.usda", metres=0.01)
    for name in ("a", "b"):
        prim = stage.DefinePrim(f"/{name}", kind)
        stages.place(prim, at=(0, 0, -300), scale=(100, 100, 100))
    scene = stages.read(stage)
    assert len(scene.instances) == 2
    mesh, world = scene.meshes[scene.instances[0].mesh], scene.instances[0].transform
    found = mesh.positions.astype(float) @ world[:3, :3].T + world[:3, 3]
    low, high = UsdGeom.Boundable.ComputeExtentFromPlugins(UsdGeom.Boundable(prim), 0)
    found -= (0, 0, -3)
    assert np.allclose([found.min(axis=0), found.max(axis=0)], [low, high], atol=1e-5)
    scene.set_environment(color=(1, 1, 1))
    assert np.isfinite(stages.seen(scene, stages.looking((0, 0, -3)))).all()


def test_a_solid_that_changes_its_size_is_a_note(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    size = UsdGeom.Capsule_1.Define(stage, "/a").GetRadiusTopAttr()
    size.Set(1.0, 1)
    size.Set(2.0, 9)
    UsdGeom.Cube.Define(stage, "/b").CreateDisplayColorAttr([Gf.Vec3f(1)])
    notes = [note for note in stages.read(stage).warnings if "size changes" in note]
    assert notes == [
        "a solid whose size changes over time keeps its size at the scene's time (1 use)"
    ]
