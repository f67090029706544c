"""The table with what stands on it, and flowers in front of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.exporters.gltf import Shape
from kit import shapes, textures
from lens_scenes.chart import chart
from night.stage import Stage

TOP = -0.215  # of the table, m
FLOOR = -1.5


def add_table(stage: Stage) -> None:
    """A stone table: white frame and chart in the plane of focus, figures before and behind."""
    stone = stage.matter("stone", baseColorFactor=[0.30, 0.29, 0.27, 1], roughnessFactor=0.35)
    stage.put("slab", shapes.box((1.2, 0.06, 0.52)), stone, translation=[0, TOP - 0.06, -0.11])
    for x in (-0.42, 0.42):
        foot = shapes.box((0.14, TOP - 0.06 - FLOOR, 0.36))
        stage.put("foot", foot, stone, translation=[x, FLOOR, -0.11])
    enamel = stage.matter("enamel", baseColorFactor=[0.8, 0.8, 0.78, 1], roughnessFactor=0.3)
    stage.put("frame", _frame(0.31, 0.215, 0.0035), enamel)
    paper = stage.matter(
        "chart",
        baseColorTexture=stage.glb.add_picture("chart", textures.png(chart())),
        roughnessFactor=0.9,
    )
    wide, high = 0.17, 0.24
    stage.put("chart", shapes.square(wide, high), paper, translation=[0.165, -0.045, 0.001])
    back = stage.matter("board", baseColorFactor=[0.2, 0.13, 0.08, 1], roughnessFactor=0.6)
    board = shapes.box((wide + 0.012, high + 0.012, 0.008))
    stage.put("board", board, back, translation=[0.165, -0.171, -0.0045])
    _add_figures(stage)
    for x, z in ((-0.19, 0.95), (0.26, 2.6), (-0.30, 5.0)):
        _add_flowers(stage, x, z)


def _frame(x: float, y: float, radius: float) -> Shape:
    """A rectangle of round bars about the origin."""
    corners = np.array([(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)])
    bars = [
        shapes.tube(np.linspace(corners[k], corners[(k + 1) % 4], 2), radius, 12) for k in range(4)
    ]
    knobs = [shapes.moved(shapes.ball(1.8 * radius, 12, 24), at) for at in corners]
    return shapes.join(*bars, *knobs)


def add_men(stage: Stage) -> list[int]:
    """Meshes of a red and an ivory chessman, 67 mm high."""
    profile = [(0.0, 0.0), (0.017, 0.0), (0.018, 0.006), (0.012, 0.012), (0.008, 0.020)]
    profile += [(0.006, 0.038), (0.012, 0.042), (0.007, 0.045)]
    body = shapes.lathe(shapes.smooth_profile(profile, 8), 48)
    man = shapes.join(body, shapes.moved(shapes.ball(0.0125, 16, 32), (0, 0.054, 0)))
    return [
        stage.glb.add_mesh(
            name, man, stage.matter(name, baseColorFactor=[*color, 1], roughnessFactor=0.12)
        )
        for name, color in (("red", (0.55, 0.03, 0.02)), ("ivory", (0.75, 0.66, 0.48)))
    ]


def _add_figures(stage: Stage) -> None:
    """Chessmen 10 cm before the plane of focus to 30 cm behind it."""
    meshes = add_men(stage)
    places = [(-0.255, 0.10), (0.03, 0.085), (0.0, 0.0), (0.285, 0.05), (0.045, -0.09)]
    places += [(-0.27, -0.16), (0.30, -0.17), (0.09, -0.28), (-0.05, -0.31), (0.235, -0.30)]
    for k, (x, z) in enumerate(places):
        stage.glb.add_node("man", mesh=meshes[k % 2], translation=[x, TOP, z])


def _add_flowers(stage: Stage, x: float, z: float) -> None:
    """Poppies whose heads reach into the lower corner of pictures from farther away."""
    rng = np.random.default_rng(int(1000 * z))
    green = stage.matter("stem", baseColorFactor=[0.06, 0.14, 0.04, 1], roughnessFactor=0.7)
    red = stage.matter("petal", baseColorFactor=[0.75, 0.10, 0.05, 1], roughnessFactor=0.6)
    stems, heads = [], []
    for _ in range(9):
        top = np.array([rng.normal(0, 0.06), -0.15 + 0.05 * rng.random(), rng.normal(0, 0.05)])
        t = np.linspace(0, 1, 9)[:, None]
        foot = np.array([0, FLOOR, 0])
        stems.append(shapes.tube(foot + (top - foot) * np.hstack([t**2, t, t**2]), 0.0016, 6))
        heads.append(shapes.moved(_petals(), top))
    stage.put("stems", shapes.join(*stems), green, translation=[x, 0, z])
    stage.put("poppies", shapes.join(*heads), red, translation=[x, 0, z])


def _petals() -> Shape:
    """A cup of petals."""
    angle: NDArray[np.float64] = np.linspace(0, 2 * np.pi, 41)
    cup = [(0.002, -0.010), (0.012, -0.006), (0.019, 0.004), (0.020, 0.012)]
    rows = [
        np.stack([r * np.sin(angle), h + 0.003 * np.cos(5 * angle), r * np.cos(angle)], 1)
        for r, h in cup
    ]
    outside = np.stack(rows)
    return shapes.join(shapes.surface(outside), shapes.surface(outside[:, ::-1]))
