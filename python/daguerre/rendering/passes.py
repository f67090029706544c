"""Pass files: a viewable picture together with the exact sums for merging.

A pass is an EXR of several parts:

- The first part is the picture, as in any frame.
- ``sums`` has the film's fixed-point sums as they are in memory, without a copy: 28 words of 32
  bits per pixel, in a picture of four channels that is seven times as wide. Its header has the key
  that two passes must share to be added (``daguerre:key``: hashes of scene, camera, settings and
  build), the samples drawn (``daguerre:ranges``) and the format of the pass (``daguerre:pass``;
  another format is refused).
- ``aovs`` has the sums of the auxiliary channels in the same way.
- ``splats`` and ``flare`` have the light of light paths (``daguerre.rendering.light_paths``) and
  ghosts (``daguerre.setup.body``), if any were drawn.
- ``bands`` has the wavelength bands that the frame keeps, or that diffraction needs; its pupils
  are in the metadata (``daguerre.rendering.diffraction``).
- ``channels`` and ``channel_splats`` have the channels of the sensor.
- ``objects`` lists the coverage of each pixel by objects; its rows are as long as the longest list.
- ``round``, in the checkpoint of an adaptive render, has begin and count of each pixel in the
  current round; ``daguerre:round`` is the progress of the round.

The sums are integers, so adding them in any order gives the same bits. Ground truth is not part of
the sums: every pass of a picture has all of it among the channels of its first part.
"""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre._core import __version__
from daguerre.errors import InputError, MismatchError
from daguerre.files.json_item import short
from daguerre.files.reading import size_of
from daguerre.files.value import BriefRecord
from daguerre.frame.world import in_world
from daguerre.pictures.exr.layout import Layout, read_layouts
from daguerre.pictures.exr.parts import PartReader
from daguerre.pictures.exr.write import ExrPart, channels, jsonable, write_parts
from daguerre.pictures.exr.write import header as picture_header

from .adaptive import Round
from .film_frame import OBJECTS
from .pass_facts import are_ranges, bad_fact
from .ranges import Range

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

    from .session import Session

State = dict[str, NDArray[np.uint32]]
Facts = Mapping[str, Any]
#: Format number of pass files; it rises whenever words of the same size change their meaning.
FORM = 1
SUMS = "sums"
HASH = re.compile("[0-9a-f]{64}")
BAND = 256  # rows of words to read at once
ROUND = "round"
STATE_PARTS = (
    SUMS, "aovs", "splats", "flare", "halves", "bands", "channels", "channel_splats", "coverage",
    OBJECTS, "catchers", "catcher_channels", ROUND,
)  # fmt: skip
ROUND_FACTS = ("drawn", "noise", "expected")
WORDS = {
    "scene": "the scene",
    "camera": "the camera",
    "settings": "resolution, crop, seed, filter, depth, AOVs, light paths, flare, scatter, "
    "background, cryptomatte, diffraction, sensor, bands",
    "build": "the build of daguerre",
}
#: Settings that a header stores in plain form.
SETTINGS = ("resolution", "crop", "overscan", "seed", "filter", "light_paths")


