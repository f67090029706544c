"""Scenes: meshes, instances, materials, lights, cameras, environment, and their motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.on_use import on_use

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["Scene"]

if not TYPE_CHECKING:  # checkers know the names above, and report all others
    __getattr__, __dir__ = on_use(
        __name__,
        {
            "Scene": "scene",
        },
    )
