"""Flags of the scene file: time, variants, units, folders.

Annotations must be real objects here (see ``groups.py``), so no ``annotations`` future.
"""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre import units as q
from daguerre.files import formats

from .groups import Text, option

if TYPE_CHECKING:
    from daguerre.scene.scene import Scene


_FILE = "Scene file"

ScenePath = Annotated[
    Path, typer.Argument(metavar="SCENE", help=f"Scene file: {formats.readable('scene')}.")
]


@dataclass(frozen=True)
class SceneFileFlags:
    """Flags with which a scene file is read."""

    time: Annotated[
        Text,
        option("--time", metavar="S", help="Time in the scene's animation, s [0].", panel=_FILE),
    ] = None
    time_code: Annotated[
        float | None,
        option(
            "--time-code",
            metavar="N",
            help="Time code of a USD stage, instead of --time [0].",
            panel=_FILE,
        ),
    ] = None
    variant: Annotated[
        list[str] | None,
        option(
            "--variant",
            metavar="NAME",
            help="Material variant of a glTF file by name, or /PRIM:SET=NAME of a USD stage; "
            "repeatable.",
            panel=_FILE,
        ),
    ] = None
    purpose: Annotated[
        str | None,
        option(
            "--purpose",
            metavar="render,proxy,guide",
            help="Purposes of prims of a USD stage to draw besides default [render].",
            panel=_FILE,
        ),
    ] = None
    camera_units: Annotated[
        Text,
        option(
            "--camera-units",
            metavar="UNIT",
            help="Unit of focal lengths and apertures in a USD stage, such as mm [a tenth of a "
            "scene unit].",
            panel=_FILE,
        ),
    ] = None
    usd_in_process: Annotated[
        bool,
        option(
            "--usd-in-process",
            help="Read a USD stage in this process, without a helper process. A damaged stage can "
            "then end the program.",
            panel=_FILE,
        ),
    ] = False
    define: Annotated[
        list[str] | None,
        option(
            "--define",
            "-D",
            metavar="NAME=VALUE",
            help="Value of a parameter of a Mitsuba scene ($NAME in the file); repeatable.",
            panel=_FILE,
        ),
    ] = None
    scene_unit: Annotated[
        Text,
        option(
            "--scene-unit",
            metavar="UNIT",
            help="Unit of lengths in a scene of pbrt or Mitsuba, such as cm [m].",
            panel=_FILE,
        ),
    ] = None
    allow_dir: Annotated[
        list[Path] | None,
        option(
            "--allow-dir",
            metavar="DIR",
            help="Folder, besides its own, from which the scene may read files; repeatable.",
            panel=_FILE,
        ),
    ] = None
    strict: Annotated[
        bool,
        option(
            "--strict",
            help="Refuse a scene of which something would be left out with a note.",
            panel=_FILE,
        ),
    ] = False

    def start(self, path: Path) -> float:
        """Scene time of frame 0, s."""
        from daguerre.errors import UsageError

        if self.time_code is None:
            return 0.0 if self.time is None else q.time_s("--time", self.time)
        if self.time is not None:
            raise UsageError("--time-code: wanted either --time or --time-code, got both")
        options = {"in_process": True} if self.usd_in_process else {}
        return float(formats.time_of_code(path, self.time_code, **options))

    def read(
        self, path: Path, *, animated: bool = False, moments: tuple[float, float] | None = None
    ) -> "Scene":
        """Reads the scene.

        Args:
            path: Scene file.
            animated: Whether other moments of its animation will be drawn, too.
            moments: Begin and end of the time that will be drawn, s after frame 0; None: any may
                be. A file that knows no such limits is read whole.
        """
        import daguerre

        options, start = self._options, self.start(path)
        if animated and formats.takes("scene", path, "animated"):
            options["animated"] = True
        if moments is not None and formats.takes("scene", path, "moments"):
            options["moments"] = tuple(start + time for time in moments)
        return daguerre.load(path, time=start, **options)

    @property
    def _allowed(self) -> tuple[Path, ...]:
        """Folders of ``--allow-dir``."""
        from daguerre.errors import UsageError

        for path in self.allow_dir or ():
            if not os.path.isdir(path):  # noqa: PTH112 - names may be too long
                raise UsageError(f"--allow-dir: wanted a folder, got {str(path)[:200]!r}")
        return tuple(self.allow_dir or ())

    @property
    def _options(self) -> dict[str, Any]:
        """Options of the reader of the scene."""
        units = self.camera_units
        chosen = self.variant or []
        options: dict[str, Any] = {
            "variant": chosen[0] if len(chosen) == 1 else tuple(chosen) or None,
            "allow_dirs": self._allowed,
        }
        if self.strict:
            options["strict"] = True
        if self.purpose is not None:
            options["purpose"] = tuple(self.purpose.split(","))
        if units is not None:
            options["camera_units"] = 1000 * q.unit_m("--camera-units", units)
        if self.usd_in_process:
            options["in_process"] = True
        if self.define is not None:
            options["define"] = tuple(self.define)
        if self.scene_unit is not None:
            options["unit_m"] = q.unit_m("--scene-unit", self.scene_unit)
        return options
