"""Uses of a file that :mod:`tests.fuzz.readers` changed: read, and what is quick."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

import daguerre as dg
from daguerre import calibration
from daguerre.development.camera_raw import read_shot
from daguerre.errors import InputError
from daguerre.files import formats
from daguerre.files.notes import Notes
from daguerre.importers.meshes import obj, ply, serialized
from daguerre.importers.volumes import nanovdb, vol
from daguerre.labels.categories import Categories
from daguerre.pictures.iris import read_grey
from daguerre.plates import files as plates
from daguerre.post import recipe as effects
from daguerre.shading.picture_bytes import decoded
from daguerre.stocks import load as load_stock

from .messages import answered as answered
from .messages import requested as requested

TINY = {"resolution": (8, 6), "spp": 1, "threads": 1}


def scene(path: Path) -> None:
    made = dg.load(path)
    camera = made.camera() if made.cameras else dg.Camera(lens_model="pinhole")
    dg.render(made, camera, **TINY)


def drawn(path: Path) -> None:
    """Reads a scene, through its own camera if it has one, and draws 4 x 4 px."""
    made = dg.load(path)
    camera = made.camera() if made.cameras else dg.Camera(lens_model="pinhole")
    dg.render(made, camera, **{**TINY, "resolution": (4, 4)})


def raw(path: Path) -> None:
    """Reads a raw photograph as plate, and develops it."""
    _all(lambda: plates.read(path), lambda: dg.development.develop(read_shot(path)))


def lens(path: Path) -> None:
    made = dg.lenses.load(str(path))
    sky = dg.Scene()
    sky.set_environment(color=(1, 1, 1))
    dg.render(sky, dg.Camera(lens=made, focus_distance=5.0), **TINY)


def exr(path: Path) -> None:
    _all(lambda: formats.read("environment", path), lambda: formats.read("frame", path))


def profile(path: Path) -> None:
    """Lights a wall with a photometric file."""
    wall = dg.Scene()
    mesh = wall.add_mesh([[-9, -9, -3], [9, -9, -3], [0, 9, -3]], [[0, 1, 2]])
    wall.add_instance(mesh)
    read = dg.LightProfile.from_ies(path)
    wall.add_light(
        dg.PointLight(profile=read.stretched(0.7).normalized() * dg.LightProfile.focus(9))
    )
    dg.render(wall, dg.Camera(lens_model="pinhole"), **TINY)


def mesh(path: Path) -> None:
    """Reads all meshes of a file and draws them."""
    notes, suffix = Notes(), path.suffix
    if suffix == ".serialized":
        found = [serialized.read(path, i) for i in range(serialized.count(path))]
    else:
        found = [(ply if suffix == ".ply" else obj).read(path, notes)]
    made = dg.Scene()
    for one in found:
        made.add_instance(one.add_to(made, "mesh", colors=True))
    dg.render(made, dg.Camera(lens_model="pinhole"), **TINY)


def grid(path: Path) -> None:
    read = (vol if path.suffix == ".vol" else nanovdb).read(path)
    assert np.isfinite(read.values).all()
    assert np.isfinite(read.transform).all()


def samples(path: Path) -> None:
    dg.merge([path])


def calibrated(path: Path) -> None:
    for one in calibration.read_all(path).values():
        one.camera()


def recipe(path: Path) -> None:
    """Reads JSON of our own by the kind in its name."""
    name = path.name.removeprefix("case-")
    if name == "sensors.json":
        dg.sensors.load(path)
    elif name == "stocks.json":
        load_stock(path)
    elif name == "effects.json":
        effects.from_file(path)
    elif name == "categories.json":
        Categories.read(path)
    elif name == "camera.json":
        dg.read_plate_camera(path)
    else:
        try:
            value = json.loads(path.read_bytes())
        except (ValueError, RecursionError):
            raise InputError("no JSON") from None
        dg.RenderSettings.from_json(value)


def picture(path: Path) -> None:
    """Reads a photograph as light, as plate and as iris."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        _all(
            lambda: formats.read("environment", path),
            lambda: plates.read(path),
            lambda: read_grey(path),
        )


def texture(path: Path) -> None:
    """Reads a picture as a texture."""
    decoded(path.read_bytes(), path.name, "texture")


def _all(*ways: Callable[[], object]) -> None:
    """Runs them; raises the last refusal."""
    refused: dg.DaguerreError | None = None
    for way in ways:
        try:
            way()
        except dg.DaguerreError as error:
            refused = error
    if refused is not None:
        raise refused
