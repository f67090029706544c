"""The extension for Blender from its folder, and a stand-in for what it translates."""

from __future__ import annotations

import importlib.util
import sys
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

import daguerre as dg

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT / "extensions" / "blender"
NAME = "daguerre_extension"
#: Blender's value of a picture over ours, of the stand-in.
FACTOR = 0.5


def extension() -> ModuleType:
    """Imports the extension as Blender does, once."""
    if NAME in sys.modules:
        return sys.modules[NAME]
    spec = importlib.util.spec_from_file_location(
        NAME, FOLDER / "__init__.py", submodule_search_locations=[str(FOLDER)]
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[NAME] = module
    spec.loader.exec_module(module)
    return module


@contextmanager
def registered() -> Iterator[ModuleType]:
    """The extension, in Blender's default scene."""
    import bpy

    bpy.ops.wm.read_factory_settings()
    found = extension()
    found.register()
    try:
        yield found
    finally:
        found.unregister()


def staged(folder: Path, size: tuple[int, int]) -> Any:
    """The scene of Blender, to be drawn by the extension with 4 samples into folder/out.exr."""
    import bpy

    made = bpy.context.scene
    made.render.engine = "DAGUERRE"
    made.render.resolution_x, made.render.resolution_y = size
    made.render.resolution_percentage = 100
    made.render.filepath = str(folder / "out.exr")
    made.render.image_settings.file_format = "OPEN_EXR"
    made.render.image_settings.color_depth = "32"
    made.daguerre.spp = 4
    return made


def scene() -> dg.Scene:
    """A triangle before an even sky, whose top row is brighter than its bottom row."""
    made = dg.Scene()
    grey = made.add_material(dg.Diffuse((0.5, 0.5, 0.5)))
    made.add_instance(made.add_mesh([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0, 1, 2]]), grey)
    sky = np.ones((4, 8, 3), np.float32)
    sky[:2] = 3
    made.set_environment(sky)
    return made


def camera(**more: Any) -> dg.Camera:
    return dg.Camera(transform=dg.look_at((0, 0, 4), (0, 0, 0)), **more)


def stand_in(monkeypatch: Any, made: dg.Scene | None = None, **more: Any) -> None:
    """Puts a scene in the place of the translation; keywords are those of the camera."""
    module = extension().engine.translation
    shown = made or scene()

    def shot_of(depsgraph: Any, scene: dg.Scene, camera_object: Any, eye: Any = None) -> Any:
        blender = depsgraph.scene
        size = blender.render.resolution_x, blender.render.resolution_y
        group = blender.daguerre
        behind = "transparent" if blender.render.film_transparent else "environment"
        settings = dg.RenderSettings.of(
            resolution=size, spp=group.spp, light_paths="off", background=behind
        )
        ours = camera(**more)
        if eye is not None:  # as far beside the camera as Blender's, in camera's axes
            beside = np.linalg.inv(np.array(camera_object.matrix_world)) @ eye.matrix
            ours = ours.with_(transform=ours.transform @ np.asarray(beside, float))
        return module.Shot(scene, ours, settings, FACTOR)

    monkeypatch.setattr(module, "scene_of", lambda depsgraph, frame_set=None: shown)
    monkeypatch.setattr(module, "shot_of", shot_of)


def wheel_of_this(folder: Path) -> Path:
    """Packs the package that runs here as a wheel for this Python alone."""
    tag = f"cp3{sys.version_info.minor}"
    core = Path(str(import_module("daguerre._core").__file__))
    package, info = Path(dg.__file__).parent, f"daguerre-{dg.__version__}.dist-info"
    files = {f"daguerre/{core.name}": core.read_bytes()}
    bundled = package.with_name("daguerre.libs")  # libraries that an installed wheel has
    for path in (*package.rglob("*"), *bundled.glob("*")):
        if path.is_file() and path.suffix != ".pyc":
            files[path.relative_to(package.parent).as_posix()] = path.read_bytes()
    files[f"{info}/METADATA"] = (
        f"Metadata-Version: 2.1\nName: daguerre\nVersion: {dg.__version__}\n".encode()
    )
    files[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nRoot-Is-Purelib: false\nTag: {tag}-{tag}-linux_x86_64\n".encode()
    )
    files[f"{info}/RECORD"] = "".join(f"{name},,\n" for name in files).encode()
    path = folder / f"daguerre-{dg.__version__}-{tag}-{tag}-linux_x86_64.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return path
