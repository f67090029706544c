"""Books, a notebook, pencils, a steel rule, and a ChArUco board."""

from __future__ import annotations

import math

import numpy as np

from calibrated import pictures
from calibrated.place import about_x, about_y, on_desk, put
from daguerre.exporters.gltf import Shape
from kit import shapes, textures
from kit.pose import turn_y
from night.stage import Stage

Parts = list[tuple[Shape, int]]


def add_papers(stage: Stage) -> None:
    """All of them."""
    _add_board(stage)
    add_books(stage)
    add_notebook(stage)
    add_pencils(stage)
    _add_rule(stage)


def _add_board(stage: Stage) -> None:
    """On a plate of aluminium 4 mm thick; the print is 27 x 18 cm, squares of 30 mm."""
    columns, rows, square, _ = pictures.BOARD
    print_ = stage.glb.add_picture("charuco", textures.png(pictures.board()))
    paper = stage.matter("board", baseColorTexture=print_, roughnessFactor=0.9)
    size = square * (columns + 1), square * (rows + 1)
    face = shapes.turned(shapes.square(*size), about_x(-90))
    plate = shapes.box((size[0] + 0.01, 0.004, size[1] + 0.01))
    parts = [(shapes.moved(face, (0, 0.0042, 0)), paper), (plate, stage.steel)]
    put(stage, "board", parts, translation=on_desk(-0.365, 0.185), rotation=turn_y(16))


def add_books(stage: Stage) -> None:
    """Four in a pile, each turned another way."""
    leaves = stage.glb.add_picture("leaves", textures.png(textures.pages()))
    paper = stage.matter("leaves", baseColorTexture=leaves, roughnessFactor=0.9)
    tones = ((0.05, 0.10, 0.17), (0.42, 0.06, 0.04), (0.55, 0.42, 0.20), (0.05, 0.13, 0.09))
    sizes = ((0.26, 0.20, 0.034), (0.24, 0.17, 0.026), (0.23, 0.16, 0.040), (0.19, 0.13, 0.018))
    lift = 0.0
    for k, (tone, size) in enumerate(zip(tones, sizes, strict=True)):
        cloth = stage.matter(f"cloth {k}", baseColorFactor=[*tone, 1], roughnessFactor=0.75)
        place = {"translation": on_desk(0.70, -0.04, lift), "rotation": turn_y((12, -6, 21, 4)[k])}
        put(stage, "book", _book(cloth, paper, *size), **place)
        lift += size[2]


def _book(cloth: int, paper: int, wide: float, deep: float, thick: float) -> Parts:
    """Lying, its back toward the viewer."""
    board = 0.003
    cover = shapes.box((wide, board, deep))
    back = shapes.moved(shapes.box((wide, thick, board)), (0, 0, deep / 2 - board / 2))
    block = shapes.box((wide - 0.008, thick - 2 * board, deep - 0.006))
    return [
        (cover, cloth),
        (shapes.moved(cover, (0, thick - board, 0)), cloth),
        (back, cloth),
        (shapes.moved(block, (0, board, -0.0005)), paper),
    ]


def add_notebook(stage: Stage) -> None:
    """Open, two pages that bend into the fold."""
    page = stage.glb.add_picture("page", textures.jpeg(pictures.squared(), 88))
    paper = stage.matter("page", baseColorTexture=page, roughnessFactor=0.9)
    cover = stage.matter("notebook", baseColorFactor=[0.02, 0.02, 0.022, 1], roughnessFactor=0.6)
    t = np.linspace(0, 1, 25)
    x, y = 0.145 * t, 0.004 + 0.008 * (1 - (1 - t) ** 6) - 0.006 * t**2
    parts: Parts = [(shapes.box((0.300, 0.003, 0.212)), cover)]
    for side in (-1, 1):
        line = np.stack([side * x, y], 1)[::side]
        grid = np.array([[(px, py, z) for px, py in line] for z in (-0.103, 0.103)])
        parts.append((shapes.surface(grid[::-1][:, ::-1]), paper))
    parts = [(_upward(shape), matter) for shape, matter in parts]
    place = {"translation": on_desk(0.50, 0.19), "rotation": turn_y(-13)}
    put(stage, "notebook", parts, **place)
    pen = stage.matter("pen", baseColorFactor=[0.02, 0.03, 0.08, 1], roughnessFactor=0.12)
    barrel = [(0, 0), (0.001, 0.002), (0.0042, 0.018), (0.0052, 0.040), (0.0058, 0.080)]
    barrel += [(0.0058, 0.132), (0.004, 0.138), (0, 0.138)]
    shape = shapes.turned(shapes.lathe(barrel, 48), about_x(90))
    clip = shapes.moved(shapes.box((0.003, 0.002, 0.04)), (0, 0.0058, 0.106))
    at = on_desk(0.55, 0.20, 0.0165)
    put(stage, "pen", [(shape, pen), (clip, stage.brass)], translation=at, rotation=turn_y(38))


