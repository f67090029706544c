"""Preparation of a render: builds the scene, sets up the camera, chooses the region."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import daguerre._core as _core
from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.exposure import without_brightness
from daguerre.camera.overscan import Overscan, check_overscan
from daguerre.camera.settled import settled
from daguerre.checks import short
from daguerre.errors import MismatchError, UsageError
from daguerre.scene.far import Place
from daguerre.scene.scene import Scene, check_moments
from daguerre.setup.built_scene import BuiltScene
from daguerre.setup.camera import set_up, with_brightness_of
from daguerre.setup.origin import given_origin, origin_of
from daguerre.setup.resolved import ResolvedCamera

from . import diffraction
from .backdrop import check_backdrop
from .film_parts import area, frame_around, inside
from .mattes import matte_facts
from .pixels import Box, crop_within
from .settings import RenderSettings
from .truth import focused

if TYPE_CHECKING:
    from daguerre.sensors import Sensor


@dataclass(frozen=True)
class Prepared:
    """Scene, camera and settings of one picture, ready to be drawn.

    Attributes:
        scene: The scene.
        camera: The camera, as given.
        settings: Render settings.
        built: Scene built for the core.
        setup: Camera set up for the core.
        interval: Begin and end of the exposure, s.
        overscan: Extra pixels around the picture.
        crop: Pixels to draw, (x0, y0, x1, y1).
        sensor: Sensor of the camera, which defines the channels of the film; None: no channels.
        pupils: Pupils for the kernels of diffraction, as JSON.
        mattes: Names of objects for mattes (``mattes.matte_facts``), if requested.
        overscan_notes: Remarks for users about the extra pixels.
    """

    scene: Scene
    camera: Camera
    settings: RenderSettings
    built: BuiltScene
    setup: ResolvedCamera
    interval: tuple[float, float]
    overscan: Overscan
    crop: Box
    sensor: Sensor | None
    pupils: dict[str, Any] | None
    mattes: dict[str, Any] | None
    overscan_notes: tuple[str, ...]

    @property
    def notes(self) -> tuple[str, ...]:
        """Remarks for users."""
        return (*self.setup.notes, *self.overscan_notes, *self.built.notes)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture, px."""
        return self.settings.film.resolution

    @property
    def core_scene(self) -> _core.Scene:
        """Scene of the core."""
        return self.built.core

    @property
    def focused_camera(self) -> Camera:
        """Camera with its resolved focus."""
        return focused(self.camera, self.setup.lens.focus_distance_m)

    @property
    def window(self) -> Box:
        """Part of the crop inside the picture."""
        return inside(self.crop, self.size)

    def exposed(self, camera: Camera) -> Prepared:
        """Returns the same picture as another camera exposes it.

        Raises:
            UsageError: Its exposure is wrong.
            MismatchError: It sees other light.
        """
        camera = settled(camera, self.scene.time)
        if without_brightness(camera) != without_brightness(self.camera):
            raise MismatchError(
                "expose: the camera must see the same light: only its exposure may differ"
            )
        check_backdrop(self.scene, self.settings, camera.exposure)
        return replace(self, camera=camera, setup=with_brightness_of(self.setup, camera))

    def share(self, pixels: int) -> float:
        """Returns a number of pixels as a share of the picture's."""
        return pixels / area((0, 0, *self.size))


def prepare(
    scene: Scene,
    camera: Camera | str | None,
    settings: RenderSettings,
    built: BuiltScene | None = None,
    origin: Place | None = None,
) -> Prepared:
    """Builds the scene and sets up the camera.

    Args:
        scene: The scene.
        camera: Camera, or its name in the scene; None: the scene's own.
        settings: Render settings.
        built: Scene built for another picture; reused if both expose at the same time.
        origin: Origin of the core's scene in the world, m; None: near the camera.
    """
    if not isinstance(scene, Scene):
        raise UsageError(f"scene: wanted a Scene, got {short(scene)}")
    camera = camera if isinstance(camera, Camera) else scene.camera(camera)
    camera = settled(camera, scene.time)
    size = settings.film.resolution
    interval = shutter.interval(camera, scene.time, size)
    check_moments(scene, *interval)
    place = origin_of(camera, scene.time, size) if origin is None else given_origin(origin)
    if built is None or not built.shows(scene, interval, place):
        built = BuiltScene(scene, interval, built, place)
    setup = set_up(scene, camera, size, built.core)
    notes = []
    overscan = check_overscan(settings.film.overscan, size)
    if overscan is None:
        from daguerre.distortion import overscan as around
        from daguerre.distortion.rectified import RectifiedView

        overscan = around.to_undistort(
            RectifiedView(focused(camera, setup.lens.focus_distance_m), size, scene=scene)
        )
        notes.append(around.note(overscan))
    crop = crop_within(settings.film.crop, overscan.region(size))
    sensor = None
    if camera.sensor is not None:
        from daguerre import sensors

        sensor = sensors.load(camera.sensor)
    check_backdrop(scene, settings, camera.exposure)
    film = settings.film
    mattes = matte_facts(scene, tuple(film.cryptomatte), film.cryptomatte_ranks)
    made = Prepared(
        scene, camera, settings, built, setup, interval, overscan, crop, sensor, None, mattes,
        tuple(notes),
    )  # fmt: skip
    return replace(made, pupils=_pupils(made))


def _pupils(prepared: Prepared) -> dict[str, Any] | None:
    """Pupils at mid-exposure, for the film with its overscan, if diffraction is on."""
    if prepared.settings.diffraction is None:
        return None
    camera = prepared.camera.frozen_at(0.5 * (prepared.interval[0] + prepared.interval[1]))
    frame, middle = frame_around(prepared.setup, prepared.size, prepared.overscan)
    setup = replace(prepared.setup, frame_size_mm=frame, shift_mm=middle)
    grown = prepared.overscan.grown(prepared.size)
    return diffraction.plan(prepared.settings.diffraction, camera, setup, grown, prepared.sensor)
