"""The rooms of ``bench/rooms.py``, made by script: each a scene with its camera."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from sky_rooms import skies, textures
from sky_rooms.parts import Builder, Hole, Placed, Point, chair, frame, table

import daguerre as dg

sys.path.append(str(Path(__file__).resolve().parent.parent / "ajar_door"))

WALL = 0.2  # m
STEEL, BRASS = (0.72, 0.73, 0.75), (0.82, 0.71, 0.52)


class Paints:
    """Materials by name, for a scene."""

    def __init__(self, scene: dg.Scene) -> None:
        self._scene = scene
        self.all: dict[str, dg.Material] = {
            "white": dg.Material(dg.Diffuse((0.76, 0.75, 0.72))),
            "lawn": dg.Material(dg.Diffuse((0.20, 0.24, 0.15))),
            "steel": dg.Material(dg.Conductor(STEEL, alpha=0.25)),
            "brass": dg.Material(dg.Conductor(BRASS, alpha=0.15)),
        }

    def matt(self, **colors: Point) -> Paints:
        """Adds diffuse colours."""
        for name, color in colors.items():
            self.all[name] = dg.Material(dg.Diffuse(color))
        return self

    def picture(
        self, name: str, pixels: np.ndarray, metres: float = 1.0, at: tuple[float, float] = (0, 0)
    ) -> Paints:
        """Adds a diffuse picture; it begins at a point of a box's coordinates."""
        a = 1 / metres
        slot = dg.TextureSlot(
            self._scene.add_texture(pixels, srgb=True, name=name),
            transform=(a, 0, -a * at[0], 0, a, -a * at[1]),
        )
        self.all[name] = dg.Material(dg.Diffuse((1.0, 1.0, 1.0), reflectance_texture=slot))
        return self


def living_room(sky_width: int) -> dg.Scene:
    """An overcast sky through four windows in two walls."""
    scene = dg.Scene()
    paints = Paints(scene).matt(
        sofa=(0.30, 0.36, 0.42),
        pillow=(0.55, 0.45, 0.35),
        book=(0.45, 0.25, 0.2),
        oak=(0.4, 0.3, 0.2),
    )
    paints.picture("boards", textures.boards((0.36, 0.27, 0.19)), 1.6)
    paints.picture("rug", textures.weave((0.45, 0.36, 0.33)), 2.4, (-1.6, 0.2))
    paints.picture("wallpaper", textures.stripes((0.6, 0.58, 0.5)), 1.5)
    paints.picture("painting", textures.painting(), 1.2, (-0.2, -1.0))
    b = Builder(scene, paints.all)
    north: list[Hole] = [((-2.4, -0.9), (0.8, 2.3)), ((0.3, 1.8), (0.8, 2.3))]
    west: list[Hole] = [((-1.9, -0.6), (0.8, 2.3)), ((0.6, 1.9), (0.8, 2.3))]
    _shell(b, (3.0, 2.7, 2.5), "boards", north=("white", north), west=("white", west))
    b.box("wallpaper", (2.99, 0, -2.5), (3.0, 2.7, 2.5))
    _paneless(b, north, west, (3.0, 2.5))
    sofa = Placed(b, (2.3, 0.2), 90)
    for low, high in (
        ((-1.0, 0.08, -0.4), (1.0, 0.42, 0.45)),
        ((-1.0, 0.42, 0.25), (1.0, 0.85, 0.48)),
        ((-1.15, 0.08, -0.4), (-1.0, 0.6, 0.48)),
        ((1.0, 0.08, -0.4), (1.15, 0.6, 0.48)),
    ):
        sofa.box("sofa", low, high)
    for x in (-0.6, 0.55):
        sofa.box("pillow", (x - 0.2, 0.42, 0.08), (x + 0.2, 0.75, 0.24))
    b.box("rug", (-0.8, 0.0, -1.4), (1.6, 0.012, 1.0))
    table(Placed(b, (0.6, 0.0), 8), "oak", "steel", (0.6, 0.35), 0.42)
    b.ball("brass", (0.45, 0.52, 0.05), 0.10)
    b.ball("white", (0.75, 0.50, -0.12), 0.08)
    _shelf(b, (-1.2, -2.2), ("oak", "book", "pillow", "sofa"))
    b.box("painting", (-0.2, 1.2, -2.499), (0.1, 1.9, -2.48))
    b.ball("steel", (-2.2, 0.35, 1.9), 0.35)
    scene.set_environment(skies.overcast(sky_width))
    return _seen(b.finish(), (0.6, 1.5, 2.3), (-0.1, 1.0, -1.4), 20)


