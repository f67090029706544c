"""Scenes: meshes, instances, materials, lights, cameras, environment, and their motion."""

from __future__ import annotations

from .scene import Scene

__all__ = ["Scene"]
