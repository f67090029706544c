"""Reads sources of calibrations: files, or their values as dicts."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import short
from daguerre.errors import InputError, UsageError, suggest
from daguerre.files import extras, json_text, reading, xml_text
from daguerre.files.json_item import Item
from daguerre.files.source import Source

from . import foreign

FloatArray = NDArray[np.float64]
#: First element of an XML text.
_ELEMENT = re.compile(rb"<([A-Za-z_][\w.:-]*)")
#: Largest files. A calibration has some thousand bytes; JSON may hold all frames of a long shot.
MAX_BYTES, MAX_JSON_BYTES = 1 << 20, 1 << 26


def load(source: Source) -> Item:
    """Loads the values of a file (JSON by suffix, XML by its first bytes, else YAML), or a dict.

    Raises:
        InputError: The file cannot be read.
    """
    if isinstance(source, dict):
        return Item(_plain(source), "calibration")
    if not isinstance(source, str | os.PathLike):
        raise UsageError(f"calibration: wanted a file or a dict, got {short(source)}")
    path = Path(source)
    if path.suffix.lower() == ".jsonl":
        raise InputError(
            f"{path}: wanted one calibration; a .jsonl file holds several, such as an "
            f"OpenTrackIO take"
        )
    data = read_bytes(path)
    foreign.refuse(path)
    if data.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<"):
        root = _xml(data, path)
    elif path.suffix.lower() == ".json":
        root = json_text.parse(data, str(path))
    else:
        root = _yaml(data, path)
    if not isinstance(root.value, dict):
        root.fail(f"wanted names and values, got {short(root.value)}; {foreign.READ}")
    return root


def _xml(data: bytes, path: Path) -> Item:
    element = _ELEMENT.search(data)
    if element is not None and element[1] != xml_text.ROOT.encode():
        name = element[1][:40].decode("ascii", "replace")
        raise InputError(
            f"{path}: XML: wanted <{xml_text.ROOT}>, as OpenCV writes it, got <{name}>; "
            f"{foreign.READ}"
        )
    return xml_text.parse(data, str(path))


def _yaml(data: bytes, path: Path) -> Item:
    extras.need("yaml", f"{path}: YAML")
    from daguerre.files import yaml_text

    try:
        return yaml_text.parse(data, str(path))
    except InputError as error:
        if path.suffix.lower() in (".yaml", ".yml"):
            raise
        raise InputError(f"{error}; {foreign.READ}") from None


def read_bytes(path: Path) -> bytes:
    """Reads a file of at most ``MAX_BYTES``, or ``MAX_JSON_BYTES`` for JSON."""
    is_json = path.suffix.lower() in (".json", ".jsonl")
    return reading.read_bytes(path, MAX_JSON_BYTES if is_json else MAX_BYTES)


def _plain(value: object) -> Any:
    """Converts arrays and tuples to lists, as in a file."""
    if isinstance(value, dict):
        return {str(name): _plain(one) for name, one in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return [_plain(one) for one in value] if isinstance(value, list | tuple) else value


def first(root: Item, *names: str) -> Item | None:
    """Member with the first of these names that exists; None: none does."""
    return next((found for name in names if (found := root.get(name)) is not None), None)


def needed(root: Item, wanted: str, *names: str) -> Item:
    """Finds a member like :func:`first`, but requires it."""
    found = first(root, *names)
    if found is None:
        root.fail(f"missing: {wanted} ({' or '.join(names)})")
    return found


def matrix(item: Item, rows: int, columns: int) -> FloatArray:
    """Reads a matrix of finite numbers: as rows, as a flat list, or in OpenCV's form."""
    data = item
    if isinstance(item.value, dict):
        shape = item.need("rows").integer(0, 4096), item.need("cols").integer(0, 4096)
        if shape != (rows, columns):
            _shape(item, rows, columns, f"{shape[0]} x {shape[1]}")
        data = item.need("data")
    elements = list(data)
    if elements and isinstance(elements[0].value, list):
        if len(elements) != rows or any(len(list(row)) != columns for row in elements):
            _shape(item, rows, columns, f"{len(elements)} rows of {len(list(elements[0]))}")
        elements = [element for row in elements for element in row]
    if len(elements) != rows * columns:
        _shape(item, rows, columns, f"{len(elements)} numbers")
    return np.array([element.number() for element in elements]).reshape(rows, columns)


