"""Memory that a picture needs, checked against the machine's before anything is drawn."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

import daguerre._core as _core
from daguerre import memory
from daguerre.errors import InputError
from daguerre.frame.aovs import FILM_CHANNELS

#: Bytes per pixel of a frame beside its film: colours, XYZ, variance, alpha, counts, and buffers of
#: writing. Measured: bench/film_memory.py.
FRAME = 52
TRUTH = 108  # ground truth and its rays
#: Nodes of ghost maps while they are drawn: a sum per pixel, and a third more; scatter takes that
#: third again.
NODES, SCATTER_NODES = 32 / 3, 8 / 3
FLOAT = 4
MATTE_PLANES = 36  # of three layers of six ranks: hashes and shares
#: Memory of a denoised frame and of the denoiser: per pixel, and fixed.
DENOISED, DENOISER = 450, 950_000_000


def pixel_bytes(layout: _core.FilmLayout, *, truth: bool = False, scatter: bool = False) -> int:
    """Peak memory per pixel, when the frame is made and written."""
    planes = 3 * (layout.flare + layout.splats * layout.aovs) + 12 * layout.halves
    planes += len(FILM_CHANNELS) * layout.aovs
    planes += 2 * (layout.channels + layout.bands)  # as one array, and as planes of a file
    planes += 4 * (3 + 2 * layout.channels) * layout.catchers  # and two that they are made of
    planes += MATTE_PLANES * layout.objects
    made = FRAME + FLOAT * planes + TRUTH * truth
    nodes = NODES + SCATTER_NODES * scatter
    drawn = math.ceil(nodes * (6 + layout.channels)) if layout.flare else 0
    return _core.Film.pixel_bytes(layout) + max(made, drawn)


def check_film(
    layout: _core.FilmLayout, *, truth: bool = False, scatter: bool = False, free: int | None = None
) -> None:
    """Checks that the machine has enough memory for a picture.

    Args:
        layout: Layout of the film.
        truth: Whether the frame gets ground truth.
        scatter: Whether scattered light is drawn.
        free: Bytes that may be used; None: ``memory.left_bytes``.

    Raises:
        InputError: Too little memory; the message says how many pixels fit.
    """
    size = layout.width, layout.height
    each = pixel_bytes(layout, truth=truth, scatter=scatter)
    _check(size, each, 0, "keep fewer channels", free)


def check_denoised(size: tuple[int, int], *, free: int | None = None) -> None:
    """Checks the memory that denoising needs beside a film of this size."""
    _check(size, DENOISED, DENOISER, "leave out --denoise", free)


def _check(size: tuple[int, int], each: int, fixed: int, advice: str, free: int | None) -> None:
    if free is None and (left := memory.left_bytes()) is not None:
        free = left + _core.KeptFilms.bytes()  # that the film takes over, or ends
    (width, height), shown = size, memory.shown
    if free is None or (needed := each * width * height + fixed) <= free:
        return
    most = max((free - fixed) // each, 1)
    raise InputError(
        f"picture: memory: wanted at most the {shown(free)} that are left, got {width} x {height} "
        f"px of {each} bytes: {shown(needed)}; draw it in parts of at most {most:,} pixels "
        f"(--crop) and join them (daguerre merge), {advice}, draw fewer pixels, or raise --memory"
    )


@contextmanager
def kept_films() -> Iterator[None]:
    """Context in which a new film reuses the memory of the last film of the same layout."""
    keep = _core.KeptFilms()
    try:
        yield
    finally:
        del keep
