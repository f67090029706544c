"""Saves what a picture shows beside it: depth, normals, ids, motion, and boxes as COCO has them.

    python examples/ground_truth.py [FOLDER]        (default: out)

Shows: auxiliary channels of a frame, and boxes of things by `dg.annotate`. The category of a
thing is its name without `.001`. `daguerre render --coco FILE` writes masks, too.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

import daguerre as dg

#: Name, place of the middle (m) and side (m) of each cube.
THINGS = (
    ("crate", (-0.5, -0.1, -2.4), 0.8),
    ("crate.001", (0.8, 0.1, -3.2), 1.0),
    ("toy", (0.1, -0.35, -1.8), 0.3),
)


def cubes() -> dg.Scene:
    """Cubes of one mesh before the camera, which stands at the origin."""
    scene = dg.Scene()
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh = scene.add_mesh(corners, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    for name, place, size in THINGS:
        pose = np.diag([size, size, size, 1.0])
        pose[:3, 3] = place
        scene.add_instance(mesh, dg.Diffuse((0.6, 0.5, 0.4)), pose, name=name)
    lamp = np.eye(4)
    lamp[:3, 3] = 1, 2, 0
    scene.add_light(dg.SphereLight(luminance=(20, 20, 20), radius=0.3), lamp)
    scene.set_environment(color=(0.3, 0.3, 0.4))
    return scene


def main(folder: str = "out", width: int = 480, spp: int = 16) -> None:
    """Renders the cubes with their truth."""
    scene, camera = cubes(), dg.Camera(lens="pinhole", focal_length=36)
    size = width, 2 * width // 3
    frame = dg.render(scene, camera, resolution=size, spp=spp, aovs=True, gt_time="mid")
    seen = dg.annotate(scene, camera, resolution=size, gt_time="mid")
    boxes = [
        {"id": k, "image_id": 1, "category_id": t.category.id, "bbox": t.box, "area": t.area}
        for k, t in enumerate(seen.things, 1)
        if t.box is not None  # not hidden
    ]
    named = [{"id": one.id, "name": one.name} for one in seen.categories]
    image = {"id": 1, "file_name": "ground_truth.png", "width": size[0], "height": size[1]}
    coco = {"images": [image], "annotations": boxes, "categories": named}
    Path(folder).mkdir(parents=True, exist_ok=True)
    frame.save(f"{folder}/ground_truth.exr")  # depth.Z, N, P, object_id, motion, ...
    frame.save(f"{folder}/ground_truth.png")
    Path(folder, "ground_truth.json").write_text(json.dumps(coco, indent=1))


if __name__ == "__main__":
    main(*sys.argv[1:2])
