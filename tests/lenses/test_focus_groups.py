"""Focusing by the groups that a file names: conjugates, breathing, limits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from daguerre import lenses
from daguerre.lenses.errors import LensError
from daguerre.lenses.focus import Focused, closest_focus_m, path_of

GROUPS = ["telephoto-600mm-f5.6", "portrait-85mm-f2", "canon-ts-e-90mm-f2.8-macro"]
WHOLE = "tessar-50mm-f2.8"


def image_by_rays(focused: Focused, object_z: float) -> float:
    """Where nearly axial real rays of a point on the axis meet the axis again."""
    y = 1e-3
    slope = y / -object_z
    near, far = (
        focused.lens.trace([0, y, 0], [0, slope, 1], image_z=z)[0, 1]
        for z in (focused.film_z_mm, focused.film_z_mm + 1)
    )
    return focused.film_z_mm - near / (far - near)


@pytest.mark.parametrize("name", [*GROUPS, WHOLE])
@pytest.mark.parametrize("measured_from", ["pupil", "sensor"])
def test_the_film_is_the_image_of_the_plane(name: str, measured_from: str) -> None:
    lens = lenses.load(name)
    for distance in (1e3, 30.0, 8.0):
        found = lens.focused(distance, measured_from=measured_from)  # type: ignore[arg-type]
        start = found.entrance_pupil_z if measured_from == "pupil" else found.film_z_mm
        assert image_by_rays(found, start - 1e3 * distance) == pytest.approx(
            found.film_z_mm, abs=1e-6
        )
        assert found.efl_mm == found.lens.first_order().efl


@pytest.mark.parametrize("name", GROUPS)
def test_groups_move_and_the_film_stays(name: str) -> None:
    lens = lenses.load(name)
    far, near = lens.focused(math.inf), lens.focused(10.0)
    moving = {i for c in lens.configurations for i in c.gaps}
    last = len(lens.surfaces) - 1
    for i, (a, b) in enumerate(zip(far.lens.surfaces, near.lens.surfaces, strict=True)):
        assert (a.thickness != b.thickness) == (i in moving)
    if last not in moving:
        assert near.film_z_mm - near.lens.vertices[-1] == pytest.approx(lens.surfaces[-1].thickness)
    assert near.film_z_mm == pytest.approx(near.lens.image_z, abs=1e-9)


def test_internal_focus_breathes_and_a_moved_lens_does_not() -> None:
    tele = lenses.load("telephoto-600mm-f5.6")
    lengths = [tele.focused(d).efl_mm for d in (math.inf, 30, 10, 6)]
    assert lengths == sorted(lengths, reverse=True)
    assert lengths[-1] < 0.9 * lengths[0]
    tessar = lenses.load(WHOLE)
    assert tessar.focused(0.5).efl_mm == tessar.focused(math.inf).efl_mm
    assert tessar.focused(0.5).film_z_mm > tessar.focused(math.inf).film_z_mm + 5


@pytest.mark.parametrize("name", GROUPS)
def test_the_ends_of_the_way_are_the_files_own(name: str) -> None:
    lens = lenses.load(name)
    far, near = lens.configurations
    way = path_of(lens)
    assert way is not None
    for place, own in ((0.0, far), (1.0, near)):
        at = way.at(place)
        assert {i: at.surfaces[i].thickness for i in own.gaps} == pytest.approx(own.gaps)


@pytest.mark.parametrize("name", [*GROUPS, WHOLE])
def test_too_near_names_the_nearest(name: str) -> None:
    lens = lenses.load(name)
    with pytest.raises(LensError, match=r"wanted ([\d.]+) m or more") as caught:
        lens.focused(0.05)
    assert caught.value.code == "lens-focus-near"
    text = str(caught.value)
    nearest = float(text.split("wanted ")[1].split(" m")[0])
    lens.focused(nearest * 1.001)
    with pytest.raises(LensError):
        lens.focused(nearest * 0.99)
    for bad in (0.0, -1.0, math.nan):
        with pytest.raises(LensError):
            lens.focused(bad)


def test_zoom_and_focus_form_a_grid() -> None:
    lens = lenses.load("nikon-af-s-70-200mm-f2.8")
    for mm in np.geomspace(71.5, 195.9, 5):
        for distance in (20.0, 3.0, 1.2):
            found = lens.focused(distance, zoom_mm=mm)
            start = found.entrance_pupil_z
            assert image_by_rays(found, start - 1e3 * distance) == pytest.approx(
                found.film_z_mm, abs=1e-6
            )
            # The film stays behind the last group, whatever zoom and focus.
            assert found.film_z_mm - found.lens.vertices[-1] == pytest.approx(54, abs=1e-6)
    way = path_of(lens.at_zoom(100.0))
    assert way is not None
    assert set(way.changes[0].values()) == {0.0}


@pytest.mark.parametrize("measured_from", ["pupil", "sensor"])
def test_an_anamorphic_lens_is_focused_between_its_sections(measured_from: str) -> None:
    lens = lenses.load("schneider-anamorphic-60mm")
    lens = lens.rebuilt(lens.surfaces, configurations=lens.configurations[:1])  # moves as a whole
    for distance in (math.inf, 5.0):
        found = lens.focused(distance, measured_from=measured_from)  # type: ignore[arg-type]
        start = found.entrance_pupil_z if measured_from == "pupil" else found.film_z_mm
        images = []
        for axis in (0, 1):
            direction, origin = np.array([0.0, 0, 1]), np.array([0.0, 0, 0])
            direction[axis] = 0.0 if math.isinf(distance) else 1e-3 / (1e3 * distance - start)
            origin[axis] = 1e-3
            near, far = (found.lens.trace(origin, direction, image_z=z)[0, axis] for z in (0, 1))
            images.append(-near / (far - near))
        assert np.mean(images) == pytest.approx(found.film_z_mm, abs=1e-5)
        assert abs(images[1] - images[0]) > 0.02


def test_an_anamorphic_lens_brings_its_sections_together_by_its_cylinders() -> None:
    lens = lenses.load("schneider-anamorphic-60mm")
    for distance in (20.0, 5.0, 3.0, 1.8, 1.2):
        found = lens.focused(distance)
        object_z = found.entrance_pupil_z - 1e3 * distance
        orders = [found.lens.first_order(section=s) for s in ("x", "y")]
        images = [o.back_focal_point + o.efl**2 / (o.front_focal_point - object_z) for o in orders]
        assert images == pytest.approx([found.film_z_mm] * 2, abs=0.02)
        assert orders[1].efl / orders[0].efl > 1.7


def test_the_best_focus_has_the_smallest_spot() -> None:
    for name in ("double-gauss-50mm-f2", "telephoto-200mm-f1.8"):
        lens = lenses.load(name)
        spots = {}
        for by in ("paraxial", "best"):
            found = lens.focused(10.0, by=by)  # type: ignore[arg-type]
            y = np.linspace(0.02, 0.98, 49) * found.lens.first_order().entrance_pupil.diameter / 2
            start = found.entrance_pupil_z - 1e4
            origins = np.tile([0.0, 0.0, start], (49, 1))
            directions = np.stack([0 * y, y, 0 * y + 1e4], axis=1)
            points = found.lens.trace(origins, directions, image_z=found.film_z_mm)
            spots[by] = math.sqrt(float(np.sum(y * points[:, 1] ** 2) / np.sum(y)))
        assert spots["best"] < 0.9 * spots["paraxial"]
    # Groups move for it, too: the film stays.
    tele = lenses.load("telephoto-200mm-f1.8")
    a, b = tele.focused(10.0), tele.focused(10.0, by="best", f_stop=2.0)
    assert a.film_z_mm == pytest.approx(b.film_z_mm, abs=1e-6)
    assert a.lens.surfaces[9].thickness != b.lens.surfaces[9].thickness


def test_every_lens_of_the_library_focuses() -> None:
    """To the film where its file has it, or says how near it can."""
    for name in lenses.names():
        lens = lenses.load(name)
        found = lens.focused(20.0 if lens.first_order().efl < 700 else 100.0)
        if path_of(lens) is not None:
            assert found.film_z_mm == pytest.approx(found.lens.image_z, abs=1e-6)
        assert min(s.thickness or 0 for s in found.lens.surfaces[:-1]) >= 0


@pytest.mark.parametrize("measured_from", ["pupil", "sensor"])
def test_every_lens_of_the_library_focuses_at_its_closest_distance(measured_from: str) -> None:
    for name in lenses.names():
        lens = lenses.load(name)
        closest = closest_focus_m(lens, from_sensor=measured_from == "sensor")
        for share, reached in ((1 + 1e-6, True), (0.99, False)):
            if closest == 0:
                continue
            try:
                lens.focused(share * closest, measured_from=measured_from)  # type: ignore[arg-type]
            except LensError:
                assert not reached, (name, closest)
            else:
                assert reached, (name, closest)
