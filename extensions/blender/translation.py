# SPDX-License-Identifier: GPL-3.0-or-later
"""Seam to ``daguerre.blender``, which translates Blender's evaluated data to Daguerre's."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from daguerre.blender.frames import AXES as AXES
from daguerre.camera.camera import Camera
from daguerre.files.notes import Notes
from daguerre.rendering.settings import RenderSettings
from daguerre.scene.scene import Scene

#: Goes to a frame and a fraction of one.
FrameSet = Callable[[int, float], None]


@dataclass(frozen=True)
class Shot:
    """A picture to draw, as Daguerre takes it.

    Attributes:
        scene: The scene.
        camera: The camera.
        settings: Render settings; the crop is the render region.
        factor: Blender's value of a picture over Daguerre's.
    """

    scene: Scene
    camera: Camera
    settings: RenderSettings
    factor: float

    @property
    def is_transparent(self) -> bool:
        """Whether the picture has no background."""
        return self.settings.backdrop.background == "transparent"


@dataclass(frozen=True)
class Eye:
    """One eye of a stereo pair.

    Attributes:
        matrix: Blender's world from the eye, shape (4, 4).
        shift_x: Shift of its film to the right, as Blender counts it.
    """

    matrix: Any
    shift_x: float


def scene_of(depsgraph: Any, frame_set: FrameSet | None = None) -> Scene:
    """Translates the evaluated scene.

    Args:
        depsgraph: Evaluated data.
        frame_set: Goes to a frame, for motion; that of the engine inside of a render.
    """
    from daguerre.blender import translate

    made: Scene = translate.scene_of(depsgraph, frame_set=frame_set)
    return made


def shot_of(depsgraph: Any, scene: Scene, camera: Any, eye: Eye | None = None) -> Shot:
    """Makes the picture of one camera.

    Args:
        depsgraph: Evaluated data.
        scene: Its translation.
        camera: Camera object of Blender.
        eye: One eye of a stereo pair; None: the camera itself.
    """
    from daguerre.blender import settings

    shot = depsgraph.scene
    ours = scene.camera(camera.name_full) if eye is None else _eye(shot, camera, eye, scene)
    return Shot(scene, ours, settings.settings_of(shot, camera), settings.factor_of(shot))


def region_of(render: Any, size: tuple[int, int]) -> tuple[int, int, int, int] | None:
    """Render region, px, from the top left; None: the whole picture."""
    from daguerre.blender import settings

    found: tuple[int, int, int, int] | None = settings.region_of(render, size)
    return found


def camera_of(thing: Any, scene: Any) -> Camera:
    """Translates a camera object by itself, at rest."""
    from daguerre.blender import cameras, frames

    matrix = frames.world_from_blender(scene) @ np.array(thing.matrix_world)
    found: Camera = cameras.camera_of(thing, scene.render, matrix, Notes())
    return found


def film_reach_mm(data: Any, render: Any) -> float:
    """Largest distance of a camera's film from the axis of its lens, mm."""
    from daguerre.blender import cameras

    found: float = cameras.film_reach_mm(data, render)
    return found


def _eye(shot: Any, camera: Any, eye: Eye, scene: Scene) -> Camera:
    """Camera of one eye of a stereo pair, which moves as the camera does."""
    from daguerre.blender import cameras, eyes, frames

    notes = Notes()
    place = frames.world_from_blender(shot) @ eye.matrix
    still = cameras.camera_of(camera, shot.render, place, notes, shift_x=eye.shift_x)
    scene.note(*notes.sentences())
    found: Camera = eyes.eye_of(scene.camera(camera.name_full), still, scene.time)
    return found
