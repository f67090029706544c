"""The desk, its chair, a bookcase and a door."""

from __future__ import annotations

import numpy as np

from calibrated import pictures
from calibrated.place import BACK, DEEP, TOP, WIDE, put
from calibrated.room import RIGHT
from daguerre.exporters.gltf import Shape
from kit import shapes, textures
from kit.pose import turn_y
from night.stage import Stage

THICK = 0.032  # of the desk's top, m


def add_furniture(stage: Stage) -> None:
    """All of it."""
    wood = _wood(stage)
    _add_desk(stage, wood)
    _add_chair(stage, wood)
    _add_bookcase(stage)
    _add_door(stage)


def _wood(stage: Stage) -> int:
    color, packed, normal = textures.wood()
    lighter = np.clip(color * (1.22, 1.15, 1.05), 0, 1)
    return stage.glb.add_material(
        "walnut",
        pbrMetallicRoughness={
            "metallicFactor": 0.0,
            "baseColorTexture": stage.glb.add_picture("walnut", textures.jpeg(lighter, 85)),
            "metallicRoughnessTexture": stage.glb.add_picture("satin", textures.jpeg(packed, 80)),
        },
        normalTexture=stage.glb.add_picture("grain", textures.jpeg(normal, 85)),
    )


def _add_desk(stage: Stage, wood: int) -> None:
    """Boards on a frame of black steel, with a drawer under them."""
    steel = stage.matter("black steel", baseColorFactor=[0.03, 0.03, 0.03, 1], roughnessFactor=0.4)
    tile = 0.80  # the texture repeats so, m
    top, edge = (0, 0, WIDE / tile, DEEP / tile), (0, 0, WIDE / tile, THICK / tile)
    board = shapes.box((WIDE, THICK, DEEP), [edge, edge, top, top, edge, edge])
    # Direction of u on each face of a box, for the normal map.
    along = [(0, 0, -1), (0, 0, 1), (1, 0, 0), (1, 0, 0), (1, 0, 0), (-1, 0, 0)]
    board.tangents = np.repeat([(*a, 1.0) for a in along], 4, axis=0).astype(np.float32)
    legs: list[Shape] = []
    for x in (-WIDE / 2 + 0.06, WIDE / 2 - 0.06):
        for z in (-DEEP / 2 + 0.05, DEEP / 2 - 0.05):
            legs.append(shapes.moved(shapes.box((0.04, TOP - THICK, 0.04)), (x, THICK - TOP, z)))
        bar = shapes.box((0.04, 0.04, DEEP - 0.14))
        legs.append(shapes.moved(bar, (x, -0.04, 0)))
    mesh = stage.glb.add_parts("desk", [(board, wood), (shapes.join(*legs), steel)])
    stage.glb.add_node("desk", mesh=mesh, translation=[0, TOP - THICK, 0])


def _add_chair(stage: Stage, wood: int) -> None:
    """Adds a chair of wood with four legs and a back of three bars, turned away from the desk."""
    parts = [shapes.moved(shapes.box((0.42, 0.025, 0.42)), (0, 0.45, 0))]
    for x in (-0.18, 0.18):
        parts.append(shapes.tube([(x * 1.1, 0, -0.2), (x, 0.45, -0.17)], 0.016, 12))
        parts.append(shapes.tube([(x * 1.1, 0, 0.2), (x, 0.45, 0.18), (x, 0.92, 0.25)], 0.016, 12))
    for y in (0.60, 0.72, 0.84):
        z = 0.18 + (y - 0.45) * 0.15
        parts.append(shapes.moved(shapes.box((0.36, 0.05, 0.014)), (0, y, z)))
    chair = [(part, wood) for part in parts]
    put(stage, "chair", chair, translation=[0.86, 0, 0.86], rotation=turn_y(28))


def _add_bookcase(stage: Stage) -> None:
    """Five shelves of books at the right wall."""
    paint = stage.matter("bookcase", baseColorFactor=[0.24, 0.16, 0.10, 1], roughnessFactor=0.6)
    long, high, deep, thick = 1.10, 2.05, 0.28, 0.022
    parts = [shapes.moved(shapes.box((0.008, high, long)), (deep / 2, 0, 0))]
    for z in (-long / 2, long / 2):
        parts.append(shapes.moved(shapes.box((deep, high, thick)), (0, 0, z)))
    levels = np.linspace(0.06, high - thick, 6)
    for y in levels:
        parts.append(shapes.moved(shapes.box((deep, thick, long)), (0, y, 0)))
    at = [RIGHT - deep / 2 - 0.01, 0, 0.42]
    put(stage, "bookcase", [(part, paint) for part in parts], translation=at)
    backs = stage.glb.add_picture("spines", textures.png(pictures.spines()))
    cloth = stage.matter("spines", baseColorTexture=backs, roughnessFactor=0.8)
    rng = np.random.default_rng(21)
    for y in levels[:-1]:
        row = _row_of_books(rng, long - 0.06)
        put(stage, "books", [(row, cloth)], translation=np.add(at, (-0.02, y + thick, 0)))


def _row_of_books(rng: np.random.Generator, long: float) -> Shape:
    """Backs toward -x, one after the other along z, with a gap at the end."""
    books, z = [], -long / 2
    while z < long / 2 - rng.uniform(0.05, 0.2):
        thick, high, deep = rng.uniform(0.015, 0.045), rng.uniform(0.2, 0.3), rng.uniform(0.15, 0.2)
        k = int(rng.integers(16))
        rect = (k / 16 + 0.002, 0, (k + 1) / 16 - 0.002, 1)
        book = shapes.box((deep, high, thick - 0.001), [rect] * 6)
        books.append(shapes.moved(book, (-0.10 + deep / 2, 0, z + thick / 2)))
        z += thick
    return shapes.join(*books)


def _add_door(stage: Stage) -> None:
    """In the right wall, toward the front, with six fields."""
    paint = stage.matter("door", baseColorFactor=[0.72, 0.71, 0.67, 1], roughnessFactor=0.4)
    parts = [shapes.box((0.03, 2.02, 0.86))]
    for side in (-1, 1):
        parts.append(shapes.moved(shapes.box((0.06, 2.08, 0.09)), (0, 0, side * 0.475)))
        for y, high in ((0.14, 0.55), (0.83, 0.55), (1.52, 0.36)):
            field = shapes.box((0.045, high, 0.28))
            parts.append(shapes.moved(field, (0, y, side * 0.20)))
    parts.append(shapes.moved(shapes.box((0.06, 0.09, 1.04)), (0, 2.02, 0)))
    knob = shapes.moved(shapes.ball(0.028, 16, 32), (-0.06, 1.0, -0.37))
    door = [*((part, paint) for part in parts), (knob, stage.brass)]
    put(stage, "door", door, translation=[RIGHT - 0.015, 0, BACK + 2.3])
