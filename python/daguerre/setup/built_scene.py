"""A built scene, which all cameras with the same exposure interval share."""

from __future__ import annotations

import daguerre._core as _core
from daguerre.cached import cached_property
from daguerre.scene.scene import Scene

from .content_hash import ContentHash
from .scene import build


class BuiltScene:
    """Scene of the core, with warnings and a hash.

    Args:
        scene: The scene; it must not change while this object is in use.
        interval: Exposure interval, s.
        before: Scene built for another interval; of the same scene, its hash need not begin anew.

    Attributes:
        core: Scene of the core.
        warnings: A sentence for each motion that is only approximated.
    """

    def __init__(
        self, scene: Scene, interval: tuple[float, float], before: BuiltScene | None = None
    ) -> None:
        self.scene, self.interval = scene, interval
        self._content = ContentHash(scene)
        if before is not None and before.scene is scene:
            self._content = before._content
        self.warnings: list[str] = []
        self.core: _core.Scene = build(scene, interval, self.warnings)

    def shows(self, scene: Scene, interval: tuple[float, float]) -> bool:
        """Whether it was built from this scene for this interval; a static scene fits any."""
        return self.scene is scene and (self.interval == interval or not scene.motion)

    @cached_property
    def hash(self) -> str:
        """Hash of everything that a picture can depend on."""
        return self._content.over(self.interval)