def _shape(item: Item, rows: int, columns: int, got: str) -> NoReturn:
    item.fail(f"wrong shape: wanted a matrix {rows} x {columns}, got {got}")


def row(item: Item, counts: Iterable[int]) -> tuple[float, ...]:
    """Reads an allowed number of finite numbers, as a row or a column."""
    data = item
    if isinstance(item.value, dict):
        shape = item.need("rows").integer(0, 4096), item.need("cols").integer(0, 4096)
        if min(shape) > 1:
            item.fail(f"wrong shape: wanted a row or a column, got {shape[0]} x {shape[1]}")
        data = item.need("data")
        if len(list(data)) != shape[0] * shape[1]:
            item.fail(f"wrong shape: {shape[0]} x {shape[1]}, got {len(list(data))} numbers")
    elements = list(data)
    if len(elements) == 1 and isinstance(elements[0].value, list):
        elements = list(elements[0])
    elif elements and all(isinstance(e.value, list) and len(e.value) == 1 for e in elements):
        elements = [next(iter(element)) for element in elements]
    wanted = sorted(counts)
    if len(elements) not in wanted:
        names = " or ".join(str(count) for count in wanted)
        item.fail(f"wrong shape: wanted {names} numbers, got {len(elements)}")
    return tuple(element.number() for element in elements)


def agreed(
    item: Item, names: str, told: tuple[int, int] | None, given: tuple[int, int] | None
) -> tuple[int, int]:
    """Size of the picture, px, from the file, else the given size; both must agree.

    Args:
        item: Item of the file, for messages.
        names: Names of the size in the file.
        told: Size in the file.
        given: Size from the caller.
    """
    size = told or given
    if size is None:
        item.fail(
            f"missing: the size of the picture ({names}); set size=(W, H) or --calibration-size"
        )
    if given is not None and size != tuple(given):
        item.fail(
            f"wanted the size in the file, {size[0]} x {size[1]} px, got {given[0]} x {given[1]}"
        )
    return size


def camera_matrix(item: Item) -> tuple[tuple[float, float], tuple[float, float]]:
    """Reads focal lengths and principal point from a camera matrix, px."""
    k = matrix(item, 3, 3)
    if k[0, 1] != 0:
        item.fail(f"skew is not supported: row 1, column 2 must be 0, got {k[0, 1]:g}")
    if k[1, 0] != 0 or (k[2] != (0, 0, 1)).any():
        item.fail(f"wanted [fx 0 cx; 0 fy cy; 0 0 1], got {k.tolist()}")
    if min(k[0, 0], k[1, 1]) <= 0:
        item.fail(f"wanted focal lengths above 0, got {k[0, 0]:g}, {k[1, 1]:g}")
    return (float(k[0, 0]), float(k[1, 1])), (float(k[0, 2]), float(k[1, 2]))


def rigid(item: Item) -> FloatArray:
    """Reads a rotation and a translation, shape (4, 4); the last row may be left out."""
    rows = item.need("rows").value if isinstance(item.value, dict) else len(list(item))
    pose = np.eye(4)
    if rows in (3, 12):
        pose[:3] = matrix(item, 3, 4)
    else:
        pose = matrix(item, 4, 4)
    turned = pose[:3, :3]
    odd = np.abs(turned @ turned.T - np.eye(3)).max() > 1e-4 or np.linalg.det(turned) < 0
    if odd or (np.abs(pose[3] - (0, 0, 0, 1)) > 1e-9).any():
        got = short(pose.tolist())
        item.fail(f"wanted a rotation and a translation (last row 0 0 0 1), got {got}")
    return pose


def turned(q: FloatArray) -> FloatArray:
    """Matrix of a unit quaternion (w, x, y, z), Hamilton's."""
    w, v = q[0], q[1:]
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.asarray(np.eye(3) + 2 * w * cross + 2 * cross @ cross)


def choice(item: Item, known: Iterable[str]) -> str:
    """Reads one of the known names; an error suggests the nearest."""
    name, names = item.text(), list(known)
    if name not in names:
        item.fail(f"wanted {', '.join(names)}; got {short(name)}{suggest(name, names)}")
    return name
