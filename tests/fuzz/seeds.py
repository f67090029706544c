"""Good files of each kind that :mod:`tests.fuzz.readers` changes."""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg
from daguerre import calibration
from daguerre.calibration import Calibration
from daguerre.camera.projection import Projection
from daguerre.rendering.passes import pass_of, write_pass
from daguerre.rendering.session import Session
from daguerre.scene.packed.chunk import embed
from tests.bad_files import bases
from tests.bad_files.exr_files import LIE, READ
from tests.faults.scene import write_scene
from tests.importers.gltf import test_gltf_compressed_images as ktx2
from tests.importers.gltf import test_gltf_draco as draco
from tests.importers.gltf import test_gltf_meshopt as meshopt
from tests.importers.mitsuba import scene_files
from tests.importers.pbrt import everything as pbrt_scene
from tests.lenses.test_lens_fuzz import SEEDS as LENSES
from tests.support.formats import mesh_files, tracked
from tests.support.formats.nanovdb_files import Writer, segment
from tests.support.pictures.plate_frames import of_light
from tests.support.scene.packed_scenes import everything

from .messages import answers as answers
from .messages import requests as requests
from .shot_seeds import rares as rares
from .shot_seeds import raws as raws
from .shot_seeds import tagged as tagged
from .stage_seeds import usdas as usdas
from .stage_seeds import usdcs as usdcs
from .stage_seeds import usdzs as usdzs

#: A file's name and bytes.
Seed = tuple[str, bytes]
ROOT = Path(__file__).resolve().parents[2]
LIBRARY = Path(dg.__file__).parent
POINTS = ("opencv", (520.0, 515.0), (331.3, 236.8), (-0.28, 0.09, 1e-3, -2e-3, -0.01))


def small_scene() -> dg.Scene:
    """An object below an even sky."""
    scene = dg.Scene()
    mesh = scene.add_mesh([[-1, -1, -3], [1, -1, -3], [0, 1, -3]], [[0, 1, 2]])
    scene.add_instance(mesh, dg.Diffuse((0.5, 0.4, 0.3)), name="sail")
    scene.set_environment(color=(1, 0.9, 0.8))
    return scene


def small(**settings: object) -> Session:
    """A drawn picture of a few pixels, with an object in it."""
    session = Session(
        small_scene(), dg.Camera(lens_model="pinhole"), resolution=(12, 8), **settings
    )
    session.draw(0, 4)
    return session


def scenes(folder: Path) -> Iterator[Seed]:
    for make in (bases.full, bases.moving, bases.seen):
        yield "scene.glb", make().glb(folder / "a.glb").read_bytes()
        yield "scene.gltf", make().gltf(folder / "a.gltf").read_bytes()


def packed(folder: Path) -> Iterator[Seed]:
    """Meshes and textures that libraries unpack, or our own code (meshopt)."""
    sheet = draco.stream()
    made = [
        draco.sheet(sheet, draco.ids(sheet)),
        meshopt.grid(),
        meshopt.grid("EXT", "positions v1", "INDICES"),
    ]
    made += [
        ktx2.scene("KHR_texture_basisu", data, plain=False, required=True)
        for data in ktx2.KTX2.values()
    ]
    made.append(ktx2.scene("EXT_texture_webp", ktx2.webp(folder), plain=False, required=True))
    for one in made:
        yield "packed.glb", one.glb(folder / "a.glb").read_bytes()


def exact(folder: Path) -> Iterator[Seed]:
    """Files with a scene as it is."""
    for scene in (everything(), small_scene()):
        path = write_scene(folder / "a.glb")
        embed(path, scene)
        yield "exact.glb", path.read_bytes()


def lenses(folder: Path) -> Iterator[Seed]:
    for text, suffix in LENSES:
        yield f"lens{suffix}", text.encode()


