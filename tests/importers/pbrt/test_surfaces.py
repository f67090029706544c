"""Transforms, shapes, textures, materials and media, against formulas of pbrt's book and guide."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.color import srgb
from daguerre.importers.pbrt.subsurface import MEASURED, diffuse_reflectance
from daguerre.scene.materials import Boundary, Coated, Conductor, Dielectric, Diffuse, Mix
from tests.support.formats import nanovdb_files

from .text import MIRROR, SQUARE, picture, read, world_points


def _kind(scene: dg.Scene, i: int = 0) -> object:
    return scene.materials[scene.instances[i].material].kind


def _place(scene: dg.Scene, i: int = 0) -> np.ndarray:
    """World of pbrt from local, (3, 4)."""
    return MIRROR @ scene.instances[i].transform[:3]


def test_transforms_are_those_of_pbrt(tmp_path: Path) -> None:
    scene = read(
        tmp_path,
        "Translate 1 2 3 Rotate 90 0 0 1 Scale 2 3 4 Shape \"sphere\" "
        "AttributeBegin Identity ConcatTransform [0 1 0 0 -1 0 0 0 0 0 1 0 5 6 7 1] "
        'Shape "sphere" CoordinateSystem "a" AttributeEnd '
        'AttributeBegin CoordSysTransform "a" Translate 1 0 0 Shape "sphere" AttributeEnd '
        'TransformBegin Identity TransformEnd Shape "sphere" '
        'LookAt 1 2 3  1 2 7  0 1 0 Shape "sphere" Transform [1 0 0 0 0 1 0 0 0 0 1 0 9 9 9 1] '
        'Shape "sphere"',
    )  # fmt: skip
    first = np.array([(0, -3, 0, 1), (2, 0, 0, 2), (0, 0, 4, 3)])
    turned = np.array([(0, -1, 0, 5), (1, 0, 0, 6), (0, 0, 1, 7)])
    assert _place(scene, 0) == pytest.approx(first)
    assert _place(scene, 1) == pytest.approx(turned)
    assert _place(scene, 2)[:, 3] == pytest.approx((5, 7, 7))
    assert _place(scene, 3) == pytest.approx(first)
    assert _place(scene, 4)[:, 3] == pytest.approx(first @ (-1, -2, -3, 1))
    assert _place(scene, 5)[:, 3] == pytest.approx((9, 9, 9))


def test_objects_stand_at_their_instances_and_move(tmp_path: Path) -> None:
    scene = read(
        tmp_path,
        'ObjectBegin "a" Translate 0 1 0 Shape "sphere" Shape "disk" ObjectEnd '
        'AttributeBegin Translate 5 0 0 ObjectInstance "a" AttributeEnd '
        "TransformTimes 1 3 ActiveTransform EndTime Translate 2 0 0 ActiveTransform All "
        'ObjectInstance "a"',
    )
    assert len(scene.meshes) == 2
    assert len(scene.instances) == 4
    places = {tuple(np.round(_place(scene, i)[:, 3], 6)) for i in range(4)}
    assert places == {(5, 1, 0), (0, 1, 0)}
    assert scene.duration == 3
    moved = scene.at(2.0)
    assert {tuple(np.round(_place(moved, i)[:, 3], 6)) for i in range(4)} == {(5, 1, 0), (1, 1, 0)}
    assert scene.nodes["a"] == [0, 1, 2, 3]


def test_attributes_and_names_of_v3_that_are_defined_anew(tmp_path: Path) -> None:
    scene = read(
        tmp_path,
        'Attribute "shape" "float radius" 3 Shape "sphere" Shape "sphere" "float radius" 1 '
        'MakeNamedMaterial "m" "string type" "matte" "color Kd" [1 0 0] NamedMaterial "m" '
        'Shape "disk" MakeNamedMaterial "m" "string type" "matte" "color Kd" [0 1 0] '
        'NamedMaterial "m" Shape "disk" WorldEnd',
    )
    sizes = [np.abs(world_points(scene, i)).max() for i in range(4)]
    assert sizes == pytest.approx([3, 1, 3, 3])
    red, green = _kind(scene, 2), _kind(scene, 3)
    assert isinstance(red, Diffuse)
    assert isinstance(green, Diffuse)
    assert red.reflectance == (1, 0, 0)
    assert green.reflectance == (0, 1, 0)


@pytest.mark.parametrize(
    ("shape", "area"),
    [
        ('"sphere" "float radius" 2', 16 * math.pi),
        ('"sphere" "float radius" 2 "float zmin" -1 "float zmax" 1', 8 * math.pi),
        ('"sphere" "float phimax" 90', math.pi),
        ('"disk" "float radius" 2 "float innerradius" 1', 3 * math.pi),
        ('"cylinder" "float radius" 2 "float zmin" 0 "float zmax" 3', 12 * math.pi),
        ('"bilinearmesh" "point3 P" [0 0 0 2 0 0 0 3 0 2 3 0]', 6),
    ],
)
def test_shapes_have_their_area_and_face_outward(tmp_path: Path, shape: str, area: float) -> None:
    scene = read(tmp_path, f"Shape {shape}")
    mesh = scene.meshes[0]
    corners = mesh.positions[mesh.indices].astype(float)
    corners = corners * np.linalg.norm(scene.instances[0].transform[0, :3])
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert 0.5 * np.linalg.norm(cross, axis=1).sum() == pytest.approx(area, rel=2e-3)
    assert mesh.normals is not None
    assert (np.einsum("ij,ij->i", cross, mesh.normals[mesh.indices].sum(axis=1)) > 0).all()


def test_a_plymesh_of_polygons_has_its_coordinates(tmp_path: Path) -> None:
    (tmp_path / "quad.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nproperty float u\nproperty float v\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n"
        "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n"
    )
    scene = read(tmp_path, 'Shape "plymesh" "string filename" "quad.ply"')
    mesh = scene.meshes[0]
    assert mesh.indices.shape == (2, 3)
    assert mesh.uv is not None
    assert mesh.uv.tolist() == [[0, 1], [1, 1], [1, 0], [0, 0]]  # (0, 0) is the top left
    assert scene.instances[0].name == "quad"
    lost = read(tmp_path, 'Shape "plymesh" "string filename" "no.ply"')
    assert "a mesh whose file is missing is left out (1 use: 'no.ply')" in lost.warnings


def test_curves_of_all_bases_are_their_own_points(tmp_path: Path) -> None:
    """The middle of the first segment, by the values of de Boor's and Bernstein's polynomials."""
    points = np.array([(0, 0, 0), (1, 2, 0), (3, 1, 1), (4, 0, 2)], float)
    text = " ".join(f"{x:g}" for x in points.reshape(-1))
    middles = {
        ("bezier", 3): points.T @ (1, 3, 3, 1) / 8,
        ("bspline", 3): points.T @ (1, 23, 23, 1) / 48,
        ("bspline", 2): points[:3].T @ (1, 6, 1) / 8,
        ("bezier", 2): points[:3].T @ (1, 2, 1) / 4,
    }
    for (basis, degree), middle in middles.items():
        given = text if (basis, degree) != ("bezier", 2) else " ".join(text.split()[:9])
        scene = read(
            tmp_path,
            f'Scale 2 2 2 Shape "curve" "string basis" "{basis}" "integer degree" {degree} '
            f'"point3 P" [{given}] "float width0" 0.4 "float width1" 0.2 "string type" "cylinder"',
        )
        first = world_points(scene, 0)[:4]
        assert pytest.approx(2 * middle) == MIRROR @ (first.T @ (1, 3, 3, 1) / 8)
        curves = scene.meshes[0]
        assert isinstance(curves, dg.scene.parts.Curves)
        assert curves.radii[[0, -1]] == pytest.approx((0.4, 0.2))


def _slot(scene: dg.Scene, name: str = "reflectance_texture") -> tuple[np.ndarray, Any]:
    slot = getattr(_kind(scene), name)
    assert isinstance(slot, dg.TextureSlot)
    texture = scene.textures[slot.texture]
    pixels = texture.pixels.astype(float) / (255 if texture.pixels.dtype == np.uint8 else 1)
    return (srgb.to_linear(pixels) if texture.srgb else pixels), (slot, texture)


def _seen(scene: dg.Scene, u: float, v: float, name: str = "reflectance_texture") -> np.ndarray:
    """Nearest texel at texture coordinates of pbrt, as the core reads it."""
    pixels, (slot, texture) = _slot(scene, name)
    a, b, c, d, e, f = slot.transform
    x, y = a * u + b * (1 - v) + c, d * u + e * (1 - v) + f
    height, width = pixels.shape[:2]
    column, row = math.floor(x * width), math.floor(y * height)
    assert texture.wrap == ("repeat", "repeat")
    return np.asarray(pixels[row % height, column % width])


def _colors(tmp_path: Path) -> np.ndarray:
    pixels = np.random.default_rng(4).integers(0, 256, (4, 8, 3)).astype(np.uint8)
    picture(tmp_path / "a.png", pixels)
    return pixels


def test_pictures_lie_as_in_pbrt(tmp_path: Path) -> None:
    pixels = _colors(tmp_path)
    scene = read(
        tmp_path,
        'Texture "a" "spectrum" "imagemap" "string filename" "a.png" "float uscale" 3 '
        '"float vscale" 0.5 "float udelta" 0.25 "float vdelta" 0.125 '
        f'Material "diffuse" "texture reflectance" "a" {SQUARE}',
    )
    for u, v in ((0.05, 0.1), (0.9, 0.3), (0.4, 0.95)):
        s, t = (3 * u + 0.25) % 1, (0.5 * v + 0.125) % 1
        wanted = pixels[int((1 - t) * 4), int(s * 8)] / 255
        assert _seen(scene, u, v) == pytest.approx(srgb.to_linear(wanted), abs=1e-6)


@pytest.mark.parametrize(
    ("texture", "formula"),
    [
        ('"imagemap" "string filename" "a.png" "bool invert" true', lambda c: 1 - c),
        ('"imagemap" "string filename" "a.png" "string encoding" "linear"', None),
        ('"mix" "texture tex1" "b" "rgb tex2" [1 0 0] "float amount" 0.25',
         lambda c: 0.75 * c + 0.25 * np.array((1, 0, 0))),
        ('"scale" "texture tex1" "b" "texture tex2" "b"', lambda c: c * c),
    ],
)  # fmt: skip
def test_trees_of_textures_are_their_formulas(
    tmp_path: Path, texture: str, formula: object
) -> None:
    pixels = _colors(tmp_path)
    scene = read(
        tmp_path,
        'Texture "b" "spectrum" "imagemap" "string filename" "a.png" "string filter" "point" '
        f'Texture "c" "spectrum" {texture} "string filter" "point" '
        f'Material "diffuse" "texture reflectance" "c" {SQUARE}',
    )
    for row, column in ((0, 0), (3, 7), (1, 4)):
        value = pixels[row, column] / 255
        wanted = value if formula is None else formula(srgb.to_linear(value))  # type: ignore[operator]
        found = _seen(scene, (column + 0.5) / 8, 1 - (row + 0.5) / 4)
        assert found == pytest.approx(wanted, abs=1e-5)


def test_a_factor_of_a_picture_stays_a_factor(tmp_path: Path) -> None:
    _colors(tmp_path)
    scene = read(
        tmp_path,
        'Texture "b" "spectrum" "imagemap" "string filename" "a.png" "float scale" 0.5 '
        'Texture "c" "spectrum" "scale" "texture tex" "b" "float scale" 0.5 '
        f'Material "diffuse" "texture reflectance" "c" {SQUARE}',
    )
    kind = _kind(scene)
    assert isinstance(kind, Diffuse)
    assert kind.reflectance == (0.25, 0.25, 0.25)
    assert scene.textures[0].pixels.dtype == np.uint8


def test_a_checkerboard_has_its_squares(tmp_path: Path) -> None:
    scene = read(
        tmp_path,
        'Texture "c" "spectrum" "checkerboard" "float uscale" 5 "float vscale" 3 '
        '"rgb tex1" [0.9 0.8 0.7] "rgb tex2" [0.1 0.2 0.3] '
        f'Material "diffuse" "texture reflectance" "c" {SQUARE}',
    )
    assert scene.textures[0].filter == "nearest"
    for u, v in ((0.1, 0.1), (0.3, 0.1), (0.3, 0.4), (0.97, 0.98)):
        even = (math.floor(5 * u) + math.floor(3 * v)) % 2 == 0
        assert _seen(scene, u, v)[:3] == pytest.approx((0.9, 0.8, 0.7) if even else (0.1, 0.2, 0.3))


def test_a_planar_mapping_is_that_of_the_world(tmp_path: Path) -> None:
    scene = read(
        tmp_path,
        'AttributeBegin Translate 1 0 0 Texture "c" "spectrum" "checkerboard" '
        '"string mapping" "planar" "vector3 v1" [0.5 0 0] "vector3 v2" [0 0.25 0] '
        '"float udelta" 0.5 AttributeEnd Translate 0 2 0 '
        f'Material "diffuse" "texture reflectance" "c" {SQUARE}',
    )
    mesh = scene.meshes[0]
    assert mesh.uv1 is not None
    points = world_points(scene, 0) @ MIRROR
    wanted = np.stack([0.5 * (points[:, 0] - 1) + 0.5, 1 - 0.25 * points[:, 1]], axis=1)
    assert mesh.uv1 == pytest.approx(wanted, abs=1e-6)
    _, (slot, _) = _slot(scene)
    assert slot.uv_set == 1


@pytest.mark.parametrize("version", [3, 4])
def test_round_mappings_begin_where_those_of_pbrt_do(tmp_path: Path, version: int) -> None:
    """Half a turn from +x on a cylinder, whose height pbrt-v3 takes on the unit sphere."""
    for kind in ("cylindrical", "spherical"):
        scene = read(
            tmp_path,
            f'Texture "c" "spectrum" "checkerboard" "string mapping" "{kind}" '
            'Material "diffuse" "texture reflectance" "c" Shape "trianglemesh" "point3 P" '
            '[3 0 4 0 3 4 -3 -1e-6 4] "integer indices" [0 1 2] ' + "WorldEnd" * (version == 3),
        )
        uv = scene.meshes[0].uv1
        assert uv is not None
        if kind == "cylindrical":
            height = 0.8 if version == 3 else 4
            wanted = [(0.5, 1 - height), (0.75, 1 - height), (0, 1 - height)]
        else:
            theta = math.acos(0.8) / math.pi
            wanted = [(theta, 1), (theta, 0.75), (theta, 0.5)]
        assert uv == pytest.approx(np.array(wanted), abs=1e-5)


def test_a_plane_of_v3_lies_in_the_world(tmp_path: Path) -> None:
    text = 'Translate 1 0 0 Texture "c" "spectrum" "checkerboard" "string mapping" "planar" '
    text += f'Material "diffuse" "texture reflectance" "c" {SQUARE}'
    new, old = (read(tmp_path, text + more).meshes[0].uv1 for more in ("", " WorldEnd"))
    assert new is not None
    assert old is not None
    assert old - new == pytest.approx(np.array([(1, 0)] * len(old)), abs=1e-6)


def test_roughness_becomes_alpha_as_in_pbrt(tmp_path: Path) -> None:
    def alpha(parameters: str, more: str = "") -> tuple[float, float | None]:
        name = "metal" if more else "conductor"
        kind = _kind(read(tmp_path, f'Material "{name}" {parameters} {SQUARE} {more}'))
        assert isinstance(kind, Conductor)
        return kind.alpha, kind.alpha_v

    assert alpha('"float roughness" 0.25')[0] == pytest.approx(0.5)
    assert alpha('"float roughness" 0.25')[1] is None
    assert alpha('"float roughness" 0.25 "bool remaproughness" false')[0] == pytest.approx(0.25)
    assert alpha('"float uroughness" 0.04 "float vroughness" 0.16') == pytest.approx((0.2, 0.4))
    x = math.log(0.1)  # pbrt-v3's fit, written out
    fit = 1.62142 + 0.819955 * x + 0.1734 * x**2 + 0.0171201 * x**3 + 0.000640711 * x**4
    assert alpha('"float roughness" 0.1', "WorldEnd")[0] == pytest.approx(fit, rel=1e-5)
    assert alpha("")[0] == 0


def test_materials_of_v4_are_their_kinds(tmp_path: Path) -> None:
    def kind(material: str) -> object:
        return _kind(read(tmp_path, f"Material {material} {SQUARE}"))

    gold = kind('"conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"')
    assert gold == Conductor.of_metal("Au", alpha=0.0)
    assert kind('"conductor"') == Conductor.of_metal("Cu", alpha=0.0)
    assert kind('"conductor" "rgb reflectance" [0.5 0.6 0.7]') == Conductor((0.5, 0.6, 0.7), 0.0)
    assert kind('"dielectric" "float eta" 1.3') == Dielectric(1.3)
    flint = kind('"dielectric" "spectrum eta" "glass-SF11"')
    assert isinstance(flint, Dielectric)
    assert isinstance(flint.ior, dg.Spectrum)
    assert flint.ior.at(587.6) == pytest.approx(1.78472, abs=2e-4)  # Schott's catalogue
    assert kind('"thindielectric"') == Dielectric(1.5, thin=True)
    coat = kind('"coateddiffuse" "rgb reflectance" [0.1 0.2 0.3] "float roughness" 0.01')
    assert isinstance(coat, Coated)
    assert coat.base == Diffuse((0.1, 0.2, 0.3))
    assert coat.alpha == pytest.approx(0.1)
    coat = kind('"coatedconductor" "float conductor.roughness" 0.04 "float interface.eta" 1.4')
    assert isinstance(coat, Coated)
    assert coat.ior == pytest.approx(1.4)
    assert coat.base == Conductor.of_metal("Cu", alpha=pytest.approx(0.2))
    through = kind('"diffusetransmission" "float scale" 2 "rgb transmittance" [0.1 0.1 0.1]')
    assert through == Diffuse((0.5, 0.5, 0.5), None, (0.2, 0.2, 0.2))
    assert kind('"hair" "rgb reflectance" [0.1 0.2 0.3]') == Diffuse((0.1, 0.2, 0.3))
    assert kind('"interface"') == Boundary()
    assert kind('""') == Boundary()


def test_mixtures_and_masks(tmp_path: Path) -> None:
    named = (
        'MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [1 0 0] '
        'MakeNamedMaterial "b" "string type" "dielectric" '
        'MakeNamedMaterial "none" "string type" "interface" '
    )
    scene = read(
        tmp_path,
        f'{named} Material "mix" "string materials" ["a" "b"] "float amount" 0.3 {SQUARE}',
    )
    kind = _kind(scene)
    assert isinstance(kind, Mix)
    assert kind.amount == pytest.approx(0.3)  # the share of the second (mix material, guide)
    assert scene.materials[kind.first].kind == Diffuse((1, 0, 0))
    assert scene.materials[kind.second].kind == Dielectric()
    masked = read(
        tmp_path,
        f'{named} Material "mix" "string materials" ["a" "none"] "float amount" 0.3 '
        f'{SQUARE} "float alpha" 0.5',
    )
    material = masked.materials[masked.instances[0].material]
    assert material.kind == Diffuse((1, 0, 0))
    assert material.opacity == pytest.approx(0.35)
    old = read(
        tmp_path,
        f'{named} Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" '
        f'"rgb amount" [0.3 0.3 0.3] {SQUARE} WorldEnd',
    )
    kind = _kind(old)
    assert isinstance(kind, Mix)
    assert old.materials[kind.second].kind == Diffuse((1, 0, 0))  # pbrt-v3: of the first
    with pytest.raises(dg.InputError, match="MakeNamedMaterial: mixes form a cycle"):
        read(
            tmp_path,
            'MakeNamedMaterial "a" "string type" "mix" "string materials" ["a" "a"] '
            f'NamedMaterial "a" {SQUARE}',
        )


def test_media_are_those_of_their_names(tmp_path: Path) -> None:
    medium = (
        'MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [1 2 3] '
        '"rgb sigma_s" [4 5 6] "float scale" 0.5 "float g" 0.3 "rgb Le" [1 1 1] '
    )
    options = f'{medium} MediumInterface "" "m" Camera "perspective" '
    scene = read(tmp_path, f'MediumInterface "m" "" Shape "sphere" {medium[:0]}', options)
    material = scene.materials[scene.instances[0].material]
    assert material.interior is not None
    assert material.interior.absorption == pytest.approx((0.5, 1, 1.5))
    assert material.interior.scattering == pytest.approx((2, 2.5, 3))
    assert material.interior.lobes == ((0.3, 1.0),)
    assert material.interior.emission == pytest.approx((0.5, 1, 1.5))  # sigma_a Le
    assert material.exterior is None
    assert scene.fog is None  # a shape bounds it
    around = read(tmp_path, 'MediumInterface "" "m" Shape "sphere"', options).fog
    assert around == material.interior
    preset = read(
        tmp_path,
        'MakeNamedMedium "m" "string type" "homogeneous" "string preset" "Cream" '
        'MediumInterface "m" "" Shape "sphere"',
    )
    inside = preset.materials[preset.instances[0].material].interior
    assert inside is not None
    assert inside.scattering == pytest.approx(MEASURED["Cream"][0])
    colored = read(
        tmp_path,
        'MakeNamedMedium "m" "string type" "rgbgrid" MediumInterface "m" "" Shape "sphere"',
    )
    assert colored.materials[colored.instances[0].material].interior is None
    assert any("a medium of kind 'rgbgrid' is left out" in note for note in colored.warnings)


def test_a_grid_of_densities_stands_in_its_box(tmp_path: Path) -> None:
    scene = read(
        tmp_path,
        'Translate 1 2 3 MakeNamedMedium "m" "string type" "uniformgrid" "integer nx" 2 '
        '"integer ny" 3 "integer nz" 1 "float density" [0 1 2 3 4 5] "point3 p0" [-1 0 0] '
        '"point3 p1" [1 1 1] MediumInterface "m" "" Material "interface" Shape "sphere"',
    )
    medium = scene.materials[scene.instances[0].material].interior
    assert medium is not None
    assert medium.density is not None
    assert medium.density.values.tolist() == [[[0, 1], [2, 3], [4, 5]]]
    # For the inside of a mesh the grid stands in the mesh's space.
    world = scene.instances[0].transform @ medium.density.transform
    assert world[:3] @ (0, 0, 0, 1) == pytest.approx(MIRROR @ (0, 2, 3))
    assert world[:3] @ (1, 1, 1, 1) == pytest.approx(MIRROR @ (2, 3, 4))
    with pytest.raises(dg.InputError, match="MakeNamedMedium: density: wanted 8 numbers, got 1"):
        read(
            tmp_path,
            'MakeNamedMedium "m" "string type" "uniformgrid" "integer nx" 8 "float density" [1] '
            'MediumInterface "m" "" Shape "sphere"',
        )


def test_a_grid_of_nanovdb_stands_where_its_file_says(tmp_path: Path) -> None:
    cells = nanovdb_files.Writer({(0, 0, 0): 0.5, (3, 1, 2): 2.0})
    grid = cells.bytes((0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1), (1, 0, 0))
    (tmp_path / "smoke.nvdb").write_bytes(nanovdb_files.segment([("density", grid)]))
    medium = (
        'Translate 0 0 5 MakeNamedMedium "m" "string type" "nanovdb" {} "rgb sigma_s" [2 3 4] '
        '"float scale" 0.5 MediumInterface "m" "" Material "interface" Shape "sphere"'
    )
    scene = read(tmp_path, medium.format('"string filename" "smoke.nvdb"'))
    inside = scene.materials[scene.instances[0].material].interior
    assert inside is not None
    assert inside.density is not None
    assert inside.scattering == pytest.approx((1, 1.5, 2))
    z, y, x = np.unravel_index(inside.density.values.argmax(), inside.density.values.shape)
    size = inside.density.values.shape[::-1]
    centre = (np.array((x, y, z)) + 0.5) / size
    placed = scene.instances[0].transform @ inside.density.transform @ (*centre, 1)
    assert placed[:3] == pytest.approx(MIRROR @ (1.3, 0.1, 5.2))
    missing = read(tmp_path, medium.format('"string filename" "other.nvdb"'))
    assert any("a medium whose file is missing is left out" in note for note in missing.warnings)
    for wrong, error in (
        ("", "filename: missing, wanted a .nvdb file"),
        ('"string filename" "smoke.nvdb" "string gridname" "heat"', "wanted a grid 'heat'"),
    ):
        with pytest.raises(
            dg.InputError, match=rf"line \d+, column \d+: MakeNamedMedium: .*{error}"
        ):
            read(tmp_path, medium.format(wrong))


def test_light_below_a_surface_keeps_its_limits() -> None:
    """All light comes back without absorption, none without scattering (Jensen et al. 2001)."""
    assert diffuse_reflectance((0, 0, 0), (1, 1, 1), 1.3) == pytest.approx((1, 1, 1))
    assert diffuse_reflectance((1, 1, 1), (0, 0, 0), 1.3) == (0, 0, 0)
    red, green, blue = diffuse_reflectance(MEASURED["Skin1"][1], MEASURED["Skin1"][0], 1.3)
    assert red > green > blue


def test_old_materials_tell_what_they_become(tmp_path: Path) -> None:
    scene = read(tmp_path, f'Material "plastic" "rgb Kd" [0.1 0.2 0.3] {SQUARE} WorldEnd')
    kind = _kind(scene)
    assert isinstance(kind, Coated)
    assert kind.base == Diffuse((0.1, 0.2, 0.3))
    assert kind.specular_tint == (0.25, 0.25, 0.25)
    assert any("'plastic' of pbrt-v3" in note for note in scene.warnings)
    glass = _kind(read(tmp_path, f'Material "glass" "float index" 1.7 {SQUARE} WorldEnd'))
    assert glass == Dielectric(1.7)
    assert _kind(read(tmp_path, f'Material "mirror" {SQUARE} WorldEnd')) == Conductor((0.9,) * 3, 0)


def test_triangles_without_coordinates_have_those_of_pbrt(tmp_path: Path) -> None:
    scene = read(
        tmp_path,
        'Texture "c" "spectrum" "checkerboard" Material "diffuse" "texture reflectance" "c" '
        'Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0] "integer indices" [0 1 2 0 2 3]',
    )
    mesh = scene.meshes[0]
    assert mesh.uv is not None
    assert (mesh.uv * (1, -1) + (0, 1))[mesh.indices].tolist() == [[[0, 0], [1, 0], [1, 1]]] * 2


def test_a_bump_tilts_the_normal_by_the_slope_of_its_heights(tmp_path: Path) -> None:
    """A ramp of 0.2 m along u, on a square of 2 m on whose u is 1 m^-1 / 2: a slope of 0.1."""
    ramp = np.repeat(np.linspace(0.1, 0.9, 5)[None, :, None], 4, axis=0).astype(np.float32)
    picture(tmp_path / "ramp.exr", ramp)
    texture = (
        'Texture "h" "float" "imagemap" "string filename" "ramp.exr" "string wrap" "clamp" '
        '"float scale" 0.2 Material "diffuse" "texture displacement" "h" '
    )
    scene = read(tmp_path, f"{texture} Scale 3 3 1 {SQUARE}")
    material = scene.materials[scene.instances[0].material]
    assert material.normal_scale == pytest.approx(1 / 6, rel=0.01)  # |dp/du| = 6 m
    slot = material.normal_texture
    assert slot is not None
    middle = scene.textures[slot.texture].pixels[1, 2] * 2.0 - 1
    # d = 0.2 s, so dd/du = 0.2; the surface turns away from +u.
    assert middle == pytest.approx((-0.2, 0, 1), abs=1e-6)


def test_bumps_upward_and_repeated_ones_keep_their_signs() -> None:
    from daguerre.importers.pbrt.bump import normal_map

    rows = (np.arange(64) + 0.5) / 64
    heights = np.sin(2 * np.pi * (1 - rows))[:, None] * np.ones((64, 8))  # sin 2 pi t
    normals = normal_map(heights, (1.0, 0.5), repeats=True) * 2 - 1
    slope = 2 * np.pi * np.cos(2 * np.pi * (1 - rows)) / 0.5
    assert normals[:, 0, 1] == pytest.approx(-slope, abs=0.05)
    assert np.allclose(normals[..., 0], 0)
