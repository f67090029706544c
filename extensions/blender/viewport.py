# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures in the viewport: a thread draws the newest request, coarse at first, then better."""

import itertools
import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.camera import Camera
from daguerre.camera.exposure_mode import LIGHT
from daguerre.errors import UsageError
from daguerre.rendering import Photograph
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.drawn import Drawn, PictureRequest
from daguerre.viewfinder.painter import Painter
from daguerre.viewfinder.shot import Shot
from daguerre.viewfinder.stage import Stage

from . import passes, translation
from .reports import text_of

#: Width of the film of a free view, mm.
FILM_MM = 36.0

Rectangle = tuple[float, float, float, float]


@dataclass(frozen=True)
class View:
    """View of the viewport; equal views have equal pictures.

    Attributes:
        size: Size of the picture, px.
        rectangle: Where it stands in the region: x, y, width, height, px.
        matrix: View from world, and projection, as numbers; empty: that of the scene's camera.
    """

    size: tuple[int, int]
    rectangle: Rectangle
    matrix: tuple[float, ...] = ()


class Viewport:
    """Pictures of one viewport.

    Args:
        redraw: Asks Blender to draw the viewport again; called from another thread.
    """

    def __init__(self, redraw: Callable[[], None]) -> None:
        self._redraw = redraw
        self._numbers = itertools.count()
        self._requested: int | None = None
        self._view: View | None = None
        self._stage: Stage | None = None
        self._shot: translation.Shot | None = None
        self.newest: Drawn | None = None
        self.words = "Waiting"
        self._lock = threading.Lock()  # of the request that counts, its picture and its words
        self._painter = Painter(self._show, self._fail)

    def close(self) -> None:
        """Ends the thread."""
        self._painter.close()

    def update(self, context: Any, depsgraph: Any) -> None:
        """Takes over a changed scene; the next ``draw`` asks for its picture."""
        self._shot = self._view = self._stage = None
        scene, camera = translation.scene_of(depsgraph), depsgraph.scene.camera
        if camera is None:
            raise UsageError("scene: wanted a camera, got none")
        self._shot = translation.shot_of(depsgraph, scene, camera)

    def draw(self, engine: Any, context: Any, depsgraph: Any) -> None:
        """Shows the newest picture, and asks for another one if the view changed."""
        if self._shot is None:
            return
        view = view_of(context, depsgraph)
        if view != self._view:
            self._view = view
            self.ask(self._shot, camera_of(view, self._shot.camera, depsgraph.scene), view.size)
        if self.newest is not None:
            pixels = passes.combined(self.newest.frame, self._shot)
            show(engine, depsgraph.scene, pixels, view.rectangle)

    def refuse(self, error: Exception) -> None:
        """Tells in the viewport why there is no picture, until the view or the scene changes."""
        self._painter.rest()
        with self._lock:
            self._view = self._requested = self.newest = None
            self.words = text_of(error)

    def ask(self, shot: translation.Shot, camera: Camera, size: tuple[int, int]) -> None:
        """Asks for a picture instead of all before."""
        camera = camera.with_(exposure=LIGHT)  # shown linear: no picture needs a meter
        settings = shot.settings.with_(resolution=size, crop=None, overscan=None)
        if self._stage is None:
            self._stage = Stage(shot.scene, camera, settings)
        requested = Shot(shot.scene, camera, settings, Photograph())
        self._requested = next(self._numbers)
        self._painter.request(PictureRequest(self._requested, self._stage, Dials(), requested))

    def _show(self, drawn: Drawn) -> None:
        most = drawn.request.shot.settings.sampling.most
        words = f"{drawn.samples}/{most} spp" if drawn.whole else "Preview"
        self._tell(drawn.request, words, drawn)

    def _fail(self, request: PictureRequest, error: Exception) -> None:
        self._tell(request, text_of(error), None)

    def _tell(self, request: PictureRequest, words: str, newest: Drawn | None) -> None:
        """Takes over what the painter's thread found, unless another request counts by now."""
        with self._lock:
            if request.number != self._requested:
                return
            self.words, self.newest = words, newest
        self._redraw()


def view_of(context: Any, depsgraph: Any) -> View:
    """View of a 3D region."""
    region, shown = context.region, context.region_data
    if shown.view_perspective == "CAMERA":
        x, y, width, height = map(round, frame_of(context, depsgraph))
        frame = max(1, width), max(1, height)
        return View(fitted(frame, region.width * region.height), (x, y, *frame))
    if not shown.is_perspective:
        raise UsageError("viewport: wanted a perspective or camera view, got an orthographic one")
    size = region.width, region.height
    numbers = [
        x for matrix in (shown.view_matrix, shown.window_matrix) for row in matrix for x in row
    ]
    return View(size, (0, 0, *size), tuple(numbers))


def fitted(size: tuple[int, int], most: int) -> tuple[int, int]:
    """Size of the picture of a frame: its pixels are those of the screen, unless it has more."""
    factor = min(1.0, math.sqrt(most / (size[0] * size[1])))
    return max(1, int(size[0] * factor)), max(1, int(size[1] * factor))


def frame_of(context: Any, depsgraph: Any) -> Rectangle:
    """Where the camera's frame stands in the region: x, y, width, height, px."""
    from bpy_extras.view3d_utils import location_3d_to_region_2d

    scene = depsgraph.scene
    camera = scene.camera
    corners = [camera.matrix_world @ corner for corner in camera.data.view_frame(scene=scene)]
    points = np.array(
        [location_3d_to_region_2d(context.region, context.region_data, c) for c in corners]
    )
    (x, y), (right, top) = points.min(0), points.max(0)
    return float(x), float(y), float(right - x), float(top - y)


def camera_of(view: View, camera: Camera, scene: Any) -> Camera:
    """Camera of a view: the scene's own, or a pinhole that sees what the user sees."""
    if not view.matrix:
        return camera
    world, projection = np.array(view.matrix).reshape(2, 4, 4)
    return free_camera(world, projection, view.size, scene.unit_settings.scale_length)


def free_camera(
    view: NDArray[Any], projection: NDArray[Any], size: tuple[int, int], unit_m: float
) -> Camera:
    """Pinhole with the view of a perspective region.

    Args:
        view: View from world, shape (4, 4), Blender's axes and units.
        projection: Projection of OpenGL, shape (4, 4).
        size: Size of the region, px.
        unit_m: One unit of Blender, m.
    """
    transform = np.asarray(translation.AXES @ np.linalg.inv(view), np.float64)
    transform[:3, 3] *= unit_m
    return Camera(
        transform=transform,
        lens="pinhole",
        focal_length=FILM_MM / 2 * float(projection[0, 0]),
        sensor_size=(FILM_MM, FILM_MM * size[1] / size[0]),
    )


def show(engine: Any, scene: Any, pixels: NDArray[np.float32], where: Rectangle) -> None:
    """Draws pixels, shape (H, W, 4), into the region, through Blender's colour management."""
    import gpu
    from gpu_extras.presets import draw_texture_2d

    height, width = pixels.shape[:2]
    values = passes.flat(pixels)
    buffer = gpu.types.Buffer("FLOAT", len(values), values)
    texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=buffer)
    gpu.state.blend_set("ALPHA_PREMULT")
    engine.bind_display_space_shader(scene)
    draw_texture_2d(texture, where[:2], *where[2:])
    engine.unbind_display_space_shader()
    gpu.state.blend_set("NONE")
