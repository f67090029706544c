"""Fitted lenses from Python: against the exact trace, as data, and with bad input."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import daguerre as dg
from daguerre import polynomial
from daguerre.errors import InputError, UsageError
from tests.support.lenses.line_glass import on_the_line

NAME = "double-gauss-50mm-f2"


@pytest.fixture(scope="module")
def fitted() -> polynomial.LensFit:
    return polynomial.fit(NAME, 7, f_stop=4)


def film_rays(count: int = 400) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Film points of a full frame, slopes toward the exit pupil, wavelengths."""
    lens = dg.lenses.load(NAME).focused(math.inf)
    pupil = lens.lens.first_order().exit_pupil
    random = np.random.default_rng(3)
    film = (random.random((count, 2)) - 0.5) * (30, 20)
    angle, radius = 2 * np.pi * random.random(count), np.sqrt(random.random(count))
    aim = 0.25 * pupil.diameter * radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)
    slopes = (film - aim) / (lens.film_z_mm - pupil.z)
    return film, slopes, 400 + 300 * random.random(count)


def test_agrees_with_the_exact_trace_within_its_error(fitted: polynomial.LensFit) -> None:
    film, slopes, nm = film_rays()
    rays = fitted.evaluate(film, slopes, nm)
    lens = dg.lenses.load(NAME).focused(math.inf)
    origins = np.column_stack([film, np.full(len(film), lens.film_z_mm)])
    toward = np.column_stack([-slopes, -np.ones(len(film))])
    toward /= np.linalg.norm(toward, axis=1)[:, None]
    points, exits, iris, _, light, stopped = lens.lens.prescription.rays(
        origins, toward, nm, True, toward_film=False
    )
    through = stopped < 0
    assert through.sum() > 200
    assert np.all(rays.within[through])
    angle = np.linalg.norm(np.cross(rays.directions, exits), axis=1)[through]
    assert np.sqrt(np.mean(angle**2)) < 1.5 * fitted.error.direction_rad[0]
    assert angle.max() < 2 * fitted.error.direction_rad[1]
    offset = np.linalg.norm(np.cross(points - rays.origins, exits), axis=1)[through]
    # focused at infinity: as far from the ray as the direction's error is after three metres
    assert np.sqrt(np.mean(offset**2)) < 1.2 * 3000 * fitted.error.direction_rad[0]
    assert offset.max() < 4e-3
    assert np.abs(rays.iris - iris)[through].max() < 2 * fitted.error.iris_mm[1]
    assert np.abs(rays.transmittance - light)[through].max() < 2 * fitted.error.transmittance[1]


def test_film_rays_come_back(fitted: polynomial.LensFit) -> None:
    film, slopes, nm = film_rays(100)
    rays = fitted.evaluate(film, slopes, nm)
    back, again = fitted.to_film(rays.origins, rays.directions, nm)
    np.testing.assert_allclose(back, film, atol=1e-9)
    np.testing.assert_allclose(again, slopes, atol=1e-10)


def test_data_as_json_is_the_same_fit(fitted: polynomial.LensFit) -> None:
    data = json.loads(json.dumps(fitted.to_dict()))
    copy = polynomial.LensFit.from_dict(data)
    film, slopes, nm = film_rays(50)
    a, b = fitted.evaluate(film, slopes, nm), copy.evaluate(film, slopes, nm)
    np.testing.assert_array_equal(a.directions, b.directions)
    np.testing.assert_array_equal(a.origins, b.origins)
    np.testing.assert_array_equal(a.transmittance, b.transmittance)
    assert copy.to_dict() == fitted.to_dict()
    assert repr(copy) == repr(fitted)


