"""Reads Wavefront OBJ: an importer with all that docs/importers.md asks of one.

    import import_obj                       # registers the format, and dg.load reads it
    scene = dg.load("chair.obj", unit_m=0.01)

Each ``o`` or ``g`` becomes a mesh with points, normals and texture coordinates. OBJ has no unit:
``unit_m`` is the length of 1 in meters. Statements of other kinds are noted.
"""

from pathlib import Path

import numpy as np

import daguerre as dg
from daguerre.files.formats import Format, register
from daguerre.files.notes import Notes
from daguerre.files.text_lines import statements

WIDTHS = {"v": 3, "vt": 2, "vn": 3}


def read(path: str | Path, *, time: float = 0.0, unit_m: float = 1.0) -> dg.Scene:
    """Reads a file; ``unit_m`` is the length of 1 in it, m."""
    scene, notes = dg.Scene(path=Path(path), time=time), Notes()
    rows, objects, name = {word: [] for word in WIDTHS}, {}, Path(path).stem
    for where, word, rest in statements(path):
        if word in WIDTHS:
            rows[word].append(numbers(rest, WIDTHS[word], where))
        elif word == "f":
            if len(rest) < 3:
                raise dg.InputError(f"{where}: wanted 3 corners or more, got {len(rest)}")
            counts = [len(found) for found in rows.values()]
            objects.setdefault(name, []).append([corner(text, counts, where) for text in rest])
        elif word in ("o", "g"):
            name = " ".join(rest) or name
        else:
            notes.add(f"the statement {word[:20]!r} is not used")
    tables = [np.reshape(np.array(rows[kind], float), (-1, WIDTHS[kind])) for kind in WIDTHS]
    for name, polygons in objects.items():
        scene.add_node(name, np.zeros(3))
        scene.add_instance(add_mesh(scene, name, polygons, tables, unit_m), name=name)
    scene.note(*notes.sentences())
    return scene


def numbers(words: list[str], count: int, where: str) -> list[float]:
    """The first words, which must be finite numbers."""
    try:
        values = [float(word) for word in words[:count]]
    except ValueError:
        values = []
    if len(values) < count or not np.isfinite(values).all():
        raise dg.InputError(f"{where}: wanted {count} finite numbers, got {' '.join(words)[:60]!r}")
    return values


def corner(text: str, counts: list[int], where: str) -> tuple[int, ...]:
    """Indices, from 0, of point, texture coordinate and normal; -1: it has none."""
    found = []
    for word, count in zip([*text.split("/"), "", ""], counts, strict=False):
        index = int(word) if word.removeprefix("-").isdecimal() else 0
        index += count if index < 0 else -1  # negative ones count from the latest
        if not 0 <= index < count and (word or not found):
            raise dg.InputError(f"{where}: wanted an index of 1 .. {count}, got {text[:60]!r}")
        found.append(index if word else -1)
    return tuple(found)


def add_mesh(scene: dg.Scene, name: str, polygons: list, tables: list, unit_m: float) -> int:
    """Adds polygons as fans of triangles; corners that are alike become one vertex."""
    order = {key: i for i, key in enumerate(dict.fromkeys(key for p in polygons for key in p))}
    fans = [[p[0], p[k], p[k + 1]] for p in polygons for k in range(1, len(p) - 1)]
    used = zip(np.array(list(order)).T, tables, strict=True)
    points, uv, normals = (table[k] if (k >= 0).all() else None for k, table in used)
    uv = None if uv is None else uv * (1, -1) + (0, 1)  # v grows upward in OBJ
    indices = np.array([[order[key] for key in fan] for fan in fans])
    return scene.add_mesh(points * unit_m, indices, normals, uv, name=name)


register(Format("Wavefront OBJ", "scene", (".obj",), reads=read, takes=("unit_m",)))
