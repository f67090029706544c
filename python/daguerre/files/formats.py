"""Table of file formats: the functions that read or write a file, by its suffix.

All reading and writing goes through this table. A new format is a row: below, or at run time by
:func:`register`. ``docs/importers.md`` explains how to write a reader of scenes.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Literal

from daguerre.errors import InputError, UsageError, suggest

from . import extras
from .notes import Notes

Kind = Literal[
    "scene",
    "frame",
    "picture",
    "raw",
    "environment",
    "camera",
    "exchange",
    "profile",
    "density",
    "fit",
]
#: A function, or "module:function", which is imported on first use.
Function = str | Callable[..., Any]
#: Suffix that matches every suffix without another row of the kind.
ANY = "*"


@dataclass(frozen=True)
class Format:
    """A file format.

    Attributes:
        name: Name for messages, such as ``glTF 2.0``.
        kind: Kind of content, such as scene or picture.
        suffixes: Suffixes, lower case, with their dots; or ``ANY``.
        reads: Reader, called as ``reads(path, **options)``; None: write only.
        writes: Writer, called as ``writes(path, value, **options)``; None: read only.
        takes: Options of reader and writer, besides ``time`` (s) of scenes; None: they check their
            options themselves.
        needs: Package that it needs, and how to install it; empty for a package of an extra.
        time_of: Converts a time code of a scene to s, called as ``time_of(path, code, **options)``;
            None: the format has no time codes.
    """

    name: str
    kind: Kind
    suffixes: tuple[str, ...]
    reads: Function | None = None
    writes: Function | None = None
    takes: tuple[str, ...] | None = ()
    needs: tuple[str, str] | None = None
    time_of: Function | None = None


_GLTF, _USD = "daguerre.importers.gltf.reader", "daguerre.importers.usd.wall"
_FRAMES = "daguerre.pictures.frame_files"
_DENSITY = "daguerre.importers.volumes.density"
_DISPLAYED = "daguerre.development.shown"
_DEVELOPED = "daguerre.development.raw_files"
_EXR, _PNG, _JPEG, _TIFF = (".exr",), (".png",), (".jpg", ".jpeg"), (".tif", ".tiff")
_READ_EXR = "daguerre.pictures.exr.read:load_frame"
_SHOWN, _CODED = ("tone",), ("quality", "bits")
_FORMATS = [
    Format("glTF 2.0", "scene", (".glb", ".gltf"), f"{_GLTF}:read",
           takes=("variant", "allow_dirs", "scene_index", "animated")),
    Format("OpenUSD", "scene", (".usd", ".usda", ".usdc", ".usdz"), f"{_USD}:read",
           takes=("variant", "allow_dirs", "purpose", "camera_units", "moments", "in_process"),
           needs=("pxr", ""),
           time_of=f"{_USD}:time_of_code"),
    Format("pbrt", "scene", (".pbrt",), "daguerre.importers.pbrt.reader:read",
           takes=("unit_m", "allow_dirs")),
    Format("Mitsuba", "scene", (".xml",), "daguerre.importers.mitsuba.reader:read",
           takes=("define", "unit_m", "allow_dirs")),
    Format("OpenEXR", "frame", _EXR, _READ_EXR, "daguerre.pictures.exr.write:as_exr", _SHOWN),
    Format("PNG", "frame", _PNG, None, f"{_DISPLAYED}:as_png", _SHOWN),
    Format("JPEG", "frame", _JPEG, None, f"{_DISPLAYED}:as_picture", _SHOWN),
    Format("TIFF", "frame", _TIFF, None, f"{_DISPLAYED}:as_picture", _SHOWN),
    Format("JPEG", "picture", _JPEG, None, f"{_FRAMES}:picture", _CODED),
    Format("PNG", "picture", _PNG, None, f"{_FRAMES}:picture", _CODED),
    Format("TIFF", "picture", _TIFF, None, f"{_FRAMES}:picture", _CODED),
    Format("OpenEXR", "picture", _EXR, None, f"{_FRAMES}:picture", _CODED),
    Format("DNG", "raw", (".dng",), None, f"{_DEVELOPED}:as_dng", None),
    Format("a developed picture", "raw", (*_JPEG, *_PNG, *_TIFF, *_EXR), None,
           f"{_DEVELOPED}:as_picture", None),
    Format("OpenUSD", "camera", (".usda", ".usdc", ".usd"), None,
           "daguerre.exporters.usd.cameras:write_cameras", ("times",),
           ("pxr", "")),
    Format("pbrt-v4", "exchange", (".pbrt",), None, "daguerre.exporters.pbrt.writer:write"),
    Format("Mitsuba 3", "exchange", (".xml",), None, "daguerre.exporters.mitsuba.writer:write"),
    Format("an image", "environment", (ANY,), "daguerre.pictures.light:read_environment",
           takes=("notes",)),
    Format("IES LM-63", "profile", (".ies",), "daguerre.importers.ies:read"),
    Format("NanoVDB", "density", (".nvdb",), f"{_DENSITY}:of_nanovdb", takes=("grid",)),
    Format("Mitsuba's grid", "density", (".vol",), f"{_DENSITY}:of_vol"),
    Format("a fitted lens", "fit", (".c", ".glsl", ".osl", ".py", ".json"), None,
           "daguerre.export.files:write"),
]  # fmt: skip


def register(made: Format) -> None:
    """Adds a format to the table, or replaces the format of the same kind and name.

    Raises:
        UsageError: Another format of the kind has one of its suffixes.
    """
    place = len(_FORMATS)
    for i, row in enumerate(_FORMATS):
        if row.kind != made.kind:
            continue
        if row.name == made.name:
            place = i
        elif both := sorted({*row.suffixes} & {*made.suffixes}):
            raise UsageError(
                f"format {made.name!r}: suffixes: {both[0]} belongs to {row.name} already"
            )
    _FORMATS[place : place + 1] = [made]


def formats(kind: Kind) -> list[Format]:
    """Rows of a kind."""
    return [row for row in _FORMATS if row.kind == kind]


def written(kind: Kind) -> tuple[str, ...]:
    """Suffixes to which values of a kind can be written."""
    return tuple(suffix for row in formats(kind) if row.writes for suffix in row.suffixes)


def readable(kind: Kind) -> str:
    """Formats of a kind that can be read, with their suffixes, in words."""
    rows = [row for row in formats(kind) if row.reads]
    return _either([f"{row.name} ({', '.join(row.suffixes)})" for row in rows])


def read(
    kind: Kind, path: str | os.PathLike[str], notes: Notes | None = None, **options: object
) -> Any:
    """Reads a file in the format of its suffix.

    Args:
        kind: Kind of its content.
        path: The file.
        notes: Receives notes, if the format takes notes.
        options: Options of the format.

    Raises:
        InputError: No format of the kind has this suffix, or the file cannot be used.
        UsageError: The format has no such option.
    """
    rows = [row for row in formats(kind) if row.reads]
    suffix = Path(path).suffix.lower()
    row = _row(rows, suffix)
    if row is None or row.reads is None:
        known = _either([s for row in rows for s in row.suffixes])
        raise InputError(f"{path}: format: wanted {known}, got {suffix or 'no suffix'}")
    if notes is not None and "notes" in (row.takes or ()):
        options["notes"] = notes
    return _ready(row, row.reads, path, options)(path, **options)


def takes(kind: Kind, path: str | os.PathLike[str], option: str) -> bool:
    """Whether the format of a file's suffix has an option."""
    row = _row(formats(kind), Path(path).suffix.lower())
    return row is not None and row.takes is not None and option in row.takes


