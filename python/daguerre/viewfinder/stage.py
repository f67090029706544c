"""Stage: scene, camera and settings of a viewfinder, and the shots that dials make from them."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from daguerre.camera.camera import Camera
from daguerre.camera.exposure import check_exposure, is_held
from daguerre.camera.exposure_mode import CHOICES, chosen_by, is_automatic
from daguerre.errors import InputError, UsageError, core_errors
from daguerre.files.recorded import Stamp, recorded
from daguerre.rendering.backdrop import shows_plate
from daguerre.rendering.light_plan import check_light
from daguerre.rendering.photograph import Photograph
from daguerre.rendering.prepare import Prepared, prepare
from daguerre.rendering.session import Session
from daguerre.rendering.settings import RenderSettings
from daguerre.scene.far import Place
from daguerre.scene.scene import Scene
from daguerre.sensors import Sensor
from daguerre.setup.built_scene import BuiltScene
from daguerre.setup.origin import is_near
from daguerre.setup.resolved import ResolvedLens

from .dials import Dials
from .ghosts import Layers
from .light_meter import LightMeter
from .shot import Shot

#: Divisor of the size of a picture that is only set up.
_SMALLEST = 64


@dataclass
class Stage:
    """Scene, camera and settings as the user opened them.

    Attributes:
        scene: The scene.
        camera: The camera before any dial.
        settings: Render settings before any dial.
        photograph: Sensor and development before any dial.
        tone: Tone curve of pictures that are not developed.
        load: Loads the scene again; None: the scene cannot be loaded again.
        files: Files that were read for it, with their stamps before.
        built: Scene built for the core, kept between shots.
        meter: Light meter for automatic modes.
        layers: Draws layers of live ghosts for pictures on the way.
        moment: The scene at the time of the last shot, if that differs from the scene's time.
        metering: Held while the meter is used.
    """

    scene: Scene
    camera: Camera
    settings: RenderSettings = field(default_factory=RenderSettings)
    photograph: Photograph = field(default_factory=Photograph)
    tone: str = "srgb"
    load: Callable[[], tuple[Scene, Camera]] | None = None
    files: Mapping[str, Stamp] = field(default_factory=dict)
    built: BuiltScene | None = None
    meter: LightMeter = field(default_factory=LightMeter)
    layers: Layers = field(default_factory=Layers)
    moment: Scene | None = None
    metering: threading.Lock = field(default_factory=threading.Lock, repr=False, compare=False)

    def reload(self, dials: Dials) -> Stage:
        """Loads the scene again; returns the stage with it.

        Args:
            dials: Dials that must fit the scene.

        Raises:
            DaguerreError: It cannot be loaded, or not be drawn with these dials.
        """
        if self.load is None:
            raise UsageError("reload: this scene was not read from a file")
        with recorded() as files:
            scene, camera = self.load()
            made = Stage(scene, camera, self.settings, self.photograph, self.tone, self.load, files)
            made.set_up(made.shot(dials))
        return made

    def shot(self, dials: Dials) -> Shot:
        """Returns the picture that dials ask for.

        Raises:
            DaguerreError: The camera cannot be set so.
        """
        values = dials.values()
        scene = self._scene_at(values.get("time"))
        camera = self.camera if "camera" not in values else scene.camera(values["camera"])
        settings = dials.settings(self.settings)
        names = ("iso", "look", "seed")
        taken: dict[str, Any] = {name: values[name] for name in names if name in values}
        if isinstance(values.get("sensor"), Sensor):
            taken["sensor"] = values["sensor"]
        photograph = replace(self.photograph, **taken)
        shot = Shot(scene, dials.camera(camera), settings, photograph, self.tone)
        _check_mode(shot.camera, values)
        _check_shown(shot)
        return shot

    def exposed(self, shot: Shot, *, fresh: bool = True) -> Shot:
        """Returns a shot with the exposure that its mode chooses, if the mode is automatic.

        Args:
            shot: The shot.
            fresh: Whether the meter must measure anew after motion; if not, its last reading will
                do.

        Raises:
            DaguerreError: The mode chooses a setting that the lens does not have.
        """
        if not is_automatic(shot.camera.exposure):
            return shot
        with self.metering:
            chosen, built = self.meter.choose(shot, self.built, fresh=fresh)
            if "shutter_time" not in chosen.changes:  # the meter exposes as long as the picture
                self.built = built
        return replace(shot, camera=chosen.of(shot.camera), chosen=chosen)

    def set_up(self, shot: Shot) -> ResolvedLens:
        """Sets up the lens of a shot.

        Raises:
            DaguerreError: The shot cannot be drawn.
        """
        return self._prepared(shot).setup.lens

    def try_out(self, dials: Dials) -> None:
        """Sets up a small picture, so that an error appears before any page opens.

        Raises:
            DaguerreError: The scene, the lens or a setting cannot be drawn.
        """
        shot = self.exposed(self.shot(dials))
        small = shot.smaller(_SMALLEST)
        session = Session(small.scene, small.camera, settings=small.settings, built=self.built)
        self.built = session.built
        check_light(self._prepared(shot))

    def origin(self, shot: Shot) -> Place | None:
        """Origin of the built scene, while the camera is near it; None: near the camera.

        A camera that crosses the edge of a cell again and again builds the scene once.
        """
        place = shot.camera.transform[:3, 3]
        if self.built is None or not is_near(self.built.origin, place):
            return None
        return self.built.origin

    def _prepared(self, shot: Shot) -> Prepared:
        with core_errors(InputError, "render"):
            origin = self.origin(shot)
            one = prepare(shot.scene, shot.camera, shot.settings, self.built, origin)
        self.built = one.built
        return one

    def _scene_at(self, time: float | None) -> Scene:
        """The scene at a time, s, kept with its built parts; None: at the scene's time."""
        if time is None:
            return self.scene
        if self.moment is None or self.moment.time != time:
            self.moment = self.scene.at(time)
        return self.moment


def _check_mode(camera: Camera, turned: Collection[str]) -> None:
    """Checks that no setting is fixed that the exposure mode chooses.

    Raises:
        UsageError: A setting that the mode chooses is fixed.
    """
    mode = camera.exposure
    for name in chosen_by(mode):
        if name not in turned and is_held(camera, name):
            raise UsageError(
                f"exposure {mode} chooses {CHOICES[mode]}, but the scene sets it ({name}): choose "
                "another mode"
            )
    check_exposure(camera)


def _check_shown(shot: Shot) -> None:
    """Checks that the command line can show a picture, too.

    Raises:
        UsageError: The picture is developed, though it has a tone curve or a plate that cannot be.
    """
    mode = shot.camera.exposure
    if not shot.photograph.develops({"exposure": mode, "white_balance": shot.camera.white_balance}):
        return
    if shot.tone != "srgb":
        raise UsageError(
            f"--tone {shot.tone} shapes pictures in light alone; open the scene without it"
        )
    if shows_plate(shot.settings):
        raise UsageError("--background plate: the plate shows in light alone; open it without it")