def classroom(sky_width: int) -> dg.Scene:
    """The sun and a blue sky through four windows in one wall."""
    scene = dg.Scene()
    paints = Paints(scene).matt(
        oak=(0.46, 0.35, 0.23),
        seat=(0.25, 0.36, 0.42),
        frame=(0.5, 0.5, 0.48),
        paper=(0.7, 0.69, 0.66),
    )
    paints.picture("tiles", textures.tiles((0.42, 0.41, 0.37)), 2.0)
    paints.picture("board", textures.writing((0.05, 0.07, 0.06)), 3.2, (-1.6, -1.3))
    b = Builder(scene, paints.all)
    west: list[Hole] = [((z, z + 1.3), (0.9, 2.6)) for z in (-3.4, -1.6, 0.2, 2.0)]
    _shell(b, (3.0, 3.0, 4.0), "tiles", west=("white", west))
    _paneless(b, [], west, (3.0, 4.0))
    b.box("board", (-1.6, 0.9, -3.99), (1.6, 2.3, -3.96))
    b.box("frame", (-1.65, 0.85, -3.98), (1.65, 0.9, -3.90))
    for i in range(3):
        for j in range(4):
            x, z = -1.9 + 1.8 * i, -1.9 + 1.35 * j
            table(Placed(b, (x, z)), "oak", "steel", (0.6, 0.3))
            chair(Placed(b, (x + 0.05 * j, z + 0.5), 7 * (i - 1) + 5 * (j % 2)), "seat", "steel")
            b.box("paper", (x - 0.3, 0.74, z - 0.1), (x - 0.09, 0.745, z + 0.2))
    table(Placed(b, (1.5, -3.0)), "oak", "oak", (0.8, 0.4))
    b.ball("brass", (1.2, 0.86, -3.0), 0.12)
    for z in (-2.2, 0.2, 2.4):
        b.box("paper", (-1.2, 2.93, z - 0.1), (1.2, 2.97, z + 0.1))
    scene.set_environment(skies.sunny(sky_width, (-0.76, 0.5, -0.3)))
    return _seen(b.finish(), (1.9, 1.75, 3.7), (-0.5, 0.85, -1.2), 20)


