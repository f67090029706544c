"""Photographs from a render: sensor, brackets, development.

Exposure never changes an ``.exr``. Other pictures show a frame by its exposure mode. In ``light``
they show 1 as white. They are developed in other modes, and for a sensor, a look or a white.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import UsageError

from .reporter import Reporter

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame
    from daguerre.frame.picture import Picture
    from daguerre.frame.raw import Raw
    from daguerre.sensors import Sensor

PICTURES = (".png", ".jpg", ".jpeg", ".tif", ".tiff")


class Like(Protocol):
    """A camera with a look that pictures imitate: the camera of a plate."""

    @property
    def facts(self) -> dict[str, Any]:
        """Metadata about the camera for files of frames."""

    def seen(self, frame: Frame, seed: int = 0) -> Frame:
        """Turns a noiseless frame into that camera's, with its blur and noise."""

    def finished(self, picture: Picture, seed: int = 0) -> Picture:
        """Adds traces of that camera's development to a developed picture."""


@dataclass(frozen=True)
class Photograph:
    """Development, sensor and bracketing of pictures; frames know their exposure.

    Attributes:
        sensor: Sensor that takes the picture; None: a perfect sensor.
        iso: ISO that the sensor must have; None: the camera's, else the base ISO of the sensor.
        bracket: Exposures, EV, each of which gives a picture; empty: a single picture.
        look: Tone curve; None: neutral.
        seed: Seed of the noise.
        like: Camera with the look that pictures imitate; None: none.
        colorspace: Colour space of .exr files, of ``color.spaces.LINEAR``; None: linear Rec.709.
    """

    sensor: Sensor | None = None
    iso: float | None = None
    bracket: tuple[float, ...] = ()
    look: str | None = None
    seed: int = 0
    like: Like | None = None
    colorspace: str | None = None

    def develops(self, metadata: Mapping[str, Any]) -> bool:
        """Whether pictures of a frame with this metadata are developed, not just encoded."""
        from daguerre.exposure.lux_seconds import is_developed

        own = (self.sensor, self.look, self.like)
        return any(value is not None for value in own) or is_developed(metadata)

    def packages(self, path: Path) -> list[str]:
        """Packages of extras that an output needs."""
        kind = path.suffix.lower()
        writes_tags = kind in (".tif", ".tiff") or is_raw(path)
        mosaic = self.sensor is not None and len(self.sensor.channels) > 1
        return ["tifffile"] * writes_tags + ["rawpy"] * (mosaic and kind in PICTURES)

    def files(self, path: Path) -> list[tuple[Path, float]]:
        """Files that an output writes, and their exposures, EV."""
        if not self.bracket or not shows_exposure(path):
            return [(path, 0.0)]
        return [
            (path.with_name(f"{path.stem}_{offset_name(ev)}{path.suffix}"), ev)
            for ev in self.bracket
        ]

    def check(self, metadata: dict[str, Any], paths: Sequence[Path], tell: Reporter) -> None:
        """Checks, before anything is drawn, that the camera's metadata have an exposure.

        Raises:
            InputError: They lack it; the message names the field.
        """
        from daguerre.exposure.lux_seconds import in_light, luminance_exposure, pinhole_note

        if not any(shows_exposure(path) for path in paths):
            if self.bracket:
                known = ", ".join(PICTURES)
                raise UsageError(f"--bracket needs an output that is exposed (-o .dng, {known})")
            return
        developed = self.develops(metadata) or any(is_raw(path) for path in paths)
        if in_light(metadata) or not developed:
            return
        luminance_exposure(metadata)
        if note := pinhole_note(metadata):
            tell.note(note)
        if self.bracket:
            tell.note("bracketed by time: motion blur is the same as at 0 EV")

    def write(self, frame: Frame, paths: Sequence[Path], tone: str, tell: Reporter) -> None:
        """Writes outputs; each exposure is taken once for all its formats."""
        if self.like is not None:
            frame = replace(frame, metadata={**frame.metadata, "plate": self.like.facts})
        exposed = [path for path in paths if shows_exposure(path)]
        for path in paths:
            if path not in exposed:
                frame.save(path, tone=tone, colour_space=self.colorspace)
        offsets = self.bracket or (0.0,)
        for offset in offsets if exposed else ():
            files = [file for path in exposed for file, ev in self.files(path) if ev == offset]
            # Only the picture nearest to 0 EV reports messages, as they are the same for all.
            reporter = tell if offset == min(offsets, key=abs) else Reporter()
            self._shoot(frame, offset, files, tone, reporter)

    def _shoot(
        self, frame: Frame, offset: float, files: list[Path], tone: str, tell: Reporter
    ) -> None:
        """Writes one exposure to its files."""
        frame, raw = self._exposed(frame, offset, raw=any(is_raw(file) for file in files))
        for text in raw.notes if raw is not None else ():
            tell.note(text)
        for file in files:
            if raw is not None and is_raw(file):
                from daguerre.development.dng import size_note

                raw.save(file)
                if remark := size_note(raw):
                    tell.note(f"{file}: {remark}")
            elif self.develops(frame.metadata):
                self._developed(frame, raw).save(file)
            else:
                frame.save(file, tone=tone)

    def _exposed(self, frame: Frame, offset: float, *, raw: bool) -> tuple[Frame, Raw | None]:
        """Exposes a frame at an offset, EV; adds a raw picture if a sensor is set or ``raw``."""
        from daguerre.exposure.lux_seconds import with_exposure

        if offset:
            frame = replace(frame, metadata=with_exposure(frame.metadata, offset))
        if self.like is not None:
            frame = self.like.seen(frame, self.seed)
        if self.sensor is None and not raw:
            return frame, None
        chosen = self.iso is not None or "metering" in frame.metadata
        iso = frame.metadata.get("isoSpeed") if chosen else None  # the sensor has its own
        return frame, frame.expose(self.sensor, iso, seed=self.seed)

    def _developed(self, frame: Frame, raw: Raw | None) -> Picture:
        from daguerre.development import develop

        looks: dict[str, Any] = {} if self.look is None else {"look": self.look}
        source = frame if raw is None or self.sensor is None else raw
        return self._finished(develop(source, **looks))

    def shown(self, frame: Frame, tone: str) -> NDArray[np.uint8]:
        """Pixels for display, (H, W, 3), as in a .png of one exposure.

        Args:
            frame: The frame.
            tone: Tone curve if the picture is not developed.
        """
        if not self.develops(frame.metadata):
            return frame.display(tone)
        exposed, raw = self._exposed(frame, 0.0, raw=False)
        return self._developed(exposed, raw).bytes8()

    def _finished(self, picture: Picture) -> Picture:
        return picture if self.like is None else self.like.finished(picture, self.seed)


def is_raw(path: Path) -> bool:
    """Whether a file is a raw picture."""
    return path.suffix.lower() == ".dng"


def shows_exposure(path: Path) -> bool:
    """Whether a file depends on the exposure of its frame."""
    return is_raw(path) or path.suffix.lower() in PICTURES


def offset_name(ev: float) -> str:
    """Name of a bracket's exposure in file names, such as ``+1ev``."""
    return f"{ev:+.3g}ev" if ev else "0ev"
