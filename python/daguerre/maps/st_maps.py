"""STMaps of a camera: to undistort its pictures, and to distort rectilinear pictures.

``daguerre.post.effects.stmap`` and docs/darkroom.md explain ``s`` and ``t``.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.cached import cached_property
from daguerre.camera.overscan import NONE, Overscan
from daguerre.distortion.overscan import overscan_of, to_redistort, to_undistort
from daguerre.distortion.rectified import RectifiedView, built
from daguerre.errors import DaguerreError

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera
    from daguerre.post.warp import Warp
    from daguerre.scene.scene import Scene

Image = NDArray[np.float32]


@guarded
@dataclass(frozen=True)
class StMaps:
    """The two maps of a camera.

    Attributes:
        view: The camera and its rectified (pinhole) twin.
        overscan: Extra pixels around the picture, which the maps cover too.
    """

    view: RectifiedView
    overscan: Overscan = NONE

    @cached_property
    def undistort(self) -> Image:
        """Map that makes the undistorted picture: s and t in the camera's picture of each pixel.

        Shape (H, W, 2), rows from the top of the data window; NaN: outside of both pictures.
        """
        return self._values(self._undistort)

    @cached_property
    def redistort(self) -> Image:
        """Map that makes the camera's picture: s and t in the undistorted one of each pixel."""
        return self._values(self._redistort)

    def save(
        self,
        undistort: str | os.PathLike[str] | None = None,
        redistort: str | os.PathLike[str] | None = None,
    ) -> None:
        """Writes the maps, 32-bit OpenEXR: R is s, G is t.

        Raises:
            OutputError: A file cannot be written.
        """
        from daguerre.post.stmap_rows import write_stmap

        for path, warp in ((undistort, "_undistort"), (redistort, "_redistort")):
            if path is not None:
                named = {"daguerre:stmap": warp[1:], "daguerre:overscan": str(self.overscan)}
                write_stmap(path, getattr(self, warp), self._canvas, named)

    @property
    def needed(self) -> dict[str, Overscan | None]:
        """Overscan of the source that each map needs to fill the display window.

        ``undistort`` reads the camera's picture, ``redistort`` the undistorted picture. None: no
        overscan suffices, as the source is unbounded or the camera does not show parts of it.
        """
        try:
            undistort: Overscan | None = to_undistort(self.view)
        except DaguerreError:
            undistort = None
        return {"undistort": undistort, "redistort": to_redistort(self.view)}

    @cached_property
    def _canvas(self) -> Any:
        from daguerre.post.picture import Canvas

        size = self.view.resolution
        corner = -self.overscan.left, -self.overscan.top
        return Canvas(*self.overscan.grown(size), corner=corner, full_size=size)

    @cached_property
    def _undistort(self) -> Warp:
        from daguerre.post.warp import Warp

        return Warp.of(self._canvas, self.view.bent_from_straight)

    @cached_property
    def _redistort(self) -> Warp:
        from daguerre.post.warp import Warp

        return Warp.of(self._canvas, self.view.straight_from_bent)

    def _values(self, warp: Warp) -> Image:
        from daguerre.convolution.rows import Rows
        from daguerre.post.stmap_rows import st_rows

        return st_rows(warp, self._canvas, Rows(0, self._canvas.height))


@guarded
def stmaps(
    camera: Camera,
    resolution: tuple[int, int],
    *,
    scene: Scene | None = None,
    overscan: object = None,
) -> StMaps:
    """Returns the STMaps of any camera, at mid-exposure.

    The undistorted picture has a pinhole's projection, with the same focal length near the axis and
    the same principal point. The maps are exact for points in the plane of focus.

    Args:
        camera: Pinhole, thin, thick, exact, polynomial or projection.
        resolution: Width and height of the picture, px.
        scene: Scene, for autofocus; without it the camera then focuses at infinity.
        overscan: Extra pixels around the picture, which the maps cover too; see ``Session``.

    Raises:
        UsageError: The camera is a cube, which cannot be undistorted; or one of its parameters is
            wrong.
    """
    from daguerre.rendering.pixels import check_resolution

    size = check_resolution(resolution)
    core_scene = built(scene, camera, size)
    wanted = overscan_of(overscan, camera, size, scene, core_scene)
    view = RectifiedView(camera, size, scene=scene, core_scene=core_scene, overscan=wanted)
    return StMaps(view, wanted)
