"""The price of a catcher layer: CPU time and error beside the whole scene and the object alone.

    python bench/catchers.py [--json] [--spp 64] [--res 240x160] [--noise 0.01]

Four pictures of one view: ``whole``, the object on its ground as one scene; ``caught``, the same
with the ground as a catcher, put over the ground's own picture; ``holdout``, with a ground that
catches nothing, so without the layer; ``alone``, the object without the ground. ``error`` is the
mean square difference of two seeds, halved, over the square of the mean: that of the picture that
users see. ``cpu`` is the CPU time of one, the least of three. ``ratio`` is CPU time x error of the
composite over that of the whole scene, ``over_holdout`` the CPU time over that of the same picture
without the layer, ``over_alone`` over that of the object alone, whose pixels are mostly empty. With
``--noise`` each picture is drawn until it has that noise, so CPU times are those of equal noise.
"""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre as dg
from daguerre.frame.over import change_of_rgb
from daguerre.scene.catcher import EFFECTS

GROUND = (-8.0, 8.0)
MATERIALS = {
    "matte": dg.Diffuse((0.5, 0.4, 0.3)),
    "glossy": dg.Gltf(base_color=(0.3, 0.25, 0.2), metallic=0.6, roughness=0.25),
}
OBJECTS = {"matte": dg.Diffuse((0.8, 0.15, 0.1)), "glass": dg.Dielectric(ior=1.5, alpha=0.0)}
MOST = 1 << 16  # samples per pixel of a picture that is drawn until it has its noise
WAYS = ("whole", "caught", "holdout", "alone")


def ball(segments: int = 32, radius: float = 0.5) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and triangles of a ball, seen from outside."""
    theta, phi = np.linspace(0, np.pi, segments + 1), np.linspace(0, 2 * np.pi, 2 * segments + 1)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    points = np.stack([np.sin(t) * np.cos(p), np.cos(t), np.sin(t) * np.sin(p)], -1)
    number = np.arange(points[..., 0].size).reshape(t.shape)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]
    faces = np.concatenate([np.stack(each, -1).reshape(-1, 3) for each in ((a, b, d), (a, d, c))])
    return radius * points.reshape(-1, 3), faces


def scene(way: str, ground: Any, thing: Any) -> dg.Scene:
    """A ball on a ground, under a lamp and a sky; ``empty``: the ground alone."""
    made = dg.Scene()
    if way != "alone":
        x, z = GROUND
        corners = np.array([(x, 0, x), (x, 0, z), (z, 0, z), (z, 0, x)])
        mesh = made.add_mesh(corners, np.array([(0, 1, 2), (0, 2, 3)]))
        made.add_instance(mesh, ground, name="ground")
    if way != "empty":
        pose = np.eye(4)
        pose[:3, 3] = 0, 0.5, -1
        made.add_instance(made.add_mesh(*ball()), dg.Material(thing), pose, name="ball")
    lamp = np.eye(4)
    lamp[:3, 3] = 1.5, 2.5, 0.5
    made.add_light(dg.SphereLight(luminance=(30, 27, 22), radius=0.3), lamp)
    made.set_environment(color=(0.5, 0.6, 0.8))
    if way in ("caught", "holdout"):
        made.set_catcher("ground", "holdout" if way == "holdout" else EFFECTS)
    return made


def camera() -> dg.Camera:
    """A lens of the library that looks down at the ball."""
    pose = np.eye(4)
    c, s = np.cos(0.23), np.sin(0.23)
    pose[1:3, 1:3] = (c, s), (-s, c)
    pose[:3, 3] = 0, 1.2, 2.4
    return dg.Camera(pose, lens="double-gauss-50mm-f2", f_stop=2.8, focus_distance=3.4)


def cpu(run: Callable[[], Any]) -> tuple[Any, float]:
    """A result and the CPU time that it took, s."""
    before = os.times()
    made = run()
    after = os.times()
    return made, after.user + after.system - before.user - before.system


def measure(
    ground: Any, thing: Any, size: tuple[int, int], spp: int, noise: float | None
) -> dict[str, Any]:
    """The four pictures."""
    options: dict[str, Any] = {"resolution": size, "light_paths": "off"}
    plate = dg.render(scene("empty", ground, thing), camera(), spp=8 * spp, seed=9, **options).rgb
    if noise is not None:
        options, spp = options | {"noise": noise}, MOST
    found: dict[str, Any] = {}
    for way in WAYS:
        made = scene(way, ground, thing)
        clear = {"background": "transparent"} if way == "alone" else {}

        def draw(seed: int, made: dg.Scene = made, clear: dict[str, Any] = clear) -> dg.Frame:
            return dg.render(made, camera(), spp=spp, seed=seed, **options, **clear)

        frames = [cpu(lambda seed=seed: draw(seed)) for seed in (1, 2, 3)]
        one, two = (frame for frame, _ in frames[:2])
        pictures = [
            change_of_rgb(f, "difference").of(plate) if way == "caught" else f.rgb
            for f in (one, two)
        ]
        error = float(np.square(pictures[0] - pictures[1]).mean() / 2 / pictures[0].mean() ** 2)
        found[way] = {"cpu": min(seconds for _, seconds in frames), "error": error}
    whole, caught = found["whole"], found["caught"]
    found["ratio"] = caught["cpu"] * caught["error"] / (whole["cpu"] * whole["error"])
    found["over_whole"] = caught["cpu"] / whole["cpu"]
    found["over_holdout"] = caught["cpu"] / found["holdout"]["cpu"]
    found["over_alone"] = caught["cpu"] / found["alone"]["cpu"]
    return found


def main() -> None:
    """Prints a line for each pair of materials."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--res", default="240x160")
    parser.add_argument("--noise", type=float)
    arguments = parser.parse_args()
    width, height = map(int, arguments.res.split("x"))
    found = {
        f"{thing} on {ground}": measure(
            MATERIALS[ground], OBJECTS[thing], (width, height), arguments.spp, arguments.noise
        )
        for ground in MATERIALS
        for thing in OBJECTS
    }
    if arguments.json:
        print(json.dumps(found))
        return
    for name, one in found.items():
        print(
            f"{name:16} CPU {one['caught']['cpu']:.2f} s, without the layer "
            f"{one['holdout']['cpu']:.2f} s, whole {one['whole']['cpu']:.2f} s, alone "
            f"{one['alone']['cpu']:.2f} s; CPU x error {one['ratio']:.2f} of the whole scene's"
        )


if __name__ == "__main__":
    main()
