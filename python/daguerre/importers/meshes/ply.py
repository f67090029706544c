"""Reads PLY files: text, binary in both byte orders, gzipped.

Vertices have positions (``x y z``) and may have normals (``nx ny nz``), texture coordinates and
colours; faces are lists of vertices, and may have a list of texture coordinates of their corners.
Names of properties follow pbrt-v4, Mitsuba 3, MeshLab and Blender.

Source: G. Turk 1994, "The PLY Polygon File Format"; the documentation of pbrt-v4's ``plymesh`` and
of Mitsuba 3's ``ply``.
"""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.color.srgb import to_linear
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.importers.file_bytes import Bytes, read_bytes

from .file_mesh import (
    FileMesh,
    Floats,
    check_corners,
    check_finite,
    checked_positions,
    with_corner_uv,
)
from .ply_header import Element, Header, Property, read_header
from .ply_rows import Lists, Rows
from .text_numbers import NotANumberError, numbers

_POSITION, _NORMAL = ("x", "y", "z"), ("nx", "ny", "nz")
_UV = (("u", "v"), ("s", "t"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))
_COLORS = (
    ("red", "green", "blue", "alpha"), ("red", "green", "blue"), ("r", "g", "b", "a"),
    ("r", "g", "b"), ("color_0", "color_1", "color_2"),
)  # fmt: skip
_CORNERS, _CORNER_UV = ("vertex_indices", "vertex_index"), ("texcoord", "texture_coordinates")


def read(path: str | os.PathLike[str], notes: Notes) -> FileMesh:
    """Reads a file.

    Args:
        path: The file.
        notes: Receives notes on unused content.

    Raises:
        InputError: The file is not valid PLY; the message names file and line or element.
    """
    file = Path(path)
    data = read_bytes(file)
    header = read_header(data, str(file))
    tables = _tables(header, data, str(file), notes)
    if "vertex" not in tables:
        raise InputError(f"{file}: the element vertex is missing")
    mesh = _vertices(tables["vertex"], f"{file}: vertex", notes)
    if "face" not in tables:
        raise InputError(f"{file}: the element face is missing")
    return _with_faces(mesh, tables["face"], f"{file}: face", notes)


class Table(NamedTuple):
    """An element of the header, and its rows."""

    element: Element
    rows: Rows


def _tables(header: Header, data: Bytes, where: str, notes: Notes) -> dict[str, Table]:
    """Elements of the file, each with its rows."""
    order, begin, elements = header.order, header.size, header.elements
    if not order:  # text becomes an array of doubles, whatever the header calls them
        words = _words(data[header.size :], header.lines + 1, where)
        data, order, begin = words.astype("<f8").view(np.uint8), "<", 0
        elements = tuple(_of_doubles(element) for element in elements)
    found = {}
    for element in elements:
        rows = Rows(element, data, begin, order, f"{where}: element {element.name}")
        begin = rows.end
        if element.name in ("vertex", "face"):
            found[element.name] = Table(header.find(element.name), rows)
        else:
            notes.add(f"the element {element.name!r} of a PLY file is not used")
    if begin < len(data):
        notes.add("data after the last element of a PLY file are not used")
    return found


def _words(text: Bytes, line: int, where: str) -> NDArray[np.float64]:
    """Numbers of a text that begins at a line."""
    try:
        return numbers(text.tobytes())
    except NotANumberError as error:
        raise InputError(
            f"{where}: line {line + error.line}: wanted {error.wanted}, got {error.word}"
        ) from None


def _of_doubles(element: Element) -> Element:
    columns = (Property(p.name, "f8", p.counted and "f8") for p in element.properties)
    return replace(element, properties=tuple(columns))


