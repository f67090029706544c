"""Reads several OpenTrackIO samples: a camera with changing parameters and pose."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.argument_checks import guarded
from daguerre.errors import InputError
from daguerre.files import json_text
from daguerre.files.json_item import Item, short
from daguerre.files.source import Source

from .calibration import Calibration
from .opentrackio import read_opentrackio
from .source import load, read_bytes
from .take import Take

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera

Samples = Source | Sequence[Source]


def is_take(source: object) -> bool:
    """Whether a source has several samples: a list, a file of lines, or a JSON file with a list."""
    if isinstance(source, list | tuple):
        return True
    if not isinstance(source, str | os.PathLike):
        return False
    path = Path(source)
    if path.suffix.lower() != ".json":
        return path.suffix.lower() == ".jsonl"
    return read_bytes(path).removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"[")


@guarded
def read_take(samples: Samples, *, size: tuple[int, int] | None = None) -> Take:
    """Reads the camera of several samples; the first is at 0 s.

    Only the first sample needs the values that do not change (``static``).

    Args:
        samples: Samples as dicts or files; or one file, with lines (.jsonl) or a list.
        size: Width and height of the picture, px, if samples have no ``activeSensorResolution``.

    Raises:
        InputError: A sample cannot be used, or times do not ascend; the message has the sample.
    """
    file, listed = _listed(samples)
    if not listed:
        raise InputError(f"{file}: no samples")
    still: dict[str, Any] = {}
    found: list[tuple[float, Calibration]] = []
    begin = (0.0, 0.0)
    for i, (where, sample) in enumerate(listed):
        try:
            root = sample if isinstance(sample, Item) else load(sample)
            if not isinstance(root.value, dict):
                root.fail(f"wanted a sample with names and values, got {short(root.value)}")
            still = still | {k: v for k, v in root.value.items() if k == "static"}
            clock = _time(root, i)
            one = read_opentrackio(still | root.value, size=size)
        except InputError as error:
            text = str(error)
            raise InputError(text if text.startswith(where) else f"{where}: {text}") from None
        begin = begin if found else clock
        time = (clock[0] - begin[0]) + (clock[1] - begin[1])
        if found and time <= found[-1][0]:
            raise InputError(
                f"{where}: timing: times must increase, got {found[-1][0]:g} s then {time:g} s"
            )
        found.append((time, one))
    first = found[0][1]
    settings = first.settings | _rate(load(still))
    return Take(
        first.projection,
        Path(file).stem,
        first.rig_from_camera,
        first.pixel_pitch,
        settings,
        samples=tuple(found),
        file=file,
    )


@guarded
def read_track(
    samples: Samples,
    *,
    size: tuple[int, int] | None = None,
    camera: Camera | None = None,
    pixel_pitch: float | None = None,
) -> Camera:
    """The camera of several samples, keyed at their times; see :func:`read_take`.

    Args: as for :meth:`Camera.from_opentrackio`.
    """
    return read_take(samples, size=size).camera(camera, pixel_pitch)


def _listed(samples: Samples) -> tuple[str, list[tuple[str, Any]]]:
    """Returns the name of the source, and samples with their places."""
    if not isinstance(samples, str | os.PathLike):
        given = [samples] if isinstance(samples, dict) else list(samples)
        return "samples", [(f"samples[{i}]", one) for i, one in enumerate(given)]
    path = Path(samples)
    data = read_bytes(path)
    if path.suffix.lower() != ".jsonl":
        items = list(json_text.parse(data, str(path)))
        return str(path), [(f"{path}: [{i}]", one) for i, one in enumerate(items)]
    lines = [(f"{path}: line {i}", line) for i, line in enumerate(data.splitlines(), 1)]
    return str(path), [(at, json_text.parse(line, at)) for at, line in lines if line.strip()]


def _time(root: Item, index: int) -> tuple[float, float]:
    """Time of a sample, from its time stamp, or from its number and the rate.

    Whole seconds and the rest, s: their sum since 1970 would lose a quarter of a microsecond.
    """
    timing = root.get("timing")
    stamp = None if timing is None else timing.get("sampleTimestamp")
    if stamp is not None:
        return stamp.need("seconds").number(), 1e-9 * stamp.number_of("nanoseconds", 0.0)
    rate = None if timing is None else timing.get("sampleRate")
    if rate is None:
        root.fail("missing: timing.sampleTimestamp or timing.sampleRate")
    return 0.0, index * rate.number_of("denom", 1.0) / rate.need("num").number(above=0)


def _rate(root: Item) -> dict[str, float]:
    """Frame rate of the camera, if the take has it."""
    rate = root.need("static").need("camera").get("captureFrameRate")
    if rate is None:
        return {}
    return {"fps": rate.need("num").number(above=0) / rate.number_of("denom", 1.0)}
