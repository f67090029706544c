"""Reads Wavefront OBJ files as one mesh: the polygons of all objects and groups.

Source: Wavefront Technologies, "Object Files (.obj)", appendix B1 of the Advanced Visualizer's
manual, with its negative indices, which count back from the latest element.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place, short
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.importers.file_bytes import Bytes, read_bytes
from daguerre.scene.far import single_if_near
from daguerre.scene.polygons import weld

from .file_mesh import FileMesh, Floats, check_finite
from .obj_faces import Faces, read_faces
from .obj_lines import Lines, words_of
from .text_numbers import NotANumberError, numbers

#: Tables by keyword: numbers wanted, and the least numbers on a line.
_TABLES = {"v": (3, 3), "vt": (2, 1), "vn": (3, 3)}
#: Keywords for materials, names and smoothing; Mitsuba ignores them, too.
_IGNORED = {"o", "g", "s", "usemtl", "mtllib"}
#: Maximum size of a file, bytes.
_MOST = 1 << 32


def read(path: str | os.PathLike[str], notes: Notes) -> FileMesh:
    """Reads a file.

    Args:
        path: The file.
        notes: Receives notes on unused content.

    Raises:
        InputError: The file is not valid OBJ; the message names file and line.
    """
    file = Path(path)
    data = read_bytes(file, _MOST)
    _check_text(data, str(file))
    lines = Lines(data)
    points, uv, normals = (_table(lines, word, str(file)) for word in ("v", "vt", "vn"))
    faces = read_faces(lines, [len(points), len(uv), len(normals)], str(file))
    _note_others(lines, notes)
    if faces.small:
        notes.add("faces with fewer than 3 corners are left out", faces.small)
    kept_uv = _kept(uv, faces.uv, "texture coordinates", notes)
    kept_normals = _kept(normals, faces.normals, "normals", notes)
    return _mesh(faces, points, kept_uv, kept_normals)


def _check_text(data: Bytes, where: str) -> None:
    if data.all():
        return
    line = 1 + np.count_nonzero(data[: int(np.argmin(data))] == ord("\n"))
    raise InputError(f"{where}: line {line}: wanted text, got a zero byte")


def _table(lines: Lines, word: str, where: str) -> Any:
    """Numbers of the lines of a keyword, shape (N, K); doubles only for positions far from 0."""
    columns, least = _TABLES[word]
    chosen = lines.of(word)
    text = lines.bytes(chosen)
    counts = words_of(text, len(chosen))
    if len(counts) and counts.min() < least:
        line = int(chosen[int(np.argmin(counts))])
        raise InputError(
            f"{where}: line {line + 1}: {word}: wanted {columns} numbers, got {counts.min()}"
        )
    try:
        flat = numbers(text.tobytes())
    except NotANumberError as error:
        raise InputError(
            f"{where}: line {chosen[error.line] + 1}: {word}: wanted {error.wanted}, "
            f"got {error.word}"
        ) from None
    rows: Any = np.zeros((len(counts), columns), np.float64 if word == "v" else np.float32)
    begins = np.cumsum(counts) - counts
    with np.errstate(over="ignore"):
        for k in range(columns):
            has = counts > k
            rows[has, k] = flat[begins[has] + k]
    rows = single_if_near(rows)
    try:
        check_finite(rows, where, word)
    except InputError:
        bad = int(np.argmin(np.isfinite(rows).all(axis=1)))
        raise InputError(
            f"{where}: line {chosen[bad] + 1}: {word}: wanted finite numbers, "
            f"got {rows[bad].tolist()}"
        ) from None
    return rows


def _note_others(lines: Lines, notes: Notes) -> None:
    for word, count in lines.others():
        if word not in _IGNORED:
            notes.add(f"the statement {short(word)} of an OBJ file is not used", count)


def _kept(table: Floats, index: NDArray[np.int64], what: str, notes: Notes) -> Floats | None:
    """A table, if all corners have a row of it."""
    with_one = index >= 0
    if with_one.all() and len(index):
        return table
    if with_one.any():
        notes.add(f"{what} that some corners lack are left out")
    return None


def _mesh(faces: Faces, points: Floats, uv: Floats | None, normals: Floats | None) -> FileMesh:
    """Makes a mesh with a vertex for each distinct corner."""
    corners = faces.points
    used = [
        index for table, index in ((uv, faces.uv), (normals, faces.normals)) if table is not None
    ]
    if used:
        leaders, corners = weld(corners, *used)
        points = points[faces.points[leaders]]
        uv = None if uv is None else freeze_in_place(uv[faces.uv[leaders]])
        normals = None if normals is None else freeze_in_place(normals[faces.normals[leaders]])
    sizes = None if (faces.sizes == 3).all() else freeze_in_place(faces.sizes.astype(np.uint32))
    index = freeze_in_place(corners.astype(np.uint32))
    return FileMesh(freeze_in_place(points), index, sizes, normals, uv)
