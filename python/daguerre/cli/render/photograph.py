"""How a render becomes photographs: exposure by the triangle or by a meter, brackets, development.

An ``.exr`` is never changed by exposure. Other pictures show 1 as white, unless something of
exposure or development was asked for; a ``.dng`` is always exposed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre import units as q
from daguerre.cli import console
from daguerre.errors import DaguerreError, UsageError

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame
    from daguerre.sensors import Sensor

#: Parameters of a camera that are about exposure and development alone.
ASKING = (
    *("sensor", "iso", "exposure_compensation", "exposure_time", "exposure_f_stop"),
    *("responsivity", "white_balance"),
)
PICTURES = (".png", ".jpg", ".jpeg", ".tif", ".tiff")
MOST_EV, MOST_SHOTS = 20.0, 15


@dataclass(frozen=True)
class Photograph:
    """How pictures are photographed, developed and bracketed.

    Attributes:
        develops: Whether pictures are developed; else 1 is white.
        sensor: Sensor that takes the picture; None: a perfect one.
        iso: ISO as set; None: by the meter, or 100.
        meters: Way to meter; None: the ISO is set.
        ev: Compensation; what is not metered has it from the frame's facts.
        bracket: Exposures, EV, each with a picture; empty: one.
        look: Tone curve; None: neutral.
        seed: Seed of the noise.
        focus_at: Pixel that is in focus, if one was named: where the spot is metered.
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

    @classmethod
    def of_flags(
        cls,
        changes: dict[str, Any],
        exposure: str | None,
        bracket: str | None,
        look: str | None,
        seed: int,
    ) -> Photograph:
        """From flags, checked.

        Raises:
            UsageError: One is wrong, or does not go with another.
        """
        iso, sensor = changes.get("iso"), changes.get("sensor")
        if exposure is not None and iso is not None:
            raise UsageError("--exposure auto chooses the ISO: wanted either it or --iso, got both")
        if iso is not None and not iso > 0:
            raise UsageError(f"--iso: wanted a number above 0, got {iso:g}")
        if sensor is not None:
            from daguerre.exposure.expose import check_can_expose

            check_can_expose(sensor, iso)
        asked = any(name in changes for name in ASKING) or any((exposure, bracket, look))
        if look is not None:
            from daguerre.development.develop import Recipe

            Recipe(look=look)
        return cls(
            asked,
            sensor,
            iso,
            None if exposure is None else _meter_mode(exposure),
            changes.get("exposure_compensation", 0.0),
            () if bracket is None else _offsets(bracket),
            look,
            seed,
            changes.get("focus_at"),
        )

    def exposes(self, path: Path) -> bool:
        """Whether what is written there depends on exposure."""
        return _is_raw(path) or (self.develops and path.suffix.lower() in PICTURES)

    def files(self, path: Path) -> list[tuple[Path, float]]:
        """The pictures that an output stands for, and how they are exposed, EV."""
        if not self.bracket or not self.exposes(path):
            return [(path, 0.0)]
        return [
            (path.with_name(f"{path.stem}_{_name(ev)}{path.suffix}"), ev) for ev in self.bracket
        ]

    def check(self, metadata: dict[str, Any], paths: list[Path]) -> None:
        """Before anything is drawn: whether the camera's facts tell an exposure.

        Raises:
            InputError: They do not; the message names the field.
        """
        if not any(self.exposes(path) for path in paths):
            if self.meters or self.bracket:
                raise UsageError(
                    f"--{'exposure' if self.meters else 'bracket'}: wanted a picture with -o that "
                    f"is exposed (.dng, {', '.join(PICTURES)})"
                )
            return
        from daguerre.exposure.lux_seconds import luminance_exposure, pinhole_note

        luminance_exposure(metadata)
        if note := pinhole_note(metadata):
            console.note(note)
        if self.bracket:
            console.note("bracketed by time: motion blur is that of 0 EV")

    def metered(self, frame: Frame, paths: list[Path]) -> Frame:
        """The frame with the ISO that the meter chooses, if it is to; says which."""
        if not any(self.exposes(path) for path in paths) or self.meters is None:
            return frame
        from daguerre.exposure.metering import meter

        try:
            read = meter(frame, self.meters, at=self.focus_at)
        except DaguerreError as error:  # black, say: no reason to lose what was drawn
            console.warn(f"--exposure auto: {error}; exposed as set")
            return frame
        wanted = read.iso * 2.0**self.ev
        low, high = (1.0, 1e7) if self.sensor is None else self.sensor.iso_range
        iso = float(round(min(max(wanted, low), high), 0 if wanted > 50 else 2))
        compensated = f", {self.ev:+g} EV" if self.ev else ""
        console.note(
            f"metered ({read.mode}): {read.luminance:.3g} cd/m2, EV100 {read.ev100:.1f}; "
            f"ISO {iso:g}{compensated}"
        )
        if not low <= wanted <= high:
            console.warn(
                f"--exposure auto: ISO {wanted:.3g} is beyond {low:g} .. {high:g}: the picture is "
                f"{_stops(wanted, iso)}"
            )
        facts = {**frame.metadata, "isoSpeed": iso, "metering": read.mode}
        facts.pop("exposure_compensation", None)  # the ISO has it
        return replace(frame, metadata=facts)

    def write(self, frame: Frame, paths: list[Path], tone: str) -> None:
        """Writes outputs; each exposure is taken once, whatever its formats."""
        exposed = [path for path in paths if self.exposes(path)]
        for path in paths:
            if path not in exposed:
                frame.save(path, tone=tone)
        offsets = self.bracket or (0.0,)
        for offset in offsets if exposed else ():
            files = [file for path in exposed for file, ev in self.files(path) if ev == offset]
            # Messages about a bracket speak of one of its pictures.
            self._shoot(frame, offset, files, tell=offset == min(offsets, key=abs))

    def _shoot(self, frame: Frame, offset: float, files: list[Path], *, tell: bool) -> None:
        """One exposure into its files."""
        from daguerre.development import develop
        from daguerre.development.dng import size_note
        from daguerre.exposure.lux_seconds import with_exposure

        if offset:
            frame = replace(frame, metadata=with_exposure(frame.metadata, 2.0**offset))
        looks: dict[str, Any] = {} if self.look is None else {"look": self.look}
        raw = None
        if self.sensor is not None or any(_is_raw(file) for file in files):
            chosen = self.iso is not None or "metering" in frame.metadata
            iso = frame.metadata.get("isoSpeed") if chosen else None  # the sensor has its own
            raw = frame.expose(self.sensor, iso, seed=self.seed)
            for text in raw.notes if tell else ():
                console.note(text)
        for file in files:
            if raw is not None and _is_raw(file):
                raw.save(file)
                if tell and (remark := size_note(raw)):
                    console.note(f"{file}: {remark}")
            elif raw is not None and self.sensor is not None:
                develop(raw, **looks).save(file)
            else:
                develop(frame, **looks).save(file)


