"""Applies animations of glTF at one time to the JSON before other parts read it.

Readers of nodes, materials and lights then get the values of that time, and need no code for
animation. Values at other times come from a copy of one part of the file, so that the file as read
never changes.
Sources: glTF 2.0 specification, chapter 3.11 and appendix C; KHR_animation_pointer.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from daguerre.files.json_item import Item, clean, short
from daguerre.files.notes import Notes
from daguerre.files.value import Value

from .accessors import Accessors
from .pointers import Pointers, Target, parse
from .samplers import FloatArray, Samplers, Track

_PATHS = ("translation", "rotation", "scale", "weights")
#: Place of an object in a file, such as ("nodes", "3").
Part = tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Channel(Value):
    """An animated value of the file.

    Attributes:
        tokens: Path to the value.
        track: Values over time.
        is_flag: Whether the value is true or false.
    """

    tokens: tuple[str, ...]
    track: Track
    is_flag: bool

    @property
    def part(self) -> Part:
        """Part of the file that contains the value: the tokens up to the first index."""
        return self.tokens[: 4 if self.tokens[0] == "extensions" else 2]

    @property
    def inside(self) -> tuple[str, ...]:
        """Path from that part to the value."""
        return self.tokens[len(self.part) :]


class Animations:
    """All animations of a file; they play at once, and hold their first and last values.

    Args:
        root: The JSON object of the file; changed in place to its state at ``time``.
        accessors: Accessors of the file.
        time: Time, s.
        notes: Receives notes on unsupported content.

    Attributes:
        duration: Time of the last key, s; None: there are no animations.
    """

    def __init__(self, root: Item, accessors: Accessors, time: float, notes: Notes) -> None:
        self.duration: float | None = None
        pointers = Pointers(root)
        samplers = Samplers(accessors, notes)
        found: dict[Part, Channel] = {}
        for animation in root.list_of("animations"):
            listed = list(animation.need("samplers"))
            for item in animation.need("channels"):
                sampler = listed[item.need("sampler").index(len(listed), "samplers")]
                tokens, target = _target(item.need("target"), pointers, notes)
                if target is None:
                    continue
                place = tuple(tokens)
                if place in found:
                    notes.add(f"a second animation of the same {target.name} replaces the first")
                track = samplers.track(sampler, target)
                found[place] = Channel(place, track, target.is_flag)
                _write(target, track.at(time))
                end = track.span[1]
                self.duration = end if self.duration is None else max(end, self.duration)
        self._parts: dict[Part, list[Channel]] = {}
        for channel in found.values():
            if channel.track.changes:
                self._parts.setdefault(channel.part, []).append(channel)

    def of(self, *part: str) -> list[Channel]:
        """Channels that change a part of the file, such as ``of("nodes", "3")``."""
        return self._parts.get(part, [])

    def parts(self, kind: str) -> list[int]:
        """Indices of nodes, materials, ... that change."""
        return sorted(int(part[-1]) for part in self._parts if part[0] == kind)


def played(part: object, channels: Sequence[Channel], time: float) -> Any:
    """Returns a part of the file with its values at a time, s; the part itself is unchanged.

    Only objects and lists on the paths to the values are copied.
    """
    for channel in channels:
        part = _with(part, channel.inside, channel.track.at(time))
    return part


def _with(holder: Any, way: tuple[str, ...], value: object) -> Any:
    """Copies an object or list, with another value at the end of the path."""
    copy = holder.copy()
    key: Any = int(way[0]) if isinstance(holder, list) else way[0]
    copy[key] = value if len(way) == 1 else _with(holder[key], way[1:], value)
    return copy


def breaks_of(channels: Sequence[Channel], begin: float, end: float) -> FloatArray:
    """Increasing times of the keys inside of (begin, end), s."""
    tracks = {id(c.track): c.track for c in channels}  # many nodes may share a track
    times = [track.breaks(begin, end) for track in tracks.values()]
    if len(times) == 1:
        return times[0]
    return np.array(sorted({key for track in times for key in track.tolist()}), np.float64)


def _write(target: Target, value: object) -> None:
    """Sets a value of the file that is being read."""
    holder: Any = target.holder
    has = isinstance(holder, list) or target.key in holder
    old = holder[cast("Any", target.key)] if has else None
    if isinstance(old, list) and isinstance(value, list):
        old[:] = value  # single elements of it may be animated too
    else:
        holder[target.key] = value


def _target(item: Item, pointers: Pointers, notes: Notes) -> tuple[list[str], Target | None]:
    """Finds the target of a channel; None, mostly with a note, if it cannot be animated."""
    path, node = item.need("path").text(), item.get("node")
    if path in _PATHS:
        if node is None:  # reserved for extensions, which the file lacks (3.11)
            return [], None
        tokens = ["nodes", str(node.index(pointers.node_count, "nodes")), path]
        return tokens, pointers.target(tokens, node)
    extension = item.extension("KHR_animation_pointer") if path == "pointer" else None
    if extension is None:
        notes.add("an animation of an unsupported path is left out")
        return [], None
    use = extension.need("pointer")
    tokens = parse(use)
    target = pointers.target(tokens, use)
    if target is None:
        where = "/".join("{}" if token.isdigit() else clean(token) for token in tokens)
        notes.add(f"an animation of {short('/' + where)} is left out: it cannot be animated")
    return tokens, target