def time_of_code(path: str | os.PathLike[str], code: float, **options: object) -> float:
    """Converts a time code of a scene file to s.

    Raises:
        UsageError: The format has no time codes, or lacks an option.
        InputError: The file cannot be used.
    """
    row = _row(formats("scene"), Path(path).suffix.lower())
    if row is None or row.time_of is None:
        raise UsageError(f"{path}: --time-code: wanted a USD stage; --time takes seconds")
    return float(_ready(row, row.time_of, path, options)(path, code, **options))


def write(kind: Kind, path: str | os.PathLike[str], value: object, **options: object) -> None:
    """Writes a value atomically, in the format of the file's suffix.

    Raises:
        UsageError: No format of the kind has this suffix, or the format lacks an option.
        OutputError: The file cannot be written.
    """
    row = _row(formats(kind), check_written(path, written(kind)))
    assert row is not None
    assert row.writes is not None
    _ready(row, row.writes, path, options)(path, value, **options)


def load_writer(kind: Kind, path: str | os.PathLike[str]) -> None:
    """Imports the writer of a file's format, if the kind has the file's suffix."""
    row = _row(formats(kind), Path(path).suffix.lower())
    if row is not None and isinstance(row.writes, str):
        import_module(row.writes.partition(":")[0])


def check_written(path: str | os.PathLike[str], known: tuple[str, ...]) -> str:
    """Checks the suffix of an output and returns it in lower case.

    Raises:
        UsageError: The suffix is not in ``known``, which the message lists.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in known:
        got = repr(suffix) + suggest(suffix, known) if suffix else "none"
        if suffix == ".dng":
            got = "'.dng'; a raw file is made by frame.expose().save()"
        raise UsageError(
            f"{path}: output format: wanted a name ending in {_either(known)}, got {got}"
        )
    return suffix


def _row(rows: list[Format], suffix: str) -> Format | None:
    exact = [row for row in rows if suffix in row.suffixes]
    return next(iter(exact or (row for row in rows if ANY in row.suffixes)), None)


def _either(names: list[str] | tuple[str, ...]) -> str:
    return f"{', '.join(names[:-1])} or {names[-1]}" if len(names) > 1 else names[0]


def _ready(
    row: Format, function: Function, path: str | os.PathLike[str], options: dict[str, Any]
) -> Callable[..., Any]:
    """Returns a function of a format, after checks of its options and the package it needs."""
    _check_options(row, path, options)
    if row.needs is not None and find_spec(row.needs[0]) is None:
        module, how = row.needs
        raise UsageError(f"{path}: {row.name} needs {module}: {how or extras.hint(module)}")
    if callable(function):
        return function
    module, _, name = function.partition(":")
    found: Callable[..., Any] = getattr(import_module(module), name)
    return found


def _check_options(row: Format, path: str | os.PathLike[str], options: dict[str, Any]) -> None:
    if row.takes is None:
        return
    known = (*row.takes, "time") if row.kind == "scene" else row.takes
    for name in options:
        if name not in known:
            takes = ", ".join(known) or "none"
            raise UsageError(
                f"{path}: no option {name!r}: {row.name} takes {takes}{suggest(name, known)}"
            )
