"""Animation of glTF at one moment, written into the JSON itself.

Whoever reads a node, a material or a light then meets the value of that moment and need not know
that it moves. Sources: glTF 2.0 specification, chapter 3.11 and appendix C; KHR_animation_pointer.
"""

from __future__ import annotations

from .gltf_accessors import Accessors
from .gltf_pointers import Pointers, Target, parse
from .gltf_samplers import Samplers
from .json_item import Item, clean, short
from .notes import Notes

_PATHS = ("translation", "rotation", "scale", "weights")


def play(root: Item, accessors: Accessors, time: float, notes: Notes) -> None:
    """Sets every animated value to what it is at one time; all animations play, held at their ends.

    Args:
        root: The JSON object of the file; changed in place.
        accessors: Its accessors.
        time: s.
        notes: What was not understood.
    """
    pointers = Pointers(root)
    tracks = Samplers(accessors, time)
    seen: dict[tuple[int, str | int], Target] = {}  # keeps the holders alive, and so their ids
    for animation in root.list_of("animations"):
        samplers = list(animation.need("samplers"))
        for channel in animation.need("channels"):
            sampler = samplers[channel.need("sampler").index(len(samplers), "samplers")]
            target = _target(channel.need("target"), pointers, notes)
            if target is None:
                continue
            place = (id(target.holder), target.key)
            if place in seen:
                notes.add(f"a second animation of the same {target.name} replaces the first")
            seen[place] = target
            target.holder[target.key] = tracks.value(sampler, target)


def _target(item: Item, pointers: Pointers, notes: Notes) -> Target | None:
    """What a channel animates; None, with a note where that is odd, if it is nothing."""
    path, node = item.need("path").text(), item.get("node")
    if path in _PATHS:
        if node is None:  # left to extensions that are not in the file (3.11)
            return None
        chosen = node.index(pointers.node_count, "nodes")
        return pointers.target(["nodes", str(chosen), path], node)
    extension = item.extension("KHR_animation_pointer") if path == "pointer" else None
    if extension is None:
        notes.add("an animation of something other than a node's place is left out")
        return None
    use = extension.need("pointer")
    tokens = parse(use)
    target = pointers.target(tokens, use)
    if target is None:
        where = "/".join("{}" if token.isdigit() else clean(token) for token in tokens)
        notes.add(f"an animation of {short('/' + where)} is left out: nothing there can move")
    return target
