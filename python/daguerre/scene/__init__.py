"""Scenes: meshes, instances, materials, lights, cameras, environment, and their motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.lazy_imports import lazy_attributes

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["Scene"]

if not TYPE_CHECKING:  # type checkers use the imports above, and report other names
    __getattr__, __dir__ = lazy_attributes(
        __name__,
        {
            "Scene": "scene",
        },
    )
