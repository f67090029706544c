"""Limits of coordinates and transforms: one set for arrays and for every reader."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
import daguerre.setup.scene as setup
from daguerre.scene import limits
from daguerre.scene.transforms import ranks

TRIANGLE = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0)])
FAR = r"wanted numbers below 1e\+18"


def _sheared(amount: float) -> Any:
    made = np.eye(4)
    made[1, 2] = amount
    return made


def _scene() -> tuple[dg.Scene, int, int]:
    scene = dg.Scene()
    return scene, scene.add_mesh(TRIANGLE, [0, 1, 2]), scene.add_material()


@pytest.mark.parametrize("size", [1.1e18, 1e30])
def test_coordinates_beyond_the_limit_are_refused_wherever_they_come_in(size: float) -> None:
    scene, far = dg.Scene(), TRIANGLE * size
    wrong: dict[str, Any] = {
        "mesh": lambda: scene.add_mesh(far, [0, 1, 2]),
        "polygons": lambda: scene.add_mesh(far, [0, 1, 2], sizes=[3]),
        "subdivided": lambda: scene.add_mesh(far, [[0, 1, 2]], subdivision="loop"),
        "steps": lambda: scene.add_mesh(
            TRIANGLE, [0, 1, 2], steps=([0.0, 1.0], np.array([far, far]))
        ),
        "curves": lambda: scene.add_curves(far, [3], 0.1, basis="linear"),
    }
    for add in wrong.values():
        with pytest.raises(dg.InputError, match=FAR):
            add()
    with pytest.raises(dg.InputError, match=r"widths\[0\]: " + FAR):
        scene.add_curves(TRIANGLE, [3], size, basis="linear")
    scene.add_mesh(TRIANGLE * 0.99e18, [0, 1, 2])


@pytest.mark.parametrize(
    ("transform", "words"),
    [
        (np.diag([1.0, 1, 0, 1]), "wanted an invertible matrix"),
        (np.diag([1e-25, 1e-25, 1e-25, 1]), "wanted an invertible matrix"),
        (_sheared(1e9), "wanted an invertible matrix"),
        (np.diag([1e19, 1, 1, 1]), FAR),
        (np.diag([1e17, 1, 1, 1]), r"wanted a mesh within 1e\+18 m of the origin, got .* 5e\+18"),
    ],
)
def test_transforms_that_no_ray_can_follow_are_refused(transform: Any, words: str) -> None:
    scene, mesh, material = _scene()
    long = scene.add_mesh(TRIANGLE * 50, [0, 1, 2])
    with pytest.raises(dg.InputError, match=words):
        scene.add_instance(long, material, transform)
    with pytest.raises(dg.InputError, match=words):
        scene.add_instances(long, material, np.array([np.eye(4), transform]))
    assert not scene.instances
    with pytest.raises(dg.InputError, match=FAR):
        scene.add_light(dg.PointLight(), np.diag([1e19, 1, 1, 1]))
    scene.add_instance(mesh, material, np.diag([1e9, 1e-9, 1, 1]))  # thin and long, not sheared


def test_what_has_an_inverse_is_decided_as_in_the_core() -> None:
    scene, mesh, material = _scene()
    scene.add_instance(mesh, material)
    random = np.random.default_rng(3)
    shears = 10 ** random.uniform(6.8, 7.2, 60)
    found = limits.invertible(np.array([_sheared(s)[:3, :3] for s in shears]))
    assert 0.2 < found.mean() < 0.8
    for shear, expected in zip(shears, found, strict=True):
        scene.instances[0] = replace(scene.instances[0], transform=_sheared(shear))
        try:
            setup.build(scene)
            built = True
        except dg.InputError:
            built = False
        near = abs(shear - 1e7) < 10  # transforms of the core are floats
        assert near or built == expected


def test_many_transforms_are_decided_like_each_of_them() -> None:
    random = np.random.default_rng(5)
    linear = random.normal(size=(20_000, 3, 3)) * 10 ** random.uniform(-12, 12, (20_000, 1, 3))
    linear[::7, 2] = linear[::7, 0] + linear[::7, 1]  # flat
    found = limits.invertible(linear)
    volumes = np.abs(np.linalg.det(linear)) / np.linalg.norm(linear, axis=1).prod(axis=1)
    sure = np.abs(np.log10(np.maximum(volumes, 1e-30) / 1e-7)) > 1
    assert (found == (volumes > 1e-7))[sure].all()
    assert (ranks(linear[~found]) < 3).all()


def test_a_motion_without_an_inverse_hides_the_instance_and_ends_nothing() -> None:
    scene, mesh, material = _scene()
    flat = dg.keys([(0, _sheared(1e9)), (1, _sheared(1e9) @ np.diag([2.0, 1, 1, 1]))])
    scene.add_instance(mesh, material, flat)
    for interval in ((0.0, 0.0), (0.0, 1.0)):
        core = setup.build(scene, interval)
        assert core.first_hit((0.2, 0.2, 3), (0, 0, -1)) is None
    scene.add_instance(mesh, material, dg.keys([(0, np.eye(4)), (1, np.diag([0.0, 0, 0, 1]))]))
    assert setup.build(scene, (0.0, 1.0)).first_hit((0.1, 0.1, 3), (0, 0, -1)) is not None


_PBRT = """LookAt 0 0.5 -3 0 0.5 0 0 1 0
Camera "perspective" "float fov" 60
WorldBegin
LightSource "spot" "rgb I" [10 10 10] "point3 from" [0 3 -3] "point3 to" [0 0 0]
AttributeBegin
 Material "interface"
 Shape "sphere" "float radius" 1.2
