"""Surfaces in pictures: furnaces, colours of metals, masks, mixtures and boundaries."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg

SIZE = (12, 8)


def picture(*materials: Any, sky: float = 1.0, spp: int = 64, **fields: Any) -> NDArray[Any]:
    """A square of the last of some materials, straight before a pinhole, under an even sky."""
    scene = dg.Scene()
    for kind in materials[:-1]:
        scene.add_material(kind)
    last = materials[-1]
    material = last if isinstance(last, dg.Material) else dg.Material(last, **fields)
    square = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1)]
    uv = [(0, 1), (1, 1), (1, 0), (0, 0)]
    scene.add_texture(np.full((2, 2, 1), 0.5, np.float32))
    scene.add_texture(np.float32([[[0.0], [1.0]]]), filter="nearest")
    scene.add_instance(scene.add_mesh(square, [(0, 1, 2), (0, 2, 3)], uv=uv), material)
    scene.set_environment(color=(sky, sky, sky))
    camera = dg.Camera(lens="pinhole", focal_length=36)
    return np.asarray(dg.render(scene, camera, resolution=SIZE, spp=spp, threads=1).rgb)


def mean(rgb: NDArray[Any]) -> NDArray[Any]:
    return np.asarray(rgb.mean(axis=(0, 1)))


WHITE = (1.0, 1.0, 1.0)


@pytest.mark.parametrize(
    ("kind", "within"),
    [
        (dg.Diffuse((0.3, 0.3, 0.3), transmittance=(0.7, 0.7, 0.7)), 1e-3),
        (dg.Dielectric(thin=True), 1e-3),
        (dg.Dielectric(alpha=0.4, energy_compensation=True, thin=True), 0.02),
        (dg.Coated(dg.Diffuse(WHITE)), 0.02),
        (dg.Coated(dg.Diffuse(WHITE), alpha=0.3), 0.02),
        (dg.Coated(dg.Diffuse(WHITE), alpha=0.3, distribution="beckmann"), 0.02),
        (dg.Coated(dg.Conductor(alpha=0.0)), 1e-3),
        (dg.Boundary(), 0.01),
    ],
)
def test_what_absorbs_nothing_cannot_be_seen_in_an_even_light(kind: Any, within: float) -> None:
    assert mean(picture(kind)) == pytest.approx(np.ones(3), abs=within)


def test_a_smooth_metal_has_the_colour_of_its_table() -> None:
    eta, k = dg.Conductor.of_metal("Au").eta, dg.Conductor.of_metal("Au").k
    assert isinstance(eta, dg.Spectrum)
    assert isinstance(k, dg.Spectrum)
    nm = np.arange(380.0, 781.0)
    n, e = eta.at(nm), k.at(nm)
    reflectance = dg.Spectrum(nm, ((n - 1) ** 2 + e**2) / ((n + 1) ** 2 + e**2))
    gold = mean(picture(dg.Conductor.of_metal("Au", alpha=0), spp=256))
    # Near the centre of a narrow field the angle is as good as 0.
    assert gold == pytest.approx(mean(picture(dg.Conductor(reflectance, 0), spp=256)), rel=0.01)
    assert gold[0] > 0.9 > 0.8 > gold[1] > 0.6 > 0.45 > gold[2] > 0.2


def test_a_mask_lets_the_sky_through_by_its_share() -> None:
    black = dg.Diffuse((0, 0, 0))
    half = dg.TextureSlot(0)
    assert mean(picture(dg.Material(black, opacity=0.25), spp=256)) == pytest.approx(0.75, abs=0.01)
    masked = dg.Material(black, opacity=0.5, opacity_texture=half)
    assert mean(picture(masked, spp=256)) == pytest.approx(0.75, abs=0.01)
    stencil = picture(dg.Material(black, opacity_texture=dg.TextureSlot(1)))
    assert stencil[:, :4] == pytest.approx(1, abs=0.03)  # wavelengths are sampled
    assert stencil[:, 8:].max() == 0


def test_a_mixture_is_the_mean_of_its_parts() -> None:
    first, second = dg.Diffuse((0.8, 0.4, 0.2)), dg.Diffuse((0.2, 0.6, 0.4))
    mixed = mean(picture(first, second, dg.Mix(0, 1, 0.25), spp=400))
    assert mixed == pytest.approx([0.65, 0.45, 0.25], abs=0.01)
    textured = mean(picture(first, second, dg.Mix(0, 1, 0.5, dg.TextureSlot(0)), spp=400))
    assert textured == pytest.approx([0.65, 0.45, 0.25], abs=0.01)
    masked = dg.Material(dg.Mix(0, 1, 0.25), opacity=0.5)
    assert mean(picture(first, second, masked, spp=400)) == pytest.approx(
        [0.825, 0.725, 0.625], abs=0.01
    )


def test_a_mixture_of_mixtures_moves_with_its_parts() -> None:
    bright = dg.Material(dg.Diffuse(dg.keys([(-1, (0.2, 0.2, 0.2)), (1, (0.6, 0.6, 0.6))])))  # type: ignore[arg-type]
    parts = (bright, dg.Diffuse((0, 0, 0)), dg.Mix(0, 1, 0.5), dg.Mix(2, 0, 0.5))
    assert mean(picture(*parts, spp=400)) == pytest.approx(0.75 * 0.4 * np.ones(3), abs=0.01)


def test_a_one_sided_surface_is_black_from_behind() -> None:
    turned = dg.Material(dg.Diffuse(WHITE), two_sided=False)
    assert mean(picture(turned, spp=4)) == pytest.approx(np.ones(3), abs=0.1)
    scene = dg.Scene()
    back = [(-1, -1, -1), (-1, 1, -1), (1, 1, -1), (1, -1, -1)]
    scene.add_instance(scene.add_mesh(back, [(0, 1, 2), (0, 2, 3)]), turned)
    scene.set_environment(color=(1, 1, 1))
    camera = dg.Camera(lens="pinhole", focal_length=36)
    assert dg.render(scene, camera, resolution=SIZE, spp=4, threads=1).rgb.max() == 0


def test_emission_follows_its_texture_for_camera_and_light_sampling() -> None:
    lamp = dg.Material(
        dg.Diffuse((0, 0, 0)), emission=(4, 4, 4), emission_texture=dg.TextureSlot(1)
    )
    seen = picture(lamp, sky=0)
    assert seen[:, :4].max() == 0
    assert seen[:, 8:] == pytest.approx(4, rel=0.03)


def test_parts_that_shine_or_come_later_are_one_error() -> None:
    scene = dg.Scene()
    scene.add_material(dg.Material(emission=(1, 1, 1), name="lamp"))
    scene.add_instance(scene.add_mesh(np.eye(3), [(0, 1, 2)]), dg.Mix(0, 0))
    with pytest.raises(dg.InputError, match="first: wanted a material that emits nothing"):
        dg.render(scene, dg.Camera(), resolution=SIZE, spp=1)


def test_coats_over_what_lets_light_pass_are_one_error() -> None:
    with pytest.raises(dg.InputError, match="base: transmittance: wanted 0 under a coat"):
        picture(dg.Coated(dg.Diffuse(transmittance=(0.5, 0.5, 0.5))))
