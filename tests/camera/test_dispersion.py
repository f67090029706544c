"""Lenses whose glass bends all colours alike."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import daguerre as dg
from daguerre.lenses.dispersion import without_dispersion
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM
from daguerre.lenses.medium import Medium
from daguerre.setup.checks import prescription_of

NM = (400.0, 486.1, 587.56, 656.3, 700.0)
NAMES = ("double-gauss-50mm-f2", "tessar-50mm-f2.8", "sony-fe-70-200mm-f2.8")


def chief_ends(lens: dg.Lens, nm: float) -> np.ndarray:
    """Film points of rays toward the middle of the entrance pupil, mm."""
    pupil, slopes = lens.first_order().entrance_pupil.z, np.linspace(-0.15, 0.15, 7)
    rays = np.stack([0 * slopes, slopes, np.ones(7)], axis=1)
    return lens.trace(np.array([0, 0, pupil]) - 200 * rays, rays, nm)


@pytest.mark.parametrize("name", NAMES)
def test_chief_rays_of_all_wavelengths_coincide(name: str) -> None:
    lens = dg.lenses.load(name)
    plain = without_dispersion(lens)
    wanted = chief_ends(lens, DESIGN_WAVELENGTH_NM)
    assert np.isfinite(wanted).all()
    for nm in NM:
        np.testing.assert_allclose(chief_ends(plain, nm), wanted, rtol=0, atol=1e-9)
    fringe = np.abs(chief_ends(lens, 400.0) - wanted).max()
    assert fringe > 1e-3, "this lens has no lateral colour to take away"


@pytest.mark.parametrize("name", dg.lenses.names()[::7])
def test_the_line_d_keeps_its_lens(name: str) -> None:
    lens = dg.lenses.load(name)
    plain = without_dispersion(lens)
    assert plain.first_order() == lens.first_order()
    assert plain.first_order(400.0).efl == lens.first_order().efl
    for ours, theirs in zip(plain.surfaces, lens.surfaces, strict=True):
        assert ours.medium.absorption == theirs.medium.absorption
        assert dataclasses.replace(ours, medium=theirs.medium) == theirs


def test_water_before_the_lens_has_one_index_too() -> None:
    lens = dg.lenses.load("tessar-50mm-f2.8")
    wet = lens.rebuilt(lens.surfaces, object_medium=Medium("water"))
    plain = without_dispersion(wet).object_medium
    index = wet.object_medium.index(DESIGN_WAVELENGTH_NM)
    assert plain.index(400.0) == plain.index(700.0) == index


def test_a_camera_without_dispersion_has_no_fringes_in_its_picture() -> None:
    """A small lamp near the edge: red and blue have their middles where they are traced."""
    lens = "canon-50mm-f0.95"
    scene, place = dg.Scene(), np.eye(4)
    place[:3, 3] = 6.2, 0.0, -20.0
    scene.add_light(dg.SphereLight(luminance=(1e3,) * 3, radius=0.05), place)

    def apart(**more: bool) -> float:
        camera = dg.Camera(lens=lens, f_stop=8, focus_distance=20.0, **more)
        crop = (880, 310, 940, 330)
        frame = dg.render(scene, camera, spp=64, resolution=(960, 640), crop=crop, seed=3)
        columns = np.arange(60)
        assert frame.rgb.max() > 10
        red, _, blue = (frame.rgb[..., k].sum(axis=0) for k in range(3))
        return float(abs(red @ columns / red.sum() - blue @ columns / blue.sum()))

    assert apart(dispersion=False) < 0.05
    assert apart() > 0.5


def test_the_camera_hands_the_lens_on_and_says_so() -> None:
    camera = dg.Camera(lens="tessar-50mm-f2.8", dispersion=False)
    assert prescription_of(camera) == without_dispersion(dg.lenses.load("tessar-50mm-f2.8"))
    assert prescription_of(camera.with_(dispersion=True)) == dg.lenses.load("tessar-50mm-f2.8")
    for dispersion in (True, False):
        seen = camera.with_(dispersion=dispersion)
        facts = dg.render(dg.Scene(), seen, resolution=(4, 4), spp=1).metadata["camera"]
        assert facts.get("dispersion", True) == dispersion


def test_an_ideal_lens_has_no_dispersion_to_take_away() -> None:
    with pytest.raises(dg.UsageError, match="dispersion: wanted a lens with a prescription"):
        dg.render(dg.Scene(), dg.Camera(dispersion=False), resolution=(4, 4), spp=1)
