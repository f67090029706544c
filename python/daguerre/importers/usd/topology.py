"""Reads the faces of meshes, and makes the surfaces that are drawn: plain or subdivided."""

from __future__ import annotations

import numpy as np
from pxr import UsdGeom

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.scene.over_time.surfaces import DrawnPolygons, Faces, Subdivided
from daguerre.scene.subdivision import Refiner, Rules, edges_of_chains

from .values import Clock

_SCHEMES = {"catmullClark": "catmull-clark", "loop": "loop", "bilinear": "bilinear"}
_BOUNDARIES = {"edgeAndCorner": "edge and corner", "edgeOnly": "edge only", "none": "none"}
_FACE_VARYING = {
    "cornersPlus1": "corners plus1",
    "cornersPlus2": "corners plus2",
    "cornersOnly": "corners only",
    "boundaries": "boundaries",
    "none": "none",
    "all": "all",
}


def read_faces(mesh: UsdGeom.Mesh, count: int, clock: Clock, notes: Notes) -> Faces:
    """Reads the faces of a mesh at the scene's time.

    Args:
        mesh: The mesh.
        count: Number of its points.
        clock: Time codes of the stage.
        notes: Receives a note on faces of fewer than three corners.

    Raises:
        InputError: The arrays do not fit together, or an index has no point.
    """
    sizes = clock.integers(mesh.GetFaceVertexCountsAttr())
    vertices = clock.integers(mesh.GetFaceVertexIndicesAttr())
    where = f"{clock.file}: {mesh.GetPath()}"
    if sizes.size and sizes.min() < 0:
        raise InputError(f"{where}: faceVertexCounts: wanted at least 0, got {sizes.min()}")
    if int(sizes.sum()) != len(vertices):
        raise InputError(
            f"{where}: faceVertexIndices: wanted {int(sizes.sum())}, the sum of "
            f"faceVertexCounts, got {len(vertices)}"
        )
    if vertices.size and not (vertices.min() >= 0 and vertices.max() < count):
        worst = vertices.max() if vertices.min() >= 0 else vertices.min()
        raise InputError(f"{where}: faceVertexIndices: wanted 0 .. {count - 1}, got {worst}")
    valid = sizes >= 3
    if not valid.all():
        notes.add("a face of fewer than three corners is left out", int((~valid).sum()))
    holes = clock.integers(mesh.GetHoleIndicesAttr())
    hidden = np.zeros(len(sizes), bool)
    hidden[holes[(holes >= 0) & (holes < len(sizes))]] = True
    corners = np.flatnonzero(np.repeat(valid, sizes))
    ids = np.flatnonzero(valid)
    stated = len(sizes), len(vertices)
    return Faces(count, sizes[ids], vertices[corners], ids, corners, stated, hidden[ids])


def scheme_of(mesh: UsdGeom.Mesh, clock: Clock) -> str:
    """Scheme of subdivision, as USD names it; ``none`` for a polygon mesh."""
    return str(mesh.GetSubdivisionSchemeAttr().Get(clock.code) or "none")


def surface_of(
    faces: Faces, mesh: UsdGeom.Mesh, level: int, clock: Clock, notes: Notes
) -> DrawnPolygons:
    """Makes the surface of a mesh in its scheme of subdivision."""
    scheme = scheme_of(mesh, clock)
    if scheme not in _SCHEMES or not len(faces.sizes):
        if scheme not in (*_SCHEMES, "none"):
            notes.add(f"subdivision scheme {scheme[:40]!r} is unknown: the mesh is not subdivided")
        return DrawnPolygons(faces)
    if scheme == "loop" and (faces.sizes != 3).any():
        notes.add(
            "a mesh for Loop's subdivision has faces other than triangles: it is not subdivided"
        )
        return DrawnPolygons(faces)
    where = f"{clock.file}: {mesh.GetPath()}"
    rules = _rules(mesh, faces, clock)
    refiner = Refiner(
        faces.count, faces.sizes, faces.vertices, _SCHEMES[scheme], level, rules, where
    )
    return Subdivided(faces, refiner)


def _rules(mesh: UsdGeom.Mesh, faces: Faces, clock: Clock) -> Rules:
    """Creases, corners, boundaries and holes of a mesh, as the file states them."""
    code = clock.code
    where = f"{clock.file}: {mesh.GetPath()}"
    creases, sharpness = edges_of_chains(
        clock.integers(mesh.GetCreaseIndicesAttr()),
        clock.integers(mesh.GetCreaseLengthsAttr()),
        clock.numbers(mesh.GetCreaseSharpnessesAttr()),
        where,
    )
    boundary = str(mesh.GetInterpolateBoundaryAttr().Get(code))
    linear = str(mesh.GetFaceVaryingLinearInterpolationAttr().Get(code))
    return Rules(
        creases=creases,
        crease_sharpness=sharpness,
        corners=clock.integers(mesh.GetCornerIndicesAttr()),
        corner_sharpness=clock.numbers(mesh.GetCornerSharpnessesAttr()),
        boundary=_BOUNDARIES.get(boundary, "edge and corner"),
        face_varying=_FACE_VARYING.get(linear, "corners plus1"),
        holes=np.flatnonzero(faces.holes),
    )
