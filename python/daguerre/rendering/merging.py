"""Merging of passes: sums of a film are integers, so any order and any split give the same bits."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.errors import InputError, MismatchError, core_errors
from daguerre.frame.frame import Frame

from .film_frame import OBJECTS, frame_of, set_film_state
from .passes import Pass, check_key, read_pass
from .ranges import Range, join_ranges

if TYPE_CHECKING:
    from daguerre import _core


#: Metadata that set the brightness and white of a picture, and not its light.
_EXPOSURE = (
    "exposure", "isoSpeed", "exposure_compensation", "luminance_exposure", "white_balance"
)  # fmt: skip


def merge(
    passes: Iterable[str | os.PathLike[str] | Pass], *, aovs: bool = True
) -> tuple[Frame, Pass]:
    """Merges passes exactly, in any order; the result is bit-identical to a single render.

    Args:
        passes: Files or passes.
        aovs: Whether to keep the auxiliary channels, if the passes have them.

    Returns:
        The picture, and the sum as a pass, which also has the ground truth. Both have the exposure
        of the first pass; a note reports passes with another exposure.

    Raises:
        InputError: A file cannot be read.
        MismatchError: Passes of different pictures, samples drawn twice, or adaptive sampling; the
            message names them.
    """
    total: Any = None
    first: Pass | None = None
    ranges: list[tuple[Range, Path | None]] = []
    notes: list[str] = []
    for item in passes:
        # Read in turn, as a pass of a large picture takes gigabytes.
        one = item if isinstance(item, Pass) else read_pass(item)
        if first is None:
            first = replace(one, state={})
        check_key(first, one)
        notes += _exposure_notes(first, one)
        if one.truth and not first.truth:  # a pass with ground truth has all of it
            first = replace(first, truth=one.truth, metadata=first.metadata | _truth_facts(one))
        if one.round is not None:
            raise MismatchError(
                f"{one.path or 'pass'}: drawn with --noise, so pixels differ in sample count; "
                "merge joins passes of --samples"
            )
        _check_overlap(ranges, one)
        ranges += [(r, one.path) for r in one.ranges]
        film = film_of(one)
        if total is None:
            total = film
        else:
            total.merge(film)
    if first is None:
        raise InputError("merge: wanted at least one pass file, got none")
    merged = join_ranges([r for r, _ in ranges])
    drawn = sum(end - begin for begin, end in merged)
    count = int(total.bad_sample_count)
    metadata = {
        **first.metadata,
        "samples": drawn,
        "bad_samples": count,
        "bad_sample_places": [list(place) for place in total.bad_samples],
    }
    state = {part: total.state(part) for part in total.state_parts()}
    frame = frame_of(total, metadata, aovs=aovs and "aovs" in state)
    return frame, Pass(state, merged, first.key, metadata, truth=first.truth, notes=tuple(notes))


def _exposure_notes(first: Pass, one: Pass) -> list[str]:
    """Note on a pass with another exposure than the first pass."""
    facts, others = first.metadata, one.metadata
    if all(facts.get(name) == others.get(name) for name in _EXPOSURE):
        return []
    mode, other = (str(known.get("exposure") or "no mode") for known in (facts, others))
    return [
        f"{one.path or 'a pass'} has another exposure ({other}) than {first.path or 'the first'}: "
        f"the picture has the first one's ({mode})"
    ]


def _truth_facts(one: Pass) -> dict[str, Any]:
    names = ("gt_time", "gt_lens", "gt_rays", "motion_missing", "aovs")
    return {k: v for k, v in one.metadata.items() if k in names}


def film_of(one: Pass) -> _core.Film:
    """Makes a film of the core with the sums of a pass."""
    from daguerre._core import FILM_LAYERS, Film, FilmLayout

    if not one.state.keys() - {OBJECTS}:
        raise InputError(f"{one.path}: damaged pass file: it has no sums")
    height, width = next(w for part, w in one.state.items() if part != OBJECTS).shape[:2]
    x0, y0 = (one.metadata.get("crop") or (0, 0))[:2]
    layout = FilmLayout(width=width, height=height, offset_x=int(x0), offset_y=int(y0))
    for part, (most, words) in FILM_LAYERS.items():
        if part in one.state:
            count = min(one.state[part].shape[2] // words, most) if most > 1 else True
            setattr(layout, part, count)
    with core_errors(InputError, f"{one.path}: damaged pass file"):
        film = Film(layout)
    set_film_state(film, one.state, str(one.path))
    return film


def _check_overlap(seen: list[tuple[Range, Path | None]], one: Pass) -> None:
    for begin, end in one.ranges:
        for (a, b), path in seen:
            low, high = max(a, begin), min(b, end)
            if low < high:
                raise MismatchError(
                    f"{one.path}: samples {low}:{high} are also in {path}; "
                    "each sample may be added once"
                )
