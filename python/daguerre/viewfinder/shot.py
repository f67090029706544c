"""Shot: one picture to draw, with smaller ones of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from daguerre.camera.camera import Camera
from daguerre.camera.exposure import without_brightness
from daguerre.rendering.photograph import Photograph
from daguerre.rendering.pixels import Box, at_size, crop_box
from daguerre.rendering.settings import RenderSettings
from daguerre.scene.scene import Scene

from .switches import on_in, suited

if TYPE_CHECKING:
    from daguerre.rendering.auto_exposure import Chosen

#: Fewest pixels on the shorter side of a rung's picture, unless the full size has fewer.
_LEAST = 40
#: Most pixels of a layer of ghosts.
_LAYER = 480 * 270


@dataclass(frozen=True)
class Shot:
    """One picture to draw.

    Attributes:
        scene: The scene at its time.
        camera: The camera with its dials.
        settings: Render settings with their dials.
        photograph: Sensor and development.
        tone: Tone curve if the picture is not developed.
        chosen: Exposure that a meter chose, which the camera has; None: none did.
    """

    scene: Scene
    camera: Camera
    settings: RenderSettings
    photograph: Photograph
    tone: str = "srgb"
    chosen: Chosen | None = None

    def is_lit_as(self, other: Shot) -> bool:
        """Whether samples of another shot are samples of this shot, if no meter changes them."""
        if self.scene is not other.scene or self.settings != other.settings:
            return False
        return without_brightness(self.camera) == without_brightness(other.camera)

    def smaller(self, divisor: int) -> Shot:
        """Returns a preview of the shot, smaller by a divisor, with one sample."""
        width, height = self.settings.film.resolution
        left, top, right, bottom = self.window
        divisor = max(1, min(divisor, min(right - left, bottom - top) // _LEAST))
        return self._preview((max(1, round(width / divisor)), max(1, round(height / divisor))))

    def ghosts(self) -> Shot | None:
        """Returns the layer of live ghosts for previews of the shot; None: ghosts are off."""
        if "flare" not in on_in(self.settings):
            return None
        width, height = self.settings.film.resolution
        left, top, right, bottom = self.window
        share = min(1.0, math.sqrt(_LAYER / ((right - left) * (bottom - top))))
        return self._preview((max(1, round(width * share)), max(1, round(height * share))))

    def through(self, other: Shot) -> Shot:
        """Returns this shot by the camera of another shot, which may have another size."""
        size = self.settings.film.resolution
        return replace(self, camera=other._camera_at(size), chosen=other.chosen)

    def _preview(self, size: tuple[int, int]) -> Shot:
        """Returns the shot at another size, with one sample and no light that takes long."""
        few = RenderSettings.of(
            resolution=size,
            crop=self._crop_at(size),
            spp=1,
            light_paths="off",
            seed=self.settings.sampling.seed,
            max_depth=self.settings.light.max_depth,
            background=self.settings.backdrop.background,
            threads=self.settings.threads,
        )
        return replace(self, camera=self._camera_at(size), settings=few)

    def by_model(self, model: str, divisor: int, samples: int) -> Shot:
        """Returns a smaller picture of the shot by another model of the lens."""
        width, height = self.settings.film.resolution
        size = max(1, width // divisor), max(1, height // divisor)
        settings = suited(self.settings, model).with_(
            resolution=size, spp=samples, light_paths="off", noise=None, crop=self._crop_at(size)
        )
        camera = self._camera_at(size).with_(lens_model=model)
        return replace(self, camera=camera, settings=settings)

    @property
    def window(self) -> Box:
        """Pixels that are drawn of the whole picture: left, top, right and bottom."""
        width, height = self.settings.film.resolution
        return crop_box(self.settings.film.crop, (0, 0, width, height))

    def _crop_at(self, size: tuple[int, int]) -> Box | None:
        """Returns the crop for a picture of another size; None: all of it."""
        if self.settings.film.crop is None:
            return None
        across, down = (b / a for a, b in zip(self.settings.film.resolution, size, strict=True))
        left, top, right, bottom = self.window
        return (
            math.floor(left * across),
            math.floor(top * down),
            math.ceil(right * across),
            math.ceil(bottom * down),
        )

    def _camera_at(self, size: tuple[int, int]) -> Camera:
        """Returns the camera for a picture of another size."""
        return at_size(self.camera, self.settings.film.resolution, size)
