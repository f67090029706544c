"""Colours and spectra: texts, files, plugins, blackbodies, and their RGB."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.color.illuminants import blackbody
from daguerre.color.spectra import (
    luminance_of_rgb,
    rgb_of_emission,
    rgb_of_reflectance,
    unit_d65,
)

from .scene_files import loaded

SHAPE = '<shape type="cube"><bsdf type="diffuse">{}</bsdf></shape>'


def _reflectance(folder: Path, element: str, version: str = "3.0.0") -> object:
    kind = loaded(folder, SHAPE.format(element), version=version).materials[0].kind
    assert isinstance(kind, dg.Diffuse)
    return kind.reflectance


def _radiance(folder: Path, element: str) -> tuple[float, ...]:
    lamp = f'<shape type="cube"><emitter type="area">{element}</emitter></shape>'
    return loaded(folder, lamp).materials[0].emission


@pytest.mark.parametrize(
    ("element", "color"),
    [
        ('<rgb name="reflectance" value="0.1 0.2 0.3"/>', (0.1, 0.2, 0.3)),
        ('<rgb name="reflectance" value="0.1, 0.2, 0.3"/>', (0.1, 0.2, 0.3)),
        ('<rgb name="reflectance" value="0.4"/>', (0.4, 0.4, 0.4)),
        ('<float name="reflectance" value="0.4"/>', (0.4, 0.4, 0.4)),
        ('<spectrum name="reflectance" value="0.4"/>', (0.4, 0.4, 0.4)),
        ('<spectrum name="reflectance" type="uniform"><float name="value" value="0.3"/></spectrum>',
         (0.3, 0.3, 0.3)),
        ('<spectrum name="reflectance" type="srgb"><rgb name="color" value="0.1 0.2 0.3"/>'
         "</spectrum>", (0.1, 0.2, 0.3)),
    ],
)  # fmt: skip
def test_colors(element: str, color: tuple[float, ...], tmp_path: Path) -> None:
    assert _reflectance(tmp_path, element) == color


def test_spectra_have_samples(tmp_path: Path) -> None:
    (tmp_path / "a.spd").write_text("# nm value\n400 0.1\n500 0.2\n\n700 0.4\n")
    wanted = dg.Spectrum((400.0, 500.0, 700.0), (0.1, 0.2, 0.4))
    for element in (
        '<spectrum name="reflectance" value="400:0.1, 500:0.2, 700:0.4"/>',
        '<spectrum name="reflectance" filename="a.spd"/>',
        '<spectrum name="reflectance" type="irregular">'
        '<string name="wavelengths" value="400, 500, 700"/>'
        '<string name="values" value="0.1 0.2 0.4"/></spectrum>',
    ):
        assert _reflectance(tmp_path, element) == wanted
    regular = (
        '<spectrum name="reflectance" type="regular"><float name="wavelength_min" value="400"/>'
        '<float name="wavelength_max" value="700"/><string name="values" value="0.1 0.3 0.2"/>'
        "</spectrum>"
    )
    assert _reflectance(tmp_path, regular) == dg.Spectrum((400.0, 550.0, 700.0), (0.1, 0.3, 0.2))


def test_emission_of_one_at_all_wavelengths_has_a_luminance_of_one(tmp_path: Path) -> None:
    rgb = np.array(_radiance(tmp_path, '<spectrum name="radiance" value="300:2, 900:2"/>'))
    assert rgb @ (0.2126, 0.7152, 0.0722) == pytest.approx(2, rel=2e-3)
    assert rgb[0] > rgb[1] > rgb[2]  # E is yellow beside D65
    assert np.allclose(rgb_of_emission(unit_d65), 1, atol=1e-5)
    assert np.allclose(rgb_of_reflectance(lambda nm: 0.3 + 0 * nm), 0.3, atol=1e-5)


def test_a_light_of_a_constant_has_the_shape_of_d65(tmp_path: Path) -> None:
    assert _radiance(tmp_path, '<spectrum name="radiance" value="3"/>') == (3, 3, 3)
    d65 = '<spectrum name="radiance" type="d65"><float name="scale" value="3"/></spectrum>'
    assert _radiance(tmp_path, d65) == (3, 3, 3)


def test_blackbodies_have_plancks_radiance(tmp_path: Path) -> None:
    element = '<spectrum name="radiance" type="blackbody"><float name="temperature" value="{}"/>'
    warm = np.array(_radiance(tmp_path, element.format(3000) + "</spectrum>"))
    white = np.array(_radiance(tmp_path, element.format(6500) + "</spectrum>"))
    assert warm[0] > 2 * warm[2]
    assert np.allclose(white / white.mean(), 1, atol=0.1)
    # 2 h c^2 / l^5 / (exp(h c / (l k T)) - 1) at 555 nm, where the eye sees most
    at_555 = 1.191042972e-16 / 555e-9**5 / math.expm1(1.438776877e-2 / (555e-9 * 6500)) * 1e-9
    assert blackbody(np.array([555.0]), 6500)[0] == pytest.approx(at_555, rel=1e-6)
    assert luminance_of_rgb() @ white == pytest.approx(at_555, rel=0.02)


def test_names_of_indices_and_of_metals(tmp_path: Path) -> None:
    glass = loaded(
        tmp_path,
        '<shape type="cube"><bsdf type="dielectric"><string name="int_ior" value="diamond"/>'
        '<float name="ext_ior" value="1.333"/></bsdf></shape>',
    )
    kind = glass.materials[0].kind
    assert isinstance(kind, dg.Dielectric)
    assert kind.ior == pytest.approx(2.419 / 1.333)
    metal = '<shape type="cube"><bsdf type="conductor">{}</bsdf></shape>'
    gold = loaded(tmp_path, metal.format('<string name="material" value="Au"/>')).materials[0].kind
    assert gold == dg.Conductor.of_metal("Au", alpha=0.0)
    mirror = loaded(tmp_path, metal.format("")).materials[0].kind
    assert mirror == dg.Conductor((1, 1, 1), 0.0)
    unknown = loaded(tmp_path, metal.format('<string name="material" value="Unobtainium"/>'))
    assert unknown.materials[0].kind == mirror
    assert "the metal 'Unobtainium' is unknown: it is read as a mirror (1 use)" in unknown.warnings


@pytest.mark.parametrize(
    ("element", "wrong"),
    [
        (
            '<spectrum name="reflectance" value="400:0.1, 300:0.2"/>',
            "wavelengths_nm: must increase",
        ),
        ('<spectrum name="reflectance" value="400:0.1, 500"/>', "wanted 2 numbers, got 1"),
        ('<spectrum name="reflectance" value="400:-1"/>', "at least 0"),
        ('<boolean name="reflectance" value="true"/>', "wanted a colour or spectrum, got True"),
        (
            '<spectrum name="reflectance" type="blackbody"/>',
            "the property 'temperature' is missing",
        ),
    ],
)
def test_wrong_spectra(element: str, wrong: str, tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match=rf"line 2, column \d+: .*{wrong}"):
        loaded(tmp_path, SHAPE.format(element))
