"""A thousand small lamps against one lamp of the same power: CPU seconds to equal error.

    python bench/many_lights.py --json [--spp 64] [--only table] [--choices]

Two scenes: ``table``, bulbs over a table-top with things on it, and ``street``, textured signs
(two emissive triangles each) along the houses of a street. Errors are relative MSEs of two seeds
(see ``bench/peers.py``), CPU seconds to relMSE 0.01 are CPU seconds x relMSE / 0.01. ``--choices``
also renders the thousand lamps with each lamp chosen by power alone, and evenly. ``build`` tells
what 100,000 emissive triangles cost to set up.
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from pathlib import Path
from typing import Any

import numpy as np
from peers import relative_mse

import daguerre as dg
import daguerre._core as _core
from daguerre.rendering.session import Session
from daguerre.setup import built_scene
from daguerre.setup.scene import _add_all
from daguerre.setup.scene_motion import MovingParts

QUAD = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float32)
FACES = [(0, 1, 2), (0, 2, 3)]
QUAD_UV = np.array([(0, 1), (1, 1), (1, 0), (0, 0)], np.float32)
BOX = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32)
BOX_FACES = [
    *((0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)),
    *((2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)),
]


def place(at: Any, x: Any = (1, 0, 0), y: Any = (0, 1, 0), size: float = 1.0) -> np.ndarray:
    """World from local: axes x, y and their product, scaled, at a point."""
    m = np.eye(4)
    m[:3, 0], m[:3, 1], m[:3, 2], m[:3, 3] = x, y, np.cross(x, y), at
    m[:3, :3] *= size
    return m


def look(origin: Any, target: Any, focal_length: float) -> dg.Camera:
    """A pinhole camera with +y up."""
    z = np.subtract(origin, target, dtype=float)
    z /= np.linalg.norm(z)
    x = np.cross((0, 1, 0), z)
    x /= np.linalg.norm(x)
    return dg.Camera(
        transform=place(origin, x, np.cross(z, x)),
        lens="pinhole",
        focal_length=focal_length,
        f_stop=None,
    )


def table(lamps: int) -> tuple[dg.Scene, dg.Camera]:
    """Bulbs of 1 cm over 2 x 2 m of table with 60 boxes; one lamp hangs in the middle."""
    rng = np.random.default_rng(1)
    scene = dg.Scene()
    wood = scene.add_material(dg.Diffuse((0.5, 0.4, 0.3)))
    paint = [
        scene.add_material(dg.Diffuse((0.6, 0.15, 0.1))),
        scene.add_material(dg.Conductor((0.8, 0.7, 0.5), alpha=0.3)),
    ]
    scene.add_instance(
        scene.add_mesh(QUAD * 3, FACES), wood, place((0, 0, 0), (1, 0, 0), (0, 0, -1))
    )
    box = scene.add_mesh(BOX, BOX_FACES)
    for i in range(60):
        turn = rng.uniform(0, np.pi)
        x, size = (np.cos(turn), 0, np.sin(turn)), rng.uniform(0.03, 0.08)
        x_at, z_at = rng.uniform(-0.9, 0.9, 2)
        scene.add_instance(box, paint[i % 2], place((x_at, size, z_at), x, (0, 1, 0), size))
    power = 3e4 / lamps  # cd/m2
    for _ in range(lamps):
        at = (0.0, 0.6, 0.0)
        if lamps > 1:
            at = (*rng.uniform((-1, 0.25), (1, 1.0)), rng.uniform(-1, 1))
        scene.add_light(dg.SphereLight((power, power * 0.9, power * 0.7), 0.01), place(at))
    return scene, look((0, 1.6, 1.9), (0, 0, 0.1), 50)


def sign_texture() -> np.ndarray:
    """Bright letters on black: 64 x 32 texels, a quarter of them lit."""
    return np.kron(np.random.default_rng(3).random((8, 16)) < 0.25, np.ones((4, 4)))


def street(lamps: int) -> tuple[dg.Scene, dg.Camera]:
    """Signs on the houses left and right of a street of 60 m; one sign shines from above."""
    rng = np.random.default_rng(2)
    scene = dg.Scene()
    asphalt = scene.add_material(dg.Conductor((0.4, 0.4, 0.4), alpha=0.4))
    wall = scene.add_material(dg.Diffuse((0.35, 0.3, 0.28)))
    floor = scene.add_mesh(QUAD * 80, FACES)
    scene.add_instance(floor, asphalt, place((0, 0, 0), (1, 0, 0), (0, 0, -1)))
    box = scene.add_mesh(BOX, BOX_FACES)
    for side in (-1, 1):
        for i in range(12):
            height = rng.uniform(3, 6)
            at = (side * (8 + rng.uniform(0, 0.5)), height, 2.5 - 5 * i)
            scene.add_instance(box, wall, place(at) @ np.diag([4, height, 2.3, 1]))
    letters = np.repeat(sign_texture()[:, :, None], 3, 2).astype(np.float32)
    glow = dg.TextureSlot(scene.add_texture(letters))
    quad = scene.add_mesh(QUAD, FACES, uv=QUAD_UV)
    area = sum(0.3**2 for _ in range(500))
    for i in range(lamps // 2 if lamps > 1 else 1):
        strength = 60.0 if lamps > 1 else 60.0 * area / 0.6**2
        tint = rng.uniform(0.4, 1, 3) if lamps > 1 else np.full(3, 0.7)
        kind = dg.Gltf(base_color=(0, 0, 0), emissive=tuple(strength * tint), emissive_texture=glow)
        matrix = place((0, 7, -15), (1, 0, 0), (0, 0, 1), 0.6)
        if lamps > 1:
            side = 1 if i % 2 else -1
            # No two in one plane: where they overlap both would shine.
            x_at, y_at, z_at = rng.uniform((3.5, 1, -55), (3.95, 6, 3))
            matrix = place((side * x_at, y_at, z_at), (0, 0, side), (0, 1, 0), 0.3)
        scene.add_instance(quad, dg.Material(kind), matrix)
    return scene, look((0, 1.7, 4), (0, 2, -10), 35)


SCENES = {"table": table, "street": street}


def render(scene: dg.Scene, camera: dg.Camera, spp: int, seed: int) -> tuple[np.ndarray, float]:
    """Picture, and user seconds without the set-up."""
    session = Session(
        scene, camera, resolution=(320, 180), seed=seed, filter="box", threads=1, max_depth=8
    )
    before = resource.getrusage(resource.RUSAGE_SELF).ru_utime
    session.draw(0, spp)
    seconds = resource.getrusage(resource.RUSAGE_SELF).ru_utime - before
    return session.frame().rgb.astype(np.float64), seconds


def measure(name: str, lamps: int, choice: str, spp: int) -> dict[str, float]:
    """Cost, error and cost to a fixed error of one scene."""
    built_scene.build = lambda scene, *_: build(scene, choice)
    scene, camera = SCENES[name](lamps)
    (a, seconds_a), (b, seconds_b) = (render(scene, camera, spp, seed) for seed in (1, 2))
    error, seconds = relative_mse(a, b), (seconds_a + seconds_b) / 2
    return {
        "cpu_s": round(seconds, 3),
        "rel_mse": round(error, 6),
        "cpu_s_to_0.01": round(seconds * error / 0.01, 3),
        "mean": round(float((a + b).mean() / 2), 4),
    }


def build(scene: dg.Scene, choice: str) -> _core.Scene:
    """Builds like daguerre.setup.scene.build, with another way to choose among the lights."""
    builder = _core.SceneBuilder()
    moment = (scene.time, scene.time)
    builder.set_interval(*moment)
    moving = MovingParts(scene, moment, [])
    _add_all(builder, scene, moving)
    moving.finish()
    return builder.build(choice)


def set_up(triangles: int) -> dict[str, float]:
    """Cost of the set-up of a shining mesh beside that of a dark one."""
    n = int(np.sqrt(triangles / 2))
    y, x = np.mgrid[0 : n + 1, 0 : n + 1]
    points = np.stack([x, np.sin(x * 0.1) + np.cos(y * 0.1), y], -1).reshape(-1, 3)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1)
    faces = np.concatenate(
        [np.stack([corner, corner + n + 1, corner + 1], -1), corner[:, None] + (1, n + 1, n + 2)]
    )
    seconds, memory = [], []
    for emission in (0.0, 1.0):
        scene = dg.Scene()
        glow = dg.Material(dg.Diffuse((0.5, 0.5, 0.5)), emission=(emission,) * 3)
        scene.add_instance(scene.add_mesh(points, faces), glow)
        started, before = time.process_time(), resident_mb()
        kept = build(scene, "tree")
        seconds.append(time.process_time() - started)
        memory.append(resident_mb() - before)
        assert kept.triangle_count == len(faces)
    return {
        "triangles": len(faces),
        "cpu_s": round(seconds[1] - seconds[0], 3),
        "mb": round(memory[1] - memory[0], 1),
    }


def resident_mb() -> float:
    """Memory of this process now."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 2**20


def main() -> None:
    """Measures and prints one JSON object."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--json", action="store_true", help="the only form there is")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--only", choices=sorted(SCENES))
    parser.add_argument("--choices", action="store_true")
    options = parser.parse_args()
    result: dict[str, Any] = {"set_up": set_up(100_000)}
    for name in SCENES if options.only is None else [options.only]:
        one = measure(name, 1, "tree", options.spp)
        choices = ("tree", "power", "even") if options.choices else ("tree",)
        many = {choice: measure(name, 1000, choice, options.spp) for choice in choices}
        ratio = many["tree"]["cpu_s_to_0.01"] / one["cpu_s_to_0.01"]
        result[name] = {"one": one, **many, "ratio": round(ratio, 2)}
    print(json.dumps(result))


if __name__ == "__main__":
    main()