def exrs(folder: Path) -> Iterator[Seed]:
    import OpenImageIO as oiio

    frame = small(aovs=True, cryptomatte="object,material").frame()
    frame.save(folder / "plain.exr")
    yield "frame.exr", (folder / "plain.exr").read_bytes()
    for kind in ("none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"):
        spec = oiio.ImageSpec(12, 8, 3, oiio.HALF)
        spec.attribute("compression", kind)
        output = oiio.ImageOutput.create("openexr")
        output.open(str(folder / "k.exr"), spec)
        output.write_image(np.ascontiguousarray(frame.rgb))
        output.close()
        yield f"{kind}.exr", (folder / "k.exr").read_bytes()
    for name, made in (*READ.items(), *((n, m) for n, (m, _) in LIE.items())):
        data = made.data()
        if len(data) < 20_000:
            yield f"{name}.exr".replace(" ", "-"), data


def passes(folder: Path) -> Iterator[Seed]:
    for settings in ({}, {"aovs": True, "cryptomatte": "object"}, {"background": "transparent"}):
        session = small(**settings)
        write_pass(folder / "pass.exr", session.frame(), pass_of(session))
        yield "pass.exr", (folder / "pass.exr").read_bytes()


def calibrations(folder: Path) -> Iterator[Seed]:
    model, focal, center, numbers = POINTS
    made = Calibration(Projection(model, (640, 480), focal, center, numbers))
    for kind in calibration.WRITTEN:
        for suffix in ("yaml", "json"):
            path = folder / f"{kind}.{suffix}"
            try:
                calibration.write(path, made, kind)
            except dg.DaguerreError:
                continue
            yield path.name, path.read_bytes()
    moments = tracked.path(3)
    yield "take.json", tracked.opentrackio(folder / "take.json", moments).read_bytes()
    yield "transforms.json", tracked.nerfstudio(folder / "t.json", moments).read_bytes()
    for name in ("fisheye.yaml", "phone.yaml", "stereo.yaml"):
        yield name, (ROOT / "scenes" / "calibrated" / name).read_bytes()


def recipes(folder: Path) -> Iterator[Seed]:
    """JSON of our own: sensors, stocks, cameras of plates, settings, effects, categories."""
    for room in ("sensors", "stocks"):
        for path in sorted((LIBRARY / room / "library").glob("*.json"))[:3]:
            yield f"{room}.json", path.read_bytes()
    settings = dg.RenderSettings.of(spp=16, resolution=(12, 8), noise=0.1, aovs=True)
    yield "settings.json", json.dumps(settings.to_json()).encode()
    effects = [{"effect": "vignetting", "model": "natural"}, {"effect": "distortion", "k1": 0.01}]
    yield "effects.json", json.dumps([*effects, {"effect": "glow", "strength": 0.2}]).encode()
    categories = ROOT / "scenes" / "calibrated" / "categories.json"
    yield "categories.json", categories.read_bytes()
    shot(folder, "dng")
    dg.match_plate(folder / "shot.dng").save(folder / "camera.json")
    yield "camera.json", (folder / "camera.json").read_bytes()


def shot(folder: Path, ending: str) -> Path:
    """A photograph of edges in noise."""
    light = np.kron(np.random.default_rng(1).random((6, 9)), np.ones((40, 40)))
    facts = {"expTime": 0.01, "aperture": 4.0, "isoSpeed": 400.0, "nominalFocalLength": 50.0}
    frame = of_light(light, 0.6 * 78 / 400, **facts)
    path = folder / f"shot.{ending}"
    if ending == "exr":
        frame.save(path)
    else:
        frame.expose("sony-a7r-ii", 400).save(path)
    return path


def pictures(folder: Path) -> Iterator[Seed]:
    import OpenImageIO as oiio

    for ending in ("dng", "jpg", "png", "tif", "exr"):
        yield f"shot.{ending}", shot(folder, ending).read_bytes()
    pixels = np.random.default_rng(1).random((9, 14, 3)).astype(np.float32)
    for ending in ("hdr", "png", "jpg", "tif"):
        output = oiio.ImageOutput.create(f"a.{ending}")
        spec = oiio.ImageSpec(14, 9, 3, oiio.FLOAT if ending in ("hdr", "tif") else oiio.UINT8)
        output.open(str(folder / f"a.{ending}"), spec)
        output.write_image(pixels)
        output.close()
        yield f"a.{ending}", (folder / f"a.{ending}").read_bytes()


