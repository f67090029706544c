"""Clear diameters that no source gives: derived from the rays of the full field."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daguerre import lenses
from daguerre.lenses.diameters import image_radius
from daguerre.lenses.library import FOLDER
from daguerre.lenses.sag import sag

BARE = ["zeiss-hologon-15mm-f8", "zeiss-protar-100mm-f9", "laikin-tessar-102mm-f4.5"]


def changed(name: str, folder: Path, edit: Any) -> lenses.Lens:
    """A lens of the library from a file that was edited."""
    data = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    edit(data)
    path = folder / "lens.json"
    path.write_text(json.dumps(data))
    return lenses.load(path)


def without_diameters(data: dict[str, Any]) -> None:
    for surface in data["surfaces"]:
        surface["semi_diameter"] = None


@pytest.mark.parametrize("name", BARE)
def test_they_are_marked(name: str) -> None:
    lens = lenses.load(name)
    for surface in lens.surfaces:
        assert surface.semi_diameter is not None
        assert surface.derived != surface.stop  # the stop's size follows from the f-number
    assert "* not stated by the source" in repr(lens)
    assert not any(s.derived for s in lenses.load("double-gauss-50mm-f2").surfaces)


@pytest.mark.parametrize("name", [BARE[0], BARE[2], "laikin-heliar-254mm-f5"])
def test_the_beam_on_the_axis_and_the_corners_pass(name: str) -> None:
    """From the film: all that passes the iris passes the derived mounts."""
    lens = lenses.load(name)
    order, corner = lens.first_order(), image_radius(lens)
    assert corner is not None
    (stop,) = [s.semi_diameter for s in lens.surfaces if s.stop]
    assert stop is not None
    random = np.random.default_rng(1)
    for y in (0.0, 0.5 * corner, 0.77 * corner, corner):
        film = np.array([0, y, lens.image_z])
        # Slopes far and wide around the direction of the exit pupil.
        z = order.exit_pupil.z - lens.image_z
        slopes = np.array([0, -y / z]) + 0.6 * (random.random((6000, 2)) - 0.5) / order.f_number
        slopes *= 1 + 0.6 * (random.random((6000, 1)) - 0.5)
        directions = -np.column_stack([slopes, np.ones(6000)])
        rays = [np.tile(film, (6000, 1)), directions, np.full(6000, 587.5618)]
        _, _, iris, _, _, free = lens.prescription.rays(*rays, False, False)
        stopped = lens.prescription.rays(*rays, True, False)[-1]
        inside = (free < 0) & (np.hypot(*iris.T) < stop)
        assert inside.sum() > 10
        assert (stopped[inside] < 0).all()


def test_they_are_not_much_wider_than_the_light(tmp_path: Path) -> None:
    """On the axis of a lens without field the diameters are those of the axial beam."""

    def edit(data: dict[str, Any]) -> None:
        without_diameters(data)
        data["nominal"] = {"f_number": 4.0, "image_circle_mm": 1e-6}

    lens = changed("tessar-50mm-f2.8", tmp_path, edit)
    order = lens.first_order()
    assert order.f_number == pytest.approx(4, rel=1e-9)
    y = order.entrance_pupil.diameter / 2
    path = lens.prescription.path(
        np.array([[0, y, -9.0]]), np.array([[0, 0, 1.0]]), 587.5618, False
    )
    sizes = [s.semi_diameter for s in lens.surfaces if not s.stop]
    heights = [h for h, s in zip(path[:, 1], lens.surfaces, strict=True) if not s.stop]
    np.testing.assert_allclose(sizes, 1.01 * np.array(heights), rtol=0.03)


def test_a_patents_own_mounts_are_close(tmp_path: Path) -> None:
    """A slow, symmetric lens is hardly vignetted: its real mounts are about what rays need."""
    own = lenses.load("schneider-apo-symmar-100mm-f5.6")

    def edit(data: dict[str, Any]) -> None:
        without_diameters(data)
        data["nominal"]["full_field_deg"] = 50

    derived = changed("schneider-apo-symmar-100mm-f5.6", tmp_path, edit)
    for a, b in zip(own.surfaces, derived.surfaces, strict=True):
        assert a.semi_diameter is not None
        assert b.semi_diameter is not None
        assert 0.6 < b.semi_diameter / a.semi_diameter < 1.4


def test_without_field_they_stay_unknown(tmp_path: Path) -> None:
    def no_field(data: dict[str, Any]) -> None:
        without_diameters(data)
        data["nominal"] = {"f_number": 2.8}

    lens = changed("tessar-50mm-f2.8", tmp_path, no_field)
    assert all(s.semi_diameter is None for s in lens.surfaces if not s.stop)


def test_the_image_circle_follows_the_projection(tmp_path: Path) -> None:
    def edit(data: dict[str, Any]) -> None:
        data["nominal"] = {"full_field_deg": 180, "projection": "equisolid"}

    lens = changed("fisheye-16mm-f2.8", tmp_path, edit)
    efl = lens.first_order().efl
    assert image_radius(lens) == pytest.approx(2 * efl * math.sin(math.pi / 4))


@pytest.mark.parametrize("name", ["zeiss-protar-100mm-f9", "laikin-wide-angle-17mm-f4"])
def test_derived_rims_do_not_run_into_each_other(name: str) -> None:
    lens = lenses.load(name)
    assert not lens.notes
    for i, (a, b) in enumerate(itertools.pairwise(lens.surfaces)):
        assert a.semi_diameter is not None
        assert b.semi_diameter is not None
        r = np.array([0.999 * min(a.semi_diameter, b.semi_diameter)])
        if not a.stop and not b.stop:
            assert lens.vertices[i + 1] - lens.vertices[i] + sag(b, r, 0 * r) > sag(a, r, 0 * r)
