"""Flags of maps of a camera: the ray of each pixel, and STMaps to undistort and distort.

Annotations must be real objects here (see ``groups.py``), so no ``annotations`` future.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from daguerre.cli import console
from daguerre.rendering.parameters import TRUTH

from .groups import option

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera
    from daguerre.camera.overscan import Overscan
    from daguerre.scene.scene import Scene


@dataclass(frozen=True)
class MapFlags:
    """Maps of a camera, with or without a picture."""

    export_raymap: Annotated[
        Path | None,
        option(
            "--export-raymap",
            metavar="FILE.exr",
            help="Write the ray of each pixel: origin, direction and time.",
            panel=TRUTH,
        ),
    ] = None
    raymap_frame: Annotated[
        str,
        option(
            "--raymap-frame",
            metavar="camera|world",
            help="Coordinates of --export-raymap: the camera's (x right, y down, z ahead) or the "
            "world's [camera].",
            panel=TRUTH,
        ),
    ] = "camera"
    export_stmap_undistort: Annotated[
        Path | None,
        option(
            "--export-stmap-undistort",
            metavar="FILE.exr",
            help="Write an STMap that undistorts this camera's pictures.",
            panel=TRUTH,
        ),
    ] = None
    export_stmap_redistort: Annotated[
        Path | None,
        option(
            "--export-stmap-redistort",
            metavar="FILE.exr",
            help="Write an STMap that distorts straight pictures as this camera does.",
            panel=TRUTH,
        ),
    ] = None

    @property
    def files(self) -> list[Path]:
        """Files to write."""
        given = (getattr(self, f.name) for f in fields(self) if f.name.startswith("export"))
        return [path for path in given if path is not None]

    def renamed(self, name: Callable[[Path], Path]) -> "MapFlags":
        """Returns a copy with other file names."""
        paths: dict[str, Any] = {
            f.name: name(path)
            for f in fields(self)
            if isinstance(path := getattr(self, f.name), Path)
        }
        return replace(self, **paths)

    def check(self) -> None:
        """Checks suffixes and coordinate frame.

        Raises:
            UsageError: Another suffix, or no such frame.
        """
        from daguerre.errors import UsageError

        if self.raymap_frame != "camera":
            from daguerre.maps.ray_map import check_frame

            check_frame(self.raymap_frame, "--raymap-frame")
            if self.export_raymap is None:
                raise UsageError("--raymap-frame needs --export-raymap")
        for path in self.files:
            if path.suffix.lower() != ".exr":
                raise UsageError(f"{path}: wanted a name ending in .exr for a map")

    def write(
        self,
        scene: "Scene",
        camera: "Camera",
        size: tuple[int, int],
        overscan: "Overscan",
        gt_time: str | None = None,
    ) -> None:
        """Writes the requested maps.

        Args:
            scene: Scene, for its time.
            camera: Camera with a stated focus.
            size: Width and height of the picture, px.
            overscan: An ``Overscan``.
            gt_time: Moment of the exposure for rays.
        """
        from daguerre.maps.ray_map import rays_of

        if self.export_raymap is not None:
            rays = rays_of(camera, size, scene, None, gt_time or "mid", self.raymap_frame, overscan)
            rays.save(self.export_raymap)
            console.note(f"wrote {self.export_raymap}")
        both = {
            "undistort": self.export_stmap_undistort,
            "redistort": self.export_stmap_redistort,
        }
        found = {name: path for name, path in both.items() if path is not None}
        if found:
            _write_stmaps(scene, camera, size, overscan, found)


def _write_stmaps(
    scene: "Scene",
    camera: "Camera",
    size: tuple[int, int],
    overscan: "Overscan",
    files: dict[str, Path],
) -> None:
    from daguerre.distortion.rectified import RectifiedView
    from daguerre.maps.st_maps import StMaps

    maps = StMaps(RectifiedView(camera, size, scene=scene, overscan=overscan), overscan)
    maps.save(**files)
    source = {"undistort": "pictures of this camera", "redistort": "straight pictures"}
    for name, path in files.items():
        needed = maps.needed[name]
        what = f"--overscan {needed}" if needed else "no overscan"
        if needed is None:
            what = "unlimited overscan"
        console.note(f"wrote {path} ({source[name]} need {what} for it)")
