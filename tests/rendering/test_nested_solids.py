"""Solids in solids: the relative index and the right absorption at each boundary."""

from __future__ import annotations

import dataclasses
import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.exporters.gltf import Glb, Shape
from daguerre.rendering.session import Session
from tests.support.scene.scenes import at, sphere

CUBE = np.array([(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float)
SIDES = (
    *((0, 3, 1), (0, 2, 3), (4, 7, 6), (4, 5, 7), (0, 5, 4), (0, 1, 5)),
    *((2, 7, 3), (2, 6, 7), (0, 6, 2), (0, 4, 6), (1, 7, 5), (1, 3, 7)),
)
#: Place of the edge of a wall, seen through a wedge of glass in water, m.
EDGE_M = -0.4
NARROW = dg.Camera(lens="pinhole", focal_length=2000, sensor_size=(0.5, 0.5), transform=at(0, 0, 9))


def fresnel(a: float, b: float) -> float:
    return ((a - b) / (a + b)) ** 2


def stack(*indices: float) -> float:
    """Transmittance of parallel faces at right angles, incoherent: the sum of all reflections."""
    faces = (fresnel(a, b) for a, b in itertools.pairwise(indices))
    return 1 / (1 + sum(r / (1 - r) for r in faces))


def solid(ior: float, distance: float = math.inf, nesting: Any = "contained") -> dg.Material:
    """Glass that passes half of the light in a distance, m."""
    kind = dg.Gltf(
        base_color=(1, 1, 1), metallic=0, roughness=0, transmission=1, thickness=1, ior=ior,
        attenuation_distance=distance, attenuation_color=(0.5, 0.5, 0.5),
    )  # fmt: skip
    return dg.Material(kind, nesting=nesting)


def block(
    scene: dg.Scene, size: tuple[float, float, float], z: float, material: Any, name: str
) -> None:
    """A box, by half its sizes."""
    scene.add_instance(scene.add_mesh(CUBE * size, SIDES), material, at(0, 0, z), name=name)


def scene_of(light: float = 0.0) -> dg.Scene:
    """A wall of 1 cd/m2 behind all, in a world of other light."""
    scene = dg.Scene()
    points = CUBE[[0, 1, 3, 2]] * (50, 50, 0) - (0, 0, 9)
    wall = dg.Material(dg.Diffuse((0, 0, 0)), emission=(1, 1, 1))
    scene.add_instance(scene.add_mesh(points, [(0, 1, 2), (0, 2, 3)]), wall)
    scene.set_environment(color=(light,) * 3)
    return scene


def mean(scene: dg.Scene, **options: Any) -> float:
    given: dict[str, Any] = {
        "resolution": (8, 8),
        "spp": 256,
        "light_paths": "off",
        "max_depth": 40,
    }
    return float(dg.render(scene, NARROW, **(given | options)).rgb.mean())


def mean_through(outer: dg.Material, inner: dg.Material) -> float:
    """Light through a cube of 6 m that holds 2 m of another solid."""
    scene = scene_of()
    block(scene, (3, 3, 3), 0, outer, "outer")
    block(scene, (2, 2, 1), 0, inner, "inner")
    return mean(scene)


def test_an_air_gap_in_glass_reflects() -> None:
    assert mean_through(solid(1.5), solid(1.0)) == pytest.approx(stack(1, 1.5, 1, 1.5, 1), rel=0.01)


def test_the_same_glass_in_glass_is_not_there() -> None:
    assert mean_through(solid(1.5), solid(1.5)) == pytest.approx(stack(1, 1.5, 1), rel=0.01)


def test_glass_in_water_has_the_relative_index() -> None:
    assert mean_through(solid(1.33), solid(1.8)) == pytest.approx(
        stack(1, 1.33, 1.8, 1.33, 1), rel=0.005
    )


def test_each_absorbs_where_it_is() -> None:
    thin, thick = solid(1.0, 4.0), solid(1.0, 1.0)  # 4 m of it, and 2 m
    assert mean_through(thin, thick) == pytest.approx(0.5 * 0.25, rel=0.01)


@pytest.mark.parametrize("hair", [0.01, 0.0])
def test_water_that_touches_glass_or_overlaps_it_by_a_hair(hair: float) -> None:
    """A slab of glass, and water behind it: one boundary between both."""
    scene = scene_of()
    block(scene, (3, 3, 1), 1, solid(1.5), "glass")  # 0 to 2
    block(scene, (3, 3, 1), -1 + hair, solid(1.33), "water")  # -2 to 0
    assert mean(scene) == pytest.approx(stack(1, 1.5, 1.33, 1), rel=0.005)


def test_an_air_gap_between_water_and_glass_stays() -> None:
    scene = scene_of()
    block(scene, (3, 3, 1), 1, solid(1.5), "glass")
    block(scene, (3, 3, 1), -1.01, solid(1.33), "water")
    assert mean(scene) == pytest.approx(stack(1, 1.5, 1, 1.33, 1), rel=0.005)


def test_the_higher_priority_is_there() -> None:
    """Two dyes that overlap along 1 m: each would pass half of the light in 1 m, or in 4."""

    def light(first: Any, second: Any) -> float:
        scene = scene_of()
        block(scene, (3, 3, 1), 0.5, solid(1.0, 1.0, first), "strong")  # -0.5 to 1.5
        block(scene, (3, 3, 1), -0.5, solid(1.0, 4.0, second), "weak")  # -1.5 to 0.5
        return mean(scene)

    strong, weak = 0.5**2 * 0.5**0.25, 0.5 * 0.5**0.5
    assert light(2, 1) == pytest.approx(strong, rel=0.01)
    assert light(1, 2) == pytest.approx(weak, rel=0.01)
    assert light("contained", "contained") == pytest.approx(weak, rel=0.01)  # the later one


def test_literal_interfaces_are_as_before() -> None:
    scene = scene_of()
    for half, ior in ((3, 1.5), (1, 1 / 1.5)):  # a ratio already
        block(scene, (3, 3, half), 0, dg.Material(dg.Dielectric(ior), nesting="literal"), "glass")
    assert mean(scene) == pytest.approx(stack(1, 1.5, 1, 1.5, 1), rel=0.01)


def test_a_lamp_without_size_shines_through_nested_glass() -> None:
    def light(*blocks: tuple[float, float]) -> float:
        scene = dg.Scene()
        for half, ior in blocks:
            block(scene, (3, 3, half), 0, solid(ior), f"{half} m")
        points = CUBE[[0, 1, 3, 2]] * (50, 50, 0) - (0, 0, 9)
        scene.add_instance(scene.add_mesh(points, [(0, 1, 2), (0, 2, 3)]), dg.Diffuse((1, 1, 1)))
        scene.add_light(dg.PointLight((100, 100, 100)), at(0, 0, 4))
        camera = NARROW.with_(transform=at(0, 0, -7))
        given: dict[str, Any] = {"resolution": (8, 8), "spp": 64, "max_depth": 1}
        return float(dg.render(scene, camera, light_paths="off", **given).rgb.mean())

    bare, same = light(), light((2, 1.5), (1, 1.5))
    one, gap = light((2, 1.5)), light((2, 1.5), (1, 1.0))
    assert same == pytest.approx(one, rel=0.01)
    assert gap / one == pytest.approx((1 - 0.04) ** 2, rel=0.01)
    assert one / bare == pytest.approx((1 - 0.04) ** 2, rel=0.01)


def test_a_white_furnace_with_nested_solids_is_white() -> None:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    ball = scene.add_mesh(*sphere(24))
    scene.add_instance(ball, solid(1.5), at(0, 0, 0) * 1.0, name="glass")
    small = np.diag((0.6, 0.6, 0.6, 1.0))
    scene.add_instance(ball, solid(1.0), at(0.1, 0, 0) @ small, name="bubble")
    tiny = np.diag((0.3, 0.3, 0.3, 1.0))
    scene.add_instance(ball, solid(1.33), at(0.1, 0, 0) @ tiny, name="water")
    camera = dg.Camera(lens="pinhole", focal_length=120, transform=at(0, 0, 9))
    frame = dg.render(scene, camera, resolution=(16, 16), spp=256, light_paths="off", max_depth=200)
    assert frame.rgb[6:10, 6:10].mean() == pytest.approx(1, rel=0.01)


@pytest.mark.parametrize("camera_in", [False, True])
def test_light_paths_change_no_mean(camera_in: bool) -> None:
    scene = dg.Scene()
    floor = CUBE[[0, 1, 3, 2]] * (4, 4, 0) - (0, 0, 2)
    scene.add_instance(scene.add_mesh(floor, [(0, 1, 2), (0, 2, 3)]), dg.Diffuse((0.8, 0.8, 0.8)))
    ball = scene.add_mesh(*sphere(24))
    scene.add_instance(ball, solid(1.5), at(0, 0, 0), name="glass")
    small = np.diag((0.5, 0.5, 0.5, 1.0))
    scene.add_instance(ball, solid(1.0), at(0.2, 0, 0) @ small, name="bubble")
    scene.add_light(dg.SphereLight((300, 300, 300), 0.3), at(1, 1, 3))
    place = at(0, 0, 0.8) if camera_in else at(0.5, 0.5, 6)
    camera = dg.Camera(lens="pinhole", focal_length=20, transform=place)
    given: dict[str, Any] = {"resolution": (16, 12), "spp": 4096, "max_depth": 8}
    off, on = (
        dg.render(scene, camera, light_paths=paths, **given).rgb.mean() for paths in ("off", 4.0)
    )
    assert on == pytest.approx(off, rel=0.02)


def told(scene: dg.Scene) -> tuple[list[str], list[str]]:
    """Warnings, and notes about overlaps."""
    session = Session(scene, NARROW, resolution=(8, 8), spp=1)
    return session.warnings, [note for note in session.notes if "overlap" in note]


def two_blocks(shift: float, first: Any = "contained", second: Any = "contained") -> dg.Scene:
    scene = scene_of()
    block(scene, (3, 3, 3), 0, solid(1.5, nesting=first), "glass")
    block(scene, (2, 2, 1), shift, solid(1.0, nesting=second), "gap")
    return scene


@pytest.mark.parametrize(("shift", "first"), [(0, "contained"), (3, -1), (0, -1)])
def test_a_clear_overlap_is_a_note(shift: float, first: Any) -> None:
    by = "containment" if first == "contained" else "priority"
    warnings, notes = told(two_blocks(shift, first))
    assert warnings == []
    assert notes == [f"where solids overlap, 'gap' replaces 'glass' (by {by})"]


def test_an_unclear_overlap_is_a_warning() -> None:
    warnings, notes = told(two_blocks(3))
    assert notes == []
    assert warnings == [
        "where solids of equal priority overlap and neither is inside the other, 'gap' replaces "
        "'glass' (by the order of the file); Material(nesting=) chooses another"
    ]


def test_an_unclear_overlap_is_told_beside_many_clear_ones() -> None:
    scene = two_blocks(3)
    small = scene.add_mesh(CUBE * 0.05, SIDES)
    for k in range(20):
        scene.add_instance(small, solid(1.0), at(-1.8 + 0.18 * k, 0, 0.5), name=f"bubble {k}")
    warnings, notes = told(scene)
    assert ["'gap' replaces 'glass'" in text for text in warnings] == [True]
    assert ["(by containment)" in text for text in notes] == [True]


def test_strict_accepts_bubbles_in_glass(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """No warning of a correct scene, and ``--strict`` draws it."""
    glb = Glb("daguerre tests")
    volume = {"KHR_materials_transmission": {"transmissionFactor": 1}}
    volume["KHR_materials_volume"] = {"thicknessFactor": 1}
    glass = glb.add_material("glass", extensions=volume)
    points, faces, normals = sphere(12)
    for name, size in (("glass", 1.0), ("bubble", 0.4)):
        shape = Shape(points * size, normals, points[:, :2], faces)
        glb.add_node(name, mesh=glb.add_mesh(name, shape, glass))
    path = tmp_path / "bubbles.glb"
    glb.write(path)
    words = ["render", str(path), "--strict", "--res", "8x8", "--spp", "1"]
    assert main([*words, "-o", str(tmp_path / "a.png")]) == 0
    said = [line for line in capsys.readouterr().err.splitlines() if "overlap" in line]
    assert said == ["daguerre: where solids overlap, 'bubble' replaces 'glass' (by containment)"]


def test_more_solids_than_a_path_knows_are_told() -> None:
    def warnings(count: int) -> list[str]:
        scene = scene_of()
        for i in range(count):
            size = 3 - 0.2 * i
            block(scene, (size, size, size), 0, solid(1.1 + 0.01 * i), f"shell {i}")
        return told(scene)[0]

    assert warnings(8) == []
    assert warnings(9) == ["more than eight solids are nested; a path keeps eight"]


@pytest.mark.parametrize("kind", ["gltf", "dielectric"])
def test_either_side_of_a_boundary_disperses(kind: str) -> None:
    """Plain glass before water that disperses, with a wall in it; their boundary is of either."""

    def made(ior: float, dispersion: float, priority: int) -> dg.Material:
        base = solid(ior).kind if kind == "gltf" else dg.Dielectric(ior)
        return dg.Material(dataclasses.replace(base, dispersion=dispersion), nesting=priority)

    def colours(water_owns: bool) -> np.ndarray:
        scene = dg.Scene()
        slanted, flat = (1, -12) if water_owns else (-1, 2)
        own = [(x, y, -0.4 * x if z == slanted else flat) for x, y, z in CUBE * (3, 3, 1)]
        glass, water = made(1.5, 0, 1 - water_owns), made(1.33, 3, int(water_owns))
        wedge = scene.add_mesh(own, SIDES)
        scene.add_instance(wedge, water if water_owns else glass, name="wedge")
        if water_owns:
            block(scene, (3, 3, 1.9), 0.1, glass, "rest")
        else:
            block(scene, (3, 3, 6.9), -5.1, water, "rest")
        wall = CUBE[[0, 1, 3, 2]] * (20, 50, 0) - (20.0 + EDGE_M, 0, 9)
        lit = dg.Material(dg.Diffuse((0, 0, 0)), emission=(1, 1, 1))
        scene.add_instance(scene.add_mesh(wall, [(0, 1, 2), (0, 2, 3)]), lit)
        camera = NARROW.with_(sensor_size=(24.0, 1.0))
        given: dict[str, Any] = {"resolution": (24, 1), "spp": 4096, "max_depth": 12}
        return np.asarray(dg.render(scene, camera, light_paths="off", **given).rgb[0])

    of_glass, of_water = colours(False), colours(True)
    assert np.abs(of_water[:, 0] - of_water[:, 2]).max() > 0.5
    np.testing.assert_allclose(of_glass, of_water, atol=0.04)


def test_boxes_that_overlap_are_no_solids_that_do() -> None:
    scene = scene_of()
    ball = scene.add_mesh(*sphere(16))
    scene.add_instance(ball, solid(1.5), at(0, 0, 0), name="one")
    scene.add_instance(ball, solid(1.5), at(1.5, 1.5, 1.5), name="other")
    hollow = Session(scene, NARROW, resolution=(8, 8), spp=1)
    assert hollow.warnings == []
    assert hollow.built.core.overlaps == []


@pytest.mark.parametrize("wrong", ["inside", 1.5, True, 2000, None])
def test_a_wrong_nesting_is_one_error(wrong: Any) -> None:
    with pytest.raises(dg.InputError, match="nesting: wanted 'contained', 'literal' or a whole"):
        dg.Scene().add_material(dg.Material(dg.Diffuse(), nesting=wrong))
