"""Photographs from a render: exposure set by hand or by a meter, brackets, development.

Exposure never changes an ``.exr``. Other pictures show 1 as white unless a parameter of exposure or
development is given. A ``.dng`` is always exposed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import DaguerreError, UsageError

from .reporter import Reporter

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame
    from daguerre.frame.picture import Picture
    from daguerre.frame.raw import Raw
    from daguerre.sensors import Sensor

PICTURES = (".png", ".jpg", ".jpeg", ".tif", ".tiff")


class Like(Protocol):
    """A camera whose look pictures imitate: that of a plate."""

    @property
    def facts(self) -> dict[str, Any]:
        """Metadata about the camera for files of frames."""

    def seen(self, frame: Frame, seed: int = 0) -> Frame:
        """Turns a noiseless frame into that camera's, with its blur and noise."""

    def finished(self, picture: Picture, seed: int = 0) -> Picture:
        """Adds traces of that camera's development to a developed picture."""


@dataclass(frozen=True)
class Photograph:
    """Exposure, development and bracketing of pictures.

    Attributes:
        develops: Whether pictures are developed; otherwise 1 is white.
        sensor: Sensor that takes the picture; None: a perfect one.
        iso: ISO setting; None: metered, or 100.
        meters: Metering mode; None: the ISO is set.
        ev: Exposure compensation, EV; without metering the frame's metadata have it.
        bracket: Exposures, EV, each of which gives a picture; empty: a single picture.
        look: Tone curve; None: neutral.
        seed: Seed of the noise.
        focus_at: Pixel in focus, if given; spot metering uses it.
        like: Camera whose look pictures imitate; None: none.
    """

    develops: bool = False
    sensor: Sensor | None = None
    iso: float | None = None
    meters: str | None = None
    ev: float = 0.0
    bracket: tuple[float, ...] = ()
    look: str | None = None
    seed: int = 0
    focus_at: tuple[float, float] | None = None
    like: Like | None = None

    def exposes(self, path: Path) -> bool:
        """Whether a file depends on exposure."""
        return _is_raw(path) or (self.develops and path.suffix.lower() in PICTURES)

    def packages(self, path: Path) -> list[str]:
        """Packages of extras that an output needs."""
        kind = path.suffix.lower()
        writes_tags = kind in (".tif", ".tiff") or _is_raw(path)
        mosaic = self.sensor is not None and len(self.sensor.channels) > 1
        demosaics = mosaic and self.exposes(path) and not _is_raw(path)
        return ["tifffile"] * writes_tags + ["rawpy"] * demosaics

    def files(self, path: Path) -> list[tuple[Path, float]]:
        """Files that an output stands for, and their exposures, EV."""
        if not self.bracket or not self.exposes(path):
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
        if not any(self.exposes(path) for path in paths):
            if self.meters or self.bracket:
                flag = "--exposure" if self.meters else "--bracket"
                known = ", ".join(PICTURES)
                raise UsageError(f"{flag} needs an output that is exposed (-o .dng, {known})")
            return
        from daguerre.exposure.lux_seconds import luminance_exposure, pinhole_note

        luminance_exposure(metadata)
        if note := pinhole_note(metadata):
            tell.note(note)
        if self.bracket:
            tell.note("bracketed by time: motion blur is the same as at 0 EV")

    def metered(self, frame: Frame, paths: Sequence[Path], tell: Reporter) -> Frame:
        """Returns the frame with the metered ISO, if metering is on, and reports the ISO."""
        if not any(self.exposes(path) for path in paths) or self.meters is None:
            return frame
        from daguerre.exposure.metering import meter

        try:
            read = meter(frame, self.meters, at=self.focus_at)
        except DaguerreError as error:  # such as a black picture, which must not cost the render
            tell.warning(f"--exposure auto: {error}; the ISO stays as set")
            return frame
        wanted = read.iso * 2.0**self.ev
        low, high = (1.0, 1e7) if self.sensor is None else self.sensor.iso_range
        iso = float(round(min(max(wanted, low), high), 0 if wanted > 50 else 2))
        compensated = f", {self.ev:+g} EV" if self.ev else ""
        tell.note(
            f"metered ({read.mode}): {read.luminance:.3g} cd/m2, EV100 {read.ev100:.1f}; "
            f"ISO {iso:g}{compensated}"
        )
        if not low <= wanted <= high:
            tell.warning(
                f"--exposure auto: ISO {wanted:.3g} is outside {low:g} .. {high:g}: the picture "
                f"is {_stops(wanted, iso)}"
            )
        facts = {**frame.metadata, "isoSpeed": iso, "metering": read.mode}
        facts.pop("exposure_compensation", None)  # the ISO has it
        return replace(frame, metadata=facts)

    def write(self, frame: Frame, paths: Sequence[Path], tone: str, tell: Reporter) -> None:
        """Writes outputs; each exposure is taken once for all its formats."""
        if self.like is not None:
            frame = replace(frame, metadata={**frame.metadata, "plate": self.like.facts})
        exposed = [path for path in paths if self.exposes(path)]
        for path in paths:
            if path not in exposed:
                frame.save(path, tone=tone)
        offsets = self.bracket or (0.0,)
        for offset in offsets if exposed else ():
            files = [file for path in exposed for file, ev in self.files(path) if ev == offset]
            # Messages about a bracket name one of its pictures.
            told = tell if offset == min(offsets, key=abs) else Reporter()
            self._shoot(frame, offset, files, told)

    def _shoot(self, frame: Frame, offset: float, files: list[Path], tell: Reporter) -> None:
        """Writes one exposure to its files."""
        from daguerre.development.dng import size_note

        frame, raw = self._exposed(frame, offset, raw=any(_is_raw(file) for file in files))
        for text in raw.notes if raw is not None else ():
            tell.note(text)
        for file in files:
            if raw is not None and _is_raw(file):
                raw.save(file)
                if remark := size_note(raw):
                    tell.note(f"{file}: {remark}")
            else:
                self._developed(frame, raw).save(file)

    def _exposed(self, frame: Frame, offset: float, *, raw: bool) -> tuple[Frame, Raw | None]:
        """Exposes a frame at an offset, EV; with a sensor, or if one is wanted, also a raw one."""
        from daguerre.exposure.lux_seconds import with_exposure

        if offset:
            frame = replace(frame, metadata=with_exposure(frame.metadata, 2.0**offset))
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
        if not self.develops:
            return frame.display(tone)
        frame = self.metered(frame, [Path("shown.png")], Reporter())
        return self._developed(*self._exposed(frame, 0.0, raw=False)).bytes8()

    def _finished(self, picture: Picture) -> Picture:
        return picture if self.like is None else self.like.finished(picture, self.seed)


def _is_raw(path: Path) -> bool:
    return path.suffix.lower() == ".dng"


def offset_name(ev: float) -> str:
    """Name of a bracket's exposure in file names, such as ``+1ev``."""
    return f"{ev:+.3g}ev" if ev else "0ev"


def _stops(wanted: float, iso: float) -> str:
    import math

    stops = math.log2(wanted / iso)
    return f"{abs(stops):.1f} EV too {'dark' if stops > 0 else 'bright'}"
