#!/usr/bin/env python3
"""Blender's default scene, with lamps around it, through a lens that Daguerre exported.

    daguerre lens double-gauss-50mm-f2 --focus 0.96 --export out/double_gauss.osl
    python script/docs/gallery/blender_lens.py out/double_gauss.osl out/blender_lens.jpg
        [--spp 384] [--own]

Runs in a Python that has `bpy` (pip install bpy, or Blender's own); Daguerre is not needed there.
One unit of the scene stands for 10 cm, so the cube is a box of 20 cm, 0.96 m away. `--own`: through
the camera that Blender has itself, 50 mm with the same opening.
"""

from __future__ import annotations

import argparse
import hashlib
import tempfile
from pathlib import Path

import bpy
from mathutils import Vector

METRES = 0.1  # per unit
FOCUS = 0.96  # m, the cube's nearest edge
ACROSS = 50e-3 / 2.0  # m, the pupil of a 50 mm f/2
LAMPS = 14.0  # radiance
COLOURS = ((1.0, 0.6, 0.25), (1.0, 0.85, 0.6), (0.35, 0.6, 1.0), (1.0, 0.2, 0.1))


def main() -> None:
    """Renders one picture."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("lens", type=Path, help="what daguerre lens --export wrote, .osl")
    parser.add_argument("output", type=Path, nargs="?", default=Path("out/blender_lens.jpg"))
    parser.add_argument("--spp", type=int, default=384)
    parser.add_argument("--size", type=int, nargs=2, default=(840, 560))
    parser.add_argument("--own", action="store_true")
    given = parser.parse_args()
    bpy.ops.wm.read_factory_settings()
    scene = bpy.context.scene
    add_lamps()
    camera = scene.camera.data
    if given.own:
        camera.dof.use_dof = True
        camera.dof.focus_distance = FOCUS / METRES
        camera.dof.aperture_fstop = camera.lens * 1e-3 / (ACROSS / METRES)
    else:
        set_lens(camera, given.lens, metres=METRES)
    render(scene, given.output, given.spp, *given.size)


def set_lens(camera: bpy.types.Camera, path: Path, **parameters: float) -> None:
    """Puts an exported lens on a camera of Cycles: what the buttons of Blender do, in a script."""
    import _cycles  # exists once bpy is loaded

    with tempfile.TemporaryDirectory() as folder:
        compiled = Path(folder) / "lens.oso"
        if not _cycles.osl_compile(str(path), str(compiled)):
            raise SystemExit(f"{path}: wanted a camera shader in OSL")
        code = compiled.read_text()
    camera.type, camera.custom_mode = "CUSTOM", "INTERNAL"
    camera.custom_bytecode = code
    camera.custom_bytecode_hash = hashlib.md5(code.encode(), usedforsecurity=False).hexdigest()
    for name, value in parameters.items():
        camera.cycles_custom[name] = value
    camera.update_tag()


def add_lamps() -> None:
    """A wall of small lamps 6 m away, far out of focus, as wide as the picture."""
    view = bpy.context.scene.camera.matrix_world
    for row in range(-3, 4):
        for column in range(-5, 6):
            shift = 0.25 if row % 2 else -0.25
            place = Vector((4.2 * (column + shift), 4.4 * row, -60.0))
            ball(view @ place, 0.2, COLOURS[(2 * row + column) % 4])


def ball(place: Vector, radius: float, colour: tuple[float, float, float]) -> None:
    """One lamp."""
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=place)
    material = bpy.data.materials.new("lamp")
    tree = material.node_tree
    tree.nodes.clear()
    light = tree.nodes.new("ShaderNodeEmission")
    light.inputs["Color"].default_value = (*colour, 1.0)
    light.inputs["Strength"].default_value = LAMPS
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(light.outputs[0], output.inputs["Surface"])
    bpy.context.object.data.materials.append(material)


def render(scene: bpy.types.Scene, path: Path, spp: int, width: int, height: int) -> None:
    """With Cycles, on the CPU."""
    scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
    scene.cycles.samples, scene.cycles.use_adaptive_sampling = spp, False
    scene.cycles.use_denoising = True
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    formats = {".jpg": "JPEG", ".png": "PNG", ".exr": "OPEN_EXR"}
    scene.render.image_settings.file_format = formats[path.suffix.lower()]
    path.parent.mkdir(parents=True, exist_ok=True)
    scene.render.filepath = str(path.resolve())
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main()
