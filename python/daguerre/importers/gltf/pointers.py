"""Resolves JSON pointers into a glTF file, and decides which values an animation may change.

The decision uses a value's place and type, not a list of names, so that animations can change
the factors of any extension, including future ones.
Sources: RFC 6901; glTF 2.0 Asset Object Model; KHR_animation_pointer.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from daguerre.files.budget import Budget
from daguerre.files.json_item import Item, short

_TYPES = ("SCALAR", "VEC2", "VEC3", "VEC4")
_WIDTHS = {"translation": 3, "rotation": 4, "scale": 3}  # of nodes
_INDEX = re.compile(r"0|[1-9][0-9]{0,14}")
#: Members of materials, cameras and lights that refer to other objects or select a kind.
_FIXED = frozenset(
    ("index", "texCoord", "light", "name", "type", "alphaMode", "doubleSided", "extensions")
)
# Limit of weights that are copied from meshes to nodes.
_MAX_COPIED = 1 << 22


@dataclass(frozen=True)
class Target:
    """A value of the file that an animation sets.

    Attributes:
        holder: Object or list that contains the value.
        key: Name or index of the value in ``holder``.
        name: Name for notes.
        width: Numbers in the value; None: as in the accessor's type, or a list of any length.
        types: Accessor types that fit.
        is_flag: Whether the value is true or false.
    """

    holder: dict[str, Any] | list[Any]
    key: str | int
    name: str
    width: int | None
    types: tuple[str, ...]
    is_flag: bool = False

    @property
    def is_list(self) -> bool:
        """Whether the value is a list of any length."""
        return self.width is None and self.types == _TYPES[:1]


def parse(use: Item) -> list[str]:
    """Splits a JSON pointer into its reference tokens."""
    text = use.text()
    if not text.startswith("/") or re.search(r"~(?![01])", text):
        use.fail(f"wanted a JSON pointer such as '/nodes/0/rotation', got {short(text)}")
    # In this order: "~01" is "~1" (RFC 6901, chapter 4).
    return [token.replace("~1", "/").replace("~0", "~") for token in text[1:].split("/")]


class Pointers:
    """Finds the targets of animations in a file.

    Args:
        root: The JSON object of the file.
    """

    def __init__(self, root: Item) -> None:
        self._root = root
        self._meshes = root.list_of("meshes")
        self.node_count = len(root.list_of("nodes"))
        self._copied = Budget(_MAX_COPIED, "weights of single nodes")

    def target(self, tokens: list[str], use: Item) -> Target | None:
        """Finds the value at the tokens; None if it cannot be animated.

        Raises:
            InputError: An index is invalid or out of range; the message names ``use``.
        """
        if not _is_mutable(tokens):
            return None
        holder: dict[str, Any] | list[Any] = self._root.value
        for token in tokens[:-1]:
            if token == "weights" and isinstance(holder, dict) and "weights" not in holder:
                self._write_weights(holder, tokens, use)
            holder = _step(holder, token, use)
        return _target(holder, tokens, use)

    def _write_weights(self, owner: dict[str, Any], tokens: list[str], use: Item) -> None:
        """Writes default weights into an object, so that an animation can change one of them."""
        chosen = owner.get("mesh") if tokens[0] == "nodes" else int(tokens[1])
        if not isinstance(chosen, int) or not 0 <= chosen < len(self._meshes):
            return
        mesh = self._meshes[chosen]
        weights = _list(mesh, "weights")  # a node inherits the weights of its mesh (3.7.4)
        if not weights:  # weights of a mesh default to 0 (3.7.2.2)
            first = mesh.list_of("primitives")[:1]
            weights = [0.0] * sum(len(_list(primitive, "targets")) for primitive in first)
        self._copied.spend(len(weights), use)
        owner["weights"] = list(weights)


def _list(owner: Item, key: str) -> list[Any]:
    member = owner.get(key)
    return member.value if member is not None and isinstance(member.value, list) else []


def _is_mutable(tokens: list[str]) -> bool:
    match tokens:
        case ["nodes", _, "translation" | "rotation" | "scale" | "weights"]:
            return True
        case ["meshes", _, "weights"] | ["nodes" | "meshes", _, "weights", _]:
            return True
        case (
            ["nodes", _, "extensions", _, key]
            | ["cameras" | "materials", _, *_, key]
            | ["extensions", _, "lights", _, *_, key]
        ):
            return key not in _FIXED
        case _:
            return False


def _target(holder: object, tokens: list[str], use: Item) -> Target | None:
    key = tokens[-1]
    if isinstance(holder, list) and tokens[-2] == "weights":  # in other lists, no single number
        return Target(holder, _index(key, holder, use), "weights", 1, _TYPES[:1])
    if not isinstance(holder, dict):
        return None
    if key == "weights":
        return Target(holder, key, key, None, _TYPES[:1])
    if key == "visible":
        return Target(holder, key, key, 1, _TYPES[:1], is_flag=True)
    width = _WIDTHS[key] if tokens[0] == "nodes" and key in _WIDTHS else _width(holder.get(key))
    if width == 0:
        return None
    return Target(holder, key, key, width, _TYPES if width is None else _TYPES[width - 1 : width])


def _width(value: object) -> int | None:
    """Count of numbers in a value; None: there is no value; 0: not numbers."""
    if value is None:
        return None
    numbers = value if isinstance(value, list) else [value]
    fits = all(isinstance(n, (int, float)) and not isinstance(n, bool) for n in numbers)
    return len(numbers) if fits and len(numbers) <= len(_TYPES) else 0


def _step(holder: object, token: str, use: Item) -> Any:
    if isinstance(holder, list):
        return holder[_index(token, holder, use)]
    return holder.get(token) if isinstance(holder, dict) else None


def _index(token: str, holder: list[Any], use: Item) -> int:
    if not _INDEX.fullmatch(token) or int(token) >= len(holder):
        wanted = f"0 .. {len(holder) - 1}" if holder else "no index: the list is empty"
        use.fail(f"index out of range: wanted {wanted}, got {short(token)}")
    return int(token)
