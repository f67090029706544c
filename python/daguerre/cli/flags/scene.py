"""Flags of the scene: its file, environment, catchers, plate.

Annotations must be real objects here (see ``groups.py``), so no ``annotations`` future.
"""

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from daguerre import units as q
from daguerre.rendering.names import has_frame, numbered
from daguerre.scene.catcher import EFFECTS

from .groups import Text, option
from .scene_file import SceneFileFlags

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from daguerre.camera.camera import Camera
    from daguerre.scene.scene import Scene


_LIGHT = "Light and scene"


@dataclass(frozen=True)
class SceneFlags(SceneFileFlags):
    """Flags of the scene, its light and its plate."""

    env: Annotated[
        Path | None,
        option(
            "--env",
            metavar="FILE",
            help="Environment map (.hdr, .exr) around the scene.",
            panel=_LIGHT,
        ),
    ] = None
    env_scale: Annotated[
        float | None,
        option(
            "--env-scale",
            metavar="X",
            help="Luminance of a value of 1 in --env, cd/m2 [1].",
            panel=_LIGHT,
        ),
    ] = None
    env_lux: Annotated[
        Text,
        option(
            "--env-lux",
            metavar="LUX",
            help="Illuminance of the ground by --env or --sky, lux, instead of --env-scale.",
            panel=_LIGHT,
        ),
    ] = None
    env_rotation: Annotated[
        Text,
        option(
            "--env-rotation",
            metavar="DEG",
            help="Rotation of --env about the vertical, degrees [0].",
            panel=_LIGHT,
        ),
    ] = None
    sky: Annotated[
        Text,
        option(
            "--sky", metavar="R,G,B", help="Uniform sky of this luminance, cd/m2.", panel=_LIGHT
        ),
    ] = None
    catcher: Annotated[
        list[str] | None,
        option(
            "--catcher",
            metavar="NODE[:EFFECTS]",
            help="Node (`daguerre info` lists names) that stands in for something in the plate: "
            "it catches shadow,reflection,gi of objects as a layer [all three], or only hides "
            "what is behind it (holdout); repeatable.",
            panel=_LIGHT,
        ),
    ] = None
    plate: Annotated[
        Path | None,
        option(
            "--plate",
            metavar="PHOTO",
            help="Photograph of the set, projected onto the catchers for mirrors, glass and "
            "bounced light; # in its name stands for the frame number.",
            panel=_LIGHT,
        ),
    ] = None
    plate_camera: Annotated[
        Path | None,
        option(
            "--plate-camera",
            metavar="FILE",
            help="Calibration of the camera that took --plate, placed where the scene's camera "
            "stands [the camera that renders].",
            panel=_LIGHT,
        ),
    ] = None
    plate_scale: Annotated[
        Text,
        option(
            "--plate-scale",
            metavar="X",
            help="Luminance of a value of 1 in --plate, cd/m2 [from its EXIF or "
            "--like-plate; linear files: 1].",
            panel=_LIGHT,
        ),
    ] = None

    def load(
        self,
        path: Path,
        taken: "Camera | None" = None,
        *,
        animated: bool = False,
        moments: tuple[float, float] | None = None,
    ) -> "Scene":
        """Reads the scene and adds environment, catchers and plate.

        Args:
            path: Scene file.
            taken: Camera of ``--like-plate``, which took the plate; None: there is none.
            animated: Whether other moments of its animation will be drawn, too.
            moments: Begin and end of the time that will be drawn, s after frame 0; None: any.
        """
        lux, environment = self._lux(), self._environment()
        scene = self.read(path, animated=animated, moments=moments)
        if environment:
            scene.set_environment(**environment)
        elif self.env_scale is not None or self.env_rotation is not None:
            self._change(scene)
        if lux is not None:
            self._light(scene, lux)
        for text in self.catcher or ():
            node, effects = _catcher(text, scene.nodes)
            scene.set_catcher(node, effects or EFFECTS)
        if not self.plate_moves:
            self.throw_plate(scene, taken)
        return scene

    @property
    def plate_moves(self) -> bool:
        """Whether each frame has another plate."""
        return self.plate is not None and has_frame(self.plate)

    def check_plates(self, frames: Iterable[int | None]) -> None:
        """Checks that no plate of a sequence is missing.

        Raises:
            UsageError: There are no frames.
            InputError: A plate is missing; the message names its frame and its file.
        """
        from daguerre.errors import InputError, UsageError
        from daguerre.files.in_use import note_read
        from daguerre.files.reading import fault_of

        if self.plate is None or not self.plate_moves:
            return
        for frame in frames:
            if frame is None:
                raise UsageError(
                    f"--plate {self.plate}: # stands for the frame number and needs --frames"
                )
            path = numbered(self.plate, frame)
            if fault := fault_of(path):
                raise InputError(f"frame {frame}: {path}: {fault}")
            note_read([path])

    def throw_plate(self, scene: "Scene", taken: "Camera | None", frame: int = 0) -> None:
        """Sets the plate of the scene; in a sequence, the plate of a frame.

        Args:
            scene: The scene, at the time of the frame.
            taken: Camera of ``--like-plate``; None: not given.
            frame: Number of the frame.
        """
        from daguerre.cli import console
        from daguerre.errors import UsageError

        if self.plate is None:
            for name, value in (("camera", self.plate_camera), ("scale", self.plate_scale)):
                if value is not None:
                    raise UsageError(f"--plate-{name} needs --plate")
            return
        from daguerre.plates.photo_light import photo_light

        path = numbered(self.plate, frame)

        scale = self.plate_scale
        number = None if scale is None else q.plain_number("--plate-scale", scale, "a luminance")
        if number is not None and not 0 < number < 1e12:
            raise UsageError(f"--plate-scale: wanted a luminance above 0, got {scale!r}")
        pixels, notes = photo_light(path, number, taken)
        for note in notes:
            console.note(f"{path}: {note}")
        camera = None
        if self.plate_camera is not None:
            from daguerre.calibration import read_all

            one = next(iter(read_all(self.plate_camera).values()))
            camera = one.camera(scene.camera(), None)
        scene.set_plate(pixels, camera)

    def _lux(self) -> float | None:
        from daguerre.errors import UsageError

        if self.env_lux is None:
            return None
        if self.env_scale is not None:
            raise UsageError("--env-scale and --env-lux: wanted one of them, got both")
        lux = q.plain_number("--env-lux", self.env_lux, "an illuminance in lux such as 10000")
        if lux < 0:
            raise UsageError(f"--env-lux: wanted at least 0, got {self.env_lux!r}")
        return lux

    def _light(self, scene: "Scene", lux: float) -> None:
        from dataclasses import replace

        from daguerre.errors import UsageError
        from daguerre.scene.illuminance import scale_for

        if scene.environment is None:
            raise UsageError("--env-lux needs an environment: --env or --sky")
        scale = scale_for(scene.environment, lux, "--env-lux")
        scene.environment = replace(scene.environment, scale=scale)

    def _scale(self) -> float:
        import math

        from daguerre.errors import UsageError

        scale = 1.0 if self.env_scale is None else self.env_scale
        if not (0 <= scale < math.inf):
            raise UsageError(f"--env-scale: wanted a number of at least 0, got {scale}")
        return scale

    def _rotation(self) -> float:
        return q.angle_deg("--env-rotation", self.env_rotation) if self.env_rotation else 0.0

    def _environment(self) -> dict[str, Any]:
        from daguerre.errors import UsageError

        if self.env is not None and self.sky is not None:
            raise UsageError("--env and --sky: wanted one of them, got both")
        if self.sky is not None:
            color = q.numbers("--sky", self.sky, 3, "1,1,1")
            if min(color) < 0:
                raise UsageError(f"--sky: wanted colours of at least 0, got {self.sky!r}")
            return {"color": color, "scale": self._scale()}
        if self.env is not None:
            image = self._panorama(self.env)
            return {"image": image, "scale": self._scale(), "rotation": self._rotation()}
        return {}

    @staticmethod
    def _panorama(path: Path) -> "NDArray[np.float32]":
        from daguerre.cli import console
        from daguerre.files.notes import Notes
        from daguerre.pictures.light import read_environment

        notes = Notes()
        image = read_environment(path, notes)
        for sentence in notes.sentences():
            console.note(sentence)
        return image

    def _change(self, scene: "Scene") -> None:
        from dataclasses import replace

        from daguerre.errors import UsageError

        if scene.environment is None:
            raise UsageError("--env-scale and --env-rotation need --env")
        changes: dict[str, Any] = {}
        if self.env_scale is not None:
            changes["scale"] = self._scale()
        if self.env_rotation is not None:
            changes["rotation"] = self._rotation()
        scene.environment = replace(scene.environment, **changes)


def _catcher(text: str, nodes: Collection[str]) -> tuple[str, str]:
    """Node and effects of ``NODE[:EFFECTS]``; names of nodes may have colons, too."""
    from daguerre.scene.node_names import find_node

    if ":" not in text or find_node(text, nodes) is not None:
        return text, ""
    node, _, effects = text.rpartition(":")
    return node, effects
