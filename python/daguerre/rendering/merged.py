"""Merging passes into a picture and its files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from daguerre.argument_checks import guarded
from daguerre.errors import MismatchError
from daguerre.frame.frame import Frame

from . import merging
from .output import only
from .passes import Pass, write_pass
from .ranges import missing_ranges, show_ranges

PathLike = str | os.PathLike[str]


@guarded
def merge(
    passes: Iterable[PathLike],
    out: PathLike | Sequence[PathLike] = (),
    *,
    strict: bool = False,
    keep_sums: bool = False,
) -> Frame:
    """Merges passes of one picture, in any order; the result is bit-identical to one render.

    The picture has the exposure of the first pass.

    Args:
        passes: Files of ``daguerre render --samples``, or of a ``rendering.Job``.
        out: Files to write, .exr, .png and so on; default: none.
        strict: Whether a missing range of samples between the passes is an error.
        keep_sums: Whether an .exr keeps the sums, so that it can be merged again.

    Returns:
        The picture, with the channels that were requested for the passes.

    Raises:
        InputError: A file cannot be read, or has no sums.
        MismatchError: Passes of different pictures, samples drawn twice, or (``strict``) missing.
        OutputError: A file cannot be written.
    """
    frame, total = merging.merge(passes)
    if strict:
        refuse_gaps(total)
    frame = whole(frame, total)
    for path in (out,) if isinstance(out, str | os.PathLike) else out:
        write(Path(path), frame, total, keep_sums=keep_sums)
    return frame


def whole(frame: Frame, total: Pass) -> Frame:
    """Completes the picture: adds ground truth, and keeps only the requested channels."""
    frame = replace(frame, aovs=frame.aovs | total.truth)
    wanted = total.metadata.get("aovs")
    return frame if wanted is None else only(frame, wanted)


def gaps(total: Pass) -> str | None:
    """Message about ranges that are missing between the passes; None: there are none."""
    found = missing_ranges(total.ranges)
    return f"samples {show_ranges(found)} are missing between the passes" if found else None


def refuse_gaps(total: Pass) -> None:
    """Checks that no range is missing between the passes.

    Raises:
        MismatchError: A range is missing; the message names it.
    """
    if text := gaps(total):
        raise MismatchError(f"merge: {text}")


def write(
    path: Path, frame: Frame, total: Pass, *, keep_sums: bool = False, tone: str = "srgb"
) -> None:
    """Writes the picture; an .exr with its sums, if they are kept."""
    if keep_sums and path.suffix.lower() == ".exr":
        write_pass(path, frame, total)
    else:
        frame.save(path, tone=tone)
