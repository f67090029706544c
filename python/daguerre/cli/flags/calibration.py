"""Flags of a calibration that replaces a lens.

Annotations must be real objects here (see ``groups.py``), so no ``annotations`` future.
"""

from collections.abc import Iterable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from daguerre import units as q
from daguerre.cached import cached_property
from daguerre.camera.ideal import WITHOUT_IRIS
from daguerre.camera.parameters import CAMERA
from daguerre.cli import console
from daguerre.files.reading import exists

from .groups import Text, option

if TYPE_CHECKING:
    from daguerre.calibration.calibration import Calibration
    from daguerre.camera.camera import Camera


_CALIBRATION = "Calibration"


@dataclass(frozen=True)
class CalibrationFlags:
    """Cameras given by their calibration."""

    calibration: Annotated[
        list[str] | None,
        option(
            "--calibration",
            metavar="FILE[:NAME,...|all]",
            help="Camera calibration to use instead of a lens: a file of OpenCV, ROS, Kalibr, "
            "OpenTrackIO, COLMAP, EuRoC, camodocal, basalt, BOP or KITTI, or transforms.json. "
            ":NAME picks cameras of the file, :all takes all; # in NAME stands for the frame "
            "number; repeatable [the file's first camera].",
            panel=_CALIBRATION,
        ),
    ] = None
    pixel_pitch: Annotated[
        Text,
        option(
            "--pixel-pitch",
            metavar="UM",
            help="Pixel pitch of the calibrated sensor, um; blur depends on it [the file's, else "
            "from --sensor].",
            panel=_CALIBRATION,
        ),
    ] = None

    calibration_size: Annotated[
        Text,
        option(
            "--calibration-size",
            metavar="WxH",
            help="Picture size of the calibration, px, if the file does not state it.",
            panel=_CALIBRATION,
        ),
    ] = None
    calibration_unit: Annotated[
        Text,
        option(
            "--calibration-unit",
            metavar="M",
            help="Length unit of an OpenCV stereo pair, a COLMAP model or transforms.json, such as "
            "25mm [1 m].",
            panel=_CALIBRATION,
        ),
    ] = None
    calibration_model: Annotated[
        Text,
        option(
            "--calibration-model",
            metavar="opencv|fisheye",
            help="Projection model of an OpenCV file that does not state it [opencv].",
            panel=_CALIBRATION,
        ),
    ] = None
    rectified: Annotated[
        bool,
        option(
            "--rectified",
            help="Use the camera after rectification: P of a ROS file or an OpenCV stereo pair.",
            panel=_CALIBRATION,
        ),
    ] = False
    timeshift: Annotated[
        bool,
        option(
            "--timeshift",
            help="Delay each shutter of a Kalibr chain by timeshift_cam_imu minus that of cam0.",
            panel=_CALIBRATION,
        ),
    ] = False

    @cached_property
    def found(self) -> dict[str, Any]:
        """Calibrations by name, read once; none without the flag."""
        from daguerre.errors import UsageError

        if not self.calibration:
            for name in (f.name for f in fields(self)):
                if getattr(self, name):
                    flag = "--" + name.replace("_", "-")
                    raise UsageError(f"{flag} needs --calibration")
            return {}
        found: dict[str, Any] = {}
        for text in self.calibration:
            for name, one in _read(text, self._options).items():
                if name in found:
                    raise UsageError(
                        f"--calibration {text}: wanted cameras with different names, got {name!r} "
                        "twice (the only camera of a file is named after the file)"
                    )
                found[name] = one
        return found

    @property
    def _options(self) -> dict[str, Any]:
        """Options of the reader."""
        size, unit = self.calibration_size, self.calibration_unit
        options: dict[str, Any] = {"model": self.calibration_model, "rectified": self.rectified}
        if size is not None:
            options["size"] = q.resolution("--calibration-size", size, (0, 0))
        if unit is not None:
            options["unit_m"] = q.unit_m("--calibration-unit", unit)
        return options

    def resolution(
        self, calibration: "Calibration | None", res: str | None, default: tuple[int, int]
    ) -> tuple[int, int]:
        """Size of the picture, px: from ``--res``, else from the calibration, else the default."""
        size = default if calibration is None else calibration.projection.size
        if not res:
            return size
        columns, rows = q.resolution("--res", res, size)
        if calibration is not None and "%" in res:  # its shape, whatever was rounded
            rows = max(1, round(columns * size[1] / size[0]))
        return columns, rows

    def check(self, changes: dict[str, Any]) -> None:
        """Checks that flags of a lens are not given with a calibration, which replaces it.

        Raises:
            UsageError: Both are given; the message names the flags.
        """
        from daguerre.errors import UsageError

        if not self.found:
            return
        both = [
            row.flag
            for row in CAMERA.flagged
            if row.name in changes and not row.takes("projection")
        ]
        if changes.get("lens") in WITHOUT_IRIS:  # no iris: all is sharp
            both.remove("--lens")
            if "f_stop" in changes:
                raise UsageError(
                    f"--lens {changes['lens']} and --f-stop: wanted one of them, got both"
                )
        if self.pixel_pitch is not None and {"sensor", "sensor_size"} & set(changes):
            raise UsageError("--pixel-pitch and --sensor: wanted one of them, got both")
        if both:
            raise UsageError(f"--calibration and {both[0]}: wanted one of them, got both")

    def camera(
        self, camera: "Camera", calibration: "Calibration | None", changes: dict[str, Any]
    ) -> "Camera":
        """Returns the scene's camera, with the calibration (if not None) and changes."""
        if calibration is not None:
            pitch = self.pixel_pitch
            um = None if pitch is None else q.pitch_um("--pixel-pitch", pitch)
            rate = {"fps": changes["fps"]} if "fps" in changes else {}
            camera = calibration.camera(camera.with_(**rate), um)
            if changes.get("lens") in WITHOUT_IRIS:
                changes = {name: value for name, value in changes.items() if name != "lens"}
                camera = camera.with_(f_stop=None)
        camera = camera.with_(**changes)
        if not self.timeshift or calibration is None:
            return camera
        from daguerre.calibration.calibration import delayed

        return delayed(camera, calibration.delay_s)

    def notes(self, camera: "Camera", calibration: "Calibration | None") -> list[str]:
        """Decisions made on the user's behalf, a sentence each."""
        if calibration is None:
            return []
        from daguerre.calibration.calibration import field_notes

        notes = [*calibration.notes, *field_notes(calibration.projection)]
        if self.timeshift and not any(one.delay_s for one in self.found.values()):
            notes.append("--timeshift has no effect: all cameras have the same timeshift_cam_imu")
        if camera.f_stop is not None and self.pixel_pitch is None and not calibration.pixel_pitch:
            notes.append(
                f"no --pixel-pitch: blur is computed for a sensor {camera.sensor_size[0]:g} mm wide"
            )
        return notes


