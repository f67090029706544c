"""Finds nodes by name. Nodes of USD have the path of their prim as their name."""

from __future__ import annotations

from collections.abc import Collection

from daguerre.checks import short
from daguerre.errors import did_you_mean, nearest, suggest


def find_node(name: str, known: Collection[str]) -> str | None:
    """Finds a node by its name, by a path with a first slash, or by the last part of its path.

    Args:
        name: Name as a user gives it.
        known: Names of nodes.

    Returns:
        The name of the node; None if there is none, or if several end in this part.
    """
    for exact in (name, name.removeprefix("/")):
        if exact in known:
            return exact
    ends = _ends(name, known)
    return ends[0] if len(ends) == 1 else None


def no_node(name: str, known: Collection[str]) -> str:
    """Message that there is no such node, with the nearest names."""
    parts: dict[str, list[str]] = {}
    for node in known:
        parts.setdefault(node.rpartition("/")[2], []).append(node)
    near = [node for part in nearest(name, sorted(parts)) for node in parts[part]]
    hint = did_you_mean(_ends(name, known) or near) or suggest(name, known, few=True)
    return f"no node named {short(name)}{hint}"


def _ends(name: str, known: Collection[str]) -> list[str]:
    return [node for node in known if node.endswith(f"/{name}")]