def dining_room(sky_width: int) -> dg.Scene:
    """The sun through the slats of blinds."""
    scene = dg.Scene()
    paints = Paints(scene).matt(
        oak=(0.38, 0.27, 0.18),
        cloth=(0.62, 0.6, 0.55),
        slat=(0.66, 0.64, 0.58),
        fruit=(0.5, 0.3, 0.16),
    )
    paints.picture("boards", textures.boards((0.30, 0.21, 0.15), 6), 1.8)
    paints.picture("wallpaper", textures.stripes((0.55, 0.53, 0.46), 10), 1.2)
    paints.picture("painting", textures.painting(), 1.2, (-2.1, -0.9))
    b = Builder(scene, paints.all)
    north: list[Hole] = [((-1.9, -0.2), (0.7, 2.3)), ((0.3, 2.0), (0.7, 2.3))]
    _shell(b, (2.4, 2.6, 2.6), "boards", north=("white", north))
    b.box("wallpaper", (-2.4, 0, -2.6), (-2.39, 2.6, 2.6))
    b.box("wallpaper", (2.39, 0, -2.6), (2.4, 2.6, 2.6))
    for (x, last), (low, high) in north:
        for k in range(int((high - low) / 0.05)):
            _slat(b, (x + 0.01, last - 0.01), low + 0.05 * k + 0.03, -2.55)
    table(Placed(b, (0.1, -0.5)), "oak", "oak", (0.9, 0.5))
    for x, z, turn in ((-0.4, 0.15, 4), (0.6, 0.2, -8), (-0.35, -1.2, 176), (0.55, -1.15, 185)):
        chair(Placed(b, (x, z), turn), "cloth", "oak")
    chair(Placed(b, (-1.05, -0.5), -86), "cloth", "oak")
    b.ball("brass", (0.35, 0.84, -0.45), 0.10)
    for k, x in enumerate((-0.2, -0.05, 0.08)):
        b.ball("fruit", (x, 0.79, -0.5 + 0.07 * (k % 2)), 0.05)
    b.box("cloth", (-0.3, 0.74, -0.75), (0.5, 0.744, -0.25))
    b.box("painting", (-2.389, 1.1, -1.9), (-2.36, 1.8, -0.9))
    scene.set_environment(skies.sunny(sky_width, (0.35, 0.55, -0.76)))
    return _seen(b.finish(), (1.2, 1.55, 2.4), (-0.2, 0.85, -1.3), 22)


def staircase(sky_width: int) -> dg.Scene:
    """Thirteen panels of light above and below a staircase; no sky."""
    del sky_width
    scene = dg.Scene()
    paints = Paints(scene).matt(oak=(0.42, 0.3, 0.2), wall=(0.62, 0.6, 0.57), vase=(0.4, 0.45, 0.5))
    paints.picture("boards", textures.boards((0.36, 0.25, 0.17)), 1.6)
    paints.picture("painting", textures.painting(), 1.2, (-2.4, -1.2))
    paints.picture("tiles", textures.tiles((0.5, 0.49, 0.46), 2), 1.5)
    b = Builder(scene, paints.all)
    _shell(b, (2.5, 5.0, 3.0), "tiles")
    for k in range(14):
        rise, z = 0.18 * (k + 1), 1.2 - 0.28 * k
        b.box("boards", (0.9, rise - 0.05, z - 0.3), (2.5, rise, z))
        b.box("wall", (0.9, 0, z - 0.28), (2.5, rise - 0.05, z - 0.02))
        b.box("steel", (0.92, rise, z - 0.15), (0.94, rise + 0.9, z - 0.13))
    b.box("boards", (-2.5, 2.46, -3.0), (0.9, 2.66, -1.5))
    b.box("steel", (-2.5, 3.5, -1.53), (0.9, 3.54, -1.49))
    for x in np.arange(-2.3, 0.9, 0.3):
        b.box("steel", (x, 2.66, -1.52), (x + 0.02, 3.5, -1.50))
    b.box("painting", (-2.499, 1.2, -0.6), (-2.46, 2.1, 0.6))
    table(Placed(b, (-1.6, -2.3)), "oak", "steel", (0.6, 0.3))
    b.ball("brass", (-1.8, 0.9, -2.3), 0.16)
    b.ball("vase", (-1.3, 0.86, -2.3), 0.12)
    b.ball("steel", (-0.4, 0.4, -1.0), 0.4)
    warm = (28.0, 25.0, 20.0)
    for x in (-1.8, -0.4, 1.0):
        for z in (-2.0, 0.0, 2.0):
            b.lamp((x, 4.98, z), (0.15, 0.15), warm)
    for x in (-2.0, -1.1, -0.2, 0.6):
        b.lamp((x, 2.44, -2.2), (0.06, 0.06), (60.0, 52.0, 40.0))
    return _seen(b.finish(), (-1.9, 1.7, 2.8), (0.3, 1.7, -1.6), 18)


