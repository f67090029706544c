"""Materials as values: fields, checks, what a scene keeps of them."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.scene import metals

SLOT = dg.TextureSlot(0)
GREEN = dg.Spectrum((400, 550, 700), (0.1, 0.8, 0.2))
KINDS: tuple[Any, ...] = (
    dg.Diffuse(GREEN, SLOT, (0.1, 0.2, 0.3), SLOT),
    dg.Conductor.of_metal("Au", alpha=0.2, alpha_v=0.4, alpha_texture=SLOT),
    dg.Dielectric(GREEN, 0.1, reflection_tint=GREEN, thin=True, energy_compensation=True),
    dg.Coated(dg.Conductor.of_metal("Cu"), absorption=GREEN, thickness=1e-4),
    dg.Coated(dg.Diffuse((0.5, 0.2, 0.1)), alpha=0.2, nonlinear=False),
    dg.Coated(alpha=0.3, energy_compensation=False),
    dg.Mix(0, 1, 0.25, SLOT),
    dg.Dielectric(alpha=0.3, distribution="beckmann"),
    dg.Boundary(),
)


def test_a_spectrum_is_linear_between_samples_and_constant_beyond() -> None:
    assert GREEN.at([300, 475, 625, 800]).tolist() == pytest.approx([0.1, 0.45, 0.5, 0.2])
    arrays = dg.Spectrum(np.array([400.0, 550, 700]), [0.1, 0.8, 0.2])  # type: ignore[arg-type]
    assert arrays == GREEN
    assert hash(GREEN) == hash(pickle.loads(pickle.dumps(GREEN)))
    assert repr(GREEN) == "Spectrum(3 samples, 400..700 nm)"


@pytest.mark.parametrize(
    ("nm", "values", "place"),
    [
        ((), (), "wavelengths_nm: wanted 1 to 4096"),
        ((400,), (1, 2), "values: wanted 1 numbers, got 2"),
        ((500, 400), (1, 2), "wavelengths_nm: must increase"),
        ((0, 400), (1, 2), "wavelengths_nm: must increase"),
        ((400, 500), (1, -2), "values: wanted at least 0, got -2"),
        ((400, 500), (1, float("nan")), "values: wanted a row of finite"),
        (((400, 500),), (1, 2), "wavelengths_nm: wanted a row"),
        ("red", (1, 2), "wavelengths_nm: wanted a row"),
        (range(1, 5000), range(1, 5000), "wavelengths_nm: wanted 1 to 4096"),
    ],
)
def test_a_spectrum_that_is_none_is_refused(nm: Any, values: Any, place: str) -> None:
    with pytest.raises(dg.InputError, match=f"^spectrum: {place}"):
        dg.Spectrum(nm, values)


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        (dg.Diffuse(0.5), "reflectance: wanted three numbers, got 0.5"),  # type: ignore[arg-type]
        (dg.Conductor(eta=(1, 1, 1)), "k: missing, eta needs it"),
        (dg.Conductor(alpha_v="x"), "alpha_v: wanted a number"),  # type: ignore[arg-type]
        (dg.Dielectric(distribution="GGX"), "distribution: wanted ggx or beckmann, got 'GGX'"),  # type: ignore[arg-type]
        (dg.Coated(distribution=1), "distribution: wanted ggx or beckmann, got 1"),  # type: ignore[arg-type]
        (dg.Dielectric(ior=(1, 1, 1)), "ior: wanted a number"),  # type: ignore[arg-type]
        (dg.Dielectric(thin=2), "thin: wanted True or False, got 2"),  # type: ignore[arg-type]
        (dg.Coated(dg.Gltf()), "base: wanted Diffuse or Conductor"),  # type: ignore[arg-type]
        (dg.Coated(dg.Conductor(k=(1, 1, 1))), "base: eta: missing, k needs it"),
        (dg.Mix(0, 5), "second: wanted one of the 2 materials before it, got 5"),
        (dg.Mix(2, 0), "first: wanted one of the 2 materials before it, got 2"),
    ],
)
def test_a_wrong_field_is_one_error_that_names_it(kind: Any, message: str) -> None:
    scene = dg.Scene()
    scene.add_material(dg.Diffuse())
    scene.add_material(dg.Diffuse())
    with pytest.raises(dg.InputError, match=f"^material '?2'?: {message}"):
        scene.add_material(dg.Material(kind))


@pytest.mark.parametrize(
    ("kind", "says"),
    [
        (dg.Gltf(), "set it on Gltf instead"),
        (dg.Mix(0, 0), "set it on the parts instead"),
        (dg.Boundary(), "a boundary has none"),
    ],
)
def test_a_normal_map_belongs_to_kinds_that_scatter_by_it(kind: Any, says: str) -> None:
    scene = dg.Scene()
    scene.add_material(dg.Diffuse())
    with pytest.raises(dg.InputError, match=f"normal_texture: {says}"):
        scene.add_material(dg.Material(kind, normal_texture=SLOT))


def test_materials_pickle_and_compare() -> None:
    for kind in KINDS:
        material = dg.Material(kind, opacity=0.5, opacity_texture=SLOT, two_sided=False)
        assert pickle.loads(pickle.dumps(material)) == material


def test_metals_have_a_source_and_cover_the_visible_range() -> None:
    for name in metals.names():
        metal = metals.entry(name)
        assert metal.source
        assert metal.eta.wavelengths_nm == metal.k.wavelengths_nm
        assert metal.eta.wavelengths_nm[0] <= 400
        assert metal.eta.wavelengths_nm[-1] >= 700
    assert {"Au", "Ag", "Al", "Cu", "Cr", "Fe", "Ti", "W", "Ni", "Pt", "a-C"} <= set(metals.names())
    with pytest.raises(dg.UsageError, match=r"metal: wanted .*, got 'Unobtainium'"):
        dg.Conductor.of_metal("Unobtainium")
    with pytest.raises(dg.UsageError, match="eta: comes from the table of metals"):
        dg.Conductor.of_metal("Au", eta=(1, 1, 1))


def test_the_tables_have_the_colours_of_the_metals() -> None:
    def reflectance(name: str, nm: float) -> float:
        eta, k = (float(part.at(nm)) for part in metals.load(name))
        return ((eta - 1) ** 2 + k**2) / ((eta + 1) ** 2 + k**2)

    assert reflectance("Au", 650) > 0.9 > 0.45 > reflectance("Au", 450)
    assert reflectance("Cu", 650) > 0.85 > 0.65 > reflectance("Cu", 500)
    assert reflectance("Ag", 550) > 0.95
    assert 0.87 < reflectance("Al", 550) < 0.94
    assert 0.4 < reflectance("W", 550) < 0.6


def test_materials_print_what_differs_from_their_defaults() -> None:
    told = {repr(dg.Material(kind, opacity=0.5)) for kind in KINDS}
    assert len(told) == len(KINDS)
    assert all(text.endswith(", opacity=0.5)") and "None" not in text for text in told)
    assert repr(dg.Material()) == "Material()"
    assert repr(dg.Dielectric(1.6, thin=True)) == "Dielectric(ior=1.6, thin=True)"
    assert repr(dg.Coated(dg.Diffuse((1, 0, 0)))) == "Coated(base=Diffuse(reflectance=(1, 0, 0)))"