def profiles(folder: Path) -> Iterator[Seed]:
    """Photometric files of three years, with symmetries and included tilts."""
    facts = "1 1000 1 3 {} 1 2 0 0 0 1 1 60"
    for head, tilt, phi in (
        ("IESNA:LM-63-1995", "NONE", "0"),
        ("IES:LM-63-2019", "NONE", "0 45 90"),
        ("[TEST] none", "INCLUDE\n1\n2\n0 90\n1 0.8", "0 90 180 270 360"),
    ):
        columns = len(phi.split())
        candelas = "\n".join(f"{900 + i} {400 + i} {50 + i}" for i in range(columns))
        lines = head, f"TILT={tilt}", facts.format(columns), "0 45 90", phi, candelas
        yield "lamp.ies", "\n".join(lines).encode()


def _values() -> dict[str, Any]:
    """Columns of 12 vertices."""
    rng = np.random.default_rng(6)
    names = ["x", "y", "z", "nx", "ny", "nz", "u", "v", "r", "g", "b"]
    return dict(zip(names, rng.random((len(names), 12)), strict=True))


#: Faces of a few sizes, and more of them than are read one by one.
FACES = [(0, 1, 2), (2, 3, 4), (4, 5, 6, 7), (7, 8, 9), (0, 3, 6, 9, 11), (1, 4, 8, 10), (3, 5, 7)]


def plys(folder: Path) -> Iterator[Seed]:
    values, points = _values(), {key: _values()[key] for key in "xyz"}
    uv = [[0.5] * (2 * len(face)) for face in FACES]
    yield "text.ply", mesh_files.ply(values, FACES, "")
    yield "little.ply", mesh_files.ply(values, FACES, "<", uv=uv)
    yield "big.ply", mesh_files.ply(points, FACES, ">", length="i4", index="u2")
    yield "triangles.ply", mesh_files.ply(points, FACES[:2] * 50, "<")
    yield "mixed.ply", mesh_files.ply(points, FACES * 30, "<", index="u1")
    yield "packed.ply", gzip.compress(mesh_files.ply(values, FACES))


def meshes(folder: Path) -> Iterator[Seed]:
    yield (
        "mesh.obj",
        b"# comment\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nvt 0 0\nvt 1 1\nvn 0 0 1\ng a\n"
        b"f 1/1/1 2/2/1 3/1/1 4//1\nf -1 -2 \\\n -3\nusemtl b\nf 1//1 2//1 3//1\nl 1 2\n",
    )
    yield "uv.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n" * 9
    rng = np.random.default_rng(7)
    mesh: dict[str, Any] = {
        "positions": rng.random((6, 3)), "normals": rng.random((6, 3)), "uv": rng.random((6, 2)),
        "triangles": [(0, 1, 2), (3, 4, 5)], "name": "mesh",
    }  # fmt: skip
    yield "four.serialized", mesh_files.serialized([mesh, mesh])
    yield "three.serialized", mesh_files.serialized([mesh, mesh], 3, "<f8")


def grids(folder: Path) -> Iterator[Seed]:
    grid = Writer({(0, 0, 0): 1.0, (9, 0, 0): 2.0}, {((16, 8, 0), 8): 2.5}).bytes()
    yield "smoke.vol", mesh_files.vol(np.random.default_rng(8).random((2, 3, 4, 1)))
    yield "bytes.vol", mesh_files.vol(np.ones((2, 3, 4, 3)), kind=3)
    yield "raw.nvdb", grid
    yield "plain.nvdb", segment([("a", grid), ("b", grid)])
    yield "zipped.nvdb", segment([("a", grid)], 1)


def pbrts(folder: Path) -> Iterator[Seed]:
    """Scenes of pbrt, with the files that they name beside them."""
    data = pbrt_scene.everything(folder)[0].read_bytes()
    yield "scene.pbrt", data
    yield "v3.pbrt", data + b"WorldEnd"


def mitsubas(folder: Path) -> Iterator[Seed]:
    """Scenes of Mitsuba, of today and of 0.6, with a mesh beside them."""
    (folder / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n")
    yield "rich.xml", scene_files.text_of(*scene_files.RICH)
    yield "many.xml", scene_files.text_of(*scene_files.MANY)
    yield "old.xml", scene_files.text_of(*scene_files.OLD, version="0.6.0")
