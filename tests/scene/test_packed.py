"""Scenes as they are in a chunk of a .glb: equal afterwards, and nothing in them is trusted."""

from __future__ import annotations

import json
import struct
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.errors import InputError, UsageError
from daguerre.files.value import same
from daguerre.motion.values import Composite
from daguerre.scene import shapes
from daguerre.scene.packed import CHUNK
from daguerre.scene.packed.chunk import embed
from daguerre.scene.packed.parts import parts_of
from daguerre.scene.packed.rebuild import rebuilt
from daguerre.sensors.writer import write as write_sensor
from tests.faults.scene import write_scene
from tests.fuzz import readers
from tests.support.scene.packed_scenes import everything

TINY = {"resolution": (40, 30), "spp": 2, "threads": 1}


@pytest.fixture
def glb(tmp_path: Path) -> Path:
    """A small .glb of glTF's own content."""
    return write_scene(tmp_path / "scene.glb")


def without_path(scene: dg.Scene) -> dg.Scene:
    return replace(scene, path=None)


def test_a_scene_is_the_same_afterwards(glb: Path) -> None:
    made = everything()
    embed(glb, made)
    found = dg.load(glb)
    assert found.path == glb
    for name, part in vars(made).items():
        if name != "path":
            assert same(getattr(found, name), part), name
    assert list(found.nodes) == list(made.nodes)
    assert list(found.cameras) == list(made.cameras)


def test_pictures_have_the_same_bits(glb: Path) -> None:
    made = everything()
    embed(glb, made)
    how = dg.RenderSettings.of(**TINY, aovs=True, cryptomatte="object")
    before, after = (dg.render(s, s.camera(), settings=how) for s in (made, dg.load(glb)))
    np.testing.assert_array_equal(before.rgb, after.rgb)
    assert before.rgb.std() > 0
    assert same(before.aovs, after.aovs)


def test_moments_within_the_shutter_are_the_same(glb: Path) -> None:
    made = everything()
    embed(glb, made)
    found = dg.load(glb)
    for when in (-0.01, 0.003, 0.01):
        assert same(without_path(found.at(when)), made.at(when))


def test_shared_meshes_stay_shared(glb: Path) -> None:
    made = dg.Scene()
    mesh = made.add_mesh(np.eye(3), [[0, 1, 2]], name="leaf")
    grey = made.add_material(dg.Diffuse())
    made.add_instances(mesh, grey, np.repeat(np.eye(4)[None], 5000, axis=0), name="leaves")
    embed(glb, made)
    found = dg.load(glb)
    assert (len(found.meshes), len(found.instances)) == (1, 5000)
    assert glb.stat().st_size < 5000 * 180


def test_other_programs_see_plain_gltf(glb: Path) -> None:
    plain, before = dg.load(glb), glb.read_bytes()
    embed(glb, everything())
    data = glb.read_bytes()
    assert data[12 : len(before)] == before[12:]
    assert struct.unpack_from("<I", data, 8)[0] == len(data)
    size, kind = struct.unpack_from("<II", data, len(before))
    assert kind == CHUNK
    assert size % 4 == 0
    assert len(before) + 8 + size == len(data)
    assert same(dg.load(glb, animated=True).meshes, plain.meshes)


@pytest.mark.parametrize("asked", [{"time": 0.5}, {"animated": True}, {"scene_index": 0}])
def test_another_moment_is_that_of_plain_gltf(glb: Path, asked: dict[str, Any]) -> None:
    plain = dg.load(glb, **asked)
    embed(glb, everything())
    found = dg.load(glb, **asked)
    assert same(found.meshes, plain.meshes)
    assert found.warnings[0].startswith(
        "the exact scene is stored for the time of its export only: plain glTF is read instead"
    )
    with pytest.raises(
        InputError, match="strict: the file has notes: the exact scene is stored for"
    ):
        dg.load(glb, strict=True, **asked)