def _is_raw(path: Path) -> bool:
    return path.suffix.lower() == ".dng"


def _meter_mode(text: str) -> str:
    kind, _, mode = text.partition(":")
    if kind != "auto":
        raise UsageError(
            f"--exposure: wanted auto, auto:centre, auto:spot or auto:matrix; got {text!r}"
        )
    from daguerre.exposure.metering import check_mode

    return check_mode(mode or "centre", "--exposure auto")


def _offsets(text: str) -> tuple[float, ...]:
    wanted = f"exposures in EV such as -2,0,2, {MOST_SHOTS} at most"
    parts = text.split(",")
    if not 1 <= len(parts) <= MOST_SHOTS:
        raise UsageError(f"--bracket: wanted {wanted}; got {text!r}")
    found = tuple(q.plain_number("--bracket", part, wanted) for part in parts)
    if len({_name(ev) for ev in found}) < len(found) or max(map(abs, found)) > MOST_EV:
        raise UsageError(
            f"--bracket: wanted {wanted}, each once, within {MOST_EV:g} EV; got {text!r}"
        )
    return found


def _name(ev: float) -> str:
    return f"{ev:+.3g}ev" if ev else "0ev"


def _stops(wanted: float, iso: float) -> str:
    import math

    stops = math.log2(wanted / iso)
    return f"{abs(stops):.1f} EV too {'dark' if stops > 0 else 'bright'}"