def ajar(sky_width: int) -> dg.Scene:
    """The room of ``bench/ajar.py``, which gets its light through a door ajar."""
    del sky_width
    import daguerre_side as door

    scene = door.scene()
    scene.add_camera("room", door.camera())
    return scene


ROOMS: dict[str, Callable[[int], dg.Scene]] = {
    "living-room": living_room,
    "classroom": classroom,
    "dining-room": dining_room,
    "staircase": staircase,
    "ajar": ajar,
}


def _shell(
    b: Builder,
    half: Point,
    floor: str,
    north: tuple[str, list[Hole]] = ("white", []),
    west: tuple[str, list[Hole]] = ("white", []),
) -> None:
    """Floor, walls, ceiling, and a lawn outside.

    Args:
        b: The room.
        half: Half of its width, its whole height, half of its depth.
        floor: Material of the floor.
        north: Material and holes of the wall at -z.
        west: Material and holes of the wall at -x.
    """
    x, top, z = half
    b.box(floor, (-x - WALL, -WALL, -z - WALL), (x + WALL, 0, z + WALL))
    b.box("white", (-x - WALL, top, -z - WALL), (x + WALL, top + WALL, z + WALL))
    b.wall(north[0], (-x, 0, -z - WALL), (x, top, -z), north[1])
    b.box("white", (-x, 0, z), (x, top, z + WALL))
    sideways = [(hole[1], hole[0]) for hole in west[1]]
    b.wall(west[0], (-x - WALL, 0, -z - WALL), (-x, top, z + WALL), sideways, across=0)
    b.box("white", (x, 0, -z - WALL), (x + WALL, top, z + WALL))
    b.box("lawn", (-60, -1.0, -60), (60, -0.9, 60))


def _paneless(b: Builder, north: list[Hole], west: list[Hole], half: tuple[float, float]) -> None:
    """Bars in the windows."""
    for hole in north:
        frame(b, "white", hole, 2, -half[1] - WALL / 2)
    for hole in west:
        frame(b, "white", hole, 0, -half[0] - WALL / 2)


def _slat(b: Builder, along: tuple[float, float], height: float, z: float) -> None:
    """One slat of a blind, nearly level, so that some of the sun comes through."""
    tilt = np.radians(3)
    y, depth = 0.02 * np.sin(tilt), 0.02 * np.cos(tilt)
    (x, last), thick = along, 0.002
    low = [(x, height + y, z - depth), (last, height + y, z - depth)]
    low += [(last, height - y, z + depth), (x, height - y, z + depth)]
    b.slab("slat", np.array(low), thick)


def _shelf(b: Builder, at: tuple[float, float], materials: Sequence[str]) -> None:
    """Two boards with books, by the wall at -z; the first material is that of the boards."""
    rng = np.random.default_rng(2)
    x0, z = at
    boards, *books = materials
    for level in (0.02, 0.40):
        b.box(boards, (x0, level, z - 0.28), (x0 + 1.6, level + 0.03, z))
        x = x0 + 0.03
        while x < x0 + 1.45:
            width, height = rng.uniform(0.03, 0.06), rng.uniform(0.2, 0.33)
            name = books[int(rng.integers(len(books)))]
            b.box(name, (x, level + 0.03, z - 0.27), (x + width, level + 0.03 + height, z - 0.06))
            x += width + 0.004
    for x in (x0 - 0.03, x0 + 1.6):
        b.box(boards, (x, 0, z - 0.28), (x + 0.03, 0.78, z))
    b.box(boards, (x0 - 0.03, 0.78, z - 0.28), (x0 + 1.63, 0.81, z))


def _seen(scene: dg.Scene, origin: Point, target: Point, focal_length: float) -> dg.Scene:
    """The scene with its camera, a pinhole."""
    scene.add_camera(
        "room",
        dg.Camera(
            transform=dg.look_at(origin, target),
            lens="pinhole",
            focal_length=focal_length,
            f_stop=None,
        ),
    )
    return scene