def _upward(shape: Shape) -> Shape:
    """A sheet with its print above: turned over where its normals look down."""
    if float(shape.normals[:, 1].sum()) >= -1e-3:
        return shape
    uv = shape.uv * np.float32([-1, 1]) + np.float32([1, 0])
    return Shape(shape.positions, -shape.normals, uv, shape.indices[:, ::-1].copy())


def add_pencils(stage: Stage) -> None:
    """Seven in a cup of steel mesh."""
    tin = stage.matter(
        "tin", baseColorFactor=[0.09, 0.10, 0.11, 1], metallicFactor=1.0, roughnessFactor=0.35
    )
    cup = [(0, 0), (0.038, 0), (0.040, 0.002), (0.040, 0.098), (0.0385, 0.100), (0.037, 0.098)]
    cup += [(0.037, 0.004), (0, 0.004)]
    at = on_desk(0.12, -0.31)
    put(stage, "cup", [(shapes.lathe(cup, 64), tin)], translation=at)
    bare = stage.matter("bare wood", baseColorFactor=[0.62, 0.42, 0.24, 1], roughnessFactor=0.8)
    tones = ((0.75, 0.45, 0.02), (0.60, 0.05, 0.04), (0.03, 0.18, 0.42), (0.04, 0.26, 0.12))
    for k in range(7):
        tone = tones[k % 4]
        paint = stage.matter(f"paint {k}", baseColorFactor=[*tone, 1], roughnessFactor=0.25)
        lead = stage.matter(f"lead {k}", baseColorFactor=[c * 0.4 for c in tone] + [1])
        long, angle = 0.150 + 0.006 * (k % 3), 2 * math.pi * k / 7
        lean = about_y(math.degrees(angle)) @ about_x(9 + 3 * (k % 3))
        parts = [
            (shapes.faceted(shapes.lathe([(0, 0), (0.0038, 0), (0.0038, long)], 6)), paint),
            (shapes.lathe([(0.0036, long), (0.0013, long + 0.012)], 24), bare),
            (shapes.lathe([(0.0013, long + 0.012), (0, long + 0.018)], 24), lead),
        ]
        turned = [(shapes.turned(shape, lean), matter) for shape, matter in parts]
        aside = (-0.012 * math.sin(angle), 0.006, -0.012 * math.cos(angle))
        put(stage, "pencil", turned, translation=np.add(at, aside))


def _add_rule(stage: Stage) -> None:
    """30 cm of steel with a stroke per millimetre on both edges of its upper side."""
    black = stage.matter("strokes", baseColorFactor=[0.02, 0.02, 0.02, 1], roughnessFactor=0.8)
    satin = stage.matter(
        "satin steel",
        baseColorFactor=[0.62, 0.62, 0.63, 1],
        metallicFactor=1.0,
        roughnessFactor=0.32,
    )
    strokes = []
    for mm in range(301):
        long = 0.009 if mm % 10 == 0 else 0.007 if mm % 5 == 0 else 0.0045
        stroke = shapes.turned(shapes.square(0.00025, long), about_x(-90))
        x = (mm - 150) * 1e-3
        strokes.append(shapes.moved(stroke, (x, 0.00105, 0.0145 - long / 2)))
    parts = [(shapes.box((0.310, 0.001, 0.030)), satin), (shapes.join(*strokes), black)]
    put(stage, "ruler", parts, translation=on_desk(-0.02, 0.30), rotation=turn_y(-4))
