"""Focus, zoom, iris and film shift that change while the shutter is open.

An ideal lens or a projection has keys, with an error within the bound of
:mod:`daguerre.motion.resample`. The parameters of a projection's model change in steps that move
no point by more than twice ``MODEL_BLUR`` of a pixel. A thick or exact lens is set up in states;
each sample uses the state nearest in time. There are so many states that focusing and tilting miss
the true blur by less than ``STATE_BLUR`` of a pixel, and the iris turns and bends by less than 1 %
of its radius. The f-stop needs no states: the widest iris is closed to its size at each moment.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.cached import cached_property
from daguerre.camera.camera import Camera
from daguerre.camera.parameters.needs import TRACED
from daguerre.errors import UsageError
from daguerre.lenses.engraved import opened
from daguerre.motion.resample import resample

from .resolved import ResolvedLens

#: Blur error, px, that the focus of a state may have.
STATE_BLUR = 0.1
#: Error of an iris corner that a state may have, in radii.
_STATE_TURN = 0.01
MAX_STATES = 129
#: Blur error, px, for a projection's model. Its states are cheap, and ground truth uses them, too.
MODEL_BLUR = 0.01
MAX_MODELS = 513
_LOOKS = 1024
_IRIS = ("blades", "blade_rotation", "blade_curvature")
_LENS = (
    *("focal_length", "f_stop", "aperture_diameter", "focus_distance", "tilt", "zoom"),
    *("projection", *_IRIS),
)
_ACROSS = 9  # points across the picture at which the motion by a model is measured


@dataclass(frozen=True)
class LensMotion:
    """Changes of a lens within an exposure.

    Attributes:
        camera: Camera with its motion.
        changing: Names of the parameters that change within the interval.
        begin: Begin of the interval, s.
        end: End of the interval, s.
        lens: The lens at mid-exposure.
        make: Function that makes the lens of a camera without motion.
    """

    camera: Camera
    changing: set[str]
    begin: float
    end: float
    lens: ResolvedLens
    make: Callable[[Camera], ResolvedLens]

    def apply(self, frame: tuple[float, float], pitch: float) -> list[str]:
        """Applies the changes to the core's camera at mid-exposure.

        Args:
            frame: Size of the picture on the film, mm.
            pitch: Pixel pitch, mm.

        Returns:
            Notes on error bounds that are missed, and on lens models that are replaced.

        Raises:
            UsageError: A parameter changes that must be constant.
        """
        if "sensor_size" in self.changing:
            raise UsageError(
                "camera: sensor_size: cannot change while the shutter is open; change "
                "focal_length instead, or set shutter_time=0"
            )
        notes: list[str] = []
        if not self._in_states:
            if self.changing & {*_LENS}:
                notes = self._change_ideal()
        elif self.changing & {*_LENS, "shift"}:
            notes = self._change_states(frame, pitch)
        if "shift" in self.changing or (self._in_states and "f_stop" in self.changing):
            self._change_setting()
        return notes

    @property
    def _in_states(self) -> bool:
        """Whether the lens is set up in states; ideal lenses are interpolated."""
        return self.lens.model in (*TRACED, "thick")

    @cached_property
    def _still(self) -> Camera:
        """Camera at mid-exposure."""
        return self.camera.frozen_at(0.5 * (self.begin + self.end))

    def _at(self, time: float) -> Camera:
        """Camera at a time, with a known focus distance."""
        now = self.camera.frozen_at(time)
        distance = self.lens.focus_distance_m
        if "focus_distance" in self.changing or distance is None:
            return now
        known: dict[str, Any] = {"focus_on": None, "focus_at": None}
        if "zoom" in self.changing:  # which moves the pupil, while the film stays
            known |= {
                "focus_distance": distance + self.lens.film_offset_m(self._still.tilt),
                "focus_from": "sensor",
            }
        else:
            known |= {"focus_distance": distance, "focus_from": "pupil"}
        return replace(now, **known)

    def _fractions(self, times: Sequence[float]) -> NDArray[np.float32]:
        span = self.end - self.begin
        return np.array([(t - self.begin) / span for t in times], np.float32)

    def _looks(self) -> list[float]:
        """Moments at which the rate of change is measured."""
        even = self.begin + (self.end - self.begin) * np.arange(_LOOKS + 1) / _LOOKS
        return [float(t) for t in even]

    def _change_ideal(self) -> list[str]:
        made: dict[float, _core.Camera] = {}

        def lens(time: float) -> _core.Camera:
            if time not in made:
                made[time] = self.make(self._at(time)).core
            return made[time]

        watched = _Watched(lambda t: lens(t).lens_numbers, self.camera, self.changing)
        times, _ = resample(watched, self.begin, self.end)
        steps, needed = self._model_times()
        if self.changing & {*_IRIS}:
            steps = [*steps, *self._looks()[:: _LOOKS // (MAX_STATES - 1)]]
        if steps:
            times = sorted({*times, *steps})
        self.lens.core.change_lens(self._fractions(times), [lens(t) for t in times])
        return _too_many("projection: its parameters", needed, MAX_MODELS)

    def _model_times(self) -> tuple[list[float], int]:
        """Times of the models of a changing projection, and the number that the bound needs."""
        if "projection" not in self.changing:
            return [], 0
        models = [self.camera.motion["projection"].at(t) for t in self._looks()]
        if len({projection.parameters for projection in models}) == 1:
            return [], 0
        middle = models[_LOOKS // 2]
        ends = [np.linspace(-0.5, side - 0.5, _ACROSS) for side in middle.size]
        pixels = np.stack(np.meshgrid(*ends), axis=-1).reshape(-1, 2)
        ahead = middle.unproject(pixels)
        ahead = ahead[np.isfinite(ahead).all(axis=1)]
        places = np.array([p.core.project(ahead) for p in models]) * middle.focal
        moved = np.linalg.norm(np.diff(places, axis=0), axis=2)
        return self._spread(np.nan_to_num(moved).max(axis=1) / (2 * MODEL_BLUR), MAX_MODELS)

    def _change_states(self, frame: tuple[float, float], pitch: float) -> list[str]:
        cameras = [self._at(t) for t in self._looks()]
        widest = min(self._stop(c) for c in cameras)
        shifts = np.abs([c.shift for c in cameras]).max(axis=0)
        reach = math.hypot(*(size / 2 + s for size, s in zip(frame, shifts, strict=True)))
        times, needed = self._state_times(cameras, reach, widest, STATE_BLUR * pitch)
        states = [
            replace(
                self._at(t), f_stop=widest, t_stop=None, shift=(float(shifts[0]), float(shifts[1]))
            )
            for t in times
        ]
        with ThreadPoolExecutor() as pool:
            made = list(pool.map(self.make, states))
        self.lens.core.change_lens(self._fractions(times), [lens.core for lens in made])
        notes = _too_many("lens: its focus and iris", needed, MAX_STATES)
        models = [lens.model for lens in made]
        if "polynomial" in models and "exact" in models:
            notes.append(
                f"polynomials fit {models.count('exact')} of the {len(models)} states of the lens "
                "poorly: the exact lens is used for these"
            )
        return notes

    def _stop(self, camera: Camera) -> float:
        if "f_stop" in self.changing and camera.f_stop is not None:
            stop = float(camera.f_stop)
            return stop if self.lens.glass is None else opened(stop, self.lens.widest_stop)
        assert self.lens.f_stop is not None  # an exact lens has an f-stop
        return self.lens.f_stop

    def _state_times(
        self, cameras: list[Camera], reach: float, stop: float, blur_mm: float
    ) -> tuple[list[float], int]:
        """Times of the states, and the number that the bounds need.

        Focusing at s moves the film by about f^2 / s; a state serves equally to either side of it.
        Tilting moves the surface of focus by as much as the film's edge turns (``reach`` from the
        axis); zooming moves the image there.
        """
        film_mm = blur_mm * stop
        # inf counts as 0, so does a focus that stays
        inverse = [1e-3 / c.focus_distance if c.focus_distance else 0.0 for c in cameras]
        steps = self.lens.effective_focal_length_mm**2 * np.abs(np.diff(inverse)) / (2 * film_mm)
        tilts = np.radians([c.tilt for c in cameras])
        steps += reach * np.abs(np.diff(tilts, axis=0)).sum(axis=1) / (2 * film_mm)
        zooms = np.log([c.zoom or 1.0 for c in cameras])
        steps += reach * np.abs(np.diff(zooms)) / (2 * blur_mm)
        turns = np.radians([c.blade_rotation for c in cameras])
        bends = np.array([c.blade_curvature for c in cameras])
        blades = np.diff([c.blades for c in cameras]) != 0
        steps += (np.abs(np.diff(turns)) + np.abs(np.diff(bends))) / (2 * _STATE_TURN) + 2 * blades
        return self._spread(steps, MAX_STATES)

    def _spread(self, steps: NDArray[np.float64], most: int) -> tuple[list[float], int]:
        """Times of states that share the total change evenly, in units of one state's bound."""
        way = np.concatenate([[0.0], np.cumsum(steps)])
        if not way[-1] > 0:
            return [0.5 * (self.begin + self.end)], 1
        needed = int(np.ceil(way[-1]))
        count = min(needed, most)
        middles = way[-1] * (np.arange(count) + 0.5) / count
        return [float(t) for t in np.interp(middles, way, self._looks())], needed

    def _change_setting(self) -> None:
        """Sets iris radius (relative to the widest) and film shift of an exact lens over time."""
        core, exact, middle = self.lens.core, self._in_states, self._still.shift
        widest = min(self._stop(self._at(t)) for t in self._looks()) if exact else 1.0

        def setting(time: float) -> tuple[float, float, float]:
            now = self._at(time)
            opening = widest / self._stop(now) if exact else 1.0
            return opening, now.shift[0] - middle[0], now.shift[1] - middle[1]

        times, values = resample(
            _Watched(setting, self.camera, self.changing), self.begin, self.end
        )
        table = np.array(values, np.float32)
        openings = np.ascontiguousarray(np.minimum(1, table[:, 0]))
        core.change_setting(self._fractions(times), openings, np.ascontiguousarray(table[:, 1:]))


def _too_many(what: str, needed: int, most: int) -> list[str]:
    if needed <= most:
        return []
    return [f"{what} change so much that they need {needed} states; {most} are used"]


@dataclass(frozen=True)
class _Watched:
    """Values computed from parameters that change, as a value over time."""

    value: Callable[[float], Any]
    camera: Camera
    names: set[str]

    def at(self, time_s: float) -> Any:
        return self.value(time_s)

    def breaks(self, begin: float, end: float) -> list[float]:
        parts = [self.camera.motion[name].breaks(begin, end) for name in self.names]
        return sorted({float(t) for part in parts for t in part})