def _read(text: str, options: dict[str, Any]) -> dict[str, Any]:
    """Reads ``FILE`` (its first camera), ``FILE:cam0,cam1`` (these) or ``FILE:all``."""
    from daguerre.calibration import pick, read_all
    from daguerre.errors import UsageError

    if not text:  # as of a variable of a shell that is not set: not the folder, which "" is, too
        raise UsageError("--calibration: wanted a file, got ''")

    file, _, names = text.rpartition(":")
    if not file or exists(Path(text)) or not exists(Path(file)):
        file, names = text, ""
    known = read_all(file, **options)
    if names == "all" and "all" not in known:
        return known
    if not names:
        first = next(iter(known))
        if len(known) > 1:
            hint = ":all uses all; # in a name stands for the frame number"
            console.note(f"{file} has {_some(known)}; using {first} ({hint})")
        return {first: known[first]}
    wanted = [names] if names in known else [name.strip() for name in names.split(",")]
    if twice := [name for name in wanted if wanted.count(name) > 1]:
        raise UsageError(f"--calibration {text}: {twice[0]!r} appears twice")
    found: dict[str, Any] = {}
    for name in wanted:
        one = pick(known, name, file)
        label = name if name in known else one.name
        if label in found:
            raise UsageError(f"--calibration {text}: wanted different names, got {label!r} twice")
        found[label] = one
    return found


def _some(names: Iterable[str]) -> str:
    """Names between commas; if there are many, the first of them."""
    listed = list(names)
    more = f" and {len(listed) - 8} more" if len(listed) > 8 else ""
    return ", ".join(listed[:8]) + more
