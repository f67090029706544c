"""Facts of a stage that its prims are read with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from daguerre.errors import InputError

from .values import Clock

#: Finds the file of an asset: (place, asset path) -> file. The place is for messages.
Resolve = Callable[[str, str], Path]


def refuse(place: str, asset: str) -> Path:
    """Refuses every file; the default of a stage without a folder."""
    raise InputError(f"{place}: refused: wanted a name of the library, got the file {asset[:60]!r}")


@dataclass(frozen=True)
class StageFacts:
    """Facts of a stage.

    Attributes:
        file: File, for messages.
        clock: Time codes.
        metres: Length of a scene unit, m (``metersPerUnit``).
        camera_millimetres: Length of a unit of camera lengths, mm; None: a tenth of a scene unit,
            as UsdGeomCamera has it.
        resolve: Finds the file of an asset, and refuses files outside of the stage's folder.
        fps: Frames per second; None: the time codes per second.
    """

    file: str
    clock: Clock
    metres: float = 1.0
    camera_millimetres: float | None = None
    resolve: Resolve = refuse
    fps: float | None = None

    @property
    def millimetres(self) -> float:
        """Length of a unit of camera lengths, mm."""
        return 100 * self.metres if self.camera_millimetres is None else self.camera_millimetres

    @property
    def frame_rate(self) -> float:
        """Frames per second."""
        return self.clock.rate if self.fps is None else self.fps
