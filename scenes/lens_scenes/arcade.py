"""The arcade at night: one subject for every lens, from fisheyes to the longest telephoto.

Metres, y up; the eyes of the head, the test chart and the white frame lie in the plane z = 0, which
is half a metre high in the picture, and the camera looks along -z. Whatever the focal length, step
back until the frame stands near the edge of the picture: what differs then is the lens. Luminances
are stylised: 1 cd/m2 shows as 1.
"""

from __future__ import annotations

from daguerre.exporters.gltf import Glb
from kit.pose import Point, look
from lens_scenes import hall, head, lanterns, table
from night.stage import Stage

#: Eye, target, focal length in mm, f-stop, focus in m. Camera: half a metre of the plane z = 0.
CAMERAS = {
    "Camera": ((0, 0, 50 * 0.5 / 24), (0, 0, 0), 50.0, 1.4, 50 * 0.5 / 24),
    "one place": ((0.02, 0.02, 2.2), (-0.07, 0.0, 0), 50.0, 2.8, 2.13),
    "portrait": ((-0.12, 0.0, 1.9), (-0.12, 0.0, 0), 85.0, 2.8, 1.9),
    "zoom": ((0, 0, 4.5), (0, 0, 0), 70.0, 2.8, 4.5),
    "level": ((0.9, -0.9, 1.9), (0.3, -0.9, -6), 35.0, 8.0, 8.0),
    "tilted up": ((0.9, -0.9, 1.9), (0.3, 1.9, -6), 35.0, 8.0, 8.0),
}


def make() -> Glb:
    """The scene with its cameras."""
    stage = Stage("daguerre scenes/lens_scenes.py")
    for name, (eye, target, focal_length, f_stop, focus) in CAMERAS.items():
        _add_camera(stage, name, eye, target, (focal_length, f_stop, focus))
    hall.add_hall(stage)
    lanterns.add_lanterns(stage)
    head.add_head(stage)
    table.add_table(stage)
    return stage.glb


def _add_camera(
    stage: Stage, name: str, eye: Point, target: Point, lens: tuple[float, float, float]
) -> None:
    camera = stage.glb.add_camera(name, lens[0], lens[1], round(lens[2], 4))
    stage.glb.add_node(name, camera=camera, translation=eye, rotation=look(eye, target))
