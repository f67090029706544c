"""Animation of glTF at one moment, written into the JSON itself.

Whoever reads a node, a material or a light then meets the value of that moment and need not know
that it moves. What does know asks for another moment: of one part of the file at a time.
Sources: glTF 2.0 specification, chapter 3.11 and appendix C; KHR_animation_pointer.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from daguerre.files.json_item import Item, clean, short
from daguerre.files.notes import Notes

from .accessors import Accessors
from .pointers import Pointers, Target, parse
from .samplers import FloatArray, Samplers, Track

_PATHS = ("translation", "rotation", "scale", "weights")
#: Where something stands in a file, such as ("nodes", "3").
Part = tuple[str, ...]


@dataclass(frozen=True)
class Channel:
    """A value of the file and what it is over time.

    Attributes:
        tokens: The way to it.
        target: Where it is written.
        track: Its values over time.
    """

    tokens: list[str]
    target: Target
    track: Track

    def write(self, time: float) -> None:
        """Sets the value to what it is at a time, s."""
        value = self.track.at(time)
        old = self.target.holder[self.target.key] if _has(self.target) else None
        if isinstance(old, list) and isinstance(value, list):
            old[:] = value  # single elements of it may be animated too
        else:
            self.target.holder[self.target.key] = value


class Animations:
    """All animations of a file, which play at once, each held at its ends.

    Args:
        root: The JSON object of the file; changed in place to the moment ``time``.
        accessors: Its accessors.
        time: s.
        notes: Gets what was not understood.

    Attributes:
        duration: Time of the last key, s; None: there is no animation.
    """

    def __init__(self, root: Item, accessors: Accessors, time: float, notes: Notes) -> None:
        self.duration: float | None = None
        pointers = Pointers(root)
        samplers = Samplers(accessors, notes)
        found: dict[tuple[int, str | int], Channel] = {}  # keeps the holders alive, and their ids
        for animation in root.list_of("animations"):
            listed = list(animation.need("samplers"))
            for item in animation.need("channels"):
                sampler = listed[item.need("sampler").index(len(listed), "samplers")]
                tokens, target = _target(item.need("target"), pointers, notes)
                if target is None:
                    continue
                place = (id(target.holder), target.key)
                if place in found:
                    notes.add(f"a second animation of the same {target.name} replaces the first")
                found[place] = Channel(tokens, target, samplers.track(sampler, target))
                found[place].write(time)
                end = found[place].track.span[1]
                self.duration = end if self.duration is None else max(end, self.duration)
        self._parts: dict[Part, list[Channel]] = {}
        for channel in found.values():
            if channel.track.changes:
                self._parts.setdefault(_part(channel.tokens), []).append(channel)

    def of(self, *part: str) -> list[Channel]:
        """Channels that change a part of the file, such as ``of("nodes", "3")``."""
        return self._parts.get(part, [])

    def parts(self, kind: str) -> list[int]:
        """Indices of the nodes, materials, ... in which something changes."""
        return sorted(int(part[-1]) for part in self._parts if part[0] == kind)


def play(channels: Sequence[Channel], time: float) -> None:
    """Sets values to what they are at a time, s."""
    for channel in channels:
        channel.write(time)


def breaks_of(channels: Sequence[Channel], begin: float, end: float) -> FloatArray:
    """Rising times of the keys inside of (begin, end), s."""
    tracks = {id(c.track): c.track for c in channels}  # many nodes may follow one
    times = [track.breaks(begin, end) for track in tracks.values()]
    return times[0] if len(times) == 1 else np.unique(np.concatenate([np.zeros(0), *times]))


def _has(target: Target) -> bool:
    return isinstance(target.holder, list) or target.key in target.holder


def _part(tokens: list[str]) -> Part:
    """The part of the file that the tokens lead into: up to the first index."""
    return tuple(tokens[: 4 if tokens[0] == "extensions" else 2])


def _target(item: Item, pointers: Pointers, notes: Notes) -> tuple[list[str], Target | None]:
    """Target of a channel; None, with a note where that is odd, if it is nothing."""
    path, node = item.need("path").text(), item.get("node")
    if path in _PATHS:
        if node is None:  # left to extensions that are not in the file (3.11)
            return [], None
        tokens = ["nodes", str(node.index(pointers.node_count, "nodes")), path]
        return tokens, pointers.target(tokens, node)
    extension = item.extension("KHR_animation_pointer") if path == "pointer" else None
    if extension is None:
        notes.add("an animation of something other than a node's place is left out")
        return [], None
    use = extension.need("pointer")
    tokens = parse(use)
    target = pointers.target(tokens, use)
    if target is None:
        where = "/".join("{}" if token.isdigit() else clean(token) for token in tokens)
        notes.add(f"an animation of {short('/' + where)} is left out: nothing there can move")
    return tokens, target
