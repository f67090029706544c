"""Lights: their units, powers, directions, and the light that maps keep."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.color.illuminants import planck, white_xy, xy_of
from daguerre.color.spectra import luminance_of_rgb, rgb_from_xyz
from daguerre.importers.pbrt.environment import _upward
from daguerre.importers.pbrt.octahedral import directions_of, panorama_of, square_of
from daguerre.scene.lights import DirectionalLight, PointLight

from .text import MIRROR, SQUARE, picture, read


def _one(tmp_path: Path, text: str) -> tuple[PointLight, np.ndarray]:
    ((light, transform),) = read(tmp_path, text).lights
    assert isinstance(light, PointLight)
    return light, transform


def _flux(light: object) -> float:
    """Luminous flux, by Monte Carlo over the sphere."""
    assert isinstance(light, PointLight)
    rng = np.random.default_rng(3)
    ways = rng.normal(size=(200_000, 3))
    factors = 1.0 if light.profile is None else light.profile.factors(ways).mean(axis=0)
    return 4 * math.pi * float(luminance_of_rgb() @ (np.array(light.intensity) * factors))


def test_a_point_light_has_its_candelas_or_its_lumens(tmp_path: Path) -> None:
    light, transform = _one(
        tmp_path, 'Translate 1 2 3 LightSource "point" "rgb I" [1 2 3] "float scale" 2 '
        '"point3 from" [0 0 1]'
    )  # fmt: skip
    assert light.intensity == pytest.approx((2, 4, 6))
    assert transform[:3, 3] == pytest.approx((1, 2, -4))
    light, _ = _one(tmp_path, 'LightSource "point" "blackbody I" 3000 "float power" 100')
    assert _flux(light) == pytest.approx(100, rel=1e-3)


def test_a_spot_light_falls_off_as_in_pbrt_and_has_its_power(tmp_path: Path) -> None:
    text = 'LightSource "spot" "point3 from" [0 3 0] "point3 to" [0 0 4] "float coneangle" 40 '
    text += '"float conedeltaangle" 15 "rgb I" [2 2 2]'
    light, transform = _one(tmp_path, text)
    ahead = MIRROR @ np.array((0, -3, 4.0)) / 5
    assert -transform[:3, 2] == pytest.approx(ahead)
    assert light.profile is not None
    for angle in (0, 10, 24, 26, 30, 35, 39, 41, 120):
        x = (math.cos(math.radians(angle)) - math.cos(math.radians(40))) / (
            math.cos(math.radians(25)) - math.cos(math.radians(40))
        )
        x = min(max(x, 0), 1)
        way = np.array([(math.sin(math.radians(angle)), 0, -math.cos(math.radians(angle)))])
        assert light.profile.factors(way)[0, 1] == pytest.approx(x * x * (3 - 2 * x), abs=2e-3)
    lamp, _ = _one(tmp_path, f'{text} "float power" 500'.replace("[2 2 2]", "[1 1 1]"))
    # pbrt's own formula for the power takes the mean of the soft edge for one half.
    inner, outer = math.cos(math.radians(25)), math.cos(math.radians(40))
    assert lamp.intensity[1] == pytest.approx(
        500 / (2 * math.pi * (1 - inner + (inner - outer) / 2))
    )
    assert _flux(lamp) == pytest.approx(500, rel=0.02)


def test_a_spot_light_of_v3_falls_off_by_the_fourth_power(tmp_path: Path) -> None:
    light, _ = _one(tmp_path, 'LightSource "spot" "float coneangle" 40 WorldEnd')
    assert light.profile is not None
    inner, outer, seen = (math.cos(math.radians(angle)) for angle in (35, 40, 38))
    way = np.array([(math.sin(math.radians(38)), 0, -seen)])
    wanted = ((seen - outer) / (inner - outer)) ** 4
    assert light.profile.factors(way)[0, 1] == pytest.approx(wanted, abs=2e-3)


def test_a_distant_light_has_its_lux_and_direction(tmp_path: Path) -> None:
    scene = read(
        tmp_path,
        'Rotate 90 0 1 0 LightSource "distant" "point3 from" [0 0 0] "point3 to" [0 -1 1] '
        '"float illuminance" 250 "spectrum L" [400 7 700 7]',
    )
    ((light, transform),) = scene.lights
    assert isinstance(light, DirectionalLight)
    assert luminance_of_rgb() @ light.illuminance == pytest.approx(250, rel=1e-3)
    # Rotate 90 about y takes +z to +x in pbrt's frame.
    assert -transform[:3, 2] == pytest.approx(np.array((1, -1, 0)) / math.sqrt(2))


def test_a_distant_light_lights_as_the_formula_says(tmp_path: Path) -> None:
    options = 'LookAt 0 0 -4 0 0 0 0 1 0 Camera "perspective" "float fov" 10'
    light = 'LightSource "distant" "point3 from" [0 0 0] "point3 to" [0 1 1] "rgb L" [3 3 3]'
    world = f'{light} Material "diffuse" "rgb reflectance" [0.4 0.4 0.4] {SQUARE}'
    frame = dg.render(read(tmp_path, world, options), resolution=(8, 8), spp=16)
    assert frame.rgb[4, 4, 1] == pytest.approx(0.4 / math.pi * 3 / math.sqrt(2), rel=0.01)


def test_a_goniometric_light_shines_by_its_map(tmp_path: Path) -> None:
    image = np.full((16, 16, 3), 0.2, np.float32)
    way = np.array((0.6, 0.64, 0.48))  # in the light's space; the map's axis is its y
    s, t = square_of(way[[0, 2, 1]])
    image[int(t * 16), int(s * 16)] = 5
    picture(tmp_path / "map.exr", image)
    light, transform = _one(tmp_path, 'LightSource "goniometric" "string filename" "map.exr"')
    assert light.profile is not None
    assert np.linalg.det(transform[:3, :3]) == pytest.approx(1)
    to_frame = transform[:3, :3].T @ MIRROR
    assert light.profile.factors((to_frame @ way)[None])[0, 1] == pytest.approx(5, rel=0.05)
    other = to_frame @ (way * (-1, 1, 1))
    assert light.profile.factors(other[None])[0, 1] == pytest.approx(0.2, rel=0.01)


def test_a_projection_light_is_upright(tmp_path: Path) -> None:
    image = np.zeros((8, 16, 3), np.uint8)
    image[:4, 8:] = (255, 0, 0)  # upper right
    image[4:, :8] = (0, 255, 0)  # lower left
    picture(tmp_path / "slide.png", image)
    scene = read(tmp_path, 'LightSource "projection" "string filename" "slide.png" "float fov" 60')
    assert len(scene.lights) == 2
    for (light, transform), way in zip(scene.lights, ((0.4, 0.2, 1), (-0.4, -0.2, 1)), strict=True):
        assert isinstance(light, PointLight)
        assert light.profile is not None
        frame = transform[:3, :3].T @ MIRROR
        ways = np.array([frame @ np.array(way), frame @ (np.array(way) * (-1, 1, 1))])
        assert light.profile.factors(ways)[:, 1] == pytest.approx((1, 0), abs=0.01)
    powered = read(
        tmp_path,
        'LightSource "projection" "string filename" "slide.png" "float fov" 60 "float power" 90',
    )
    assert sum(_flux(light) for light, _ in powered.lights) == pytest.approx(90, rel=0.05)


def test_a_projection_light_of_v3_is_45_degrees_wide(tmp_path: Path) -> None:
    """Across the shorter side, unless it says otherwise; those of pbrt-v4 are 90 degrees wide."""
    picture(tmp_path / "slide.png", np.full((8, 8, 3), 255, np.uint8))
    text = 'LightSource "projection" "string mapname" "slide.png"'
    for more, half in (("", 45.0), ("WorldEnd", 22.5)):
        ((light, _), *_) = read(tmp_path, f"{text} {more}").lights
        assert isinstance(light, PointLight)
        assert light.profile is not None
        angles = np.radians([half - 3, half + 3])
        ways = np.stack([np.sin(angles), np.zeros(2), -np.cos(angles)], axis=1)
        assert light.profile.factors(ways)[:, 1] == pytest.approx((1, 0), abs=0.01)


def test_areas_on_the_square_are_areas_on_the_sphere() -> None:
    """The map is equal-area: the mean of any function is that over the sphere."""
    middle = (np.arange(256) + 0.5) / 256
    s, t = np.meshgrid(middle, middle)
    ways = directions_of(s, t)
    assert np.linalg.norm(ways, axis=-1) == pytest.approx(1)
    assert np.allclose(square_of(ways), (s, t), atol=1e-9)
    x, y, z = (ways[..., i] for i in range(3))
    for value, mean in ((x * x, 1 / 3), (z**4, 1 / 5), (x * x * y * y, 1 / 15), (x * z, 0)):
        assert value.mean() == pytest.approx(mean, abs=2e-4)
    assert directions_of(np.array(0.5), np.array(0.5)) == pytest.approx((0, 0, 1))
    assert directions_of(np.array(0.75), np.array(0.5))[0] > 0


def _sun(size: int, way: np.ndarray) -> np.ndarray:
    image = np.full((size, size, 3), 0.1, np.float32)
    s, t = square_of(way)
    image[int(t * size), int(s * size)] = 1e5
    return image


@pytest.mark.parametrize("size", [8, 33, 128])
def test_a_panorama_keeps_the_light_of_its_map(size: int) -> None:
    rng = np.random.default_rng(size)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    way = np.array((0.48, -0.64, 0.6))
    image = _sun(size, way)
    made = panorama_of(image, turn)
    rows = len(made)
    edges = np.sin((0.5 - np.arange(rows + 1) / rows) * math.pi)
    solid = (edges[:-1] - edges[1:])[:, None] * (math.pi / rows)
    light = float((made[..., 1] * solid).sum())
    assert light == pytest.approx(4 * math.pi * float(image[..., 1].mean()), rel=5e-3)
    row, column = np.unravel_index(int(made[..., 1].argmax()), made.shape[:2])
    up = (0.5 - (row + 0.5) / rows) * math.pi
    around = ((column + 0.5) / (2 * rows) - 0.5) * 2 * math.pi
    seen = (math.cos(up) * math.sin(around), math.sin(up), -math.cos(up) * math.cos(around))
    assert np.dot(seen, turn @ way) > math.cos(4 / size)


def test_an_infinite_light_of_pbrt_v4_is_where_pbrt_has_it(tmp_path: Path) -> None:
    way = np.array((0.48, -0.64, 0.6))
    picture(tmp_path / "sky.exr", _sun(32, way))
    scene = read(tmp_path, 'Rotate 90 0 0 1 LightSource "infinite" "string filename" "sky.exr"')
    assert scene.environment is not None
    seen = _brightest(scene.environment.image)
    turned = np.array((-way[1], way[0], way[2]))  # by 90 degrees about z
    assert np.dot(seen, MIRROR @ turned) > math.cos(4 / 32)


def test_an_infinite_light_of_pbrt_v3_is_where_pbrt_has_it(tmp_path: Path) -> None:
    image = np.full((32, 64, 3), 0.1, np.float32)
    image[8, 6] = 100  # theta = 48 degrees from +z, phi = 37 degrees from +x toward +y
    picture(tmp_path / "sky.exr", image)
    scene = read(tmp_path, 'LightSource "infinite" "string mapname" "sky.exr" WorldEnd')
    assert scene.environment is not None
    seen = _brightest(scene.environment.image)
    theta, phi = 8.5 / 32 * math.pi, 6.5 / 32 * math.pi
    flat = math.sin(theta)
    way = np.array((flat * math.cos(phi), flat * math.sin(phi), math.cos(theta)))
    assert np.dot(seen, MIRROR @ way) > math.cos(4 / 32)


def _brightest(image: np.ndarray | None) -> np.ndarray:
    assert image is not None
    rows, columns = image.shape[:2]
    row, column = np.unravel_index(int(image[..., 1].argmax()), (rows, columns))
    up = (0.5 - (row + 0.5) / rows) * math.pi
    around = ((column + 0.5) / columns - 0.5) * 2 * math.pi
    return np.array(
        (math.cos(up) * math.sin(around), math.sin(up), -math.cos(up) * math.cos(around))
    )


def test_infinite_lights_are_added_and_have_their_lux(tmp_path: Path) -> None:
    plain = 'LightSource "infinite" "rgb L" [1 2 3] "float scale" 2'
    scene = read(tmp_path, f'{plain} LightSource "infinite" "float illuminance" 3.14159265')
    assert scene.environment is not None
    assert scene.environment.color == pytest.approx((3, 5, 7))
    picture(tmp_path / "sky.exr", np.ones((8, 8, 3), np.float32))
    both = read(tmp_path, f'{plain} LightSource "infinite" "string filename" "sky.exr"')
    assert both.environment is not None
    assert both.environment.image is not None
    assert np.allclose(both.environment.image, (3, 5, 7))
    assert _upward(np.ones((64, 64, 3), np.float32)) == pytest.approx(math.pi / 2, rel=1e-3)


def test_a_picture_that_is_no_square_is_refused(tmp_path: Path) -> None:
    picture(tmp_path / "sky.exr", np.ones((4, 8, 3), np.float32))
    message = r"LightSource: filename: .*sky\.exr: wanted a square equal-area"
    with pytest.raises(dg.InputError, match=message):
        read(tmp_path, 'LightSource "infinite" "string filename" "sky.exr"')


def test_black_bodies_and_spectra_have_luminance_1_in_v4_alone(tmp_path: Path) -> None:
    (tmp_path / "twice.spd").write_text("# twice\n380 2\n780 2\n")
    for spectrum in ('"blackbody L" 2856', '"spectrum L" "twice.spd"', '"spectrum L" "stdillum-A"'):
        scene = read(tmp_path, f'LightSource "infinite" {spectrum} "float scale" 3')
        assert scene.environment is not None
        color = np.array(scene.environment.color)
        assert luminance_of_rgb() @ color == pytest.approx(3, rel=1e-3)
    x, y = xy_of(planck(2856))
    assert (x, y) == pytest.approx((0.4476, 0.4074), abs=5e-4)  # illuminant A (CIE 015:2018)
    old = read(tmp_path, 'LightSource "infinite" "spectrum L" "twice.spd" WorldEnd')
    assert old.environment is not None
    assert luminance_of_rgb() @ np.array(old.environment.color) == pytest.approx(2, rel=1e-3)


def test_named_illuminants_have_their_white(tmp_path: Path) -> None:
    """Against daylight of 5003 K, and a black body of 2856 K (CIE 015:2018)."""
    whites = {"D65": white_xy(), "D50": white_xy(5003), "A": xy_of(planck(2856.0))}
    for name, (x, y) in whites.items():
        light, _ = _one(tmp_path, f'LightSource "point" "spectrum I" "stdillum-{name}"')
        rgb = np.array(light.intensity)
        assert float(luminance_of_rgb() @ rgb) == pytest.approx(1, rel=1e-6)
        xyz = np.linalg.inv(rgb_from_xyz()) @ rgb
        assert xyz[:2] / xyz.sum() == pytest.approx((x, y), abs=5e-4)


def _emission(scene: dg.Scene, i: int = 0) -> np.ndarray:
    return np.array(scene.materials[scene.instances[i].material].emission)


def test_areas_have_their_power(tmp_path: Path) -> None:
    """Phi = pi L A, of each triangle of a mesh and of a whole quadric (DiffuseAreaLight)."""
    light = 'AreaLightSource "diffuse" "float power" 100'
    sphere = read(tmp_path, f'{light} Shape "sphere" "float radius" 2')
    assert _emission(sphere)[1] == pytest.approx(100 / (math.pi * 16 * math.pi))
    both = read(tmp_path, f'{light} "bool twosided" true Shape "disk" "float radius" 2')
    assert _emission(both)[1] == pytest.approx(100 / (2 * math.pi * 4 * math.pi))
    square = read(tmp_path, f"Scale 3 3 1 {light} {SQUARE}")
    assert _emission(square)[1] == pytest.approx(100 / (math.pi * 18))
    uneven = read(
        tmp_path,
        f'{light} Shape "trianglemesh" "point3 P" [0 0 0 2 0 0 0 2 0 0 -8 0] '
        '"integer indices" [0 1 2 0 3 1]',
    )
    areas = {2.0, 8.0}
    for i, instance in enumerate(uneven.instances):
        points = uneven.meshes[instance.mesh].positions[uneven.meshes[instance.mesh].indices[0]]
        area = 0.5 * float(np.linalg.norm(np.cross(points[1] - points[0], points[2] - points[0])))
        assert _emission(uneven, i)[1] == pytest.approx(100 / (math.pi * area))
        areas.discard(round(area, 3))
    assert not areas


def test_patches_have_their_power_and_triangles_of_no_area_none(tmp_path: Path) -> None:
    """A bilinear patch is one light, and so is a quadrangle of a file, which pbrt draws as one."""
    light = 'AreaLightSource "diffuse" "float power" 100'
    two = '"point3 P" [0 0 0 2 0 0 0 1 0 2 1 0 4 0 0 4 1 0] "integer indices" [0 1 2 3 1 4 3 5]'
    patches = read(tmp_path, f'{light} Shape "bilinearmesh" {two}')
    assert len(patches.instances) == 1
    assert _emission(patches)[1] == pytest.approx(100 / (math.pi * 2))
    (tmp_path / "quads.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n2 0 0\n2 1 0\n0 1 0\n1 5 0\n4 0 1 2 3\n3 3 2 4\n"
    )
    quads = read(tmp_path, f'{light} Shape "plymesh" "string filename" "quads.ply"')
    assert sorted(_emission(quads, i)[1] for i in (0, 1)) == pytest.approx(
        [100 / (math.pi * 4), 100 / (math.pi * 2)]
    )
    flat = read(
        tmp_path,
        f'{light} Shape "trianglemesh" "point3 P" [0 0 0 2 0 0 0 2 0] '
        '"integer indices" [0 1 2 0 0 1]',
    )
    lit = [_emission(flat, i)[1] for i in range(len(flat.instances))]
    assert max(lit) == pytest.approx(100 / (math.pi * 2))


def test_the_front_shines_and_reverse_orientation_turns_it(tmp_path: Path) -> None:
    options = 'LookAt 0 0 -4 0 0 0 0 1 0 Camera "perspective" "float fov" 10 '
    options += 'Film "rgb" "integer xresolution" 8 "integer yresolution" 8'
    normals = f'{SQUARE} "normal N" [0 0 1 0 0 1 0 0 1 0 0 1]'
    cases = {
        SQUARE: 1,
        f"ReverseOrientation {SQUARE}": 0,
        f"Scale -1 1 1 {SQUARE}": 1,
        f"Scale 1 1 -1 {SQUARE}": 0,
        normals: 0,
        f"ReverseOrientation {normals}": 1,
        'Shape "disk"': 0,
        'ReverseOrientation Shape "disk"': 1,
        'Shape "sphere"': 1,
        'Shape "bilinearmesh" "point3 P" [-1 -1 0 -1 1 0 1 -1 0 1 1 0]': 1,
    }
    for shape, seen in cases.items():
        scene = read(tmp_path, f'AreaLightSource "diffuse" {shape}', options)
        frame = dg.render(scene, resolution=(8, 8), spp=4)
        assert frame.rgb[4, 4, 1] == pytest.approx(seen, abs=0.01), shape


def test_lights_of_objects_are_left_out_as_in_pbrt(tmp_path: Path) -> None:
    scene = read(
        tmp_path,
        f'ObjectBegin "a" AreaLightSource "diffuse" {SQUARE} ObjectEnd ObjectInstance "a"',
    )
    assert not _emission(scene).any()
    assert any("AreaLightSource of an object" in note for note in scene.warnings)
