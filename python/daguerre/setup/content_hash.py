"""Hash of everything in a scene that a picture can depend on."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
from typing import Any

import numpy as np

from daguerre.cached import cached_property
from daguerre.motion.subdivision import samples
from daguerre.scene.scene import Scene


class ContentHash:
    """SHA-256 of a scene; caches the hashes of values that do not move.

    Args:
        scene: The scene; it must not change while this object is in use.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    def over(self, interval: tuple[float, float] | None) -> str:
        """Hash for an exposure interval, s; None: without motion.

        Motion is sampled at the ends of the interval, at keys and between.
        """
        digest = self._still.copy()
        if interval is not None:
            for where, dynamic in self.scene.motion.parts():
                digest.add(where)
                digest.add(samples(dynamic, *interval))
        return digest.hex()

    @cached_property
    def _still(self) -> _Digest:
        scene, digest = self.scene, _Digest()
        for part in (
            scene.meshes,
            scene.textures,
            scene.materials,
            scene.instances,
            scene.lights,
            scene.environment,
            scene.plate,
            scene.fog,
        ):
            digest.add(part)
        return digest


def content_hash(scene: Scene, interval: tuple[float, float] | None = None) -> str:
    """Hash of a scene; see ``ContentHash.over``."""
    return ContentHash(scene).over(interval)


class _Digest:
    """SHA-256 of values: arrays, data classes, lists, and the texts of others."""

    def __init__(self) -> None:
        self._sha = hashlib.sha256()
        self._pending: list[str] = []

    def add(self, value: object) -> None:
        kind: Any = type(value)
        if isinstance(value, np.ndarray):
            self._pending.append(f"{value.dtype}{value.shape}")
            self._flush()
            self._sha.update(np.ascontiguousarray(value).data)
        elif (names := _field_names(kind)) is not None:
            for name in names:
                self._pending.append(name)
                self.add(getattr(value, name))
        elif isinstance(value, (list, tuple)):
            self._pending.append(f"[{len(value)}")
            for item in value:
                self.add(item)
        else:
            self._pending.append(repr(value))

    def copy(self) -> _Digest:
        self._flush()
        other = _Digest()
        other._sha = self._sha.copy()
        return other

    def hex(self) -> str:
        self._flush()
        return self._sha.hexdigest()

    def _flush(self) -> None:
        self._sha.update("".join(self._pending).encode())
        self._pending.clear()


@functools.cache
def _field_names(kind: type) -> tuple[str, ...] | None:
    """Names of the fields of a data class; None for other classes."""
    if not dataclasses.is_dataclass(kind):
        return None
    return tuple(field.name for field in dataclasses.fields(kind))
