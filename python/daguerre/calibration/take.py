"""Takes of a moving camera: a calibration for each of several moments or frames.

Between them the camera moves and turns at constant speed, so that pictures have motion blur and
rolling shutter. Poses come from OpenTrackIO by time, and from pictures of COLMAP and
``transforms.json`` by the number in their names.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from typing import Any, Self

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.checks import number
from daguerre.errors import InputError, UsageError
from daguerre.files.numbered import PLACE, numbers_in, with_number
from daguerre.motion.values import keys

from .calibration import Calibration

#: Parameters of a camera that may change during a take.
CHANGING = ("projection", "transform", "f_stop", "focus_distance")


@guarded
@dataclass(frozen=True)
class Take(Calibration):
    """Calibrations of a camera over time; as a ``Calibration`` it is the first of them.

    Attributes:
        samples: Times, s, ascending, and the calibration at each; with a pattern frame numbers.
        pattern: Name of the pictures with # for the frame number; empty: samples are by time.
        file: Name of the file, for messages.
        start: Time of frame 0, s.
    """

    samples: tuple[tuple[float, Calibration], ...] = ()
    pattern: str = ""
    file: str = "calibration"
    start: float = 0.0

    def _moved(self, camera: Camera) -> Camera:
        """Returns the camera with this motion; the frame rate is the camera's."""
        return camera.with_(**self._changes(camera.fps))

    def starting(self, time_s: float) -> Self:
        """Returns the take with frame 0 at another time, s; takes by time are not changed."""
        return replace(self, start=time_s) if self.pattern else self

    def check(self, frame: int | None, time_s: float, fps: float) -> None:
        """Checks that the take has a pose for a frame.

        Args:
            frame: Frame number; None: not a sequence.
            time_s: Time of the frame in the scene, s.
            fps: Frames per second.

        Raises:
            UsageError: A pattern needs a frame number, and there is none.
            InputError: The frame is outside the take.
        """
        first, last = self.samples[0][0], self.samples[-1][0]
        if self.pattern and frame is None:
            raise UsageError(
                f"--calibration {self.file}:{self.pattern}: # in the name needs --frames"
            )
        if self.pattern and frame not in {moment for moment, _ in self.samples}:
            raise InputError(
                f"{self.file}: frame {frame}: no pose for "
                f"{with_number(self.pattern, frame or 0)}; the take has "
                f"{len(self.samples)} frames of {first:g} .. {last:g}"
            )
        number(fps, f"{self.file}: fps", above=0)
        if not self.pattern and not first - 0.5 / fps <= time_s <= last + 0.5 / fps:
            which = "the picture" if frame is None else f"frame {frame}"
            raise InputError(
                f"{self.file}: {which} is at {time_s:.6g} s: wanted a time of the take, "
                f"{first:g} .. {last:.6g} s (--time moves frames)"
            )

    def _changes(self, fps: float) -> dict[str, Any]:
        """Returns keys of the parameters that change."""
        found: dict[str, Any] = {}
        for name in CHANGING:
            known = [
                (self.start + moment / fps if self.pattern else moment, value)
                for moment, one in self.samples
                if (value := _fact(one, name)) is not None
            ]
            if any(not np.array_equal(value, known[0][1]) for _, value in known):
                found[name] = keys(known)
        return found


def _fact(one: Calibration, name: str) -> Any:
    return one.projection if name == "projection" else one.settings.get(name)


def take_of(cameras: Mapping[str, Calibration], pattern: str, file: str) -> Take:
    """Makes the take of pictures with frame numbers in their names.

    Args:
        cameras: Calibrations by names of pictures.
        pattern: Name with # for the frame number.
        file: Name of their file, for messages.

    Raises:
        UsageError: No picture matches the pattern.
    """
    found = numbers_in(cameras, pattern)
    if not found:
        names = list(cameras)
        more = f" and {len(names) - 4} more" if len(names) > 4 else ""
        raise UsageError(
            f"{file}: wanted pictures named {pattern}, got {', '.join(names[:4])}{more}"
        )
    samples = tuple((float(n), cameras[name]) for n, name in found.items())
    first = samples[0][1]
    return Take(
        first.projection,
        label(pattern),
        first.rig_from_camera,
        first.pixel_pitch,
        first.settings,
        first.notes,
        samples=samples,
        pattern=pattern,
        file=file,
    )


def label(pattern: str) -> str:
    """Name of a camera from its pictures' pattern, without number and suffix."""
    bare = PLACE.sub("", str(PurePosixPath(pattern).with_suffix("")), count=1)
    return re.sub(r"[\W_]+$", "", bare) or "camera"
