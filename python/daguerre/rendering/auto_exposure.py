"""Automatic exposure: a meter renders a small picture, and sets ISO, time or f-stop.

The picture of the meter has its own size, samples and seed, so the reading depends only on the
scene, the camera and the shape of the picture.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

from daguerre.camera.camera import Camera
from daguerre.camera.exposure import check_exposure
from daguerre.camera.exposure_mode import LIGHT, split_pattern
from daguerre.camera.shutter import shutter_time
from daguerre.errors import UsageError
from daguerre.exposure.auto_iso import automatic_iso, iso_limits
from daguerre.exposure.lux_seconds import luminance_exposure
from daguerre.exposure.meter_words import NO_LIGHT, missing, reading
from daguerre.exposure.metering import luminance_of, wanted_lux_s
from daguerre.scene.scene import Scene
from daguerre.setup.metadata import camera_metadata

from .backdrop import check_backdrop
from .meter_picture import meter_picture, metered_point
from .pixels import at_size
from .prepare import Prepared, prepare
from .settings import RenderSettings

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame
    from daguerre.setup.built_scene import BuiltScene

#: Longer side of the meter's picture, px, and its samples per pixel.
SIDE, SAMPLES = 96, 16
#: Limits of the time and stop that a meter chooses; the lens has the widest stop.
TIMES_S, MOST_STOP = (1 / 8000, 1 / 15), 22.0
#: P opens the lens wholly up to this time; for more light it closes the stop and shortens the time
#: by equal steps, up to this stop.
PROGRAM_S, PROGRAM_STOP = 1 / 60, 16.0
#: Steps that find the f-stop of an exposure, as glass vignettes and its pupil is no disk.
_STEPS = 4
#: Maximum number of further pictures after the meter chose a stop, as vignetting may differ there.
_LOOKS = 2


class _Choice(NamedTuple):
    """Exposure by a mode.

    Attributes:
        changes: Parameters of ``Camera``.
        flags: Flags of the command line that set time and stop.
        lux_s: Luminance exposure of a value of 1, times the ISO.
    """

    changes: dict[str, Any]
    flags: str
    lux_s: float


@dataclass(frozen=True)
class Chosen:
    """Exposure that a meter chose.

    Attributes:
        changes: Parameters of ``Camera``.
        words: Flags of the command line that set the same.
        facts: Metadata for frames.
        ev: Compensation that the choice includes, EV.
        note: Reading and choice of the meter, in words.
        missing: Stops that the limits leave missing, in words.
        warning: The same with the mode, or why another mode was chosen.
    """

    changes: Mapping[str, Any]
    words: str
    facts: Mapping[str, Any] = field(default_factory=dict)
    ev: float = 0.0
    note: str = ""
    missing: str = ""
    warning: str = ""

    def of(self, camera: Camera) -> Camera:
        """Returns a camera with this exposure."""
        left = {"exposure_compensation": camera.exposure_compensation - self.ev} if self.ev else {}
        return camera.with_(**self.changes, **left)


def choose(
    scene: Scene,
    camera: Camera,
    settings: RenderSettings,
    built: BuiltScene | None = None,
    look: Callable[[Prepared], Frame] = meter_picture,
) -> tuple[Chosen, BuiltScene]:
    """Meters a scene for a camera in an automatic mode; returns the scene built for it, too.

    Args:
        scene: The scene.
        camera: The camera.
        settings: Settings of the picture, of which the meter takes size and threads.
        built: The scene built for another picture.
        look: Takes the meter's picture, or returns the same from before.

    Raises:
        UsageError: The mode chooses a parameter that the lens does not have, or the spot is not in
            the picture.
        InputError: The scene or the lens cannot be used.
    """
    check_backdrop(scene, settings, camera.exposure)
    meter = _Meter(scene, camera, settings, built, look)
    if not meter.luminance > 0:
        dark = Chosen({"exposure": LIGHT}, f"--exposure {LIGHT}", warning=NO_LIGHT)
        return dark, meter.prepared.built
    return meter.chosen(), meter.prepared.built


class _Meter:
    """A small picture of the whole frame, and the camera that took it."""

    def __init__(
        self,
        scene: Scene,
        camera: Camera,
        settings: RenderSettings,
        built: BuiltScene | None,
        look: Callable[[Prepared], Frame],
    ) -> None:
        check_exposure(camera)
        self.look = look
        self.mode, self.pattern = camera.exposure, camera.meter
        self.scene, self.camera = scene, camera.with_(exposure="manual")
        whole = settings.film.resolution
        scale = SIDE / max(whole)
        size = max(round(whole[0] * scale), 1), max(round(whole[1] * scale), 1)
        self.settings = RenderSettings.of(resolution=size, spp=SAMPLES, threads=settings.threads)
        placed = at_size(self.camera, whole, size)
        self.prepared = prepare(scene, placed, self.settings, built)
        self.point = metered_point(self.prepared, self.pattern, whole)
        self.luminance = self._read(self.prepared)

    def _read(self, prepared: Prepared) -> float:
        return luminance_of(self.look(prepared), split_pattern(self.pattern)[0], self.point)

    def chosen(self) -> Chosen:
        """Exposure by the mode."""
        moving = "exposure_compensation" in self.camera.motion
        ev = 0.0 if moving else self.camera.exposure_compensation
        choice: Callable[[float], _Choice] = {
            "auto": self._iso, "A": self._time, "S": self._stop, "P": self._program
        }[self.mode]  # fmt: skip
        found = choice(wanted_lux_s(self.luminance, ev))
        for _ in range(_LOOKS if "f_stop" in found.changes else 0):
            self.luminance = self._read(self._with(f_stop=found.changes["f_stop"]))
            found = choice(wanted_lux_s(self.luminance, ev))
        iso = found.changes.get("iso", self.camera.iso)
        told = f"--exposure manual --iso {iso:g}{found.flags}{' --ev 0' if ev else ''}"
        left = missing(self._ends(), found.lux_s / wanted_lux_s(self.luminance, ev))
        return Chosen(
            {"exposure": "manual", **found.changes},
            told,
            {"exposure": self.mode, "metering": self.pattern},
            ev,
            reading(self.pattern, self.luminance, ev, told),
            left,
            left and f"exposure {self.mode}: {left}",
        )

    def _ends(self) -> str:
        """Limits of the mode, in words."""
        if self.mode == "auto":
            low, high = self._isos()
            return f"ISO {low:g} .. {high:g}"
        times = f"1/{1 / TIMES_S[0]:g} .. 1/{1 / TIMES_S[1]:g} s"
        if self.mode == "A":
            return times
        most = MOST_STOP if self.mode == "S" else PROGRAM_STOP
        openings = f"f/{self._widest():.3g} .. f/{most:g}"
        return openings if self.mode == "S" else f"{times} and {openings}"

    def _with(self, **changes: object) -> Prepared:
        """Prepares the meter's picture with other parameters of the camera."""
        camera = self.prepared.camera.with_(**changes)
        return prepare(self.scene, camera, self.settings, self.prepared.built)

    def _lux_s(self, **changes: object) -> float:
        """Luminance exposure of a value of 1 by the camera with other parameters, lux s."""
        prepared = self._with(**changes) if changes else self.prepared
        return luminance_exposure(
            camera_metadata(prepared.camera, prepared.setup, prepared.size[0])
        )

    def _isos(self) -> tuple[float, float]:
        return iso_limits(self.prepared.sensor)

    def _iso(self, wanted: float) -> _Choice:
        lux_s = self._lux_s()
        iso = automatic_iso(wanted / lux_s, self._isos())
        return _Choice({"iso": iso}, "", iso * lux_s)

    def _time(self, wanted: float) -> _Choice:
        now = shutter_time(self.prepared.camera)
        per_s = self.prepared.camera.iso * self._lux_s() / now
        time, words = _short(min(max(wanted / per_s, TIMES_S[0]), TIMES_S[1]))
        return _Choice({"shutter_time": time}, f" --shutter {words}", per_s * time)

    def _stop(self, wanted: float) -> _Choice:
        stop = self._stop_for(wanted, (self._widest(), MOST_STOP))
        lux_s = self.prepared.camera.iso * self._lux_s(f_stop=stop)
        return _Choice({"f_stop": stop}, f" --f-stop {stop:g}", lux_s)

    def _stop_for(self, wanted: float, ends: tuple[float, float]) -> float:
        """F-stop of an exposure within its ends, to three digits."""
        iso, stop = self.prepared.camera.iso, self._now()
        for _ in range(_STEPS):
            got = iso * self._lux_s(f_stop=stop)
            stop = min(max(stop * math.sqrt(got / wanted), ends[0]), ends[1])
        rounded = float(f"{stop:.3g}")
        return min(max(rounded, ends[0]), ends[1])

    def _program(self, wanted: float) -> _Choice:
        camera, widest = self.prepared.camera, self._widest()
        open_lux = camera.iso * self._lux_s(f_stop=widest) / shutter_time(camera)
        stops = math.log2(open_lux * PROGRAM_S / wanted)  # above 0: more light than it needs
        stop = float(f"{min(widest * 2 ** (max(stops, 0.0) / 4), PROGRAM_STOP):.3g}")
        stop = max(stop, widest)
        per_s = camera.iso * self._lux_s(f_stop=stop) / shutter_time(camera)
        time, words = _short(min(max(wanted / per_s, TIMES_S[0]), TIMES_S[1]))
        changes = {"shutter_time": time, "f_stop": stop}
        return _Choice(changes, f" --shutter {words} --f-stop {stop:g}", per_s * time)

    def _now(self) -> float:
        stop = self.prepared.setup.lens.f_stop
        if stop is None:
            raise UsageError(
                f"exposure {self.mode} chooses the f-stop, but a pinhole has none; use auto or A"
            )
        return float(stop)

    def _widest(self) -> float:
        self._now()
        widest = self.prepared.setup.lens.widest_stop
        return math.ceil(round(widest * 1000, 6)) / 1000  # not wider than it is, in four digits


def _short(time: float) -> tuple[float, str]:
    """Time near another that a text gives exactly, and the text: 1/N s or seconds."""
    below = float(f"{1 / time:.3g}")
    return 1 / below, f"1/{below:g}"
