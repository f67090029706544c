"""Errors of lenses, with codes that programs can ask for."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

from daguerre.errors import InputError

#: Every code, and what it says.
CODES = {
    "lens-format": "the file is not of its format",
    "lens-surface": "a surface of a kind or form that is not traced",
    "lens-mirror": "a mirror: lenses that fold the light are not traced",
    "lens-glass": "a glass that is not known",
    "lens-overlap": "a gap along the axis is negative",
    "lens-edge": "two surfaces cross within the axial beam",
    "lens-no-stop": "no surface is the stop",
    "lens-two-stops": "more than one surface is the stop",
    "lens-no-light": "no ray passes",
    "lens-afocal": "the lens has no focal length",
    "lens-pupil": "the entrance pupil lies at infinity",
    "lens-film": "the film would lie inside the lens",
    "lens-f-stop": "the lens does not open that far",
    "lens-focus-near": "the lens does not focus that near",
    "lens-zoom": "the lens does not have that focal length",
}

_CODE = re.compile(r" \[(lens-[a-z-]+)\]$")
_SURFACE = re.compile(r"\bsurfaces?[ \[](\d+)")


class LensError(InputError):
    """A lens that cannot be used.

    Attributes:
        code: One of ``CODES``; the message ends in it, in brackets.
        surface: Index of the surface, as the message counts; None: the lens as a whole.
    """

    def __init__(self, message: str, code: str, surface: int | None = None) -> None:
        super().__init__(message if _CODE.search(message) else f"{message} [{code}]")
        self.code = code
        self.surface = surface


def from_core(error: ValueError, source: str, code: str | None = None) -> InputError:
    """Names the file in the core's complaint about a lens.

    Args:
        error: Error that was raised; an ``InputError`` names its file already.
        source: The lens's file.
        code: Code for errors that have none of their own; None: such errors stay as they are.
    """
    if isinstance(error, LensError) or (isinstance(error, InputError) and code is None):
        return error
    text = str(error)
    message = text if isinstance(error, InputError) else f"{source}: {text}"
    own = _CODE.search(text)
    if own is None and code is None:
        return InputError(message)
    surface = _SURFACE.search(text[len(source) :] if text.startswith(source) else text)
    return LensError(message, own[1] if own else str(code), int(surface[1]) if surface else None)


@contextmanager
def reported(source: str, code: str | None = None) -> Iterator[None]:
    """Raises complaints about a lens with the name of its file, and a code."""
    try:
        yield
    except ValueError as error:
        raise from_core(error, source, code) from None
