"""Samples of OpenTrackIO one after the other: a camera whose numbers and place change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from daguerre.errors import InputError
from daguerre.files.json_item import Item
from daguerre.files.source import Source
from daguerre.motion.values import keys

from .opentrackio import read_opentrackio
from .source import load

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera

#: Facts of a camera that samples hold, beside its projection.
TRACKED = ("transform", "f_stop", "focus_distance")


def read_track(
    samples: Sequence[Source],
    *,
    size: tuple[int, int] | None = None,
    camera: Camera | None = None,
    pixel_pitch: float | None = None,
) -> Camera:
    """The camera of several samples, keyed at their times; the first is at 0 s.

    Facts that are the same for all of a take (``static``) may be in the first of them alone.

    Args: those of :meth:`Camera.from_opentrackio`.

    Raises:
        InputError: A sample cannot be used, or times do not rise; the message names it.
    """
    if not samples:
        raise InputError("samples: wanted at least one, got none")
    still: dict[str, Any] = {}
    cameras, times = [], []
    for i, sample in enumerate(samples):
        try:
            root = load(sample)
            still = still | {k: v for k, v in root.value.items() if k == "static"}
            times.append(_time(root, i))
            found = read_opentrackio(still | root.value, size=size)
        except InputError as error:
            raise InputError(f"samples[{i}]: {error}") from None
        cameras.append(found.camera(camera, pixel_pitch))
    first = cameras[0]
    changes: dict[str, Any] = {
        "projection": keys(
            [(t - times[0], c.projection) for t, c in zip(times, cameras, strict=True)]
        )
    }
    for name in TRACKED:
        known = [
            (t - times[0], getattr(c, name))
            for t, c in zip(times, cameras, strict=True)
            if getattr(c, name) is not None
        ]
        if known and any(not np.array_equal(value, known[0][1]) for _, value in known):
            changes[name] = keys(known)
    return first.with_(**changes)


def _time(root: Item, index: int) -> float:
    """When the sample was taken, s: by its time stamp, or by its number and the rate."""
    timing = root.get("timing")
    stamp = None if timing is None else timing.get("sampleTimestamp")
    if stamp is not None:
        return stamp.need("seconds").number() + 1e-9 * stamp.number_of("nanoseconds", 0.0)
    rate = None if timing is None else timing.get("sampleRate")
    if rate is None:
        root.fail("missing: wanted timing.sampleTimestamp or timing.sampleRate, got neither")
    return index * rate.number_of("denom", 1.0) / rate.need("num").number(above=0)
