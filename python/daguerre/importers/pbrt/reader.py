"""Reads scenes of pbrt-v4, and of pbrt-v3 where the old names are unambiguous.

Start reading here. ``interpreter`` reads the whole text first; each other module then makes one
kind of object from it. A fault in a file raises an ``InputError`` with the file, line, column and
directive; each directive is applied, or reported in a note (``ledger``).

One unit of pbrt's radiance is 1 cd/m2; its lengths have no unit, and ``unit_m`` chooses one. pbrt's
frame is left-handed: the scene is its mirror image in z, so that pictures are the same.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from contextlib import closing
from pathlib import Path

import numpy as np

from daguerre.errors import InputError, UsageError
from daguerre.files.notes import Notes
from daguerre.scene.materials import Kind
from daguerre.scene.scene import Scene
from daguerre.shading.images import Images

from .cameras import mirror_of, read_camera
from .description import Description
from .emission import Emissions
from .environment import Skies, set_skies
from .files import Files
from .film import film_of
from .indices import Indices
from .interpreter import Interpreter
from .ledger import Ledger
from .lights import Lights
from .looks import Looks
from .materials import Tools
from .media import Media
from .meshes import Meshes
from .pixel_filter import tell_filter
from .placing import Placing
from .spectra import Spectra
from .state import Entity
from .texture_reader import TextureReader
from .textures import Textures
from .transforms import Matrix, Moving, scaling


def read(
    path: str | os.PathLike[str],
    *,
    time: float = 0.0,
    unit_m: float = 1.0,
    allow_dirs: Iterable[str | os.PathLike[str]] = (),
) -> Scene:
    """Reads a scene: .pbrt, or .pbrt.gz among the files that it includes.

    Args:
        path: The file.
        time: Scene time, s.
        unit_m: Length of a unit of the scene, m.
        allow_dirs: Folders, besides the file's own, from which it may read files.

    Returns:
        The scene; ``warnings`` has notes on unsupported content.

    Raises:
        InputError: A file cannot be read or is invalid.
        UsageError: The time is not finite, or the unit is no length.
    """
    return read_counted(path, time=time, unit_m=unit_m, allow_dirs=allow_dirs)[0]


def read_counted(
    path: str | os.PathLike[str],
    *,
    time: float = 0.0,
    unit_m: float = 1.0,
    allow_dirs: Iterable[str | os.PathLike[str]] = (),
) -> tuple[Scene, Ledger]:
    """Reads a scene; see :func:`read`. Returns the counts of its directives, too."""
    if not math.isfinite(time):
        raise UsageError(f"time: wanted a finite number of seconds, got {time}")
    if not 1e-9 <= unit_m <= 1e9:
        raise UsageError(f"unit_m: wanted a length of 1e-9 to 1e9 m, got {unit_m}")
    file = Path(path)
    scene, ledger = Scene(path=file, time=float(time)), Ledger(Notes())
    files = Files(file, ledger.include, allow_dirs)
    # Huge finite numbers may overflow in between; results are checked.
    with np.errstate(all="ignore"):
        described = Interpreter(files, ledger).read(file)
        with closing(Images(scene, files.picture, ledger.notes)) as images:
            axes = scaling(np.full(3, unit_m)) @ mirror_of(described.camera)
            _Builder(scene, described, axes, files, images, ledger).build()
    ledger.close()
    scene.note(*ledger.notes.sentences())
    return scene, ledger


class _Builder:
    def __init__(
        self,
        scene: Scene,
        described: Description,
        axes: Matrix,
        files: Files,
        images: Images,
        ledger: Ledger,
    ) -> None:
        self._scene, self._described, self._files = scene, described, files
        self._ledger, version = ledger, described.version
        self._axes = axes
        spectra = Spectra(files, version, ledger.notes)
        textures = Textures(images, TextureReader(images, spectra, version, ledger), ledger)
        indices = Indices(spectra, ledger.notes)
        self._media = Media(described.media.current, spectra, version, axes, files, ledger)
        tools = Tools(textures, indices, spectra, version, ledger, _no_part)
        looks = Looks(scene, tools, self._media, ledger)
        emissions = Emissions(spectra, images, version, ledger)
        self._placing = Placing(scene, axes, ledger)
        self._meshes = Meshes(scene, files, looks, emissions, self._placing, ledger)
        self._lights = Lights(spectra, images, axes, version, ledger)
        self._skies = Skies(files, spectra, axes, version, ledger)

    def build(self) -> None:
        described, scene = self._described, self._scene
        film = film_of(described.film, described.version, self._ledger)
        tell_filter(described.pixel_filter, described.version, self._ledger)
        camera = read_camera(described, film, self._files, self._axes, self._ledger)
        if camera is not None:
            scene.add_camera("camera", camera, film_size=film.resolution)
        self._meshes.add(described.shapes, None)
        self._objects()
        self._fog()
        self._light()
        if scene.motion:
            scene.set_clock(self._duration())

    def _fog(self) -> None:
        """Fills the world with the medium of the camera, unless shapes bound it."""
        camera = self._described.camera
        outside = "" if camera is None else camera.state.outside
        medium = self._media.around(outside)
        if medium is not None:
            self._scene.set_fog(medium)

    def _objects(self) -> None:
        """Places the objects at their instances."""
        found: dict[str, list[Moving]] = {}
        objects = self._described.objects
        for entity in self._described.instances:
            if entity.name not in objects:
                entity.place.fail(f"no object named {entity.name[:60]!r} is defined")
            found.setdefault(entity.name, []).append(entity.state.transform)
            self._ledger.use(entity.place)
        for name, outer in found.items():
            self._meshes.add(objects[name], outer, self._placing.name(name))

    def _light(self) -> None:
        skies = []
        for entity in self._described.lights:
            if entity.kind in ("infinite", "exinfinite"):
                sky = self._skies.read(entity)
                skies += [] if sky is None else [sky]
                continue
            for placed in self._lights.read(entity):
                self._scene.add_light(placed.light, placed.transform)
        set_skies(self._scene, skies)

    def _duration(self) -> float:
        ends = [entity.state.transform.times[1] for entity in self._moving()]
        return max((end for end in ends if end > 0), default=0.0)

    def _moving(self) -> Iterable[Entity]:
        described = self._described
        everything = [*described.shapes, *described.instances]
        everything += [entity for entity in (described.camera,) if entity is not None]
        for shapes in described.objects.values():
            everything += shapes
        return (entity for entity in everything if entity.state.transform.moves)


def _no_part(entity: Entity, name: str) -> tuple[int, Kind]:
    raise InputError(f"{entity.place}: {name}: a mixture is not allowed here")
