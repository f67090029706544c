"""Values travel: they pickle, copy, compare and print, and draw the same bits elsewhere."""

from __future__ import annotations

import copy
import dataclasses
import multiprocessing
import pickle
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.checks import as_readonly
from daguerre.rendering.session import Session
from daguerre.setup.content_hash import content_hash
from tests.support.formats import motion_files
from tests.support.formats.make_gltf import Builder, png
from tests.support.scene import motion_scenes, scenes

EYE = np.eye(4)
ASIDE = motion_scenes.move(x=1)


def _file(name: str, folder: Path) -> Path:
    return motion_files.ALL[name]().glb(folder / f"{name.replace(' ', '_')}.glb")


def _of_arrays() -> dg.Scene:
    """Everything that arrays can make, moving."""
    scene = dg.Scene()
    corners = np.float32([[0, 0, -3], [1, 0, -3], [0, 1, -3]])
    card = scene.add_mesh(corners, [0, 1, 2], steps=([0, 1], np.stack([corners, corners + 1])))
    picture = scene.add_texture(np.arange(12, dtype=np.uint8).reshape(2, 2, 3), srgb=True)
    paint = dg.Gltf(base_color_texture=dg.TextureSlot(picture), roughness=dg.keys([(0, 0), (1, 1)]))
    scene.add_instance(card, dg.Material(paint), dg.spin((0, 0, 1), 2), name="card")
    moving = dg.keys([(0, EYE), (1, ASIDE)])
    scene.add_instance(card, dg.Dielectric(dispersion=0.4), moving, shown=dg.keys([(0, True)]))
    scene.add_light(dg.SphereLight((5, 5, 5), 0.5), moving)
    scene.set_environment(np.ones((4, 8, 3), np.float32), scale=dg.keys([(0, 1.0), (1, 2.0)]))
    scene.add_camera("a", dg.Camera(lens=dg.lenses.load(dg.lenses.names()[0]), f_stop=4))
    scene.add_camera("b", dg.Camera(transform=moving, focus_distance=dg.keys([(0, 1), (1, 2)])))
    return scene


def _frame() -> dg.Frame:
    rgb = np.linspace(0, 1, 48, dtype=np.float32).reshape(4, 4, 3)
    return dg.Frame(rgb, aovs={"depth.Z": np.full((4, 4), np.nan)}, metadata={"samples": 4})


VALUES: dict[str, Callable[[], Any]] = {
    "keys of matrices": lambda: dg.keys([(0, EYE), (1, ASIDE)], pivot=(1, 2, 3)),
    "keys of names": lambda: dg.keys([(0, "a"), (1, "b")]),
    "spin": lambda: dg.spin((0, 1, 0), 3, transform=dg.keys([(0, EYE), (1, ASIDE)])),
    "camera": lambda: dg.Camera(f_stop=2.8, sensor="ideal", aperture_image=np.eye(3, dtype="f4")),
    "camera with a lens": lambda: dg.Camera(lens=dg.lenses.load(dg.lenses.names()[0])),
    "camera that moves": lambda: dg.Camera(transform=dg.keys([(0, EYE), (1, ASIDE)])),
    "camera with a projection": lambda: dg.Camera(
        projection=dg.Projection.of_field("equidistant", (64, 64), 180)
    ),
    "scatter": dg.LensScatter,
    "rolling shutter": lambda: dg.RollingShutter("left", 1e-5),
    "sensor": lambda: dg.sensors.load(dg.sensors.names()[0]),
    "stock": lambda: dg.stocks.load(dg.stocks.names()[0]),
    "material": lambda: dg.Material(dg.Gltf(roughness=0.25, unlit=True), "paint"),
    "light": lambda: dg.SpotLight((1, 2, 3), 10, 20),
    "frame": _frame,
    "scene of arrays": _of_arrays,
}


@pytest.fixture(params=[*VALUES, *(f"file: {name}" for name in motion_files.ALL), "every lens"])
def value(request: pytest.FixtureRequest, tmp_path: Path) -> Any:
    name = request.param
    if name == "every lens":
        return [dg.lenses.load(one) for one in dg.lenses.names()]
    if name.startswith("file: "):
        return dg.load(_file(name[6:], tmp_path), time=1.0)
    return VALUES[name]()


def test_values_pickle_copy_compare_and_print(value: Any) -> None:
    for other in (pickle.loads(pickle.dumps(value)), copy.copy(value), copy.deepcopy(value)):
        assert type(other) is type(value)
        assert other == value
        assert repr(other) == repr(value)
    if not isinstance(value, list):
        assert len(repr(value).splitlines()[0]) < 200
        assert "array(" not in repr(value)


def test_a_scene_that_travelled_moves_as_before_without_its_file(tmp_path: Path) -> None:
    for name in motion_files.ALL:
        path = _file(name, tmp_path)
        scene = dg.load(path)
        data = pickle.dumps(scene)
        path.unlink()
        other = pickle.loads(data)
        assert content_hash(other, (0.7, 1.3)) == content_hash(scene, (0.7, 1.3)), name
        assert other.at(1.1) == scene.at(1.1), name
        assert other.motion == scene.motion, name  # also after both were asked
        camera = next(iter(scene.cameras), None)
        assert camera is None or other.cameras[camera].frozen_at(1.1) == scene.cameras[
            camera
        ].frozen_at(1.1)


