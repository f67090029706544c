"""Daguerre's side of ``bench/rooms.py``: a room by its name, or a scene file."""

from __future__ import annotations

from side import answer, arguments, cpu_seconds

import daguerre as dg
from daguerre.rendering.session import Session


def main() -> None:
    """Renders once and reports."""
    options = arguments(room=str, sky=int, depth=int)
    before = cpu_seconds()
    if options.room.endswith(".xml"):
        scene = dg.load(options.room)
    else:
        from sky_rooms.made import ROOMS

        scene = ROOMS[options.room](options.sky)
    read = cpu_seconds()
    session = Session(
        scene,
        resolution=(options.w, options.h),
        seed=options.seed,
        filter="box",
        threads=options.threads,
        max_depth=options.depth,
    )
    ready = cpu_seconds()
    session.draw(0, options.spp)
    cpu = cpu_seconds() - ready
    answer(
        options.out,
        session.frame().rgb,
        f"daguerre {dg.__version__}",
        cpu,
        scene_cpu_s=round(read - before, 2),
        setup_cpu_s=round(ready - read, 2),
        rays=session.counters.rays,
        light_paths=session.light_paths,
    )


if __name__ == "__main__":
    main()
