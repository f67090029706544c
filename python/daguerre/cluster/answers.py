"""Answers of workers, as bytes: sums with a key and a checksum, needed values, or a failure.

Each begins with a line of JSON. Sums are the parts of a pass file (``daguerre.rendering.passes``)
without its picture, which only the client makes, and without columns of zeros.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any
from zlib import crc32

import numpy as np

from daguerre.errors import InputError, MismatchError
from daguerre.files.json_item import short
from daguerre.rendering.columns import Columns, Words, kept_of, take


@dataclass(frozen=True)
class Needs:
    """A worker needs values before it can draw.

    Attributes:
        worker: Its address.
        names: Hashes of the values.
    """

    worker: str
    names: list[str]

    def to_bytes(self) -> bytes:
        """Packs the names of the values."""
        return head_line(needs=self.names, worker=self.worker)


@dataclass(frozen=True)
class Failed:
    """A worker could not do its task.

    Attributes:
        worker: Its address.
        reason: Sentence that says why.
    """

    worker: str
    reason: str

    def to_bytes(self) -> bytes:
        """Packs the failure."""
        return head_line(failed=self.reason, worker=self.worker)


@dataclass(frozen=True)
class Sums:
    """Sums of some samples of a picture.

    Attributes:
        worker: Address of the worker that drew them.
        key: Values that must agree with the picture, by name; see ``Session.key``.
        parts: Words of the film by part.
        facts: Time that drawing took, number of rays; JSON values.
    """

    worker: str
    key: dict[str, str]
    parts: Mapping[str, Columns]
    facts: dict[str, Any]

    def fact(self, name: str) -> float:
        """A number among the facts; 0: there is none."""
        return float(self.facts.get(name) or 0)

    @property
    def piloted(self) -> tuple[float, float] | None:
        """Result of the pilot render; None: there is none."""
        found = self.facts.get("piloted")
        return None if found is None else (float(found[0]), float(found[1]))

    def check_key(self, wanted: dict[str, str], *, mixed: bool = False) -> None:
        """Checks that the sums belong to a picture.

        Args:
            wanted: Key of the picture.
            mixed: Whether another build will do.

        Raises:
            MismatchError: They do not.
        """
        for name, value in wanted.items():
            got = self.key.get(name)
            if got != value and not (mixed and name == "build"):
                raise MismatchError(
                    f"{name}: wanted the same as the client's, {value[:60]}, got {short(got)}"
                )


#: Most bytes of the line.
_LINE = 1 << 20
#: Most characters of the name of a part, and largest number of a fact.
_NAME, _MOST = 64, 1e18

Answer = Needs | Failed | Sums


def packed_sums(
    worker: str, key: dict[str, str], state: Mapping[str, Words], facts: dict[str, Any]
) -> memoryview:
    """Packs sums: the line, columns and words of each part, and the checksum of those.

    Args:
        worker: Address of the worker.
        key: Key of the picture.
        state: Sums, as in ``Session.state``; they may be large, so they are copied once.
        facts: JSON values.
    """
    kept = {part: kept_of(part, words) for part, words in state.items()}
    sizes = [[part, state[part].shape, len(own), count] for part, (own, count) in kept.items()]
    line = np.frombuffer(head_line(parts=sizes, worker=worker, key=key, facts=facts), np.uint32)
    total = sum(len(own) + count for own, count in kept.values())
    data = np.empty(len(line) + total + 1, np.uint32)
    data[: len(line)] = line
    place = len(line)
    for part, (own, count) in kept.items():
        begin = place + len(own)
        data[place:begin] = own
        place = begin + count
        take(part, state[part], own, data[begin:place])
    data[-1] = crc32(data[len(line) : -1].data)
    return data.data.cast("B")


def answer_of(data: bytes | memoryview) -> Answer:
    """Unpacks an answer; its words stay where they are.

    Raises:
        InputError: It is damaged.
    """
    try:
        line = bytes(data[:_LINE]).split(b"\n", 1)[0]
        head, rest = json.loads(line), memoryview(data)[len(line) + 1 :]
        worker = str(head["worker"])
        if "needs" in head:
            return Needs(worker, [str(name) for name in head["needs"]])
        if "failed" in head:
            return Failed(worker, str(head["failed"]))
        words, check = rest[:-4], rest[-4:]
        if crc32(words) != int.from_bytes(check, "little"):
            raise ValueError("another checksum")
        key = {str(name): str(value) for name, value in head["key"].items()}
        return Sums(worker, key, dict(_parts(head["parts"], words)), _facts(head["facts"]))
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError) as error:
        raise InputError(f"damaged answer: {str(error)[:200]}") from None


def head_line(**head: object) -> bytes:
    """Line of JSON, filled up so that the words after it lie aligned."""
    text = json.dumps(head, separators=(",", ":")).encode()
    return text + b" " * (-(len(text) + 1) % 8) + b"\n"


def _facts(facts: object) -> dict[str, Any]:
    """Facts by name: numbers of at least 0, and the result of a pilot render."""
    if not isinstance(facts, dict):
        raise TypeError(f"wanted facts by name, got {short(facts)}")
    for name, value in facts.items():
        values = [value]
        if name == "piloted":
            values = [] if value is None else value
            if not isinstance(values, list) or len(values) not in (0, 2):
                raise ValueError(f"piloted: wanted two numbers, got {short(value)}")
        if not all(type(one) in (int, float) and 0 <= one < _MOST for one in values):
            raise ValueError(f"{short(name)}: wanted numbers, got {short(value)}")
    return facts


def _parts(facts: Any, data: memoryview) -> Iterator[tuple[str, Columns]]:
    """Parts over bytes, not copied."""
    begin = 0
    for name, shape, *counts in facts:
        if not isinstance(name, str) or len(name) > _NAME or not _is_shape(shape):
            raise ValueError(f"wanted a part and its shape, got {short([name, shape])}")
        blocks = []
        for count in counts:
            words = np.frombuffer(data[begin : begin + 4 * count], np.uint32)
            if len(words) != count:
                raise ValueError("words are missing")
            blocks.append(words)
            begin += 4 * count
        kept, words = blocks
        yield name, Columns(tuple(shape), np.require(kept, requirements="A"), words)


def _is_shape(shape: object) -> bool:
    """Whether a value can be the shape of a part's words."""
    return (
        isinstance(shape, list)
        and 1 <= len(shape) <= 3
        and all(type(count) is int and 0 <= count < _MOST for count in shape)
    )
