"""A desk by a window: wood, a laptop, books, a plant, a lamp, a fan that turns, an old camera.

Metres, y up, the floor at y = 0, the desk before the back wall. Lights are in cd/m2 of a bright
day: meter it (`--exposure auto`). A thing is a node, whose name says what it is; parts of a thing
have no nodes of their own, unless they move.
"""

from __future__ import annotations

from calibrated import computer, furniture, papers, room, things
from calibrated.place import TOP, on_desk
from daguerre.exporters.gltf import Glb
from kit.pose import Point, look
from lens_scenes.view_camera import add_view_camera
from night.stage import Stage

#: Where the calibrated cameras stand and look, m.
CAMERAS: dict[str, tuple[Point, Point]] = {
    "phone": ((0.06, 1.30, 0.80), (0.03, 0.83, -0.16)),
    "fisheye": ((0.0, 1.14, 0.30), (0.0, 1.00, -0.46)),
    "rig": ((-0.06, 1.16, 0.66), (-0.06, 0.80, -0.20)),
}


def make() -> Glb:
    """The scene."""
    stage = Stage("daguerre scenes/calibrated.py")
    add_cameras(stage)
    room.add_room(stage)
    room.add_window(stage)
    furniture.add_furniture(stage)
    computer.add_computer(stage)
    papers.add_papers(stage)
    things.add_things(stage)
    add_view_camera(stage, on_desk(0.33, -0.16), -28)
    return stage.glb


def add_cameras(stage: Stage) -> None:
    """Each at f/4 and focused on what it looks at; the first is that of the scene."""
    for name, (eye, target) in CAMERAS.items():
        away = sum((a - b) ** 2 for a, b in zip(eye, target, strict=True)) ** 0.5
        camera = stage.glb.add_camera(name, 24.0, 4.0, round(away, 3))
        stage.glb.add_node(name, camera=camera, translation=eye, rotation=look(eye, target))


__all__ = ["CAMERAS", "TOP", "make"]