@dataclass(frozen=True, repr=False)
class Pass(BriefRecord):
    """The sums of a part of the samples of a picture.

    Attributes:
        state: The film's words by part, each (H, W, words) uint32.
        ranges: Samples drawn, [begin, end), merged and sorted.
        key: Values that must agree with another pass, by name.
        metadata: Metadata of the frame.
        path: File that it was read from, for messages.
        round: Round of adaptive sampling, else None.
        truth: Channels of ground truth (``rendering.truth``) by name, if the pass has them.
        notes: Remarks on a merge.
    """

    state: State
    ranges: list[Range]
    key: dict[str, str]
    metadata: dict[str, Any] = field(default_factory=dict)
    path: Path | None = None
    round: Round | None = None
    truth: dict[str, NDArray[Any]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def pass_of(session: Session) -> Pass:
    """Makes a pass of all samples that a session has drawn so far."""
    return Pass(
        session.state(),
        list(session.ranges),
        dict(session.key),
        {**session.metadata, "resolution": (session.width, session.height), "crop": session.crop},
        round=session.round,
    )


def write_pass(path: str | os.PathLike[str], frame: Frame, drawn: Pass) -> None:
    """Writes a pass file, atomically; ``frame`` is the picture of the same samples."""
    header: dict[str, Any] = {
        "daguerre:pass": FORM,
        "daguerre:key": json.dumps(drawn.key, sort_keys=True),
        "daguerre:ranges": json.dumps(drawn.ranges),
        "daguerre:metadata": json.dumps(drawn.metadata, sort_keys=True, default=jsonable),
    }
    planes = dict(drawn.state)
    if drawn.round is not None:
        facts = {name: getattr(drawn.round, name) for name in ROUND_FACTS}
        header["daguerre:round"] = json.dumps(facts)
        begin, count = drawn.round.begin, drawn.round.count
        planes[ROUND] = np.stack([begin, count, 0 * begin, 0 * begin], axis=2)
    parts = [
        ExrPart("beauty", picture_header(frame), channels(frame)),
        *(_words_part(frame, name, header, words) for name, words in planes.items()),
    ]
    write_parts(path, parts, frame)


def _words_part(
    frame: Frame, name: str, header: dict[str, Any], words: NDArray[np.uint32]
) -> ExrPart:
    """Words (H, W, 4 k) as a picture (H, k W) of four channels, in place."""
    height, width, count = words.shape
    corner = np.array((frame.metadata.get("crop") or (0, 0))[:2], np.int32)
    size = np.array([width * count // 4 - 1, height - 1], np.int32)
    header = {**header, "daguerre:words": count, "dataWindow": (corner, corner + size)}
    return ExrPart(name, header, {"words": words.reshape(height, -1, 4)})


def read_pass(path: str | os.PathLike[str]) -> Pass:
    """Reads a pass file.

    Raises:
        InputError: The file is missing, damaged, or an EXR without sums.
    """
    path = Path(path)
    size_of(path)
    parts = read_layouts(path)
    state: State = {}
    facts = found = None
    for part in parts:
        if part.name not in STATE_PARTS:
            continue
        header = part.header.facts
        _check_form(path, header)
        words = _words(part, header.get("daguerre:words"))
        facts = facts or _header(path, header)
        if part.name != OBJECTS:
            _check_crop(path, facts, words)
        if part.name == ROUND:
            found = _round(path, header, words)
        else:
            state[part.name] = words
    if facts is None:
        raise InputError(
            f"{path}: holds no sums, only a picture; "
            "wanted a file written by `daguerre render --samples a:b` or a checkpoint"
        )
    truth = _read_truth(parts[0]) if facts.metadata.get("gt_time") else {}
    truth = in_world(truth, facts.metadata.get("world_origin"))
    return replace(facts, state=state, path=path, round=found, truth=truth)


def check_key(first: Pass, other: Pass) -> None:
    """Checks that two passes are of the same picture; the error names the differences."""
    names = sorted({*first.key, *other.key})
    differing = [name for name in names if first.key.get(name) != other.key.get(name)]
    if differing:
        words = [_difference(name, first, other) for name in differing]
        raise MismatchError(
            f"{other.path or 'this render'}: does not belong to "
            f"{first.path or 'this render'}: they differ in {'; '.join(words)}"
        )


def _difference(name: str, first: Pass, other: Pass) -> str:
    """Describes the difference of one entry of the key: values if known, else hashes."""
    if name == "settings":
        values = [
            (fact.replace("_", " "), *(_value(p.metadata.get(fact)) for p in (other, first)))
            for fact in SETTINGS
        ]
        told = [f"{fact} {got} (wanted {wanted})" for fact, got, wanted in values if got != wanted]
        if told:
            return ", ".join(told)
    got, wanted = _short(other.key.get(name)), _short(first.key.get(name))
    return f"{WORDS.get(name, name)} ({got}, wanted {wanted})"


def _value(fact: object) -> str:
    """Returns a setting as text; a setting missing from the header is off."""
    if fact is None:
        return "off"
    return ",".join(map(str, fact)) if isinstance(fact, list | tuple) else str(fact)


def _words(part: Layout, count: object) -> NDArray[np.uint32]:
    """Inverse of :func:`_words_part`: the words (H, W, count) of a part."""
    names = [f"words.{color}" for color in "RGBA"]
    if sorted(names) != list(part.channels) or set(part.channels.values()) != {"uint32"}:
        raise InputError(f"{part.path}: damaged pass file: part {part.name} has no data")
    size = 4 * part.width
    if not isinstance(count, int) or count < 1 or size % count:
        raise InputError(f"{part.path}: damaged pass file: daguerre:words is {count}")
    with PartReader(part) as reader:
        reader.check_memory(2 * part.size)
        words = np.empty((part.height, part.width, 4), np.uint32)
        for top in range(0, part.height, BAND):
            bottom = min(top + BAND, part.height)
            planes = reader.rows(top, bottom)
            for i, name in enumerate(names):
                words[top:bottom, :, i] = planes[name]
    return words.reshape(part.height, size // count, count)


def _read_truth(part: Layout) -> dict[str, NDArray[Any]]:
    """Reads the channels of ground truth of the picture in a pass."""
    from daguerre.frame.aovs import EXACT, channels_of

    names = [name for name in part.channels if name in channels_of(*EXACT)]
    with PartReader(part) as reader:
        planes = reader.rows(0, part.height, names)
    kinds = {name: np.uint32 if name.endswith("_id") else np.float32 for name in names}
    return {name: planes[name].astype(kinds[name], copy=False) for name in names}


def _field(path: Path, header: Facts, name: str, check: Callable[[Any], bool]) -> Any:
    """Reads a JSON attribute of the sums."""
    text = str(header.get(f"daguerre:{name}", ""))
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        value = None
    if not check(value):
        raise InputError(f"{path}: damaged pass file: daguerre:{name} is {text[:40]!r}")
    return value


def _round(path: Path, header: Facts, words: NDArray[np.uint32]) -> Round:
    def is_facts(value: object) -> bool:
        return (
            isinstance(value, dict)
            and all(isinstance(value.get(name), int | float) for name in ROUND_FACTS)
            and math.isfinite(value["drawn"])
        )

    facts = _field(path, header, "round", is_facts)
    if words.shape[2] < 2:
        raise InputError(f"{path}: damaged pass file: wanted 2 words of a round, got 1")
    begin, count = (np.ascontiguousarray(words[:, :, i]) for i in range(2))
    return Round(begin, count, int(facts["drawn"]), float(facts["noise"]), float(facts["expected"]))


def _check_form(path: Path, header: Facts) -> None:
    """Refuses passes of another format; those without a number have the first."""
    form = header.get("daguerre:pass", 1)
    if form != FORM:
        raise InputError(
            f"{path}: format of the pass: wanted {FORM}, got {short(form)}; "
            f"another version wrote it, this is daguerre {__version__}"
        )


def _check_crop(path: Path, facts: Pass, words: NDArray[np.uint32]) -> None:
    """Checks that the crop in the metadata has the size of the sums."""
    x0, y0, x1, y1 = facts.metadata.get("crop") or (0, 0, *words.shape[1::-1])
    if (y1 - y0, x1 - x0) != words.shape[:2]:
        raise InputError(
            f"{path}: damaged pass file: daguerre:metadata: crop is {x1 - x0}x{y1 - y0}, "
            f"wanted {words.shape[1]}x{words.shape[0]}"
        )


def _header(path: Path, header: Facts) -> Pass:
    def are_strings(value: object) -> bool:
        return isinstance(value, dict) and bool(value) and all(map(is_text, value.values()))

    def is_text(value: object) -> bool:
        return isinstance(value, str)

    metadata = _field(path, header, "metadata", lambda value: isinstance(value, dict))
    wrong = bad_fact(metadata)
    if wrong is not None:
        raise InputError(
            f"{path}: damaged pass file: daguerre:metadata: {wrong} is {short(metadata[wrong])}"
        )
    return Pass(
        {},
        [(r[0], r[1]) for r in _field(path, header, "ranges", are_ranges)],
        _field(path, header, "key", are_strings),
        metadata,
    )


def _short(value: str | None) -> str:
    """Shortens hashes; other values, such as the name of a build, stay."""
    if value is None:
        return "nothing"
    return value[:12] if HASH.fullmatch(value) else short(value, 120).strip("'")
