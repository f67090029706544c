"""Light meter: chooses exposures, and draws a new picture only where it would differ."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from daguerre.camera.camera import Camera
from daguerre.camera.exposure import without_brightness

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame
    from daguerre.rendering.auto_exposure import Chosen
    from daguerre.rendering.prepare import Prepared
    from daguerre.scene.scene import Scene
    from daguerre.setup.built_scene import BuiltScene

    from .shot import Shot

#: Pictures that it keeps: modes that choose the f-stop look through several.
_KEPT = 8


@dataclass(frozen=True)
class _Taken:
    """A picture of the meter, and its reading."""

    scene: Scene
    camera: Camera
    size: tuple[int, int]
    frame: Frame

    def shows(self, one: Prepared) -> bool:
        """Whether the meter would see the same again."""
        same = self.scene is one.scene and self.size == one.size
        return same and self.camera == without_brightness(one.camera)


class LightMeter:
    """A meter that remembers its last pictures."""

    def __init__(self) -> None:
        self._taken: list[_Taken] = []
        self._built: BuiltScene | None = None

    def choose(
        self, shot: Shot, built: BuiltScene | None, *, fresh: bool
    ) -> tuple[Chosen, BuiltScene]:
        """Chooses the exposure of a shot in an automatic mode; see ``auto_exposure.choose``.

        Args:
            shot: The shot.
            built: The scene built for another picture.
            fresh: Whether to draw anew after motion; if not, the last picture will do.
        """
        from daguerre.rendering.auto_exposure import choose

        chosen, self._built = choose(
            shot.scene,
            shot.camera,
            shot.settings,
            self._built or built,
            lambda one: self._look(one, fresh=fresh),
        )
        return chosen, self._built

    def _look(self, one: Prepared, *, fresh: bool) -> Frame:
        from daguerre.rendering.meter_picture import meter_picture

        last = self._taken[-1] if self._taken else None
        taken = next((taken for taken in self._taken if taken.shows(one)), None)
        if taken is None and not fresh and last is not None and last.size == one.size:
            taken = last
        if taken is None:
            taken = _Taken(one.scene, without_brightness(one.camera), one.size, meter_picture(one))
        others = [other for other in self._taken if other is not taken]
        self._taken = [*others[1 - _KEPT :], taken]
        return taken.frame
