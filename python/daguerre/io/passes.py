"""Pass files: a picture that can be looked at, and beside it the exact sums that can be added.

A pass is an EXR of two parts. The first is the picture as in any frame. The second, ``sums``,
holds the film's fixed-point sums as 32-bit words per pixel, and in its header what must agree
before two passes may be added (``daguerre:key``: hashes of scene, camera, settings and build) and
which samples were drawn (``daguerre:ranges``). The sums are integers, so adding them in any order
gives the same bits.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError, MismatchError
from daguerre.frame import Frame

from .exr import Channels, attributes, channels, jsonable, write_parts

if TYPE_CHECKING:
    from daguerre.render import Session

Range = tuple[int, int]
State = dict[str, NDArray[np.uint32]]
SUMS = "sums"
WORDS = {
    "scene": "the scene",
    "camera": "the camera",
    "settings": "resolution, crop, seed, filter, depth, AOVs",
    "build": "the build of daguerre",
}


@dataclass(frozen=True)
class Pass:
    """The sums of some samples of one picture.

    Attributes:
        state: The film's words by channel, each (H, W) uint32.
        ranges: Samples drawn, [begin, end), merged and sorted.
        key: What must agree with another pass, by name.
        metadata: Facts of the frame.
        path: Where it was read, for messages.
    """

    state: State
    ranges: list[Range]
    key: dict[str, str]
    metadata: dict[str, Any] = field(default_factory=dict)
    path: Path | None = None


def pass_of(session: Session) -> Pass:
    """What a session has drawn so far."""
    return Pass(
        session.state(),
        list(session.ranges),
        dict(session.key),
        {**session.metadata, "resolution": (session.width, session.height), "crop": session.crop},
    )


def write_pass(path: str | os.PathLike[str], frame: Frame, drawn: Pass) -> None:
    """Writes a pass file, atomically; ``frame`` is the picture of the same samples."""
    header = {
        "daguerre:key": json.dumps(drawn.key, sort_keys=True),
        "daguerre:ranges": json.dumps(drawn.ranges),
        "daguerre:metadata": json.dumps(drawn.metadata, sort_keys=True, default=jsonable),
    }
    parts: list[tuple[str, dict[str, Any], Channels]] = [
        ("beauty", attributes(frame.metadata), channels(frame)),
        (SUMS, header, drawn.state),
    ]
    write_parts(path, parts, frame)


def read_pass(path: str | os.PathLike[str]) -> Pass:
    """Reads a pass file.

    Raises:
        InputError: Missing, damaged, or an EXR without sums.
    """
    import OpenImageIO as oiio

    path = Path(path)
    if not path.is_file():
        raise InputError(f"{path}: no such pass file")
    source = oiio.ImageInput.open(str(path))
    if source is None:
        raise InputError(f"{path}: not a readable EXR: {oiio.geterror()}")
    try:
        index = _find_sums(source)
        if index is None:
            raise InputError(
                f"{path}: holds no sums, only a picture; "
                "wanted a file written by `daguerre render --samples a:b` or a checkpoint"
            )
        spec = source.spec()
        words = source.read_image(index, 0, 0, spec.nchannels, oiio.UINT)
        if words is None:
            raise InputError(f"{path}: damaged pass file: {source.geterror()}")
        facts = _header(path, spec)
        state = {
            name: np.ascontiguousarray(words[:, :, i]) for i, name in enumerate(spec.channelnames)
        }
        return replace(facts, state=state, path=path)
    finally:
        source.close()


def merge(
    passes: Iterable[str | os.PathLike[str] | Pass], *, aovs: bool = True
) -> tuple[Frame, Pass]:
    """Adds passes, in any order, exactly: the picture has the bits of a render in one go.

    Args:
        passes: Files or passes.
        aovs: Keep the auxiliary channels, if the passes have them.

    Returns:
        The picture, and the sum as a pass.

    Raises:
        InputError: A file cannot be read.
        MismatchError: Passes of different pictures, or samples drawn twice; the message names them.
    """
    total: Any = None
    first: Pass | None = None
    ranges: list[tuple[Range, Path | None]] = []
    for item in passes:
        # One at a time: a pass of a large picture takes gigabytes.
        one = item if isinstance(item, Pass) else read_pass(item)
        if first is None:
            first = replace(one, state={})
        check_key(first, one)
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
    metadata = {**first.metadata, "samples": drawn, "bad_samples": count}
    state = {name: total.state(name) for name in total.state_channels()}
    frame = frame_of(total, metadata, aovs=aovs and _has_aovs(state))
    return frame, Pass(state, merged, first.key, metadata)


def film_of(one: Pass) -> Any:
    """The core's film with the sums of a pass."""
    from daguerre._core import Film

    if not one.state:
        raise InputError(f"{one.path}: damaged pass file: it has no channels")
    height, width = next(iter(one.state.values())).shape
    x0, y0 = (one.metadata.get("crop") or (0, 0))[:2]
    film = Film(width, height, int(x0), int(y0), aovs=_has_aovs(one.state))
    wanted, got = set(film.state_channels()), set(one.state)
    if wanted != got:
        differing = ", ".join(sorted(wanted ^ got)[:4])
        raise MismatchError(f"{one.path}: sums of another layout: channels differ: {differing}")
    for name, words in one.state.items():
        film.set_state(name, np.ascontiguousarray(words, np.uint32))
    return film


