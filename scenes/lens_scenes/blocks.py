"""Three toy blocks on a floor, near, at medium distance and far, so that focus has a subject.

Their fronts are 0.5, 1 and 4 m away and grow with distance, so all look equally large.
"""

from __future__ import annotations

import numpy as np

from daguerre.exporters.gltf import Glb
from extensions.letters import dots_of
from extensions.studio import Studio
from kit import shapes, textures
from kit.pose import Point, turn_y

EYE = 0.1  # height of the lens, m
SIZE = 0.16  # of a block per metre of its distance, m
#: Letter, distance of the front, m, place to the right, as a share of it, turn in degrees, colour.
BLOCKS = (
    ("A", 0.5, -0.2, 8.0, (0.75, 0.06, 0.04)),
    ("B", 1.0, 0.005, -6.0, (0.04, 0.22, 0.62)),
    ("C", 4.0, 0.2, 7.0, (0.03, 0.36, 0.12)),
)
WALL = 7.0  # m


def make() -> Glb:
    """The blocks, the room and the camera, 50 mm at f/2."""
    studio = Studio("lens_scenes.py")
    _room(studio)
    for letter, away, aside, degrees, colour in BLOCKS:
        size = SIZE * away
        picture = studio.glb.add_picture(letter, textures.png(_face(letter, colour)))
        matter = studio.matter(letter, (1, 1, 1), 0.45, pbr={"baseColorTexture": picture})
        at = (aside * away, 0.0, -away - size / 2)
        studio.put(f"block {letter}", shapes.box((size,) * 3), matter, at, rotation=turn_y(degrees))
    studio.camera((0, EYE, 0), (0, EYE, -1), 50, 2, (0, EYE, -1))
    return studio.glb


def _face(letter: str, colour: Point, size: int = 512) -> textures.Picture:
    """A letter in a frame, and lines around it as fine as blur is seen on, sRGB."""
    y, x = np.abs(np.mgrid[:size, :size] + 0.5 - size / 2) * 2 / size
    edge = np.maximum(x, y)
    sheet = np.full((size, size, 3), (0.93, 0.88, 0.76))
    ink = np.sqrt(colour)
    lines = (np.minimum(x, y) * 24 % 1 < 0.5) & (edge > 0.74) & (edge < 0.84)
    sheet[(edge > 0.88) | lines] = ink
    glyph = np.kron(dots_of(letter), np.ones((size // 8, size // 8))) > 0
    top, left = (size - glyph.shape[0]) // 2, (size - glyph.shape[1]) // 2
    sheet[top : top + glyph.shape[0], left : left + glyph.shape[1]][glyph] = ink
    return sheet


def _room(studio: Studio) -> None:
    """A floor of boards, a dim wall with a string of lamps, and two soft lights."""
    color, packed, _ = textures.wood()
    boards = studio.matter(
        "boards",
        (1, 1, 1),
        1.0,
        1.0,
        pbr={
            "baseColorTexture": studio.glb.add_picture("boards", textures.jpeg(color)),
            "metallicRoughnessTexture": studio.glb.add_picture("boards_mr", textures.jpeg(packed)),
        },
    )
    floor = shapes.box((8, 0.1, WALL), [(0, 0, 4, 3.5)] * 6)
    studio.put("floor", floor, boards, (0, -0.1, -WALL / 2))
    paint = studio.matter("paint", (0.10, 0.14, 0.20), 0.9)
    studio.put("wall", shapes.square(12, 6), paint, (0, 2.9, -WALL))
    for k in range(15):
        x = -2.9 + 0.42 * k
        lamp = studio.shining("lamp", ((1.0, 0.72, 0.4), (1.0, 0.5, 0.3))[k % 2], 5.0)
        place = (x, 1.25 + 0.05 * (x % 1.7) ** 2, -WALL + 0.1)
        studio.put("lamp", shapes.ball(0.035, 8, 16), lamp, place)
    studio.softbox((-1.1, 1.6, 0.9), (0, 0.1, -0.8), (1.4, 1.4), 7.0, (1, 0.95, 0.88))
    studio.softbox((-1.6, 2.6, -1.2), (0.8, 0.3, -4), (2, 2), 12.0, (1, 0.95, 0.88))
