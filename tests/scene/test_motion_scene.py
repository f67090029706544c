"""Scenes of values over time: the lists show one moment, ``motion`` the rest, ``at`` any other."""

from __future__ import annotations

import math

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import DaguerreError
from daguerre.scene.materials import Gltf

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
FACES = [[0, 1, 2], [0, 2, 3]]


def moved(x: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[0, 3] = x
    return matrix


def slide(*xs: float) -> dg.Keys:
    return dg.keys(list(enumerate(map(moved, xs))))


def turned(degrees: float) -> np.ndarray:
    """Corners after a turn about x."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return (CORNERS @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]])).astype(np.float32)


def test_an_instance_moves_and_hides():
    scene = dg.Scene(time=0.5)
    mesh = scene.add_mesh(CORNERS, FACES)
    still = scene.add_instance(mesh)
    path = slide(0, 2)
    there = dg.keys([(0, True), (1, False)])
    moving = scene.add_instance(mesh, transform=path, shown=there)
    assert scene.motion.instances == {moving: path}
    assert scene.motion.shown == {moving: there}
    assert scene.instances[moving].transform[0, 3] == 1
    later = scene.at(1)
    assert later.time == 1
    assert later.instances[moving].transform[0, 3] == 2
    assert [i.shown for i in later.instances] == [True, False]
    assert later.instances[still] is scene.instances[still]
    assert later.motion is scene.motion


def test_many_instances_move():
    scene = dg.Scene(time=0.5)
    mesh, paint = scene.add_mesh(CORNERS, FACES), scene.add_material(dg.Diffuse())
    scene.add_instance(mesh, paint)
    paths = [slide(0, 2), slide(4, 0)]
    now = np.stack([path.at(0.5) for path in paths])
    scene.add_instances(mesh, paint, now, name="pair", motions=paths)
    assert scene.nodes["pair"] == [1, 2]
    assert scene.motion.instances == {1: paths[0], 2: paths[1]}
    assert [i.transform[0, 3] for i in scene.instances] == [0, 1, 2]
    assert [i.transform[0, 3] for i in scene.at(1).instances] == [0, 2, 0]
    for wrong, got in ((paths[:1], "2 values over time, got 1"), (3, "2 values over time, got 3")):
        with pytest.raises(dg.InputError, match=f"motions: wanted {got}"):
            scene.add_instances(mesh, paint, now, motions=wrong)
    with pytest.raises(dg.InputError, match=r"motions\[1\]: wanted a value over time, got 7"):
        scene.add_instances(mesh, paint, now, motions=[paths[0], 7])
    assert len(scene.instances) == 3


def test_nodes_group_any_number_of_instances():
    scene = dg.Scene()
    scene.group_instances("all", range(200_001))
    scene.group_instances("some", [3, 1])
    assert scene.nodes["all"] == list(range(200_001))
    assert scene.nodes["some"] == [3, 1]
    for wrong in ([0.5], [-1], "abc", None, 3.5):
        with pytest.raises(dg.InputError, match="node 'x': instances: wanted"):
            scene.group_instances("x", wrong)


def test_a_scene_in_which_nothing_moves():
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh(CORNERS, FACES), dg.Diffuse())
    scene.add_light(dg.PointLight())
    scene.set_environment(color=(1, 1, 1))
    assert not scene.motion


def test_materials_lights_sky_and_cameras():
    scene = dg.Scene()
    color = dg.keys([(0, (1, 0, 0)), (2, (0, 0, 1))])
    paint = scene.add_material(Gltf(base_color=color, roughness=0.25))
    lamp = scene.add_light(dg.PointLight(intensity=color), slide(0, 1))
    sun = scene.add_light(dg.DirectionalLight(), slide(0, 1))
    scene.set_environment(color=(1, 1, 1), scale=dg.keys([(0, 1), (1, 3)]), rotation=90)
    scene.add_camera("eye", dg.Camera(f_stop=dg.keys([(0, 2), (1, 4)])))
    later = scene.at(1)
    assert later.materials[paint].kind.base_color == (0.5, 0, 0.5)
    assert later.materials[paint].kind.roughness == 0.25
    assert later.lights[lamp][0].intensity == (0.5, 0, 0.5)
    assert [world[0, 3] for _, world in later.lights] == [1, 1]
    assert later.lights[sun][0] is scene.lights[sun][0]
    assert (later.environment.scale, later.environment.rotation) == (3, 90)
    assert scene.environment.scale == 1
    assert later.camera("eye").f_stop == 4
    assert later.camera("eye").motion.keys() == {"f_stop"}


@pytest.mark.parametrize("how", ["positions", "steps", "arrays"])
def test_vertices(how):
    scene = dg.Scene()
    over_time = dg.keys([(0, CORNERS), (1, CORNERS + 1)])
    if how == "positions":
        mesh = scene.add_mesh(over_time, FACES)
    elif how == "steps":
        mesh = scene.add_mesh(CORNERS, FACES, steps=over_time)
    else:
        mesh = scene.add_mesh(CORNERS, FACES, steps=([0, 1], np.stack([CORNERS, CORNERS + 1])))
    assert np.array_equal(scene.meshes[mesh].positions, CORNERS)
    later = scene.at(0.25).meshes[mesh]
    assert later.positions == pytest.approx(CORNERS + 0.25)
    assert later.positions.dtype == np.float32
    assert later.indices is scene.meshes[mesh].indices


def test_normals_and_tangents_turn_with_the_surface():
    scene = dg.Scene()
    slanted = np.array([[0, 0.6, 0.8]] * 4)  # no normal of the faces: as it was authored
    tangents = np.array([[1, 0, 0, -1]] * 4)
    steps = dg.keys([(0, CORNERS), (1, turned(90))])
    mesh = scene.add_mesh(CORNERS, FACES, slanted, tangents=tangents, steps=steps)
    assert scene.meshes[mesh].normals == pytest.approx(slanted)
    turned_mesh = scene.at(1).meshes[mesh]  # z becomes -y, y becomes z
    assert turned_mesh.normals == pytest.approx(np.array([[0, -0.8, 0.6]] * 4), abs=1e-6)
    assert turned_mesh.tangents == pytest.approx(tangents, abs=1e-6)


def test_normals_over_time_are_taken_as_they_are():
    scene = dg.Scene()
    normals = dg.keys([(0, np.array([[0, 0, 1.0]] * 4)), (1, np.array([[0, 1.0, 0]] * 4))])
    mesh = scene.add_mesh(CORNERS, FACES, normals)
    assert scene.at(1).meshes[mesh].normals.tolist() == [[0, 1, 0]] * 4
    assert scene.at(1).meshes[mesh].positions.tolist() == CORNERS.tolist()


BAD = {
    "shape": (
        lambda s: s.add_instance(0, transform=dg.keys([(0, 1.0)])),
        "transform: wanted shape",
    ),
    "steps of numbers": (lambda s: s.add_mesh(CORNERS, FACES, steps=(0, 1)), "steps: wanted times"),
    "steps of others": (
        lambda s: s.add_mesh(CORNERS, FACES, steps=dg.keys([(0, CORNERS[:2])])),
        "positions: wanted 4 elements, got 2",
    ),
    "times fall": (
        lambda s: s.add_mesh(CORNERS, FACES, steps=([1, 0], np.stack([CORNERS] * 2))),
        "steps: .* times must increase",
    ),
    "NaN in a step": (
        lambda s: s.add_mesh(CORNERS, FACES, steps=([0], CORNERS[None] * np.nan)),
        r"steps: positions\[0\]\[0\]: wanted finite",
    ),
    "dark light": (
        lambda s: s.add_light(dg.PointLight(intensity=dg.keys([(0, (-1, 0, 0))]))),
        "intensity: wanted three finite numbers of at least 0",
    ),
    "colour of two": (
        lambda s: s.add_material(Gltf(base_color=dg.keys([(0, (1, 1))]))),
        "base_color: wanted three numbers",
    ),
    "scale": (
        lambda s: s.set_environment(color=(1, 1, 1), scale=dg.keys([(0, -1)])),
        "environment: scale",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_wrong_is_named_and_nothing_is_added(name):
    act, message = BAD[name]
    scene = dg.Scene()
    scene.add_mesh(CORNERS, FACES)
    with pytest.raises(DaguerreError, match=message):
        act(scene)
    lists = (scene.meshes, scene.instances, scene.lights, scene.materials)
    assert [len(x) for x in lists] == [1, 0, 0, 0]
    assert not scene.motion
    assert scene.environment is None
