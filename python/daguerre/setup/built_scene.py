"""A built scene, which all cameras with the same exposure interval share."""

from __future__ import annotations

import daguerre._core as _core
from daguerre.cached import cached_property
from daguerre.scene.far import ZERO, Place
from daguerre.scene.scene import Scene

from .content_hash import ContentHash
from .nesting import overlap_notes
from .scene import build


class BuiltScene:
    """Scene of the core, with warnings and a hash.

    Args:
        scene: The scene; it must not change while this object is in use.
        interval: Exposure interval, s.
        before: Scene built for another interval; of the same scene, its hash need not begin anew.
        origin: Origin of the core's scene in the world, m.

    Attributes:
        core: Scene of the core.
        warnings: A sentence for each motion that is only approximated, and for positions that files
            have rounded.
        notes: A sentence about solids that replace each other where they overlap.
    """

    def __init__(
        self,
        scene: Scene,
        interval: tuple[float, float],
        before: BuiltScene | None = None,
        origin: Place = ZERO,
    ) -> None:
        self.scene, self.interval, self.origin = scene, interval, origin
        self._content = ContentHash(scene)
        if before is not None and before.scene is scene:
            self._content = before._content
        self.warnings: list[str] = []
        self.core: _core.Scene = build(scene, interval, self.warnings, origin)
        self.notes = overlap_notes(scene, self.core)

    def shows(self, scene: Scene, interval: tuple[float, float], origin: Place) -> bool:
        """Whether it was built from this scene, with this origin, for this interval.

        A static scene fits any interval.
        """
        same = self.scene is scene and self.origin == origin
        return same and (self.interval == interval or not scene.motion)

    @cached_property
    def hash(self) -> str:
        """Hash of everything that a picture can depend on."""
        return self._content.over(self.interval)
