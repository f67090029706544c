"""Lens errors, with codes that programs can test."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import daguerre._core as _core
from daguerre.errors import CoreError, InputError

#: Meaning of each error code.
CODES = {
    "lens-format": "the file does not follow its format",
    "lens-surface": "a surface of a kind or form that is not supported",
    "lens-mirror": "a mirror: folded systems are not supported",
    "lens-glass": "an unknown glass",
    "lens-overlap": "a gap along the axis is negative",
    "lens-edge": "two surfaces cross within the axial beam",
    "lens-no-stop": "no surface is the stop, or its size is unknown",
    "lens-two-stops": "more than one surface is the stop",
    "lens-no-light": "no ray passes",
    "lens-afocal": "the lens has no focal length",
    "lens-pupil": "the entrance pupil is at infinity",
    "lens-film": "the film would be inside the lens",
    "lens-f-stop": "the lens does not open that far",
    "lens-focus-near": "the lens does not focus that near",
    "lens-zoom": "the lens does not have that focal length",
}


class LensError(InputError):
    """A lens that cannot be used.

    Attributes:
        message: Text of the error, without the code.
        code: One of ``CODES``; ``str(error)`` ends in it, in brackets.
        surface: Index of the surface, as counted in the message; None: the lens as a whole.
    """

    def __init__(self, message: str, code: str, surface: int | None = None) -> None:
        ending = f" [{code}]"
        self.message = message.removesuffix(ending)
        super().__init__(self.message + ending)
        self.code = code
        self.surface = surface

    def __reduce__(self) -> tuple[type[LensError], tuple[str, str, int | None]]:
        return type(self), (self.message, self.code, self.surface)


def from_core(
    error: CoreError | InputError, source: str, code: str | None = None, surface: int | None = None
) -> InputError:
    """Adds the file's name to the core's error about a lens.

    Args:
        error: Error that was raised; an ``InputError`` names its file already.
        source: File of the lens.
        code: Code for errors without code; None: these errors keep their type.
        surface: Index of the surface being read, for errors without code.
    """
    if isinstance(error, _core.LensError):
        return LensError(f"{source}: {error.message}", error.code, error.surface)
    if isinstance(error, LensError) or (isinstance(error, InputError) and code is None):
        return error
    message = str(error) if isinstance(error, InputError) else f"{source}: {error}"
    return InputError(message) if code is None else LensError(message, code, surface)


@contextmanager
def reported(source: str, code: str | None = None, surface: int | None = None) -> Iterator[None]:
    """Re-raises errors about a lens with the name of its file, and a code."""
    try:
        yield
    except (CoreError, InputError) as error:
        raise from_core(error, source, code, surface) from None
