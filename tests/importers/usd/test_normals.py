"""Normals of polygon meshes over time: those of a stage that is loaded at each moment."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdGeom, Vt

import daguerre as dg
from daguerre.setup.vertices import resample_vertices
from tests.support.formats import stages

#: Normals of two moments, of other lengths and 60 degrees apart.
_FIRST, _LAST = (0.0, 0.0, 1.0), (4.0, 0.0, 2.3)
_TIMES = (0.0, 0.2, 0.5, 0.8, 1.0)


def _keyed(attribute: Usd.Attribute, *samples: Sequence[Sequence[float]]) -> None:
    for second, rows in enumerate(samples):
        attribute.Set(stages.vectors(np.array(rows, float)), 24 * second)


def _by_vertex(stage: Usd.Stage) -> None:
    mesh = stages.mesh(stage, "/card")
    _keyed(mesh.CreateNormalsAttr(), [_FIRST] * 4, [_LAST, _FIRST, _LAST, _LAST])


def _by_corner(stage: Usd.Stage) -> None:
    """Two quads; the corners at their common edge have equal normals at first, but not later."""
    points = [(x, y, 0) for y in (0, 1) for x in (0, 1, 2)]
    mesh = stages.mesh(stage, "/card", points, [4, 4], [0, 1, 4, 3, 1, 2, 5, 4])
    _keyed(mesh.CreateNormalsAttr(), [_FIRST] * 8, [_LAST] * 4 + [(-2, 0, 1)] * 4)
    mesh.SetNormalsInterpolation("faceVarying")


def _indexed(stage: Usd.Stage) -> None:
    mesh = stages.mesh(stage, "/card")
    found = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("normals", Sdf.ValueTypeNames.Normal3fArray)
    found.SetInterpolation("faceVarying")
    found.SetIndices(Vt.IntArray([1, 0, 0, 1]))
    _keyed(found.GetAttr(), [_FIRST, _LAST], [_LAST, _FIRST])


def _moving(stage: Usd.Stage) -> None:
    _by_vertex(stage)
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/card"))
    points = np.array(mesh.GetPointsAttr().Get(), float)
    _keyed(mesh.GetPointsAttr(), points, points + np.array((0, 0, 1)))


def _written(tmp_path: Path, write: Callable[[Usd.Stage], Any]) -> Path:
    stage = stages.new_stage(tmp_path / f"{write.__name__}.usda")
    stage.SetTimeCodesPerSecond(24)
    write(stage)
    return stages.save(stage)


def _rows(mesh: Any) -> np.ndarray:
    """Positions and normals at the corners of all triangles."""
    each = np.concatenate([mesh.positions, mesh.normals], axis=1)
    return np.asarray(each[mesh.indices].reshape(-1, 6))


@pytest.mark.parametrize("write", [_by_vertex, _by_corner, _indexed, _moving])
def test_another_moment_has_the_normals_of_a_stage_loaded_then(
    write: Callable[[Usd.Stage], Any], tmp_path: Path
) -> None:
    path = _written(tmp_path, write)
    scene = dg.load(path)
    for time in _TIMES:
        there = dg.load(path, time=time)
        np.testing.assert_allclose(
            _rows(scene.at(time).meshes[0]), _rows(there.meshes[0]), atol=1e-6
        )
        np.testing.assert_allclose(np.linalg.norm(there.meshes[0].normals, axis=1), 1, atol=1e-6)


@pytest.mark.parametrize("write", [_by_vertex, _by_corner, _indexed, _moving])
def test_blur_has_the_normals_of_each_moment(
    write: Callable[[Usd.Stage], Any], tmp_path: Path
) -> None:
    scene = dg.load(_written(tmp_path, write))
    moving = scene.motion.meshes[0]
    steps, keeps = resample_vertices(moving, 0.0, 1.0)
    assert keeps
    for time in np.linspace(0, 1, 23):
        place = time * (len(steps) - 1)
        i = min(int(place), len(steps) - 2)
        a, b = (np.asarray(step.normals, float) for step in steps[i : i + 2])
        between = a + (place - i) * (b - a)
        between /= np.linalg.norm(between, axis=1, keepdims=True)
        np.testing.assert_allclose(between, moving.at(time).normals, atol=3e-3)


def test_corners_that_are_always_equal_stay_one_vertex(tmp_path: Path) -> None:
    def write(stage: Usd.Stage) -> None:
        _by_corner(stage)
        mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/card"))
        _keyed(mesh.GetNormalsAttr(), [_FIRST] * 8, [_LAST] * 8)

    assert len(dg.load(_written(tmp_path, write)).meshes[0].positions) == 6
    other = dg.load(_written(tmp_path, _by_corner))
    assert len(other.meshes[0].positions) == 8


def test_normals_that_stay_and_those_whose_number_changes_are_not_over_time(
    tmp_path: Path,
) -> None:
    def stays(stage: Usd.Stage) -> None:
        _keyed(stages.mesh(stage, "/card").CreateNormalsAttr(), [_LAST] * 4, [_LAST] * 4)

    def grows(stage: Usd.Stage) -> None:
        _keyed(stages.mesh(stage, "/card").CreateNormalsAttr(), [_LAST] * 4, [_FIRST] * 5)

    for write, count in ((stays, 0), (grows, 1)):
        scene = dg.load(_written(tmp_path, write))
        assert not scene.motion.meshes
        assert len([note for note in scene.warnings if "normals over time" in note]) == count
        expected = np.array(_LAST) / np.linalg.norm(_LAST)
        np.testing.assert_allclose(scene.meshes[0].normals, np.tile(expected, (4, 1)), atol=1e-6)


def test_opposite_normals_turn_with_the_surface_where_they_cancel() -> None:
    scene = dg.Scene()
    up = np.tile((0.0, 0.0, 1.0), (3, 1))
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    scene.add_mesh(corners, [(0, 1, 2)], dg.keys([(0, up), (1, -up)]))
    for time, sign in ((0.25, 1), (0.5, 1), (0.75, -1)):
        np.testing.assert_array_equal(scene.at(time).meshes[0].normals, sign * up)


def test_a_blurred_picture_is_the_mean_of_its_moments(tmp_path: Path) -> None:
    def write(stage: Usd.Stage) -> None:
        mesh = stages.mesh(stage, "/card")
        _keyed(mesh.CreateNormalsAttr(), [_FIRST] * 4, [_LAST] * 4)

    path, place = _written(tmp_path, write), np.eye(4)
    place[:3, 3] = *dg.load(path).meshes[0].positions.mean(axis=0)[:2], 2
    camera = dg.Camera(transform=place, focal_length=200, fps=1, shutter_time=1)
    towards = np.eye(4)
    towards[:3, :3] = np.array([[0.5, 0, 0.75**0.5], [0, 1, 0], [-(0.75**0.5), 0, 0.5]])

    def light_of(time: float, camera: dg.Camera) -> float:
        scene = dg.load(path, time=time)
        scene.add_light(dg.DirectionalLight((1, 1, 1)), towards)
        return float(dg.render(scene, camera, resolution=(6, 4), spp=256).rgb.mean())

    still = camera.with_(shutter_time=0.0)
    moments = [light_of(time, still) for time in (np.arange(24) + 0.5) / 24]
    assert max(moments) > 1.3 * min(moments) > 0
    assert light_of(0.5, camera) == pytest.approx(np.mean(moments), rel=3e-3)
