"""Finds nodes by name. Nodes of USD have the path of their prim as their name."""

from __future__ import annotations

from collections.abc import Collection


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
    ends = [node for node in known if node.endswith(f"/{name}")]
    return ends[0] if len(ends) == 1 else None
