"""Daguerre's side of ``bench/peers.py``: the dof-field scene, built from arrays.

Takes the arguments of the peers' scripts, writes OUT.npy (H, W, 3) and prints ``RESULT {json}``.
With ``--mode mb`` 40 of the 200 objects travel and turn 45 degrees while the shutter is open, and
with ``--mode pan`` the camera turns by 2 degrees. The module ``scene`` of the peers' folder must be
importable.
"""

from __future__ import annotations

import argparse
import json
import resource
import time

import numpy as np
import scene as dof_field  # type: ignore[import-not-found]

import daguerre as dg
from daguerre.rendering.rounds import rounds
from daguerre.rendering.session import Session

MODES = ("pinhole", "thin", "mb", "pan")
SHUTTER = 1 / 48  # s, from time 0
PAN_DEG = 2.0
QUAD = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float32)


def cpu_seconds() -> float:
    """User and system time of this process."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def peak_mb() -> float:
    """The most memory that this process has held, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def material(name: str) -> dg.Material:
    """One of the scene's five materials and its ground."""
    kind, value = dof_field.MATERIALS[name]
    if kind == "diffuse":
        return dg.Material(dg.Diffuse(tuple(value)))
    if kind == "glossy":
        return dg.Material(dg.Conductor(tuple(value), alpha=dof_field.ALPHA))
    return dg.Material(dg.Dielectric(ior=value))


def build(mode: str) -> dg.Scene:
    """The scene: ground, 200 instances of three meshes, an area light and a constant sky."""
    source = dof_field.build()
    scene = dg.Scene(time=SHUTTER / 2)
    materials = {name: scene.add_material(material(name)) for name in dof_field.MATERIALS}
    ground = scene.add_mesh(QUAD * 60, [(0, 1, 2), (0, 2, 3)])
    scene.add_instance(ground, materials["ground"])
    meshes = {name: scene.add_mesh(v, f) for name, (v, f) in source["meshes"].items()}
    for item in source["inst"]:
        place = item["M0"]
        if mode == "mb" and item["moving"]:
            place = dg.keys([(0.0, item["M0"]), (SHUTTER, item["M1"])])
        scene.add_instance(meshes[item["mesh"]], materials[item["mat"]], place)
    lamp = dg.Material(dg.Diffuse((0.0, 0.0, 0.0)), emission=tuple(dof_field.LIGHT["radiance"]))
    quad = scene.add_mesh(QUAD * dof_field.LIGHT["half"], [(0, 2, 1), (0, 3, 2)])
    scene.add_instance(quad, lamp, dof_field.light_matrix())
    scene.set_environment(color=dof_field.ENV)
    return scene


def camera(mode: str) -> dg.Camera:
    """50 mm on 36 mm, f/1.4, focused as the scene says."""
    cam = dof_field.CAM
    place = dof_field.lookat(cam["origin"], cam["target"], cam["up"])
    if mode == "pan":
        angles = np.radians((-PAN_DEG / 2, PAN_DEG / 2))
        turned = [place @ dof_field.rot((0, 1, 0), angle) for angle in angles]
        place = dg.keys(list(zip((0.0, SHUTTER), turned, strict=True)))
    return dg.Camera(
        transform=place,
        shutter_time=SHUTTER,
        lens="pinhole" if mode == "pinhole" else "thin",
        focal_length=cam["focal_mm"],
        f_stop=None if mode == "pinhole" else cam["fstop"],
        focus_distance=None if mode == "pinhole" else cam["focus"],
    )


def main() -> None:
    """Renders once and reports."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--mode", choices=MODES, default="thin")
    parser.add_argument("--w", type=int, default=640)
    parser.add_argument("--h", type=int, default=360)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--noise", type=float, help="adaptive, to this relative error; no --spp")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--strategy", default="mis")
    parser.add_argument("--out", required=True)
    options = parser.parse_args()
    imported = peak_mb()
    scene = build(options.mode)
    started = time.perf_counter()
    session = Session(
        scene,
        camera(options.mode),
        resolution=(options.w, options.h),
        seed=options.seed,
        filter="box",
        threads=options.threads,
        max_depth=8,
        strategy=options.strategy,
    )
    ready, cpu = time.perf_counter(), cpu_seconds()
    if options.noise:
        for _ in rounds(session, options.noise):
            pass
    else:
        session.draw(0, options.spp)
    cpu, wall = cpu_seconds() - cpu, time.perf_counter() - ready
    picture = session.frame().rgb
    np.save(options.out + ".npy", picture)
    result = {
        "renderer": f"daguerre {dg.__version__}",
        "build_s": round(ready - started, 3),
        "render_s": round(wall, 3),
        "cpu_s": round(cpu, 2),
        "rays": session.counters.rays,
        "spp": session.metadata["samples"],
        "peak_rss_mb": round(peak_mb()),
        "scene_rss_mb": round(peak_mb() - imported, 1),
        "mean": float(picture.mean()),
    }
    print("RESULT " + json.dumps(result), flush=True)


if __name__ == "__main__":
    main()
