"""Meshes of a stage as OpenUSD's own functions report them, without the reader under test."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade

Array = NDArray[np.float32]
Indices = NDArray[np.int64]
#: A mesh, and each place that it has in the world; matrices act on rows, as USD's do.
Placed = tuple[UsdGeom.Mesh, list[Gf.Matrix4d]]


@dataclass(frozen=True, eq=False)
class Part:
    """Triangles of one material.

    Attributes:
        positions: Shape (N, 3), in the mesh's own space.
        normals: Shape (N, 3), or None: flat.
        uv: Primvar ``st`` with its origin at the bottom left, shape (N, 2), or None.
        triangles: Shape (T, 3).
        material: Path that the faces are bound to; it need not be that of a prim.
    """

    positions: Array
    normals: Array | None
    uv: Array | None
    triangles: Indices
    material: Sdf.Path


def drawn(root: Usd.Prim, places: list[Gf.Matrix4d], cache: UsdGeom.XformCache) -> Iterator[Placed]:
    """Meshes below a prim that a renderer draws; ``places`` are those of the prim itself."""
    walk = iter(Usd.PrimRange(root, Usd.TraverseInstanceProxies()))
    for prim in walk:
        within, _ = cache.ComputeRelativeTransform(prim, root)
        here = [within * place for place in places]
        if prim.IsA(UsdGeom.PointInstancer):
            walk.PruneChildren()
            yield from _copies(UsdGeom.PointInstancer(prim), here, cache)
        elif prim.IsA(UsdGeom.Mesh) and _is_seen(UsdGeom.Imageable(prim)):
            yield UsdGeom.Mesh(prim), here


def _copies(
    instancer: UsdGeom.PointInstancer, places: list[Gf.Matrix4d], cache: UsdGeom.XformCache
) -> Iterator[Placed]:
    now = cache.GetTime()
    kind = UsdGeom.PointInstancer
    each = instancer.ComputeInstanceTransformsAtTime(
        now, now, kind.IncludeProtoXform, kind.IgnoreMask
    )
    shown = instancer.ComputeMaskAtTime(now) or [True] * len(each)
    numbers = instancer.GetProtoIndicesAttr().Get(now)
    stage = instancer.GetPrim().GetStage()
    for number, path in enumerate(instancer.GetPrototypesRel().GetForwardedTargets()):
        own = [m for m, of, on in zip(each, numbers, shown, strict=True) if on and of == number]
        copies = [m * place for place in places for m in own]
        yield from drawn(stage.GetPrimAtPath(path), copies, cache)


def _is_seen(prim: UsdGeom.Imageable) -> bool:
    return prim.ComputeVisibility() != "invisible" and prim.ComputePurpose() in (
        UsdGeom.Tokens.default_,
        UsdGeom.Tokens.render,
    )


def parts_of(mesh: UsdGeom.Mesh) -> list[Part]:
    """Triangles of a polygon mesh, by material."""
    prim = mesh.GetPrim()
    assert mesh.GetSubdivisionSchemeAttr().Get() == "none", prim.GetPath()
    sizes = np.asarray(mesh.GetFaceVertexCountsAttr().Get(), np.int64)
    vertices = np.asarray(mesh.GetFaceVertexIndicesAttr().Get(), np.int64)
    points = np.asarray(mesh.GetPointsAttr().Get(), np.float32)
    triangles, faces = triangulated(sizes, points[vertices])
    if mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded:
        triangles = triangles[:, ::-1]
    values = {
        "points": points[vertices],
        "normals": _at_corners(_normals(mesh), sizes, vertices),
        "st": _at_corners(_primvar(prim, "st"), sizes, vertices),
    }
    return [
        _part(values, triangles[chosen[faces]], path)
        for chosen, path in _bindings(prim, len(sizes))
    ]


def triangulated(sizes: Indices, corners: Array) -> tuple[Indices, Indices]:
    """Triangles of convex polygons: fans, but quadrangles are cut along the shorter diagonal.

    Args:
        sizes: Corners of each polygon, shape (F,).
        corners: Position of each corner, shape (C, 3).

    Returns:
        Corners of triangles, shape (T, 3), and the polygon of each, shape (T,).
    """
    starts = np.cumsum(sizes) - sizes
    rows, faces = [], []
    for size in np.unique(sizes):
        chosen = np.flatnonzero(sizes == size)
        first = starts[chosen]
        if size == 4:
            a, b, c, d = (corners[first + i].astype(float) for i in range(4))
            first = first[:, None] + np.arange(4)
            other = ((d - b) ** 2).sum(axis=1) < ((c - a) ** 2).sum(axis=1)
            first[other] = np.roll(first[other], -1, axis=1)
        else:
            first = first[:, None] + np.arange(size)
        for i in range(1, size - 1):
            rows.append(first[:, [0, i, i + 1]])
            faces.append(chosen)
    return np.concatenate(rows), np.concatenate(faces)


def _primvar(prim: Usd.Prim, name: str) -> tuple[Any, str] | None:
    found = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance(name)
    return (found.ComputeFlattened(), found.GetInterpolation()) if found.HasValue() else None


def _normals(mesh: UsdGeom.Mesh) -> tuple[Any, str] | None:
    given = mesh.GetNormalsAttr().Get()
    found = _primvar(mesh.GetPrim(), "normals")
    return found or (None if given is None else (given, mesh.GetNormalsInterpolation()))


def _at_corners(values: tuple[Any, str] | None, sizes: Indices, vertices: Indices) -> Array | None:
    if values is None:
        return None
    rows, kind = np.asarray(values[0], np.float32), values[1]
    index = {
        "constant": np.zeros(len(vertices), np.int64),
        "uniform": np.repeat(np.arange(len(sizes)), sizes),
        "faceVarying": np.arange(len(vertices)),
    }.get(kind, vertices)
    return rows[index]


def _part(values: dict[str, Array | None], triangles: Indices, material: Sdf.Path) -> Part:
    """Part with each different vertex once."""
    given = {name: rows for name, rows in values.items() if rows is not None}
    used = triangles.reshape(-1)
    table = np.concatenate([rows[used] for rows in given.values()], axis=1)
    _, first, index = np.unique(table, axis=0, return_index=True, return_inverse=True)
    kept = {name: rows[used[first]] for name, rows in given.items()}
    triangles = index.reshape(-1, 3)
    return Part(kept["points"], kept.get("normals"), kept.get("st"), triangles, material)


def _bindings(prim: Usd.Prim, faces: int) -> list[tuple[NDArray[np.bool_], Sdf.Path]]:
    """Faces and the path that they are bound to."""
    left, found = np.ones(faces, bool), []
    for subset in UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets():
        chosen = np.zeros(faces, bool)
        chosen[np.asarray(subset.GetIndicesAttr().Get(), np.int64)] = True
        found.append((chosen, bound_path(subset.GetPrim())))
        left &= ~chosen
    return [*found, (left, bound_path(prim))] if left.any() else found


def bound_path(prim: Usd.Prim) -> Sdf.Path:
    """Path of the material that USD binds to a prim; without a prim there, the nearest target."""
    material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
    if material:
        return material.GetPath()
    while prim:
        targets = prim.GetRelationship("material:binding").GetForwardedTargets()
        if targets:
            return targets[0]
        prim = prim.GetParent()
    return Sdf.Path.emptyPath
