"""Reads lens files of other programs as ``daguerre-lens/0.1``, with notes on ignored content."""

from __future__ import annotations

import re
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.lenses.errors import LensError

if TYPE_CHECKING:
    from daguerre.lenses.lens import Lens

Parse = Callable[[str, str], tuple[dict[str, Any], list[str]]]

#: Formats by suffix, unless the text shows another. Modules load when a file needs them.
SUFFIXES = {".zmx": "zmx", ".seq": "seq", ".txt": None, ".dat": None}
_ZEMAX = re.compile(r"^\s*SURF\s+\d", re.MULTILINE)
_BENCH = re.compile(r"^\s*\[lens data\]", re.MULTILINE | re.IGNORECASE)
_CODE_V = re.compile(r"^\s*(S[O0]\s+[-+.\d]|RDM\b|LEN\b)", re.MULTILINE | re.IGNORECASE)


def is_foreign(path: Path) -> bool:
    """Whether a path has the suffix of another program's lens file."""
    return path.suffix.lower() in SUFFIXES


def parse(data: bytes, path: Path) -> tuple[dict[str, Any], list[str]]:
    """Converts another program's lens file to a lens file's value, with notes on ignored content.

    Raises:
        LensError: The file cannot be read; the message has the line, and the surface if any.
    """
    from .text import decoded

    text = decoded(data, str(path))
    parse_text: Parse = import_module(f".{_format(text, path)}", __name__).parse
    return parse_text(text, str(path))


def film_notes(lens: Lens) -> list[str]:
    """Returns a note if a camera focuses the lens elsewhere than its file does."""
    from .film import film_notes as notes_of

    return notes_of(lens)


def _format(text: str, path: Path) -> str:
    """Name of the module that reads a file: by its text, else by its suffix (often wrong)."""
    from .pbrt import looks_like

    if _BENCH.search(text):
        return "optical_bench"
    if _ZEMAX.search(text):
        return "zmx"
    of_suffix = SUFFIXES.get(path.suffix.lower())
    if of_suffix is not None:
        return of_suffix
    if _CODE_V.search(text):
        return "seq"
    if path.suffix.lower() == ".dat" or looks_like(text):
        return "pbrt"
    raise LensError(
        f"{path}: lens file: unknown format, wanted a Zemax (SURF), CODE V (SO, S, SI), Optical "
        f"Bench "
        "([lens data]) or pbrt file (rows of four numbers)",
        "lens-format",
    )
