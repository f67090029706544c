"""Materials and media of Mitsuba in our terms."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import daguerre as dg

from .scene_files import loaded


def _material(folder: Path, plugin: str, inner: str = "") -> dg.Material:
    body = f'<shape type="cube"><bsdf type="{plugin}">{inner}</bsdf></shape>'
    return loaded(folder, body).materials[-1]


def _kind(folder: Path, plugin: str, inner: str = "") -> Any:
    return _material(folder, plugin, inner).kind


def _picture(folder: Path, pixels: Any = None) -> str:
    if pixels is None:
        pixels = np.arange(4 * 4 * 3, dtype=np.uint8).reshape(4, 4, 3)
    Image.fromarray(pixels).save(folder / "a.png")
    return '<string name="filename" value="a.png"/>'


def test_defaults(tmp_path: Path) -> None:
    glass = 1.5046 / 1.000277
    plastic = 1.49 / 1.000277
    facets: Any = {"distribution": "beckmann"}
    for plugin, wanted in {
        "diffuse": dg.Diffuse((0.5, 0.5, 0.5)),
        "dielectric": dg.Dielectric(glass),
        "thindielectric": dg.Dielectric(glass, thin=True),
        "roughdielectric": dg.Dielectric(glass, 0.1, **facets),
        "conductor": dg.Conductor((1, 1, 1), 0.0),
        "roughconductor": dg.Conductor((1, 1, 1), 0.1, **facets),
        "plastic": dg.Coated(dg.Diffuse(), plastic, nonlinear=False),
        "roughplastic": dg.Coated(
            dg.Diffuse(), plastic, 0.1, nonlinear=False, energy_compensation=False, **facets
        ),
        "null": dg.Boundary(),
    }.items():
        assert _kind(tmp_path, plugin) == wanted, plugin


def test_opaque_surfaces_are_black_from_behind_unless_two_sided(tmp_path: Path) -> None:
    for plugin in ("diffuse", "conductor", "roughconductor", "plastic", "roughplastic"):
        assert not _material(tmp_path, plugin).two_sided, plugin
        inner = f'<bsdf type="{plugin}"/>'
        assert _material(tmp_path, "twosided", inner).two_sided, plugin
    for plugin in ("dielectric", "thindielectric", "roughdielectric", "null"):
        assert _material(tmp_path, plugin).two_sided, plugin


def test_roughness_along_u_and_v(tmp_path: Path) -> None:
    inner = '<string name="distribution" value="ggx"/><float name="alpha_u" value="0.2"/>'
    kind = _kind(tmp_path, "roughconductor", inner + '<float name="alpha_v" value="0.05"/>')
    assert (kind.alpha, kind.alpha_v) == (0.2, 0.05)


def test_facets_have_the_distribution_of_the_file(tmp_path: Path) -> None:
    for plugin in ("roughconductor", "roughdielectric", "roughplastic"):
        for name, wanted in (("ggx", "ggx"), ("beckmann", "beckmann"), ("phong", "beckmann")):
            inner = f'<string name="distribution" value="{name}"/>'
            assert _kind(tmp_path, plugin, inner).distribution == wanted, (plugin, name)


def test_measured_indices(tmp_path: Path) -> None:
    inner = '<spectrum name="eta" value="400:1, 700:2"/><spectrum name="k" value="3"/>'
    kind = _kind(tmp_path, "conductor", inner + '<float name="ext_eta" value="2"/>')
    assert kind.eta == dg.Spectrum((400.0, 700.0), (0.5, 1.0))
    assert kind.k == (1.5, 1.5, 1.5)


def test_textures_are_factors_with_their_transforms(tmp_path: Path) -> None:
    texture = (
        f'<texture type="bitmap" name="reflectance">{_picture(tmp_path)}'
        '<string name="wrap_mode" value="mirror"/><string name="filter_type" value="nearest"/>'
        '<transform name="to_uv"><scale x="2" y="3"/><translate x="0.5" y="0.25"/></transform>'
        "</texture>"
    )
    body = f'<shape type="cube"><bsdf type="diffuse">{texture}</bsdf></shape>'
    scene = loaded(tmp_path, body)
    kind = scene.materials[0].kind
    assert isinstance(kind, dg.Diffuse)
    assert kind.reflectance == (1, 1, 1)
    assert kind.reflectance_texture is not None
    assert kind.reflectance_texture.transform == pytest.approx((2, 0, 0.5, 0, 3, 0.25))
    made = scene.textures[kind.reflectance_texture.texture]
    assert (made.srgb, made.wrap, made.filter) == (True, ("mirror", "mirror"), "nearest")
    raw = body.replace("</texture>", '<boolean name="raw" value="true"/></texture>')
    assert not loaded(tmp_path, raw).textures[0].srgb


def test_checkerboards_have_the_first_colour_at_the_corner(tmp_path: Path) -> None:
    texture = (
        '<texture type="checkerboard" name="{}"><rgb name="color0" value="0.1 0.2 0.3"/>'
        '<rgb name="color1" value="0.8"/></texture>'
    )
    scene = loaded(
        tmp_path,
        f'<shape type="cube"><bsdf type="diffuse">{texture.format("reflectance")}</bsdf></shape>',
    )
    pixels = scene.textures[0].pixels
    assert pixels.shape == (2, 2, 3)
    assert np.allclose(pixels[0, 0], (0.1, 0.2, 0.3))
    assert np.allclose(pixels[0, 1], 0.8)
    assert np.allclose(pixels[1, 1], pixels[0, 0])


def test_masks_and_mixtures(tmp_path: Path) -> None:
    two = '<bsdf type="diffuse"/><bsdf type="conductor"/>'
    mask = '<float name="opacity" value="0.25"/>'
    material = _material(tmp_path, "mask", mask + '<bsdf type="diffuse"/>')
    assert material.opacity == pytest.approx(0.25)
    blend = _material(tmp_path, "blendbsdf", '<float name="weight" value="0.3"/>' + two)
    assert isinstance(blend.kind, dg.Mix)
    assert blend.kind.amount == pytest.approx(0.3)
    assert (blend.kind.first, blend.kind.second) == (0, 1)
    for plugin, inner, wrong in (
        ("mask", "", "a material inside"),
        ("twosided", "", "one or two materials"),
        ("blendbsdf", '<bsdf type="diffuse"/>', "two materials inside, got 1"),
        ("normalmap", '<bsdf type="diffuse"/>', "a texture inside"),
        ("mask", two, "wanted one bsdf"),
    ):
        with pytest.raises(dg.InputError, match=wrong):
            _material(tmp_path, plugin, inner)


def _normals(folder: Path, shape: str, plugin: str, texture: str) -> Any:
    """Pixels of the normal map of a shape."""
    body = (
        f'<shape type="{shape}"><bsdf type="{plugin}"><texture type="bitmap" name="t">{texture}'
        '<boolean name="raw" value="true"/></texture><bsdf type="diffuse"/></bsdf></shape>'
    )
    scene = loaded(folder, body)
    slot = scene.materials[-1].normal_texture
    assert slot is not None
    assert scene.textures[slot.texture].min_filter == "linear"  # Mitsuba has no mipmaps
    pixels = scene.textures[slot.texture].pixels
    return pixels / 255 if pixels.dtype == np.uint8 else pixels


def test_normal_maps_have_green_by_the_hand_of_the_coordinates(tmp_path: Path) -> None:
    texture = _picture(tmp_path, np.full((4, 4, 3), (150, 200, 220), np.uint8))
    against = _normals(tmp_path, "sphere", "normalmap", texture)
    along = _normals(tmp_path, "rectangle", "normalmap", texture)
    assert np.allclose(against[0, 0] * 255, (150, 200, 220), atol=0.01)
    assert np.allclose(along[0, 0] * 255, (150, 55, 220), atol=0.01)


def test_a_normal_map_around_a_blend_is_on_both_of_its_parts(tmp_path: Path) -> None:
    texture = _picture(tmp_path, np.full((4, 4, 3), (150, 200, 220), np.uint8))
    body = (
        f'<bsdf type="normalmap" id="outer"><texture type="bitmap" name="t">{texture}'
        '<boolean name="raw" value="true"/></texture><bsdf type="blendbsdf">'
        '<float name="weight" value="0.25"/><bsdf type="diffuse" id="one"/>'
        '<bsdf type="conductor"/></bsdf></bsdf>'
    )
    scene = loaded(tmp_path, f'{body}<shape type="rectangle"><ref id="outer"/></shape>')
    outer = scene.materials[-1]
    assert isinstance(outer.kind, dg.Mix)
    assert (outer.normal_texture, outer.name, outer.kind.amount) == (None, "outer", 0.25)
    parts = [scene.materials[i] for i in (outer.kind.first, outer.kind.second)]
    assert [part.name for part in parts] == ["one", ""]
    for part in parts:
        slot = part.normal_texture
        assert slot is not None
        assert np.allclose(scene.textures[slot.texture].pixels[0, 0] * 255, (150, 55, 220), atol=1)


def test_bump_maps_are_slopes_of_their_heights(tmp_path: Path) -> None:
    ramp = np.repeat(np.arange(0, 64, 4, dtype=np.uint8)[None], 16, axis=0)
    texture = _picture(tmp_path, np.stack([ramp] * 3, axis=2))
    texture += '<string name="wrap_mode" value="clamp"/>'
    pixels = _normals(tmp_path, "rectangle", "bumpmap", texture)
    # 4 / 255 a texel, 16 texels across 2 m
    slope = 16 * 4 / 255 / 2
    wanted = np.array((-slope, 0, 1)) / np.hypot(slope, 1)
    assert np.allclose(2 * pixels[8, 8] - 1, wanted, atol=1e-4)


def test_principled_materials_are_layers_of_gltf(tmp_path: Path) -> None:
    inner = (
        '<rgb name="base_color" value="0.2 0.4 0.6"/><float name="metallic" value="0.7"/>'
        '<float name="roughness" value="0.3"/><float name="specular" value="0.5"/>'
        '<float name="clearcoat" value="1"/><float name="sheen" value="0.5"/>'
        '<float name="anisotropic" value="0.5"/>'
    )
    kind = _kind(tmp_path, "principled", inner)
    assert isinstance(kind, dg.Gltf)
    assert kind.base_color == pytest.approx((0.2, 0.4, 0.6))
    assert kind.metallic == pytest.approx(0.7)
    assert kind.ior == pytest.approx(1.5)
    assert kind.clearcoat == pytest.approx(0.25)
    assert kind.sheen_color == pytest.approx((0.5, 0.5, 0.5))
    # widths r^2 q across, r^2 / q along, q = sqrt(1 - 0.9 a)
    q = np.sqrt(1 - 0.45)
    assert kind.roughness**2 == pytest.approx(0.09 * q)
    across, stretch = kind.roughness**2, kind.anisotropy
    assert across + (1 - across) * stretch**2 == pytest.approx(0.09 / q)
    with pytest.raises(dg.InputError, match="either eta or specular"):
        _kind(tmp_path, "principled", '<float name="eta" value="1.3"/>' + inner)


def test_what_is_not_supported_is_grey_and_named(tmp_path: Path) -> None:
    scene = loaded(tmp_path, '<shape type="cube"><bsdf type="hair"/></shape>')
    assert scene.materials[0].kind == dg.Diffuse((0.5, 0.5, 0.5))
    assert "a material 'hair' is grey: not supported (1 use)" in scene.warnings


def test_materials_are_shared(tmp_path: Path) -> None:
    one = '<shape type="cube"><ref id="m"/></shape>'
    scene = loaded(tmp_path, '<bsdf type="plastic" id="m"/>', one * 4)
    assert [material.name for material in scene.materials] == ["m"]


# Media ------------------------------------------------------------------------------------------


def _medium(folder: Path, inner: str, plugin: str = "homogeneous", **options: Any) -> dg.Medium:
    body = (
        f'<medium type="{plugin}" id="fog">{inner}</medium><shape type="cube"><bsdf type="null"/>'
        '<ref id="fog" name="interior"/><transform name="to_world"><scale value="4"/></transform>'
        "</shape>"
    )
    medium = loaded(folder, body, **options).materials[-1].interior
    assert medium is not None
    return medium


def test_homogeneous_media(tmp_path: Path) -> None:
    inner = (
        '<rgb name="sigma_t" value="1 2 4"/><rgb name="albedo" value="0.5 0.25 0"/>'
        '<float name="scale" value="3"/><phase type="hg"><float name="g" value="0.4"/></phase>'
    )
    medium = _medium(tmp_path, inner)
    assert medium.scattering == pytest.approx((1.5, 1.5, 0))
    assert medium.absorption == pytest.approx((1.5, 4.5, 12))
    assert medium.lobes == ((0.4, 1.0),)
    assert _medium(tmp_path, inner, unit_m=0.01).scattering == pytest.approx((150, 150, 0))
    plain = _medium(tmp_path, "")
    assert plain.scattering == pytest.approx((0.75, 0.75, 0.75))
    assert plain.absorption == pytest.approx((0.25, 0.25, 0.25))
    old = _medium(tmp_path, '<rgb name="sigma_a" value="1"/><rgb name="sigma_s" value="2"/>')
    assert (old.absorption, old.scattering) == ((1, 1, 1), (2, 2, 2))


def test_phase_functions_blend(tmp_path: Path) -> None:
    inner = (
        '<phase type="blendphase"><float name="weight" value="0.25"/><phase type="isotropic"/>'
        '<phase type="hg"><float name="g" value="0.5"/></phase></phase>'
    )
    assert _medium(tmp_path, inner).lobes == ((0.0, 0.75), (0.5, 0.25))


def _vol(path: Path, values: Any, box: tuple[float, ...] = (0, 0, 0, 1, 1, 1)) -> None:
    z, y, x, channels = values.shape
    head = np.array([1, x, y, z, channels], "<i4").tobytes() + np.array(box, "<f4").tobytes()
    path.write_bytes(b"VOL\x03" + head + values.astype("<f4").tobytes())


def test_grids_of_density_stand_in_the_world(tmp_path: Path) -> None:
    values = np.arange(24, dtype=np.float32).reshape(2, 3, 4, 1)
    _vol(tmp_path / "a.vol", values, (0, 0, 0, 2, 2, 2))
    inner = (
        '<float name="albedo" value="0.5"/><volume type="gridvolume" name="sigma_t">'
        '<string name="filename" value="a.vol"/>{}<transform name="to_world">'
        '<translate x="1"/></transform></volume>'
    )
    medium = _medium(tmp_path, inner.format(""), "heterogeneous")
    assert medium.density is not None
    assert np.array_equal(medium.density.values, values[:, :, :, 0])
    # the mesh is 4 times as large as the world: a unit cube in the world is a quarter there
    assert np.allclose(medium.density.transform @ (0, 0, 0, 1), (0.25, 0, 0, 1))
    assert np.allclose(medium.density.transform @ (1, 1, 1, 1), (0.5, 0.25, 0.25, 1))
    assert medium.scattering == pytest.approx((0.5, 0.5, 0.5))
    boxed = inner.format('<boolean name="use_grid_bbox" value="true"/>')
    box = _medium(tmp_path, boxed, "heterogeneous").density
    assert box is not None
    assert np.allclose(box.transform @ (1, 1, 1, 1), (0.75, 0.5, 0.5, 1))


def test_even_heterogeneous_media_end_at_the_cube_of_their_extinction(tmp_path: Path) -> None:
    inner = (
        '<volume type="constvolume" name="sigma_t"><rgb name="value" value="1 2 3"/>'
        '<transform name="to_world"><scale value="2"/></transform></volume>'
        '<float name="albedo" value="0"/>'
    )
    medium = _medium(tmp_path, inner, "heterogeneous")
    assert medium.absorption == pytest.approx((1, 2, 3))
    assert medium.density is not None
    assert medium.density.values.tolist() == [[[1.0]]]
    assert np.allclose(medium.density.transform @ (1, 1, 1, 1), (0.5, 0.5, 0.5, 1))
    assert _medium(tmp_path, inner).density is None


def test_a_camera_in_a_medium_stands_in_fog(tmp_path: Path) -> None:
    sensor = '<sensor type="perspective"><ref id="fog" name="medium"/></sensor>'
    scene = loaded(tmp_path, '<medium type="homogeneous" id="fog"/>', sensor)
    assert scene.fog is not None


@pytest.mark.parametrize("kind", ["homogeneous", "heterogeneous"])
@pytest.mark.parametrize(("side", "fills"), [("interior", False), ("exterior", True)])
def test_a_medium_of_a_camera_that_a_shape_bounds_is_no_fog(
    tmp_path: Path, kind: str, side: str, fills: bool
) -> None:
    grid = '<volume type="constvolume" name="sigma_t"><float name="value" value="1"/></volume>'
    medium = f'<medium type="{kind}" id="fog">{grid if kind[1] == "e" else ""}</medium>'
    shape = f'<shape type="sphere"><bsdf type="null"/><ref id="fog" name="{side}"/></shape>'
    sensor = '<sensor type="perspective"><ref id="fog" name="medium"/></sensor>'
    assert (loaded(tmp_path, medium + shape, sensor).fog is not None) is fills


def test_light_reaches_a_camera_in_a_bounded_medium_by_beer_lambert(tmp_path: Path) -> None:
    sensor = (
        '<sensor type="perspective"><float name="fov" value="10"/><ref id="m" name="medium"/>'
        '<transform name="to_world"><lookat origin="0,0,0" target="0,0,-1" up="0,1,0"/>'
        "</transform></sensor>"
    )
    scene = loaded(
        tmp_path,
        '<shape type="sphere"><float name="radius" value="2"/><bsdf type="null"/>'
        '<medium type="homogeneous" name="interior" id="m"><float name="sigma_t" value=".5"/>'
        '<float name="albedo" value="0"/></medium></shape><shape type="rectangle"><transform '
        'name="to_world"><scale value="100"/><translate z="-10"/></transform><emitter type="area">'
        '<rgb name="radiance" value="1"/></emitter></shape>',
        sensor,
    )
    frame = dg.render(scene, resolution=(8, 8), spp=16)
    assert frame.rgb.mean() == pytest.approx(math.exp(-1), rel=0.01)


@pytest.mark.parametrize(
    ("plugin", "name", "field"),
    [
        ("diffuse", "reflectance", "reflectance"),
        ("roughplastic", "specular_reflectance", "specular_tint"),
        ("dielectric", "specular_transmittance", "tint"),
        ("conductor", "specular_reflectance", "reflectance"),
    ],
)
def test_shares_of_light_above_1_count_as_1(
    tmp_path: Path, plugin: str, name: str, field: str
) -> None:
    body = '<shape type="cube"><bsdf type="{}"><{} name="{}" value="{}"/></bsdf></shape>'
    for tag, value, wanted in (("rgb", "1.5 0.2 3", (1, 0.2, 1)), ("spectrum", "50", (1, 1, 1))):
        scene = loaded(tmp_path, body.format(plugin, tag, name, value))
        assert getattr(scene.materials[-1].kind, field) == pytest.approx(wanted, abs=1e-6)
        assert any("values above 1 are read as 1" in note for note in scene.warnings)
