"""The exported scene: the copied command draws the bits of F12, in a process of its own."""

from __future__ import annotations

import math
import os
import shlex
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.blender.settings import factor_of
from daguerre.io.gltf.reader import read
from tests.support import blender_extension

bpy = pytest.importorskip("bpy", reason="needs bpy, the wheel of Blender")

SIZE = 48, 36


@pytest.fixture
def made(tmp_path):
    """Blender's default scene with the engine."""
    bpy.ops.wm.read_factory_settings()
    extension = blender_extension.extension()
    extension.register()
    scene = bpy.context.scene
    scene.render.engine = "DAGUERRE"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    scene.render.filepath = str(tmp_path / "out.exr")
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.daguerre.spp = 4
    yield scene
    extension.unregister()


def drawn(path):
    """Colours of a picture file, float32, (H, W, 3)."""
    return oiio.ImageBuf(str(path)).get_pixels(oiio.FLOAT)[..., :3]


def exported(folder):
    """Exports the scene; returns its file and the words of its command."""
    path = folder / "scene.glb"
    assert bpy.ops.daguerre.export_scene("EXEC_DEFAULT", filepath=str(path)) == {"FINISHED"}
    script = path.with_suffix(".sh").read_text()
    return path, shlex.split(script.split("\n", 1)[1])


def by_command(words):
    """The picture of a command, drawn in a process of its own."""
    assert words[:2] == ["daguerre", "render"]
    here = {**os.environ, "PYTHONPATH": str(blender_extension.ROOT / "python")}
    run = subprocess.run(
        [sys.executable, "-m", "daguerre", *words[1:]],
        capture_output=True, text=True, check=False, env=here,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    return drawn(words[words.index("-o") + 1]), run.stderr


def check_same(scene, folder):
    """Checks that F12 and the copied command draw the same bits; returns the picture."""
    bpy.ops.render.render(write_still=True)
    ours = drawn(scene.render.filepath)
    _, words = exported(folder)
    theirs, said = by_command(words)
    factor = np.float32(factor_of(scene))
    np.testing.assert_array_equal(ours, theirs * factor)
    assert ours.std() > 0
    assert "plain glTF" not in said
    return ours


def test_the_default_scene(made, tmp_path):
    check_same(made, tmp_path)
