"""Installs the extension's zip in Blender, renders with it, and prints where its modules lie.

Called with the zip, and with the name of a picture to draw of the scene that Blender starts with.
"""

from __future__ import annotations

import json
import sys
from typing import Any

import bpy


def draw(path: str) -> list[list[float]]:
    """Draws a small picture into a file; colours of its corner and of its middle."""
    import OpenImageIO as oiio

    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 64, 48
    scene.daguerre.spp = 4
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    pixels: Any = oiio.ImageBuf(path).get_pixels()
    return [[float(value) for value in pixels[y, x, :3]] for y, x in ((0, 0), (24, 32))]


def main() -> None:
    done = bpy.ops.extensions.package_install_files(
        filepath=sys.argv[1], repo="user_default", enable_on_install=True
    )
    import daguerre

    bpy.context.scene.render.engine = "DAGUERRE"
    facts = {
        "done": sorted(done),
        "package": daguerre.__file__,
        "core": sys.modules["daguerre._core"].__file__,
        "engine": bpy.context.scene.render.engine,
        "lens": bpy.context.scene.camera.data.daguerre.lens,
        "colours": draw(sys.argv[2]) if len(sys.argv) > 2 else [],
        "modules": {
            name: str(module.__file__)
            for name, module in list(sys.modules.items())
            if "." not in name and getattr(module, "__file__", None)
        },
    }
    print("FACTS " + json.dumps(facts))


main()
