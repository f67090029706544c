"""Daguerre's side of ``bench/ajar.py``."""

from __future__ import annotations

import room
from side import DEPTH, answer, arguments, cpu_seconds

import daguerre as dg
from daguerre.rendering.session import Session


def scene() -> dg.Scene:
    """The room as a scene."""
    made = dg.Scene()
    matter = {}
    for name, (kind, color) in room.MATERIALS.items():
        look = dg.Diffuse(color) if kind == "diffuse" else dg.Conductor(color, alpha=room.ALPHA)
        matter[name] = made.add_material(dg.Material(look))
    for mesh, material in room.build().values():
        made.add_instance(made.add_mesh(*mesh), matter[material])
    light = dg.Material(dg.Diffuse((0, 0, 0)), emission=room.LAMP["radiance"])
    made.add_instance(made.add_mesh(*room.lamp()), light)
    return made


def camera() -> dg.Camera:
    """A thin lens on 36 mm."""
    return dg.Camera(
        transform=room.camera_matrix(),
        lens="thin",
        focal_length=room.CAMERA["focal_mm"],
        f_stop=room.CAMERA["f_stop"],
        focus_distance=room.focus_distance(),
    )


def main() -> None:
    """Renders once and reports."""
    options = arguments()
    session = Session(
        scene(),
        camera(),
        resolution=(options.w, options.h),
        seed=options.seed,
        filter="box",
        threads=options.threads,
        max_depth=DEPTH,
    )
    before = cpu_seconds()
    session.draw(0, options.spp)
    cpu = cpu_seconds() - before
    rays = session.counters.rays
    answer(options.out, session.frame().rgb, f"daguerre {dg.__version__}", cpu, rays=rays)


if __name__ == "__main__":
    main()
