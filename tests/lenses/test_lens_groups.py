"""Groups of surfaces off the axis, resolved into the place of each surface."""

from __future__ import annotations

import numpy as np
import pytest

from daguerre import lenses
from daguerre.errors import InputError
from daguerre.lenses.groups import Group, angles, placed, rotation

LENS = lenses.load("double-gauss-50mm-f2")


def test_angles_undo_rotations() -> None:
    for tilt in ((1.0, 2.0, 3.0), (-30.0, 40.0, 170.0), (0.0, 0.0, 0.0)):
        np.testing.assert_allclose(angles(rotation(tilt)), tilt, atol=1e-12)
    # About x: y turns toward z.
    np.testing.assert_allclose(rotation((90, 0, 0)) @ [0, 1, 0], [0, 0, 1], atol=1e-15)


def test_a_shift_moves_each_surface_alike() -> None:
    moved = placed(LENS.surfaces, Group(6, 8, decenter=(0.5, -0.25, 0.1)))
    for i, (before, after) in enumerate(zip(LENS.surfaces, moved, strict=True)):
        expected = (0.5, -0.25, 0.1) if 6 <= i <= 8 else before.decenter
        assert after.decenter == pytest.approx(expected, abs=1e-12)
        assert after.tilt == before.tilt


def test_a_tilt_is_rigid_and_leaves_its_pivot_alone() -> None:
    group = Group(6, 8, tilt=(3.0, -2.0, 0.0), pivot_mm=5.0)
    moved = placed(LENS.surfaces, group)
    z = LENS.vertices
    before = np.array([[0, 0, z[i]] for i in (6, 7, 8)])
    after = before + [moved[i].decenter for i in (6, 7, 8)]
    pivot = np.array([0, 0, z[6] + 5.0])
    for rows in (before, after):
        np.testing.assert_allclose(
            np.linalg.norm(rows - pivot, axis=1), np.abs(z[6:9] - pivot[2]), atol=1e-12
        )
    np.testing.assert_allclose(
        np.diff(after, axis=0), np.diff(before, axis=0) @ rotation(group.tilt).T
    )
    for i in (6, 7, 8):
        assert moved[i].tilt == pytest.approx((3.0, -2.0, 0.0))


def test_turned_there_and_back_it_is_where_it_was() -> None:
    there = placed(LENS.surfaces, Group(2, 4, tilt=(5.0, 0.0, 0.0), pivot_mm=1.0))
    back = placed(there, Group(2, 4, tilt=(-5.0, 0.0, 0.0), pivot_mm=1.0))
    for surface in back:
        assert surface.decenter == pytest.approx((0, 0, 0), abs=1e-12)
        assert surface.tilt == pytest.approx((0, 0, 0), abs=1e-12)


def test_surfaces_that_are_not_there() -> None:
    for first, last in ((-1, 2), (3, 2), (4, 99)):
        with pytest.raises(
            InputError, match=r"decentered: wanted surfaces \(first, last\) within 0 \.\. 10"
        ):
            LENS.decentered((first, last), (1, 0))


def test_a_sphere_turned_about_its_centre_is_the_same_sphere() -> None:
    radius = LENS.surfaces[0].radius
    assert radius is not None
    surfaces = placed(LENS.surfaces, Group(0, 0, tilt=(4.0, 7.0, 0.0), pivot_mm=radius))
    origins = np.array([[0.0, 3, -10], [2, -4, -10]])
    directions = [[0.0, 0.02, 1], [0.01, 0, 1]]
    same, turned = (lens.trace(origins, directions) for lens in (LENS, LENS.rebuilt(surfaces)))
    np.testing.assert_allclose(turned, same, atol=1e-9)


def test_a_shifted_lens_shifts_its_image() -> None:
    last = len(LENS.surfaces) - 1
    moved = LENS.decentered((0, last), (0.3, -0.2))
    origins, directions = np.array([[0.0, 3, -10]]), np.array([[0.0, 0.02, 1]])
    shift = np.array([0.3, -0.2, 0])
    found = moved.trace(origins + shift, directions)
    np.testing.assert_allclose(found, LENS.trace(origins, directions) + shift)
