"""Cameras of a call, a single camera or a rig, and the names of their files.

All cameras use the same random numbers, so each picture is bit-identical to a call with that camera
alone.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre import units as q
from daguerre.camera.placement import Placement
from daguerre.errors import UsageError
from daguerre.rendering import picture
from daguerre.rendering.names import CAMERA
from daguerre.rendering.parameters import DEFAULT

if TYPE_CHECKING:
    from daguerre.calibration import Calibration
    from daguerre.camera.camera import Camera
    from daguerre.cli.flags.calibration import CalibrationFlags
    from daguerre.plates.match.plate_camera import PlateCamera
    from daguerre.scene.scene import Scene

SIDES = {"left": -0.5, "right": 0.5}


@dataclass(frozen=True)
class CallView:
    """One camera of a call.

    Attributes:
        name: Name in files and progress; empty: a single camera.
        camera: Name of the scene's camera; None: the default camera.
        calibration: Calibration that replaces its lens.
        shift: Shift to the right of that camera's position, m.
    """

    name: str = ""
    camera: str | None = None
    calibration: Calibration | None = None
    shift: float = 0.0

    def view(self, cameras: Cameras) -> picture.View:
        """Makes the view for a job."""

        def unshifted(scene: Scene) -> Camera:
            given = cameras.placed(scene, self.camera)
            found: Camera = cameras.flags.camera(given, self.calibration, cameras.changes)
            return found

        def camera(scene: Scene) -> Camera:
            if not self.shift:
                return unshifted(scene)
            from daguerre.setup.pose import moved_right

            return moved_right(unshifted(scene), self.shift)

        def notes(camera: Camera) -> list[str]:
            found = cameras.flags.notes(camera, self.calibration)
            if not self.shift < 0:  # once for a pair
                return found
            from daguerre.setup.stereo import stereo_note

            note = stereo_note(camera)
            return [*found, note] if note else found

        return picture.View(self.name, camera, notes, unshifted)


@dataclass(frozen=True)
class Cameras:
    """Flags of the cameras of a call.

    Attributes:
        names: Value of ``--camera``.
        flags: Calibrations that replace lenses.
        changes: Parameters that the command line changes.
        placement: Position and direction from the command line.
        plate: Camera of a photograph, which has the default size; None: no photograph.
        start: Time of frame 0, s.
    """

    names: str | None
    flags: CalibrationFlags
    changes: dict[str, Any]
    placement: Placement = field(default_factory=Placement)
    plate: PlateCamera | None = None
    start: float = 0.0

    def views(self, stereo: str | None) -> list[CallView]:
        """Views of the cameras, with both views of a stereo pair."""
        found = {name: c.starting(self.start) for name, c in self.flags.found.items()}
        views = views_of(self.names, found, stereo)
        if self.placement.given and len({view.camera for view in views}) > 1:
            raise UsageError("--position, --look-at, --roll: wanted one --camera, got several")
        return views

    def placed(self, scene: Scene, name: str | None) -> Camera:
        """Returns the scene's camera of a name at its place; a placed one needs none to be there.

        Raises:
            InputError: There is no such camera.
        """
        from daguerre.camera.camera import Camera

        bare = name is None and scene.default_camera is None and self.placement.complete
        return self.placement.of(Camera() if bare else scene.camera(name))

    def check_frames(
        self, pictures: Sequence[picture.Picture], stereo: str | None, scene: Scene
    ) -> None:
        """Checks that tracked cameras have a pose at all frames.

        Raises:
            InputError: A camera has no pose at a frame; the message names the frame.
        """
        calibrated = {view.name: view.calibration for view in self.views(stereo)}
        rates: dict[str, float] = {}
        for one in pictures:
            name, found = one.view.name, calibrated[one.view.name]
            if found is not None:
                fps = rates.setdefault(name, one.view.camera(scene).fps)
                found.check(one.frame, scene.time + (one.frame or 0) / fps, fps)

    def size(self, view: CallView, res: str | None, scene: Scene | None = None) -> tuple[int, int]:
        """Size of a camera's picture, px; None: the scene's file, which may set it, is not read.

        Raises:
            InputError: The scene has no such camera.
        """
        usual: tuple[int, int] = DEFAULT["resolution"]
        if self.plate is not None:
            usual = self.plate.resolution
        elif scene is not None and scene.film_sizes:
            usual = scene.film_size(view.camera) or usual
        return self.flags.resolution(view.calibration, res, usual)


def views_of(
    camera: str | None, calibrations: Mapping[str, Calibration], stereo: str | None
) -> list[CallView]:
    """Views of ``--camera``, ``--calibration`` and ``--stereo``.

    Raises:
        UsageError: More than one of them gives several cameras.
    """
    names = [None] if camera is None else _names(camera)
    several = {
        "--camera": len(names) > 1,
        "--calibration": len(calibrations) > 1,
        "--stereo": stereo is not None,
    }
    asking = [flag for flag, yes in several.items() if yes]
    if len(asking) > 1:
        raise UsageError(
            f"{' and '.join(asking)}: wanted one of them, got both; each stands for several cameras"
        )
    if stereo is not None:
        baseline = q.distance_m("--stereo", stereo)
        if not 0 < baseline < 1e6:
            raise UsageError(f"--stereo: wanted a distance above 0 and below 1e6 m, got {stereo!r}")
        only = next(iter(calibrations.values()), None)
        return [CallView(name, names[0], only, side * baseline) for name, side in SIDES.items()]
    if len(calibrations) > 1:
        return [CallView(name, names[0], one) for name, one in calibrations.items()]
    for name, one in calibrations.items():
        return [CallView(each or name, each, one) for each in names]
    return [CallView(each or "", each) for each in names]


def _names(text: str) -> list[str]:
    r"""Splits names at commas; a comma within a name is written ``\,``."""
    names = [part.replace("\\,", ",").strip() for part in re.split(r"(?<!\\),", text)]
    if "" in names:
        raise UsageError(f"--camera: wanted names between commas, got {text!r}")
    if twice := [name for name in names if names.count(name) > 1]:
        raise UsageError(f"--camera: {twice[0]!r} appears twice")
    return names


def check_places(outputs: list[Path], views: list[CallView]) -> None:
    """Checks that ``{camera}`` in file names has named cameras.

    Raises:
        UsageError: The only camera of this call has no name, or the placeholder is misspelt.
    """
    for path in outputs:
        for place in re.findall(r"\{[^{}]*\}", str(path)):
            if place != CAMERA:
                raise UsageError(f"-o {path}: wanted {CAMERA}, got {place}")
        if CAMERA in str(path) and not views[0].name:
            raise UsageError(
                f"-o {path}: {CAMERA} stands for the name of a camera and needs --camera, "
                "--calibration or --stereo"
            )
