"""A scene that is built: what all cameras share that look at it at the same time."""

from __future__ import annotations

import daguerre._core as _core
from daguerre.cached import cached_property
from daguerre.scene.scene import Scene

from .scene import build, content_hash


class BuiltScene:
    """The core's scene, and what is known about it.

    Args:
        scene: The scene; it must not change while this is used.
        interval: When it is seen, s.

    Attributes:
        core: The core's scene.
        warnings: A sentence for each motion that cannot be shown to its end.
    """

    def __init__(self, scene: Scene, interval: tuple[float, float]) -> None:
        self.scene, self.interval = scene, interval
        self.warnings: list[str] = []
        self.core: _core.Scene = build(scene, interval, self.warnings)

    def shows(self, scene: Scene, interval: tuple[float, float]) -> bool:
        """Whether it is of this scene at this time; what stays is the same at any."""
        return self.scene is scene and (self.interval == interval or not scene.motion)

    @cached_property
    def hash(self) -> str:
        """Hash of all that a picture can depend on."""
        return content_hash(self.scene, self.interval)
