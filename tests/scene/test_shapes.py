"""Shapes: gap to the exact surface, area, winding, normals, texture coordinates, parts of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.scene import shapes
from daguerre.scene.shapes import ShapeMesh

Array = NDArray[np.float64]
_WHOLE: dict[str, Callable[[], ShapeMesh | None]] = {
    "sphere": lambda: shapes.sphere(2.0),
    "part of a sphere": lambda: shapes.sphere(2.0, -1.0, 1.5, 250.0),
    "disk": lambda: shapes.disk(2.0, 0.5, 0.3, 250.0),
    "whole disk": lambda: shapes.disk(2.0),
    "cylinder": lambda: shapes.cylinder(2.0, -1.0, 3.0, 250.0),
    "rectangle": lambda: shapes.rectangle(3.0, 2.0),
    "cube": lambda: shapes.cube(2.0),
    "patch": lambda: shapes.bilinear([[(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0.5)]]),
}
#: Exact areas.
_AREAS = {
    "sphere": 16 * math.pi,
    "part of a sphere": math.radians(250) * 2.0 * 2.5,
    "disk": math.radians(250) / 2 * (4 - 0.25),
    "whole disk": 4 * math.pi,
    "cylinder": math.radians(250) * 2.0 * 4.0,
    "rectangle": 6.0,
    "cube": 24.0,
}


def made(name: str) -> ShapeMesh:
    found = _WHOLE[name]()
    assert found is not None
    return found


def corners(mesh: ShapeMesh) -> tuple[Array, Array, Array]:
    return tuple(mesh.positions[mesh.triangles[:, k]] for k in range(3))  # type: ignore[return-value]


def faces(mesh: ShapeMesh) -> Array:
    """Normals of triangles, of twice their area."""
    a, b, c = corners(mesh)
    return np.cross(b - a, c - a)


def area(mesh: ShapeMesh) -> float:
    return float(0.5 * np.linalg.norm(faces(mesh), axis=1).sum())


@pytest.mark.parametrize("name", _AREAS)
def test_areas_are_those_of_the_exact_shapes(name: str) -> None:
    # A gap of 2e-4 radii makes an area smaller by at most 4/3 of it (disk), or twice (sphere).
    assert 0.9996 < area(made(name)) / _AREAS[name] < 1 + 1e-9


@pytest.mark.parametrize("name", _WHOLE)
def test_triangles_face_the_side_of_the_normals(name: str) -> None:
    mesh = made(name)
    flat = faces(mesh)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    for k in range(3):
        normals = mesh.normals[mesh.triangles[:, k]]
        assert np.einsum("ij,ij->i", flat, normals).min() > 0.9
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-12)


@pytest.mark.parametrize("name", _WHOLE)
def test_a_flipped_shape_faces_the_other_side(name: str) -> None:
    mesh = made(name)
    other = mesh.flipped()
    np.testing.assert_array_equal(other.normals, -mesh.normals)
    np.testing.assert_allclose(faces(other), -faces(mesh), rtol=1e-6, atol=1e-15)


@pytest.mark.parametrize("error", [1e-2, 1e-3, 2e-4])
def test_the_gap_of_a_sphere_is_the_stated_one(error: float) -> None:
    mesh = shapes.sphere(3.0, error=error)
    assert mesh is not None
    np.testing.assert_allclose(np.linalg.norm(mesh.positions, axis=1), 3.0, rtol=1e-12)
    # The nearest points of planes bound the gaps, and those of the largest facets reach it.
    a, _, _ = corners(mesh)
    flat = faces(mesh)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    gap = 1 - np.einsum("ij,ij->i", a, flat) / 3.0
    assert gap.max() <= error * (1 + 1e-9)
    assert gap.max() > 0.5 * error


@pytest.mark.parametrize("error", [1e-2, 1e-3, 2e-4])
@pytest.mark.parametrize("make", [shapes.disk, shapes.cylinder])
def test_the_gap_of_a_rim_is_the_stated_one(make: Any, error: float) -> None:
    mesh = make(3.0, error=error)
    rim = mesh.positions[np.abs(np.hypot(*mesh.positions[:, :2].T) - 3) < 1e-9]
    rim = rim[rim[:, 2] == rim[0, 2]]
    middles = 0.5 * (rim[1:, :2] + rim[:-1, :2])
    gap = 1 - np.hypot(*middles.T) / 3
    assert 0.5 * error < gap.max() <= error * (1 + 1e-9)


def test_texture_coordinates_of_a_sphere_are_its_angles() -> None:
    """u = phi / sweep; v runs linearly in the angle, from the top down."""
    mesh = shapes.sphere(2.0, -1.0, 1.5, 250.0)
    assert mesh is not None
    x, y, z = mesh.positions.T
    phi = np.degrees(np.arctan2(y, x)) % 360
    np.testing.assert_allclose(mesh.uv[:, 0], np.where(phi > 359.9, 0, phi) / 250, atol=1e-9)
    high, low = math.acos(1.5 / 2), math.acos(-1.0 / 2)
    np.testing.assert_allclose(mesh.uv[:, 1], (np.arccos(z / 2) - high) / (low - high), atol=1e-9)
    np.testing.assert_allclose([z.min(), z.max()], [-1.0, 1.5], atol=1e-12)


def test_texture_coordinates_of_a_disk_are_angle_and_radius() -> None:
    mesh = shapes.disk(2.0, 0.5, 0.25, 90.0)
    assert mesh is not None
    x, y, z = mesh.positions.T
    np.testing.assert_allclose(mesh.uv[:, 0], np.degrees(np.arctan2(y, x)) / 90, atol=1e-9)
    np.testing.assert_allclose(mesh.uv[:, 1], (np.hypot(x, y) - 0.5) / 1.5, atol=1e-9)
    assert (z == 0.25).all()
    assert (mesh.normals == (0, 0, 1)).all()


def test_texture_coordinates_of_a_cylinder_are_angle_and_depth() -> None:
    mesh = shapes.cylinder(2.0, -1.0, 3.0, 90.0)
    assert mesh is not None
    x, y, z = mesh.positions.T
    np.testing.assert_allclose(mesh.uv[:, 0], np.degrees(np.arctan2(y, x)) / 90, atol=1e-9)
    np.testing.assert_allclose(mesh.uv[:, 1], (3.0 - z) / 4, atol=1e-9)
    np.testing.assert_allclose(mesh.normals, np.stack([x / 2, y / 2, 0 * x], 1), atol=1e-12)


def test_images_on_flat_shapes_are_upright_from_the_front() -> None:
    mesh = made("rectangle")
    np.testing.assert_allclose(mesh.uv[:, 0], mesh.positions[:, 0] / 3 + 0.5, atol=1e-12)
    np.testing.assert_allclose(mesh.uv[:, 1], 0.5 - mesh.positions[:, 1] / 2, atol=1e-12)
    cube = made("cube")
    for face in range(6):  # u, -v and the normal are right-handed on each face
        some = slice(4 * face, 4 * face + 4)
        p, uv = cube.positions[some], cube.uv[some]
        right = p[uv[:, 0] == 1].mean(0) - p[uv[:, 0] == 0].mean(0)
        up = p[uv[:, 1] == 0].mean(0) - p[uv[:, 1] == 1].mean(0)
        np.testing.assert_allclose(np.cross(right, up), 4 * cube.normals[4 * face], atol=1e-12)


#: A twisted patch; p(u, v) has the height u v.
_SADDLE = np.array([[(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 1)]], float)


@pytest.mark.parametrize("error", [1e-2, 1e-3, 1e-4])
def test_a_bilinear_patch_is_as_near_as_stated(error: float) -> None:
    mesh = shapes.bilinear(_SADDLE, error=error)
    assert mesh is not None
    x, y, z = mesh.positions.T
    np.testing.assert_allclose(z, x * y, atol=1e-12)
    np.testing.assert_allclose(mesh.uv, np.stack([x, 1 - y], axis=1), atol=1e-12)
    normals = np.stack([-y, -x, np.ones_like(x)], axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    np.testing.assert_allclose(mesh.normals, normals, atol=1e-12)
    a, b, c = corners(mesh)
    middles = np.concatenate([(a + b) / 2, (b + c) / 2, (c + a) / 2, (a + b + c) / 3])
    gap = np.abs(middles[:, 2] - middles[:, 0] * middles[:, 1]).max() / math.sqrt(3)
    assert 0.25 * error < gap <= error * (1 + 1e-9)


def test_a_flat_patch_is_two_triangles_and_neighbours_share_their_edge() -> None:
    flat = shapes.bilinear([[(0, 0, 0), (2, 0, 0), (0, 1, 0), (2, 1, 0)]])
    assert flat is not None
    assert len(flat.triangles) == 2
    assert area(flat) == pytest.approx(2.0)
    beside = [(1, 0, 0), (2, 0, 0), (1, 1, 1), (2, 1, 1)]  # flat itself
    both = shapes.bilinear([_SADDLE[0], np.array(beside, float)], error=1e-3)
    assert both is not None
    half = len(both.positions) // 2
    edges = [p[p[:, 0] == 1] for p in (both.positions[:half], both.positions[half:])]
    np.testing.assert_array_equal(edges[0], edges[1])


def test_values_of_patches_are_interpolated() -> None:
    normals = np.array([[(0, 0, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1)]], float)
    uv = np.array([[(0, 0), (4, 0), (0, 2), (4, 2)]], float)
    mesh = shapes.bilinear(_SADDLE, normals, uv, error=1e-2)
    assert mesh is not None
    x, y, _ = mesh.positions.T
    np.testing.assert_allclose(mesh.uv, np.stack([4 * x, 2 * y], axis=1), atol=1e-12)
    blend = np.stack([x * (1 - y), (1 - x) * y, (1 - x) * (1 - y) + x * y], axis=1)
    blend /= np.linalg.norm(blend, axis=1, keepdims=True)
    np.testing.assert_allclose(mesh.normals, blend, atol=1e-12)


def test_many_patches_have_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """The number of cells of a call is bounded, however twisted patches are."""
    monkeypatch.setattr(shapes, "_MOST_CELLS", 1 << 12)
    mesh = shapes.bilinear(np.repeat(_SADDLE, 100, axis=0), error=1e-6)
    assert mesh is not None
    assert len(mesh.triangles) == 2 * 100 * 6**2


def test_a_patch_whose_corners_coincide_has_normals() -> None:
    mesh = shapes.bilinear([[(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 1, 0)]])
    assert mesh is not None
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-12)


@pytest.mark.parametrize(
    "make",
    [
        lambda: shapes.sphere(0.0),
        lambda: shapes.sphere(1.0, 0.5, 0.5),
        lambda: shapes.sphere(1.0, 2.0, 3.0),
        lambda: shapes.sphere(1.0, math.nan),
        lambda: shapes.sphere(1.0, sweep=0.0),
        lambda: shapes.disk(0.0),
        lambda: shapes.disk(1.0, 1.0),
        lambda: shapes.cylinder(1.0, 2.0, 2.0),
        lambda: shapes.cylinder(0.0),
        lambda: shapes.rectangle(0.0, 1.0),
        lambda: shapes.cube(0.0),
        lambda: shapes.bilinear(np.zeros((2, 4, 3))),
        lambda: shapes.bilinear(np.zeros((0, 4, 3))),
    ],
)
def test_shapes_of_no_area_are_none(make: Callable[[], ShapeMesh | None]) -> None:
    assert make() is None


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: shapes.sphere(-1.0), "shape: radius: wanted a number of at least 0"),
        (lambda: shapes.sphere(math.inf), "shape: radius: wanted"),
        (lambda: shapes.sphere(sweep=361), "shape: sweep: wanted .* at most 360, got 361"),
        (lambda: shapes.sphere(error=0), "shape: error: wanted"),
        (lambda: shapes.disk(1.0, 2.0), "disk: inner: wanted .* at most 1, got 2"),
        (lambda: shapes.disk(height=math.nan), "disk: height: wanted"),
        (lambda: shapes.cylinder(low=-math.inf), "cylinder: low: wanted"),
        (lambda: shapes.bilinear(_SADDLE, error=1), "shape: error: wanted"),
    ],
)
def test_numbers_out_of_range_are_errors(make: Callable[[], Any], told: str) -> None:
    with pytest.raises(dg.InputError, match=told):
        make()


def test_turns_of_an_axis_keep_the_winding() -> None:
    profile, slopes = np.array([(1.0, 0.0), (1.0, 1.0)]), np.array([(1.0, 0.0), (1.0, 0.0)])
    for axis in "XYZ":
        mesh = shapes.revolved(profile, slopes, axis)
        assert mesh is not None
        k = "XYZ".index(axis)
        assert mesh.positions[:, k].max() == 1
        assert np.einsum("ij,ij->i", faces(mesh), mesh.normals[mesh.triangles[:, 0]]).min() > 0