def test_values_that_differ_are_not_equal() -> None:
    same = _of_arrays()
    for change in (
        lambda s: s.meshes[0].positions.setflags(write=True) or s.meshes[0].positions.fill(2),
        lambda s: s.materials.pop(),
        lambda s: s.motion.lights.clear(),
        lambda s: s.cameras.update(b=s.cameras["b"].with_(f_stop=2)),
        lambda s: s.instances.__setitem__(0, dataclasses.replace(s.instances[0], transform=ASIDE)),
        lambda s: s.warnings.append("a word"),
    ):
        other = copy.deepcopy(same)
        change(other)
        assert other != same
    assert dg.keys([(0, EYE), (1, ASIDE)]) != dg.keys([(0, EYE), (1, 2 * ASIDE)])
    assert dg.lenses.load(dg.lenses.names()[0]) != dg.lenses.load(dg.lenses.names()[1])
    one, two = _frame(), _frame()
    two.rgb[0, 0, 0] = 7
    assert one != two
    assert one != 5


def test_what_is_cached_stays_at_home() -> None:
    turning, lens = dg.spin((0, 0, 1), 1), dg.lenses.load(dg.lenses.names()[0])
    for value, name in ((turning, "motion"), (lens, "prescription")):
        assert getattr(value, name) is not None
        assert name in vars(value)
        assert name not in vars(pickle.loads(pickle.dumps(value)))
    assert {turning: 1}[pickle.loads(pickle.dumps(turning))] == 1


def test_arrays_that_travelled_are_read_in_place() -> None:
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        scene = pickle.loads(pickle.dumps(_of_arrays(), protocol))
        arrays = [scene.meshes[0].positions, scene.meshes[0].indices, scene.textures[0].pixels]
        assert all(not array.flags.writeable for array in arrays)
        assert all(as_readonly(array) is array for array in arrays)  # the core needs no copy


def test_a_sensor_chosen_after_a_trip_still_gives_its_size() -> None:
    sensor = dg.sensors.names()[0]
    camera = pickle.loads(pickle.dumps(dg.Camera()))
    size = dg.sensors.load(sensor).size
    assert dataclasses.replace(camera, sensor=sensor).sensor_size == size


# Two threads ----------------------------------------------------------------------------------


def _busy(folder: Path) -> dg.Scene:
    """A file in which a lamp, a paint, a shape, a camera and nodes change at once."""
    b = motion_files.coated()
    motion_files.animate(b, 0, "translation", [0, 2], [(0, 0, -3), (4, 0, -3)])
    return dg.load(b.glb(folder / "busy.glb"))


def _told(scene: dg.Scene) -> list[Any]:
    lights = [(light, place.tolist()) for light, place in scene.lights]
    places = [instance.transform.tolist() for instance in scene.instances]
    return [scene.materials, lights, places, [m.positions.tolist() for m in scene.meshes]]


@pytest.mark.parametrize("name", ["materials", "coat and lamp", "morph", "camera", "busy"])
def test_two_threads_ask_one_scene_for_two_times(name: str, tmp_path: Path) -> None:
    scene = _busy(tmp_path) if name == "busy" else dg.load(_file(name, tmp_path))
    moments = np.linspace(0.76, 1.24, 40).tolist()

    def told(t: float) -> list[Any]:
        moved = scene.at(t)
        cameras = [(c.focal_length, c.f_stop, c.focus_distance) for c in moved.cameras.values()]
        return [*_told(moved), cameras]

    alone = {t: told(t) for t in moments}
    wrong: list[float] = []

    def ask(times: list[float]) -> None:
        for _ in range(40):
            wrong.extend(t for t in times if told(t) != alone[t])

    threads = [threading.Thread(target=ask, args=(moments[k::2],)) for k in range(2)]
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    finally:
        sys.setswitchinterval(interval)
    assert wrong == []


# Another process ------------------------------------------------------------------------------


def _drawn(scene: dg.Scene) -> tuple[bytes, Any]:
    session = Session(scene, resolution=(24, 16), seed=3)
    session.draw(0, 4)
    return session.frame().rgb.tobytes(), session.key


def _elsewhere(data: bytes, out: Any) -> None:
    out.put(_drawn(pickle.loads(data)))


def _textured(folder: Path) -> dg.Scene:
    b = Builder()
    picture = b.image(png(np.arange(48, dtype=np.uint8).reshape(4, 4, 3)))
    b.add("materials", {"pbrMetallicRoughness": {"baseColorTexture": {"index": picture}}})
    points, _ = scenes.quad(1)
    uv = b.accessor(motion_files.UV)
    b.mesh(
        {"POSITION": b.accessor(points), "TEXCOORD_0": uv},
        indices=b.accessor(motion_files.QUAD, "u2"),
        material=0,
    )
    b.node(mesh=0, translation=[0, 0, -3])
    b.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.6}})
    b.node(camera=0)
    scene = dg.load(b.glb(folder / "textured.glb"))
    scene.set_environment(color=(1, 1, 1))
    return scene


def test_a_pickled_scene_draws_the_same_bits_in_another_process(tmp_path: Path) -> None:
    moving = motion_files.file_case("coat and lamp", tmp_path).scene
    for scene in (_textured(tmp_path), _of_arrays(), moving):
        wanted = _drawn(scene)
        context = multiprocessing.get_context("spawn")
        out = context.Queue()
        worker = context.Process(target=_elsewhere, args=(pickle.dumps(scene), out))
        worker.start()
        got = out.get(timeout=300)
        worker.join()
        assert got == wanted
