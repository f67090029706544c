"""Whatever a file animates is in the motion of the scene: moved there, it is as if read there."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np
import pytest

from daguerre.importers.gltf import reader as gltf
from daguerre.motion.resample import resample
from daguerre.setup.vertices import resample_vertices
from tests.support.formats.make_gltf import CORNERS, Builder, png, triangle
from tests.support.scene.same_scene import scene_differences

HALF = math.sqrt(0.5)
UP = [[0, 0, 1]] * 3
TIMES = (0.1, 0.5, 0.999, 1.0, 1.7, 3.0)


class Film:
    """Adds channels to one animation of a builder."""

    def __init__(self, b: Builder) -> None:
        self.b = b
        self.animation = {"samplers": [], "channels": []}
        b.add("animations", self.animation)

    def _add(self, target, keys, values, mode, dtype="f4") -> None:
        sampler = {"input": self.b.accessor(keys), "output": self.b.accessor(values, dtype)}
        if mode:
            sampler["interpolation"] = mode
        self.animation["channels"].append(
            {"sampler": len(self.animation["samplers"]), "target": target}
        )
        self.animation["samplers"].append(sampler)

    def node(self, node, path, keys, values, mode=None) -> None:
        self._add({"node": node, "path": path}, keys, values, mode)

    def point(self, pointer, keys, values, mode=None, dtype="f4") -> None:
        extension = {"KHR_animation_pointer": {"pointer": pointer}}
        self._add({"path": "pointer", "extensions": extension}, keys, values, mode, dtype)


def swing(film: Film, node: int) -> None:
    """Turns, goes, and shrinks a little."""
    film.node(node, "rotation", [0, 1, 2], [[0, 0, 0, 1], [0, 0, HALF, HALF], [0, HALF, 0, HALF]])
    film.node(node, "translation", [0.5, 1.5], [[0, 0, 0], [4, 0, 1]])
    film.node(node, "scale", [0, 2], [[1, 1, 1], [2, 3, 0.5]])


def moving_tree() -> Builder:
    b = triangle()
    b.json["nodes"][0]["children"] = [1]
    b.child(mesh=0, translation=[1, 0, 0], children=[2])
    b.child(translation=[0, 1, 0], name="empty", camera=0)
    b.add("cameras", {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}})
    b.node(mesh=0, name="still")
    film = Film(b)
    swing(film, 0)
    film.node(1, "rotation", [0, 2], [[0, 0, 0, 1], [1, 0, 0, 0]])
    return b


def instanced() -> Builder:
    b = triangle()
    places = {"TRANSLATION": b.accessor([[0, 0, 0], [3, 0, 0]])}
    b.json["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": places}}
    swing(Film(b), 0)
    return b


def skinned() -> Builder:
    b = Builder()
    joints = b.accessor([[0, 1, 0, 0]] * 3, "u1")
    weights = b.accessor([[1, 0, 0, 0], [0.5, 0.5, 0, 0], [0, 1, 0, 0]])
    b.mesh(
        {
            "POSITION": b.accessor(CORNERS),
            "NORMAL": b.accessor(UP),
            "TANGENT": b.accessor([[1, 0, 0, 1]] * 3),
            "JOINTS_0": joints,
            "WEIGHTS_0": weights,
        }
    )
    b.node(mesh=0, skin=0)
    b.node(children=[2])
    b.child(translation=[0, 1, 0])
    b.add("skins", {"joints": [1, 2]})
    film = Film(b)
    swing(film, 1)
    film.node(2, "rotation", [0, 1, 2], [[0, 0, 0, 1], [HALF, 0, 0, HALF], [0, 0, 0, 1]])
    return b


def morphing() -> Builder:
    b = Builder()
    targets = [
        {"POSITION": b.accessor([[0, 0, 1]] * 3), "NORMAL": b.accessor([[1, 0, 0]] * 3)},
        {"POSITION": b.accessor([[0, 2, 0]] * 3)},
    ]
    positions, normals = b.accessor(CORNERS), b.accessor(UP)
    b.mesh({"POSITION": positions, "NORMAL": normals}, targets=targets)
    b.node(mesh=0)
    b.node(mesh=0, weights=[1, 0])
    b.node(mesh=0, weights=[0, 0])
    film = Film(b)
    film.node(0, "weights", [0, 1, 2], [0, 0, 1, 0, 0, 1])
    film.point("/nodes/1/weights/1", [0, 1.5], [0, 1])
    return b


def lamps() -> Builder:
    b = triangle()
    lights = [{"type": "spot", "spot": {}}, {"type": "directional"}, {"type": "point"}]
    b.json["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
    for light in range(3):
        b.node(extensions={"KHR_lights_punctual": {"light": light}})
    film = Film(b)
    start = "/extensions/KHR_lights_punctual/lights/"
    film.point(start + "0/color", [0, 1], [[0, 0, 0], [1, 0.5, 0.25]])
    film.point(start + "0/intensity", [0, 2], [0, 8])
    film.point(start + "0/range", [0, 1], [1, 3])
    film.point(start + "0/spot/innerConeAngle", [0, 1], [0, 0.4])
    film.point(start + "0/spot/outerConeAngle", [0, 1], [0.5, 0.7])
    film.node(2, "rotation", [0, 1], [[0, 0, 0, 1], [HALF, 0, 0, HALF]])
    film.node(3, "translation", [0, 1, 2], [[0, 0, 0], [1, 2, 3], [0, 0, 0]], "STEP")
    return b


def lens() -> Builder:
    b = triangle()
    perspective = {"yfov": 1, "znear": 0.1, "aspectRatio": 1.5}
    extras = {"daguerre": {"fStop": 2, "shift": [0, 0], "bladeRotation": 0}}
    b.add("cameras", {"type": "perspective", "perspective": perspective, "extras": extras})
    b.node(camera=0, name="eye")
    film = Film(b)
    film.point("/cameras/0/perspective/yfov", [0, 1], [0.5, 1.5])
    film.point("/cameras/0/perspective/aspectRatio", [0, 1], [1.5, 2])
    film.point("/cameras/0/extras/daguerre/focusDistance", [0, 1], [2, 4])
    film.point("/cameras/0/extras/daguerre/fStop", [0, 1], [2, 8])
    film.point("/cameras/0/extras/daguerre/shift", [0, 1], [[0, 0], [3, 4]])
    film.point("/cameras/0/extras/daguerre/bladeRotation", [0, 1], [0, 90])
    film.node(1, "translation", [0, 1], [[0, 0, 0], [1, 2, 3]])
    return b


def paint() -> Builder:
    texture = {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0, 0]}}}
    b = triangle()
    b.json["meshes"][0]["primitives"][0]["material"] = 0
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = b.accessor([[0, 0]] * 3)
    b.add("materials", {"pbrMetallicRoughness": {"baseColorTexture": texture}})
    b.image(png(np.zeros((2, 2, 3), np.uint8)))
    film = Film(b)
    pbr = "/materials/0/pbrMetallicRoughness/"
    film.point(pbr + "baseColorFactor", [0, 1], [[0, 0, 0, 1], [1, 0.5, 0.25, 1]])
    film.point(pbr + "roughnessFactor", [0, 1], [0, 0, 0, 2, 1, 2], "CUBICSPLINE")
    film.point("/materials/0/emissiveFactor", [0, 1], [[0, 0, 0], [1, 2, 4]], "STEP")
    transform = pbr + "baseColorTexture/extensions/KHR_texture_transform/"
    film.point(transform + "rotation", [0, 1], [0, math.pi])
    film.point(transform + "offset", [0, 1], [[0, 0], [1, 2]])
    return b


SCENES = (moving_tree, instanced, skinned, morphing, lamps, lens, paint)


@pytest.mark.parametrize("make", SCENES, ids=[make.__name__ for make in SCENES])
def test_moved_there_as_if_read_there(tmp_path, make):
    path = make().glb(tmp_path / "a.glb")
    scene = gltf.read(path)
    assert scene.warnings == []
    for moment in TIMES:
        there = gltf.read(path, time=moment)
        assert scene_differences(scene.at(moment), there) == []
        assert scene_differences(there.at(0), scene) == []


def test_only_what_moves_is_in_the_motion(tmp_path):
    scene = gltf.read(moving_tree().glb(tmp_path / "a.glb"))
    assert scene.motion.instances.keys() == {0, 1}
    assert scene.motion.node_positions.keys() == {"tri", "node1", "empty"}
    assert scene.camera("empty").motion.keys() == {"transform"}
    assert scene.duration == 2
    assert list(scene.motion.instances[1].breaks(0, 2)) == [0.5, 1, 1.5]


def test_keys_that_are_all_alike_move_nothing(tmp_path):
    b = triangle()
    Film(b).node(0, "translation", [0, 1, 2], [[1, 2, 3]] * 3)
    scene = gltf.read(b.glb(tmp_path / "a.glb"), time=0.5)
    assert not scene.motion
    assert scene.instances[0].transform[:3, 3].tolist() == [1, 2, 3]


class Still:
    """Vertices over time with the normals of their beginning."""

    def __init__(self, moving):
        self._moving, self.breaks = moving, moving.breaks

    def at(self, time_s):
        return replace(self._moving.at(time_s), normals=self._moving.at(0).normals)


def test_meshes_that_morph_apart_are_two_meshes(tmp_path):
    scene = gltf.read(morphing().glb(tmp_path / "a.glb"))
    assert scene.meshes[0].positions.tolist() == scene.meshes[2].positions.tolist()
    assert [i.mesh for i in scene.instances] == [0, 1, 2]
    assert scene.motion.meshes.keys() == {0, 1}
    for interval, count in (((0, 1), 2), ((0.5, 1.5), 3)):
        moving = Still(scene.motion.meshes[0])
        assert len(resample_vertices(moving, *interval)[0]) == count
        # Normals between two of other lengths turn unevenly.
        assert len(resample_vertices(scene.motion.meshes[0], *interval)[0]) == 9


def test_what_blinks(tmp_path):
    b = triangle()
    b.json["nodes"][0] |= {"extensions": {"KHR_node_visibility": {}}, "children": [1]}
    b.json["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}
    b.child(mesh=0, extensions={"KHR_lights_punctual": {"light": 0}})
    pointer = "/nodes/0/extensions/KHR_node_visibility/visible"
    Film(b).point(pointer, [0, 1, 2], [0, 7, 0], "STEP", "u1")
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert [i.shown for i in scene.instances] == [False, False]
    assert [i.shown for i in scene.at(1.5).instances] == [True, True]
    assert scene.lights[0][0].intensity == (0, 0, 0)
    assert scene.at(1).lights[0][0].intensity == (1, 1, 1)
    assert list(scene.motion.shown[1].breaks(0, 3)) == [1, 2]


def test_a_hidden_node_hides_what_blinks_below_it(tmp_path):
    b = triangle()
    b.json["nodes"][0] |= {"extensions": {"KHR_node_visibility": {"visible": False}}}
    b.json["nodes"][0]["children"] = [1]
    b.child(mesh=0, extensions={"KHR_node_visibility": {}})
    Film(b).point("/nodes/1/extensions/KHR_node_visibility/visible", [0, 1], [0, 1], "STEP", "u1")
    assert gltf.read(b.glb(tmp_path / "a.glb"), time=1).instances == []


def test_a_scale_of_nothing_hides(tmp_path):
    b = triangle()
    Film(b).node(0, "scale", [0, 1, 2], [[0, 0, 0], [1, 1, 1], [0, 0, 0]], "STEP")
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert scene.warnings == []
    shown = [scene.at(t).instances[0].shown for t in (0, 0.999, 1, 1.999, 2)]
    assert shown == [False, False, True, True, False]


def test_what_is_pressed_flat_moves_by_its_vertices(tmp_path):
    b = triangle()
    b.json["nodes"][0]["scale"] = [1, 0, 1]
    Film(b).node(0, "translation", [0, 1], [[0, 0, 0], [2, 4, 0]])
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert not scene.motion.instances
    index = scene.instances[0].mesh
    assert np.array_equal(scene.instances[0].transform, np.eye(4))
    moved = scene.at(0.5).meshes[index].positions
    assert moved == pytest.approx(np.array([[1, 2, 0], [2, 2, 0], [1, 2, 0]]))


def test_colours_that_a_morph_changes_cannot_be_blurred(tmp_path):
    from daguerre.errors import InputError
    from daguerre.setup.scene import build

    b = Builder()
    colors = b.accessor([[1, 0, 0]] * 3)
    b.mesh(
        {"POSITION": b.accessor(CORNERS), "COLOR_0": colors},
        targets=[{"COLOR_0": b.accessor([[-1, 1, 0]] * 3)}],
    )
    b.node(mesh=0)
    Film(b).node(0, "weights", [0, 1], [0, 1])
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert scene.at(0.5).meshes[0].colors == pytest.approx(np.array([[0.5, 0.5, 0, 1]] * 3))
    build(scene)
    build(scene, (1, 2))
    with pytest.raises(InputError, match="mesh 'mesh0': colors: changes while the shutter is open"):
        build(scene, (0.5, 0.6))


def test_quaternions_are_made_units_and_counted(tmp_path):
    b = triangle()
    Film(b).node(0, "rotation", [0, 1], [[0, 0, 0, 2], [0, 0, HALF, HALF]])
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert np.linalg.det(scene.instances[0].transform) == pytest.approx(1)
    wanted = "a key quaternion whose length is not 1 is normalized (1 use)"
    assert scene.warnings == [wanted]


def test_a_material_over_the_shutter(tmp_path):
    scene = gltf.read(paint().glb(tmp_path / "a.glb"))
    times, values = resample(scene.motion.materials[0], 0.25, 0.25 + 1 / 48)
    assert values[0].kind.base_color[0] == pytest.approx(0.25)
    assert values[-1].kind.base_color[0] == pytest.approx(0.25 + 1 / 48)
    assert len(times) < 40


def test_thousands_of_nodes_that_move(tmp_path):
    b = triangle()
    keys = b.accessor(np.arange(30.0))
    values = [b.accessor(np.random.default_rng(k).normal(size=(30, 3))) for k in range(5)]
    samplers = [{"input": keys, "output": value} for value in values]
    channels = []
    for k in range(2_000):
        node = b.node(mesh=0)
        channels.append({"sampler": k % 5, "target": {"node": node, "path": "translation"}})
    b.add("animations", {"samplers": samplers, "channels": channels})
    path = b.glb(tmp_path / "a.glb")
    started = time.process_time()
    scene = gltf.read(path)
    scene.at(3.3)
    assert len(scene.motion.instances) == 2_000
    assert time.process_time() - started < 5
