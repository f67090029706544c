#!/usr/bin/env python3
"""Scenes of Blender, rendered by F12: by Daguerre through a real lens, and by Cycles.

    python script/docs/gallery/blender_engine.py cube out/blender_cube.jpg [--spp 256] [--width 480]
    python script/docs/gallery/blender_engine.py arm out/blender_arm.jpg
    python script/docs/gallery/blender_engine.py nodes out/blender_nodes.jpg

Runs in a Python that has `bpy` and `daguerre[denoise]`. The left half is Daguerre's, by the engine
of `extensions/blender`; the right half is by Cycles through Blender's own camera, of the same focal
length, f-stop and focus. Both have the same samples and are denoised by Open Image Denoise. The
scenes are in `blender_scenes.py`; nothing of them comes from elsewhere.
"""

from __future__ import annotations

import argparse
import importlib.util
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import blender_scenes
import bpy
import numpy as np
import OpenImageIO as oiio

ROOT = Path(__file__).resolve().parents[3]


def main() -> None:
    """Renders one scene twice, and puts both pictures side by side."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("scene", choices=blender_scenes.SHOTS)
    parser.add_argument("output", type=Path)
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--width", type=int, default=480, help="of each half, px")
    given = parser.parse_args()
    add_engine()
    bpy.ops.wm.read_factory_settings()
    shot = blender_scenes.SHOTS[given.scene]()
    halves = [drawn(shot, engine, given.spp, given.width) for engine in ("DAGUERRE", "CYCLES")]
    pixels = oiio.ImageBuf(np.ascontiguousarray(np.concatenate(halves, axis=1)))
    pixels.specmod().attribute("Compression", "jpeg:92")
    given.output.parent.mkdir(parents=True, exist_ok=True)
    if not pixels.write(str(given.output)):
        raise SystemExit(pixels.geterror())


def add_engine() -> None:
    """Registers the extension from its folder, as Blender does with an installed one."""
    folder = ROOT / "extensions" / "blender"
    spec = importlib.util.spec_from_file_location(
        "daguerre_engine", folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    if spec is None or spec.loader is None:
        raise SystemExit(f"{folder}: wanted the extension")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    module.register()


def drawn(shot: blender_scenes.Shot, engine: str, spp: int, width: int) -> Any:
    """Picture of a shot by one engine, shape (H, W, 3), as Blender's display shows it."""
    scene, camera = bpy.context.scene, bpy.context.scene.camera.data
    render = scene.render
    render.engine, render.resolution_percentage = engine, 100
    render.resolution_x, render.resolution_y = width, width * 2 // 3
    render.image_settings.file_format = "PNG"
    scene.cycles.device, scene.cycles.samples = "CPU", spp
    scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = False, True
    scene.daguerre.spp, scene.daguerre.denoise = spp, True
    scene.daguerre.light_paths = "off"
    for name, value in shot.lens.items():
        setattr(camera.daguerre, name, value)
    metres = scene.unit_settings.scale_length
    camera.dof.use_dof, camera.dof.focus_distance = True, shot.focus / metres
    camera.dof.aperture_fstop = shot.lens["f_stop"] * metres  # Cycles knows no unit
    begin = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        render.filepath = str(Path(folder) / "picture.png")
        bpy.ops.render.render(write_still=True)
        print(f"{engine}: {time.process_time() - begin:.0f} CPU seconds")
        return oiio.ImageBuf(render.filepath).get_pixels(oiio.UINT8)[..., :3]


if __name__ == "__main__":
    main()
