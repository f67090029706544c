"""JSON pointers into a glTF file, and which of its values an animation may change.

That is told by place and by the type of what stands there, not by a list of names: so the factors
of every extension can move, those too that nobody has thought of yet.
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
#: Members of materials, cameras and lights that hold the file together or choose a kind.
_FIXED = frozenset(
    ("index", "texCoord", "light", "name", "type", "alphaMode", "doubleSided", "extensions")
)
# Weights that are copied from meshes to nodes.
_MAX_COPIED = 1 << 22


@dataclass(frozen=True)
class Target:
    """A value of the file that an animation sets.

    Attributes:
        holder: The object or list that has it.
        key: Its name or index there.
        name: Its name in a remark.
        width: Numbers in it; None: the number of the accessor's type, or a list of any length.
        types: Accessor types that fit.
        is_flag: It is true or false.
    """

    holder: Any
    key: str | int
    name: str
    width: int | None
    types: tuple[str, ...]
    is_flag: bool = False

    @property
    def is_list(self) -> bool:
        """Whether it is a list of any length."""
        return self.width is None and self.types == _TYPES[:1]


def parse(use: Item) -> list[str]:
    """The reference tokens of a JSON pointer."""
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
        """Finds what the tokens lead to; None if nothing there can be animated.

        Raises:
            InputError: An index is none, or out of range; ``use`` is named.
        """
        if not _is_mutable(tokens):
            return None
        holder: Any = self._root.value
        for token in tokens[:-1]:
            if token == "weights" and isinstance(holder, dict) and "weights" not in holder:
                self._write_weights(holder, tokens, use)
            holder = _step(holder, token, use)
        return _target(holder, tokens, use)

    def _write_weights(self, owner: dict[str, Any], tokens: list[str], use: Item) -> None:
        """Writes down weights that go without saying, as one of them is to change."""
        chosen = owner.get("mesh") if tokens[0] == "nodes" else int(tokens[1])
        if not isinstance(chosen, int) or not 0 <= chosen < len(self._meshes):
            return
        mesh = self._meshes[chosen]
        weights = _list(mesh, "weights")  # a node has those of its mesh (3.7.4)
        if not weights:  # and those are zeros (3.7.2.2)
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


def _target(holder: Any, tokens: list[str], use: Item) -> Target | None:
    key = tokens[-1]
    if isinstance(holder, list) and tokens[-2] == "weights":  # of the others, no single number
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


def _width(value: Any) -> int | None:
    """How many numbers a value consists of; None if it is absent, 0 if it is something else."""
    if value is None:
        return None
    numbers = value if isinstance(value, list) else [value]
    fits = all(isinstance(n, (int, float)) and not isinstance(n, bool) for n in numbers)
    return len(numbers) if fits and len(numbers) <= len(_TYPES) else 0


def _step(holder: Any, token: str, use: Item) -> Any:
    if isinstance(holder, list):
        return holder[_index(token, holder, use)]
    return holder.get(token) if isinstance(holder, dict) else None


def _index(token: str, holder: list[Any], use: Item) -> int:
    if not _INDEX.fullmatch(token) or int(token) >= len(holder):
        wanted = f"0 .. {len(holder) - 1}" if holder else "none, as there are none"
        use.fail(f"index out of range: wanted {wanted}, got {short(token)}")
    return int(token)
