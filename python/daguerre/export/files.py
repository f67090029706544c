"""Writes a fitted lens as a file; the suffix sets the language."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from daguerre.argument_checks import guarded
from daguerre.checks import short
from daguerre.errors import UsageError, suggest
from daguerre.files.atomic import write_bytes
from daguerre.polynomial.lens_fit import LensFit

from .aim import with_aim
from .facts import facts
from .from_fit import plan_of
from .languages import c_file, glsl_file, numpy_file
from .osl import osl_file
from .plan import LensPlan

_WRITERS: dict[str, Callable[[LensPlan, Sequence[str]], str]] = {
    ".c": c_file,
    ".glsl": glsl_file,
    ".osl": osl_file,
    ".py": numpy_file,
}
SUFFIXES = (*_WRITERS, ".json")
#: Limit of unrolled code; beyond it, compilers take seconds.
MOST_COEFFICIENTS = 20000


@guarded
def check_suffix(path: str | Path, where: str = "export") -> str:
    """Returns the suffix of an output file for a lens.

    Raises:
        UsageError: The suffix is unknown.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in SUFFIXES:
        wanted = ", ".join(SUFFIXES)
        raise UsageError(
            f"{where}: wanted a name ending in {wanted}, got {str(path)!r}"
            f"{suggest(suffix, SUFFIXES) if suffix else ''}"
        )
    return suffix


#: Largest number of segments of a fit; data with more fail the check of their size.
MOST_SEGMENTS = 16


@guarded
def code(data: dict[str, Any], suffix: str) -> str:
    """Makes the text of an exported lens.

    Args:
        data: ``LensFit.to_dict()``.
        suffix: ``.c``, ``.glsl``, ``.osl``, ``.py`` or ``.json``.

    Raises:
        InputError: The data are not a fit, or code cannot express it.
        UsageError: The suffix is unknown, or the fit is too large for unrolled code.
    """
    if suffix == ".json":
        return json.dumps(data, indent=1) + "\n"
    where = "export"
    if suffix not in _WRITERS:
        raise UsageError(f"{where}: wanted {', '.join(SUFFIXES)}, got {short(suffix)}")
    if not isinstance(data.get("segments"), list) or len(data["segments"]) <= MOST_SEGMENTS:
        LensFit.from_dict(data)  # raises an error if the data are not a fit
    plan = plan_of(data)
    count = sum(_coefficients(s) for s in data["segments"])
    if count > MOST_COEFFICIENTS:
        raise UsageError(
            f"export of {data['lens']}: wanted at most {MOST_COEFFICIENTS} coefficients, got "
            f"{count}; use a lower degree, fewer segments, or .json"
        )
    return _WRITERS[suffix](with_aim(plan), facts(data))


@guarded
def save(data: dict[str, Any], path: str | Path) -> None:
    """Writes a fitted lens; the suffix sets the language.

    Raises:
        UsageError: The suffix is unknown, or the fit is too large for unrolled code.
        InputError: The data are not a fit, or code cannot express it.
        OutputError: The file cannot be written.
    """
    check_suffix(path)
    write(path, data)


def write(path: str | Path, data: dict[str, Any]) -> None:
    """Writes a fitted lens to a file; its suffix chooses the language."""
    write_bytes(path, code(data, Path(path).suffix.lower()).encode())


def _coefficients(part: object) -> int:
    """Number of coefficients in a part of a fit."""
    if isinstance(part, dict):
        if "coefficients" in part:
            return sum(len(row) for row in part["coefficients"])
        return sum(_coefficients(inner) for inner in part.values())
    return 0
