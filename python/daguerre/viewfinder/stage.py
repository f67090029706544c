"""Stage: the scene, camera and settings of a viewfinder, and what dials make of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from daguerre.camera.camera import Camera
from daguerre.errors import UsageError
from daguerre.rendering.photograph import Photograph
from daguerre.rendering.session import Session
from daguerre.rendering.settings import RenderSettings
from daguerre.scene.scene import Scene
from daguerre.sensors import Sensor
from daguerre.setup.built_scene import BuiltScene

from .dials import Dials

#: Divisor of the size of a picture that is only set up.
_SMALLEST = 64
#: A rung's picture has at least so many pixels on its shorter side, if the whole one has them.
_LEAST = 40


@dataclass(frozen=True)
class Shot:
    """One picture to draw.

    Attributes:
        scene: The scene at its time.
        camera: The camera with its dials.
        settings: Render settings with their dials.
        photograph: Exposure and development.
        tone: Tone curve if the picture is not developed.
    """

    scene: Scene
    camera: Camera
    settings: RenderSettings
    photograph: Photograph
    tone: str = "srgb"

    def smaller(self, divisor: int) -> Shot:
        """Returns a preview of the shot, smaller by a divisor, with one sample."""
        width, height = self.settings.film.resolution
        divisor = max(1, min(divisor, min(width, height) // _LEAST))
        if divisor == 1 and self.settings.film.crop is not None:
            return self
        size = max(1, round(width / divisor)), max(1, round(height / divisor))
        few = RenderSettings.of(
            resolution=size,
            spp=1,
            light_paths="off",
            seed=self.settings.sampling.seed,
            max_depth=self.settings.light.max_depth,
            background=self.settings.backdrop.background,
            threads=self.settings.threads,
        )
        return Shot(self.scene, self._camera_at(size), few, self.photograph, self.tone)

    def by_model(self, model: str, divisor: int, samples: int) -> Shot:
        """Returns a smaller picture of the shot by another model of the lens."""
        width, height = self.settings.film.resolution
        size = max(1, width // divisor), max(1, height // divisor)
        settings = self.settings.with_(
            resolution=size, spp=samples, light_paths="off", noise=None, crop=None
        )
        camera = self._camera_at(size).with_(lens_model=model)
        return Shot(self.scene, camera, settings, self.photograph, self.tone)

    def _camera_at(self, size: tuple[int, int]) -> Camera:
        """Returns the camera for a picture of another size."""
        if self.camera.focus_at is None:
            return self.camera
        (x, y), (width, height) = self.camera.focus_at, self.settings.film.resolution
        return self.camera.with_(focus_at=(x * size[0] / width, y * size[1] / height))


@dataclass
class Stage:
    """Scene, camera and settings as the user opened them.

    Attributes:
        scene: The scene.
        camera: The camera before any dial.
        settings: Render settings before any dial.
        photograph: Exposure and development before any dial.
        tone: Tone curve of pictures that are not developed.
        load: Loads the scene again; None: it cannot be.
        built: Scene built for the core, kept between shots.
    """

    scene: Scene
    camera: Camera
    settings: RenderSettings = field(default_factory=RenderSettings)
    photograph: Photograph = field(default_factory=Photograph)
    tone: str = "srgb"
    load: Callable[[], tuple[Scene, Camera]] | None = None
    built: BuiltScene | None = None

    def reload(self) -> Stage:
        """Loads the scene again; returns the stage with it.

        Raises:
            DaguerreError: It cannot be loaded.
        """
        if self.load is None:
            raise UsageError("reload: this scene was not read from a file")
        scene, camera = self.load()
        return replace(self, scene=scene, camera=camera, built=None)

    def shot(self, dials: Dials) -> Shot:
        """Returns the picture that dials ask for.

        Raises:
            DaguerreError: The camera cannot be set so.
        """
        values = dials.values()
        scene = self.scene.at(values["time"]) if "time" in values else self.scene
        camera = self.camera if "camera" not in values else scene.camera(values["camera"])
        return Shot(
            scene,
            dials.camera(camera),
            dials.settings(self.settings),
            self._photograph(values),
            self.tone,
        )

    def try_out(self, dials: Dials) -> None:
        """Sets up a small picture, so that what cannot be drawn is an error before anyone looks.

        Raises:
            DaguerreError: The scene, the lens or a setting cannot be drawn.
        """
        shot = self.shot(dials)
        small = shot.smaller(_SMALLEST)
        session = Session(small.scene, small.camera, settings=small.settings, built=self.built)
        self.built = session.built

    def _photograph(self, values: Mapping[str, Any]) -> Photograph:
        """Exposure and development, with the dials of a camera's body."""
        changes: dict[str, Any] = {}
        for dial, name in _SHOT.items():
            if dial in values:
                changes[name] = values[dial]
        develops = self.photograph.develops or any(name in values for name in _DEVELOPING)
        if not isinstance(changes.get("sensor", self.photograph.sensor), Sensor):
            changes.pop("sensor", None)
        if "iso" in changes:
            changes["meters"] = None
        elif mode := values.get("exposure"):
            changes |= {"meters": mode, "iso": None}
        return replace(self.photograph, **changes, develops=develops)


#: Dials that are fields of a photograph, and those that ask for development.
_SHOT = {
    "iso": "iso",
    "exposure_compensation": "ev",
    "look": "look",
    "sensor": "sensor",
    "focus_at": "focus_at",
}
_DEVELOPING = (
    *("sensor", "iso", "exposure_compensation", "exposure_time", "exposure_f_stop"),
    *("responsivity", "white_balance", "look", "exposure"),
)