AttributeEnd
ObjectBegin "grp"
 Shape "curve" "point3 P" [0 0 0 0.1 0.5 0 0.2 1 0 0 1.5 0] "float width0" 0.05 "float width1" 0.01
ObjectEnd
AttributeBegin
 {motion}ConcatTransform [{matrix}]
 ObjectInstance "grp"
AttributeEnd
"""
_MOVES = "ActiveTransform EndTime Translate 0.2 0 0 ActiveTransform All\n "
_MATRICES = {
    "shear": ("1 0 0 0 0 1 0 0 0 1e9 1 0 1 0 0 1", 0),
    "shear beyond the limit": ("1 0 0 0 0 1 0 0 0 1e25 1 0 1 0 0 1", 0),
    "thin": ("1 0 0 0 0 1 0 0 0 0 1e-19 0 0 0 0 1", 0),
    "small": ("1e-19 0 0 0 0 1e-19 0 0 0 0 1e-19 0 0 0 0 1", 0),
    "large": ("1e19 0 0 0 0 1e19 0 0 0 0 1e19 0 0 0 0 1", 3),
}


@pytest.mark.parametrize("moves", [False, True])
@pytest.mark.parametrize("name", list(_MATRICES))
def test_info_and_render_agree_about_odd_transforms(name: str, moves: bool, tmp_path: Path) -> None:
    matrix, still = _MATRICES[name]
    file = tmp_path / "odd.pbrt"
    file.write_text(_PBRT.format(motion=_MOVES if moves else "", matrix=matrix))
    flags = ("-o", str(tmp_path / "o.png"), "--res", "24x24", "--spp", "4", "-q")
    ends = []
    for words in (("info", str(file)), ("render", str(file), *flags)):
        command = [sys.executable, "-m", "daguerre", *words]
        ends.append(subprocess.run(command, capture_output=True, text=True, timeout=120))
    codes = [end.returncode for end in ends]
    assert codes == [0 if moves else still] * 2, ends[1].stderr
    if name.startswith("shear"):
        drawn = "a moving shape is not drawn while it is" if moves else "a shape that is"
        assert f"{drawn} scaled to zero or sheared flat" in ends[0].stdout