def test_pictures_of_media_have_the_same_bits(glb: Path) -> None:
    grid = dg.DensityGrid(np.ones((2, 3, 4), np.float32))
    smoke = dg.Medium((0.1, 0.2, 0.1), (1, 1, 2), ((0.5, 1.0),), (1, 2, 3), grid)
    made, cube = dg.Scene(), shapes.cube()
    assert cube is not None
    mesh = made.add_mesh(cube.positions, cube.triangles)
    place = np.eye(4) - 4 * np.eye(4, k=1)[[3, 3, 2, 3]]  # 4 m ahead
    made.add_instance(mesh, dg.Material(dg.Boundary(), interior=smoke), place)
    made.set_fog(dg.Medium((0.01, 0.01, 0.01), (0.1, 0.1, 0.1)))
    made.add_light(dg.PointLight((9, 9, 9)), np.eye(4))
    embed(glb, made)
    camera = dg.Camera(lens_model="pinhole")
    before, after = (dg.render(s, camera, **TINY).rgb for s in (made, dg.load(glb)))
    assert before.std() > 0
    np.testing.assert_array_equal(before, after)


def test_frames_of_a_sequence_are_those_of_plain_gltf(
    glb: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Frame 0 is the moment of the export."""
    embed(glb, everything())
    said = {}
    for frames in ("0", "0-1"):
        words = ["render", str(glb), "--res=4x3", "--spp=1", "-o", str(tmp_path / "a.#.exr")]
        assert main([*words, f"--frames={frames}"]) == 0
        said[frames] = "plain glTF is read" in "".join(capsys.readouterr())
    assert said == {"0": False, "0-1": True}


def repacked(path: Path, change: Callable[[Any, Any], None]) -> None:
    """Changes head and body of a chunk's JSON."""
    data = path.read_bytes()
    at = 12
    while struct.unpack_from("<I", data, at + 4)[0] != CHUNK:
        at += 8 + struct.unpack_from("<I", data, at)[0]
    lines = data[at + 8 :].split(b"\n", 2)
    head, body = map(json.loads, lines[:2])
    change(head, body)
    new = b"\n".join([*(json.dumps(one).encode() for one in (head, body)), lines[2]])
    new = b" " * (-len(new) % 4) + new
    made = data[12:at] + struct.pack("<II", len(new), CHUNK) + new
    path.write_bytes(data[:8] + struct.pack("<I", 12 + len(made)) + made)


def test_a_scene_of_another_version_is_left_out_with_a_note(glb: Path) -> None:
    embed(glb, everything())
    repacked(glb, lambda head, body: head.update(version="0.9\x1b[2J"))
    (note,) = [one for one in dg.load(glb).warnings if "exact scene" in one]
    assert "made by daguerre" in note
    assert "plain glTF is read" in note
    assert note.isprintable()


def part_of(body: Any, key: str) -> Any:
    """A dictionary of the packed parts that has a key, as a list of pairs."""
    found = [one["dict"] for one in body["parts"] if "dict" in one]
    return next(pairs for pairs in found if any(pair[0] == key for pair in pairs))


def set_to(key: str, value: Any) -> Callable[[Any, Any], None]:
    def change(head: Any, body: Any) -> None:
        next(pair for pair in part_of(body, key) if pair[0] == key)[1] = value

    return change


def other_class(name: str) -> Callable[[Any, Any], None]:
    def change(head: Any, body: Any) -> None:
        next(one for one in body["parts"] if "class" in one)["class"] = name

    return change


def chained(head: Any, body: Any) -> None:
    """Lists within lists, deeper than Python goes."""
    first = len(body["parts"])
    body["parts"] += [{"list": [{"part": first + k + 1}]} for k in range(5000)] + [{"list": []}]
    body["root"] = {"part": first}


HOSTILE = {
    "a file as a lens": set_to("lens", "/etc/passwd"),
    "a file as a sensor": set_to("sensor", "../../secret.json"),
    "a file as the sky": set_to("environment", {"path": "/etc/passwd"}),
    "a class of code": other_class("daguerre.rendering.session:Session"),
    "a class of Python": other_class("os:system"),
    "an unknown attribute": set_to("reflectance", 3),
    "no meshes": set_to("meshes", None),
    "a mesh index": set_to("hidden", {"tuple": [1 << 40]}),
    "itself": set_to("meshes", {"part": 0}),
    "a time": set_to("time", {"float": "nan"}),
    "a huge array": lambda head, body: body["arrays"][0].__setitem__(1, [1 << 50]),
    "a negative array": lambda head, body: body["arrays"][0].__setitem__(1, [-4]),
    "an array of objects": lambda head, body: body["arrays"][0].__setitem__(0, "|O"),
    "an array elsewhere": lambda head, body: body["arrays"][0].__setitem__(2, "ff" * 32),
    "deep": chained,
}


@pytest.mark.parametrize("name", HOSTILE)
def test_what_a_stranger_wrote_is_one_error(glb: Path, name: str) -> None:
    embed(glb, everything())
    repacked(glb, HOSTILE[name])
    with pytest.raises(InputError) as caught:
        dg.load(glb)
    text = str(caught.value)
    assert text.startswith(f"{glb}: chunk DGSC: ")
    assert len(text) < 600
    assert "\n" not in text


def test_parts_that_share_an_array_cannot_ask_for_all_memory() -> None:
    """A small file names a large array for many meshes, each a copy in single precision."""
    parts = parts_of(everything())
    triangle = next(one for one in parts["meshes"] if "curves" not in one and "motion" not in one)
    points = np.zeros((1 << 20, 3))
    parts["meshes"] = [triangle | dict.fromkeys(("normals", "uv"), None)] * 200
    for one in parts["meshes"]:
        one["positions"] = points
    with pytest.raises(InputError, match="arrays are far larger than the file"):
        rebuilt(parts, points.nbytes)


def test_a_moving_mesh_of_other_points_is_refused() -> None:
    parts = parts_of(everything())
    moving = next(one for one in parts["meshes"] if "motion" in one and "curves" not in one)
    moving["motion"] |= {"path": dg.keys([(0.0, np.zeros((2, 3))), (1.0, np.ones((2, 3)))])}
    with pytest.raises(InputError, match="motion: wanted shape"):
        rebuilt(parts, 1 << 20)


def test_curves_that_move_like_others_are_refused() -> None:
    parts = parts_of(everything())
    moving = next(one for one in parts["meshes"] if "motion" in one and "curves" in one)
    layout = moving["motion"]["layout"]
    layout["counts"] = layout["counts"][::-1] + np.array([1, -1])
    with pytest.raises(InputError, match="motion: does not fit these curves"):
        rebuilt(parts, 1 << 20)


class Odd:
    """A user's own way over time."""

    def at(self, time_s: float) -> Any:
        return np.eye(4)

    def breaks(self, begin: float, end: float) -> list[float]:
        return []


def test_what_cannot_be_packed_is_refused(glb: Path) -> None:
    made, before = everything(), glb.read_bytes()
    made.motion.instances[0] = Odd()
    with pytest.raises(UsageError, match=r"packed scene: instances\[0\]: motion: wanted keys"):
        embed(glb, made)
    assert glb.read_bytes() == before
    text = glb.with_suffix(".txt")
    text.write_text("no glb")
    with pytest.raises(InputError, match=r"not a \.glb file"):
        embed(text, everything())


def test_a_plate_is_the_same_afterwards(glb: Path) -> None:
    made = everything()
    made.set_plate(np.random.default_rng(1).random((20, 30, 3)), dg.Camera(focal_length=35.0))
    embed(glb, made)
    assert same(dg.load(glb).plate, made.plate)


PBRT = "# A singlet\n35 8 1.6 20\n-60 5 1 20\n0 30 0 12\n"


def optical_files(folder: Path) -> tuple[Path, Path]:
    """A lens of another program and a sensor, as files that no library has."""
    lens, sensor = folder / "singlet.dat", folder / "mine.json"
    lens.write_text(PBRT)
    write_sensor(sensor, dg.sensors.load("nikon-d5100").with_(read_noise=7.5, prnu=0.02))
    return lens, sensor


def test_lens_and_sensor_files_travel_in_the_scene(glb: Path, tmp_path: Path) -> None:
    """Their pictures have the same bits after the files are gone, also for a plate's camera."""
    lens, sensor = optical_files(tmp_path)
    made = everything()
    camera = replace(made.camera(), lens=str(lens), sensor=sensor, f_stop=8.0)
    made.add_camera("mine", camera)
    made.set_plate(np.full((2, 3, 3), 0.1), dg.Camera(lens=lens))
    before = dg.render(made, made.camera("mine"), **TINY)
    embed(glb, made)
    known, chip = dg.lenses.load(lens), dg.sensors.load(sensor)
    lens.unlink()
    sensor.unlink()
    found = dg.load(glb)
    assert found.plate is not None
    assert found.plate.camera is not None
    for one in (found.camera("mine").lens, found.plate.camera.lens):
        assert same(one, replace(known, source="singlet.dat"))
    assert same(found.camera("mine").sensor, chip)
    after = dg.render(found, found.camera("mine"), **TINY)
    np.testing.assert_array_equal(before.rgb, after.rgb)
    assert before.rgb.std() > 0
    assert same(before.channels, after.channels)
    assert str(tmp_path).encode() not in glb.read_bytes()


def test_read_lenses_and_sensors_travel_in_the_scene(glb: Path) -> None:
    zoom = next(name for name in dg.lenses.names() if len(dg.lenses.load(name).configurations) > 2)
    lens = dg.lenses.load(zoom, dg.lenses.load(zoom).configurations[-1].name)
    sensor = dg.sensors.load("nikon-d5100").with_(serial=7)
    made = everything()
    made.add_camera("read", dg.Camera(lens=lens, sensor=sensor))
    made.add_camera("named", dg.Camera(lens=zoom, sensor="nikon-d5100"))
    embed(glb, made)
    found = dg.load(glb)
    assert same(found.camera("read").lens, lens)
    assert same(found.camera("read").sensor, sensor)
    assert same(found.camera("named"), made.camera("named"))


def test_a_lens_that_was_changed_is_refused(glb: Path) -> None:
    made = everything()
    lens = dg.lenses.load("double-gauss-50mm-f2").decentered((0, 1), (0.1, 0.0))
    made.add_camera("bent", dg.Camera(lens=lens))
    with pytest.raises(UsageError, match="camera 'bent': lens: wanted a lens as its file"):
        embed(glb, made)


def in_text(old: str, new: str) -> Callable[[Any, Any], None]:
    """Changes the text of a lens or a sensor."""

    def change(head: Any, body: Any) -> None:
        pairs = [pair for part in body["parts"] for pair in part.get("dict", ())]
        texts = [pair for pair in pairs if pair[0] == "text" and old in pair[1]]
        assert texts
        for pair in texts:
            pair[1] = pair[1].replace(old, new)

    return change


HOSTILE_OPTICS = {
    "no JSON": in_text("{", "["),
    "a huge radius": in_text('"radius": 35', '"radius": 1e300'),
    "crossing surfaces": in_text('"thickness": 8', '"thickness": 0'),
    "a schema": in_text("daguerre-lens", "other-lens"),
    "a sensor's size": in_text('"full_well_e": ', '"full_well_e": -'),
    "a sensor's member": in_text('"prnu"', '"file"'),
    "a serial": set_to("serial", -1),
    "a serial that is a text": set_to("serial", "x"),
    "a name": set_to("configuration", "x"),
    "notes": set_to("notes", "x"),
    "a lens that is a file": set_to("text", "/etc/passwd"),
}


@pytest.mark.parametrize("name", HOSTILE_OPTICS)
def test_a_strangers_lens_and_sensor_are_checked(glb: Path, tmp_path: Path, name: str) -> None:
    lens, sensor = optical_files(tmp_path)
    made = everything()
    made.add_camera("mine", dg.Camera(lens=str(lens), sensor=str(sensor)))
    embed(glb, made)
    repacked(glb, HOSTILE_OPTICS[name])
    with pytest.raises(InputError, match="chunk DGSC: ") as caught:
        dg.load(glb)
    assert "\n" not in str(caught.value)


def test_a_million_triangles_take_about_a_second(glb: Path) -> None:
    count = 708
    x, y = np.meshgrid(np.linspace(-1, 1, count), np.linspace(-1, 1, count))
    points = np.stack([x, y, -4 + x * y], -1).reshape(-1, 3).astype(np.float32)
    first = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).reshape(-1)
    corners = [[first, first + 1, first + count], [first + 1, first + count + 1, first + count]]
    triangles = np.concatenate([np.stack(one, 1) for one in corners]).astype(np.uint32)
    made = dg.Scene()
    made.add_instance(made.add_mesh(points, triangles, np.ones_like(points)))
    assert len(triangles) >= 999_000
    began = time.process_time()
    embed(glb, made)
    found = dg.load(glb)
    assert time.process_time() - began < 2
    assert same(found.meshes, made.meshes)
    assert glb.stat().st_size < 1.01 * (points.nbytes * 2 + triangles.nbytes) + 10_000


def test_changed_files_are_used_or_refused() -> None:
    found, faults = readers.run("exact", 240, seed=11, most=600)
    assert not faults
    assert found.tried == 600
    assert 0 < found.accepted < 550


def test_motion_of_lights_keeps_its_state(glb: Path) -> None:
    made = everything()
    embed(glb, made)
    motion = dg.load(glb).motion.lights[0]
    assert isinstance(motion, Composite)
    assert same(motion, made.motion.lights[0])