def frame_of(
    film: Any,
    metadata: dict[str, Any],
    *,
    aovs: bool,
) -> Frame:
    """The picture of a film: means, variance and counts as plain arrays."""
    from daguerre.render import AOV_NAMES

    planes: dict[str, NDArray[Any]] = {}
    alpha = np.ones(film.shape, np.float32)
    if aovs:
        planes = {name: film.aov(name) for name in AOV_NAMES}
        planes["object_id"] = film.object_ids()
        alpha = film.aov("alpha")
    return Frame(
        rgb=film.mean_rgb(),
        xyz=film.mean_xyz(),
        alpha=alpha,
        variance=film.variance_rgb(),
        samples=film.sample_counts(),
        aovs=planes,
        metadata=metadata,
        bad_samples=(int(film.bad_sample_count), list(film.bad_samples)),
    )


def check_key(first: Pass, other: Pass) -> None:
    """Refuses a pass of another picture and names what differs."""
    names = sorted({*first.key, *other.key})
    differing = [name for name in names if first.key.get(name) != other.key.get(name)]
    if differing:
        words = [
            f"{WORDS.get(name, name)} ({_short(other.key.get(name))}, "
            f"wanted {_short(first.key.get(name))})"
            for name in differing
        ]
        raise MismatchError(
            f"{other.path or 'this render'}: does not belong to {first.path or 'this render'}; "
            f"different: {'; '.join(words)}"
        )


def join_ranges(ranges: Iterable[Range]) -> list[Range]:
    """Sorted ranges [begin, end), touching ones joined."""
    joined: list[Range] = []
    for begin, end in sorted(ranges):
        if joined and begin <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        elif end > begin:
            joined.append((begin, end))
    return joined


def missing_ranges(ranges: Sequence[Range], wanted: Range | None = None) -> list[Range]:
    """The gaps of ``ranges`` within ``wanted``, by default from 0 to the last sample drawn."""
    begin, end = wanted or (0, max((e for _, e in ranges), default=0))
    gaps: list[Range] = []
    for a, b in join_ranges(ranges):
        if a > begin:
            gaps.append((begin, min(a, end)))
        begin = max(begin, b)
        if begin >= end:
            break
    if begin < end:
        gaps.append((begin, end))
    return [(a, b) for a, b in gaps if b > a]


def show_ranges(ranges: Iterable[Range]) -> str:
    """``0:32, 64:96``."""
    return ", ".join(f"{a}:{b}" for a, b in ranges) or "none"


def _check_overlap(seen: list[tuple[Range, Path | None]], one: Pass) -> None:
    for begin, end in one.ranges:
        for (a, b), path in seen:
            low, high = max(a, begin), min(b, end)
            if low < high:
                raise MismatchError(
                    f"{one.path}: samples {low}:{high} are also in {path}; "
                    "each sample may be added once"
                )


def _find_sums(source: Any) -> int | None:
    index = 0
    while source.seek_subimage(index, 0):
        if source.spec().get_string_attribute("oiio:subimagename") == SUMS:
            return index
        index += 1
    return None


def _header(path: Path, spec: Any) -> Pass:
    def field_of(name: str, check: Callable[[Any], bool]) -> Any:
        text = spec.get_string_attribute(f"daguerre:{name}")
        try:
            value = json.loads(text)
        except ValueError:
            value = None
        if not check(value):
            raise InputError(f"{path}: damaged pass file: daguerre:{name} is {text[:40]!r}")
        return value

    def is_ranges(value: Any) -> bool:
        return isinstance(value, list) and all(
            isinstance(r, list)
            and len(r) == 2
            and all(isinstance(v, int) for v in r)
            and 0 <= r[0] < r[1]
            for r in value
        )

    return Pass(
        {},
        [(r[0], r[1]) for r in field_of("ranges", is_ranges)],
        field_of("key", lambda v: isinstance(v, dict) and bool(v)),
        field_of("metadata", lambda v: isinstance(v, dict)),
    )


def _has_aovs(state: State) -> bool:
    return any(name.startswith("sum.depth") for name in state)


def _short(value: str | None) -> str:
    """The start of a hash; short values as they are."""
    if value is None:
        return "nothing"
    return value if len(value) <= 40 else value[:12]