def test_error_falls_with_the_degree_and_is_told_by_field() -> None:
    for lens, degrees in ((on_the_line(NAME), (3, 5, 7)), (NAME, (3, 5, 9))):  # real glass, too
        errors = [polynomial.fit(lens, k, f_stop=4).error for k in degrees]
        rms = [error.direction_rad[0] for error in errors]
        assert rms[0] > 3 * rms[1] > 9 * rms[2]
    fitted = polynomial.fit(NAME, 5, f_stop=4)
    assert sum(zone.rays for zone in fitted.zones) == fitted.error.rays
    assert max(zone.film_um[1] for zone in fitted.zones) == fitted.error.film_um[1]
    assert fitted.error.film_px(3840, 36)[0] == pytest.approx(
        fitted.error.film_um[0] * 3840 / 36000
    )


def test_a_fit_has_the_same_bits_again(fitted: polynomial.LensFit) -> None:
    assert polynomial.fit(NAME, 7, f_stop=4).to_dict() == fitted.to_dict()
    assert polynomial.LensFit.from_dict(fitted.to_dict()).to_dict() == fitted.to_dict()


def test_few_terms_are_worse_than_all_and_better_than_fewer() -> None:
    errors = [
        polynomial.fit(on_the_line(NAME), 7, f_stop=4, terms=terms).error.direction_rad[0]
        for terms in (10, 30, None)
    ]
    assert errors[0] > 2 * errors[1] > 4 * errors[2]


def test_rays_from_elsewhere_take_the_place_of_the_fitted_ones(
    fitted: polynomial.LensFit,
) -> None:
    film, slopes, nm = film_rays(600)
    data = fitted.to_dict()
    for row in data["segments"][0]["direction"]["coefficients"]:
        row[:] = [c * (1 + 0.1 * math.sin(1e5 * c)) for c in row]
    lens = polynomial.LensFit.from_dict(data)  # another one, in the same coordinates
    rays = lens.evaluate(film, slopes, nm)
    other = fitted.refitted(film, slopes, nm, rays.origins, rays.directions)
    found = other.evaluate(film, slopes, nm)
    assert np.abs(rays.angles - fitted.evaluate(film, slopes, nm).angles).max() > 1e-3
    np.testing.assert_allclose(found.angles, rays.angles, atol=1e-9)
    np.testing.assert_array_equal(found.iris, fitted.evaluate(film, slopes, nm).iris)


def test_an_anamorphic_lens_is_fitted_without_axial_symmetry() -> None:
    found = polynomial.fit("schneider-anamorphic-60mm", 5)
    assert found.to_dict()["symmetry"] == {"axial": False, "mirror_x": True, "mirror_y": True}
    assert found.error.film_um[0] < 60
    copy = polynomial.LensFit.from_dict(json.loads(json.dumps(found.to_dict())))
    assert copy.to_dict() == found.to_dict()


@pytest.mark.parametrize("degree", [0, 4, 15, 7.5])
def test_degrees_that_are_not_fitted_are_refused(degree: int) -> None:
    with pytest.raises(UsageError, match=r"degree: wanted"):
        polynomial.fit(NAME, degree)


def test_other_bad_input_is_refused() -> None:
    with pytest.raises(UsageError, match=r"film: wanted"):
        polynomial.fit(NAME, film=(0, 24))
    with pytest.raises(UsageError, match=r"segments"):
        polynomial.fit(NAME, segments=0)
    with pytest.raises(InputError, match=r"lens-f-stop"):
        polynomial.fit(NAME, f_stop=0.5)


def test_data_of_another_form_is_refused(fitted: polynomial.LensFit) -> None:
    good = fitted.to_dict()
    with pytest.raises(InputError, match=r"format: wanted 'daguerre-lens-fit/0.1'"):
        polynomial.LensFit.from_dict({**good, "format": "other"})
    with pytest.raises(InputError, match="segments"):
        polynomial.LensFit.from_dict({k: v for k, v in good.items() if k != "segments"})
    with pytest.raises(InputError, match="points: wanted 4 functions"):
        polynomial.LensFit.from_dict({**good, "mounts": []})