def _vertices(table: Table, where: str, notes: Notes) -> FileMesh:
    """Vertices with their values, without faces."""
    element = table.element
    if not _has(element, _POSITION):
        raise InputError(f"{where}: the properties x, y and z are missing")
    positions = checked_positions(table.rows.positions(_POSITION), where, _POSITION[0])
    uv = next((names for names in _UV if _has(element, names)), ())
    colored = next((names for names in _COLORS if _has(element, names)), ())
    used = {*_POSITION, *_NORMAL, *uv, *colored}
    _note_others(element, used, "vertices", notes)
    return FileMesh(
        positions,
        np.zeros(0, np.uint32),
        normals=_values(table, _NORMAL, where),
        uv=_values(table, uv, where),
        colors=_colors(table, colored, where),
    )


def _has(element: Element, names: tuple[str, ...]) -> bool:
    """Whether an element has numbers of these names."""
    return all((p := element.find(name)) is not None and not p.counted for name in names)


def _values(table: Table, names: tuple[str, ...], where: str) -> Floats | None:
    """Columns, shape (N, K); None: the element has them not."""
    if not names or not _has(table.element, names):
        return None
    found = table.rows.numbers(names)
    check_finite(found, where, names[0])
    freeze_in_place(found)
    return found


def _colors(table: Table, names: tuple[str, ...], where: str) -> Floats | None:
    """Linear colours; whole numbers are encoded as sRGB, of the range of their type."""
    found = _values(table, names, where)
    first = table.element.find(names[0]) if names else None
    if found is None or first is None or first.largest == 0:
        return found
    scaled = found / np.float32(first.largest)
    scaled[:, :3] = to_linear(scaled[:, :3])
    return freeze_in_place(scaled)


def _with_faces(mesh: FileMesh, table: Table, where: str, notes: Notes) -> FileMesh:
    """The mesh with its faces."""
    element = table.element
    name = next((n for n in _CORNERS if (p := element.find(n)) is not None and p.counted), None)
    if name is None:
        raise InputError(f"{where}: the list vertex_indices (or vertex_index) is missing")
    faces = table.rows.lists(name)
    uv, used = _corner_uv(table, faces, notes), {name}
    if uv is not None:
        check_finite(uv[0], where, uv[1])
        used.add(uv[1])
    colored = next((names for names in _COLORS if _has(element, names)), ())
    colors = _colors(table, colored, where)
    _note_others(element, {*used, *colored}, "faces", notes)
    corners = check_corners(faces.values, len(mesh.positions), where)
    sizes = faces.sizes
    corner_uv = None if uv is None else uv[0]
    if len(sizes) and sizes.min() < 3:
        whole = sizes >= 3
        notes.add("faces with fewer than 3 corners are left out", int((~whole).sum()))
        inside = np.repeat(whole, sizes)
        corners, sizes = corners[inside], sizes[whole]
        corner_uv = None if corner_uv is None else corner_uv[inside]
        colors = None if colors is None else freeze_in_place(colors[whole])
    triangles = not len(sizes) or (sizes[0] == 3 and bool((sizes == 3).all()))
    whole_mesh = replace(
        mesh,
        corners=freeze_in_place(corners),
        sizes=None if triangles else freeze_in_place(sizes.astype(np.uint32)),
        face_colors=colors,
    )
    return whole_mesh if corner_uv is None else with_corner_uv(whole_mesh, corner_uv)


def _corner_uv(table: Table, faces: Lists, notes: Notes) -> tuple[Floats, str] | None:
    """Texture coordinates of corners, shape (C, 2), and the name of their list."""
    for name in _CORNER_UV:
        given = table.element.find(name)
        if given is not None and given.counted:
            lists = table.rows.lists(name)
            if (lists.sizes == 2 * faces.sizes).all():
                with np.errstate(over="ignore", invalid="ignore"):
                    return lists.values.astype(np.float32).reshape(-1, 2), name
            notes.add("texture coordinates that some corners of faces lack are left out")
    return None


def _note_others(element: Element, used: set[str], what: str, notes: Notes) -> None:
    for p in element.properties:
        if p.name not in used:
            notes.add(f"the property {p.name!r} of {what} of a PLY file is not used")
