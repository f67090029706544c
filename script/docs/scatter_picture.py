"""The picture of docs/scatter.md: a sun beside the frame, without and with what the lens adds.

    python script/docs/scatter_picture.py -o scatter.jpg [--paths 9e6]

Left: no flare. Middle: ghosts and scatter of the double Gauss at f/4, default parts. Right: what
they brought, four times as bright.
"""

from __future__ import annotations

import argparse
import math

import numpy as np
from numpy.typing import NDArray
from PIL import Image

import daguerre as dg
from daguerre.rendering.session import Session

SIZE = (300, 200)
#: of pillars: x, z and half of the width, m
PILLARS = (
    *((-2.6, -9, 0.45), (-1.1, -7, 0.35), (0.5, -12, 0.5), (1.5, -8, 0.3)),
    *((2.9, -10, 0.5), (-4.2, -14, 0.6), (3.6, -13, 0.5)),
)


def scene() -> dg.Scene:
    """Dark pillars before an evening sky; the sun stands 25 degrees to the right."""
    made = dg.Scene()
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
    square = made.add_mesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    dark = dg.Material(dg.Diffuse((0.06, 0.05, 0.05)))
    for x, z, half in PILLARS:
        pose = np.diag([half, 6.0, 1.0, 1.0])
        pose[:3, 3] = x, 0, z
        made.add_instance(square, dark, pose)
    ground = np.array([[30, 0, 0, 0], [0, 0, 1, -1.2], [0, -30, 0, -10], [0, 0, 0, 1]], np.float64)
    made.add_instance(square, dark, ground)
    height = np.linspace(90, -90, 64)[:, None, None]
    t = np.clip(height / 60, 0, 1)
    sky = np.where(
        height < 0, 60, 2500 * (np.array([1, 0.85, 0.7]) - t * np.array([0.6, 0.4, 0.1]))
    )
    made.set_environment(np.broadcast_to(sky, (64, 128, 3)).astype(np.float32))
    toward = np.array([math.tan(math.radians(25)), math.tan(math.radians(6)), -1.0])
    pose = np.eye(4)
    pose[:3, 3] = 1000 * toward / np.linalg.norm(toward)
    sun = (9.6e8, 8e8, 6.1e8)
    made.add_light(dg.SphereLight(sun, 1000 * math.tan(math.radians(0.265))), pose)
    return made


def shown(picture: NDArray[np.float32]) -> NDArray[np.uint8]:
    """For the eye."""
    return (255 * (1 - np.exp(-picture / 1200)).clip(0, 1) ** (1 / 2.2)).astype(np.uint8)


def main() -> None:
    """Draws and writes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--paths", type=float, default=9e6)
    arguments = parser.parse_args()
    camera = dg.Camera(lens="double-gauss-50mm-f2", focus_distance=9.0, f_stop=4.0, blades=7)
    plain = Session(scene(), camera, resolution=SIZE, light_paths="off")
    plain.draw(0, 64)
    lit = Session(
        scene(), camera, resolution=SIZE, light_paths="off", flare=2e6, scatter=arguments.paths
    )
    lit.draw(0, 1)
    without, brought = plain.frame().rgb, lit.frame().flare
    assert brought is not None
    panels = [shown(without), shown(without + brought), shown(4 * brought)]
    rule = np.full((SIZE[1], 6, 3), 255, np.uint8)
    row = np.hstack([panels[0], rule, panels[1], rule, panels[2]])
    Image.fromarray(row).save(arguments.output, quality=88)


if __name__ == "__main__":
    main()
