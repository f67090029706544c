"""Reads lens files: JSON of the schema ``daguerre-lens/0.1`` (mm), and other programs' files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from daguerre.argument_checks import guarded
from daguerre.files.json_item import Item
from daguerre.files.json_text import parse
from daguerre.files.reading import read_bytes

from . import formats
from .checking import checked
from .errors import LensError, reported
from .index import FOLDER
from .json_lens import lens_from
from .lens import Lens
from .stop_size import check_stop_size
from .unknown import unknown_members

MAX_BYTES = 16_000_000


@guarded
def read(path: str | Path, configuration: str | None = None) -> Lens:
    """Reads a lens file: JSON, Zemax, CODE V, Optical Bench or pbrt.

    Args:
        path: Path of the file.
        configuration: Zoom or focus position by name; default: the first.

    Raises:
        InputError: The file cannot be used; the message has the file, and the JSON path or line.
    """
    path = Path(path)
    data = _bytes(path)
    with reported(str(path), "lens-format"):
        root, notes = _root(data, path)
        lens = lens_from(root, path, configuration)
        source = path.stem if path.parent == FOLDER else str(path)
        notes += [*lens.notes, *unknown_members(root)]
        if formats.is_foreign(path):
            check_stop_size(lens)
            notes += formats.film_notes(lens)
        return checked(replace(lens, source=source, notes=tuple(notes)))


def read_text(text: str, source: str, configuration: str | None = None) -> Lens:
    """Reads the text of a lens file of the schema ``daguerre-lens/0.1``.

    Args:
        text: JSON.
        source: Name of the file, for messages.
        configuration: Zoom or focus position by name; default: the first.

    Raises:
        InputError: It cannot be used; the message has the JSON path.
    """
    with reported(source, "lens-format"):
        root = parse(text.encode("utf-8", "surrogatepass"), source)
        lens = lens_from(root, Path(source), configuration)
        return checked(replace(lens, notes=(*lens.notes, *unknown_members(root))))


def _root(data: bytes, path: Path) -> tuple[Item, list[str]]:
    """Parses a file; returns its value, and notes on content that an import ignores."""
    if formats.is_foreign(path):
        value, notes = formats.parse(data, path)
        return Item(value, str(path)), notes
    return parse(data, str(path)), []


def _bytes(path: Path) -> bytes:
    if path.suffix.lower() not in (".json", *formats.SUFFIXES):
        known = ", ".join((".json", *formats.SUFFIXES))
        got = path.suffix or "no suffix"
        raise LensError(f"{path}: lens file: wanted {known}, got {got}", "lens-format")
    return read_bytes(path, MAX_BYTES)
