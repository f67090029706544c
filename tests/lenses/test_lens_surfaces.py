"""Real lenses, aspheres and cylinders too: rays come back, keep etendue, and lanes follow."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from daguerre import _core, lenses

FloatArray = NDArray[np.float64]
OMEGA = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.eye(2), np.zeros((2, 2))]])
ASPHERIC = (
    "canon-ef-11-24mm-f4",
    "canon-rf-85mm-f1.2",
    "schneider-anamorphic-60mm",
    "sigma-28mm-f1.4",
)


def film_rays(lens: lenses.Lens, count: int, seed: int) -> tuple[FloatArray, FloatArray]:
    """Random rays from the film toward the exit pupil: origins, directions (mm, lens frame)."""
    random = np.random.default_rng(seed)
    order = lens.prescription.first_order(550.0)
    origins = np.zeros((count, 3))
    origins[:, :2] = 0.25 * abs(order.efl) * (random.random((count, 2)) - 0.5)
    origins[:, 2] = order.back_focal_z
    targets = np.zeros((count, 3))
    targets[:, :2] = order.exit_pupil_diameter * (random.random((count, 2)) - 0.5)
    targets[:, 2] = order.exit_pupil_z
    directions = targets - origins
    directions *= -np.sign(directions[:, 2:])  # an exit pupil may lie behind the film
    return origins, directions / np.linalg.norm(directions, axis=1, keepdims=True)


@pytest.mark.parametrize("name", lenses.names())
def test_rays_come_back_and_keep_their_etendue(name: str) -> None:
    lens = lenses.load(name)
    prescription = lens.prescription
    origins, directions = film_rays(lens, 400, 1)
    nm = np.full(len(origins), 550.0)
    points, out, iris, path, light, stopped = prescription.rays(
        origins, directions, nm, True, False
    )
    passed = stopped < 0
    assert passed.sum() > 10
    assert ((light > 0) == passed).all()
    start = points[passed]
    back, there, iris_back, path_back, _, stopped_back = prescription.rays(
        start, -out[passed], nm[passed], True, True
    )
    assert (stopped_back < 0).all()
    film = back + there * ((origins[passed, 2] - back[:, 2]) / there[:, 2])[:, None]
    assert np.abs(film - origins[passed]).max() < 1e-9
    assert np.abs(iris_back - iris[passed]).max() < 1e-9
    # The way out began on the film, the way back ends at the last surface.
    to_film = np.linalg.norm(film - back, axis=1)
    np.testing.assert_allclose(path_back + to_film, path[passed], rtol=0, atol=1e-9)
    for origin, direction in list(zip(start, -out[passed], strict=True))[:10]:
        if direction[2] < 0.3:
            continue
        jacobian = prescription.jacobian(list(origin), list(direction), 550.0, origins[0, 2])
        assert np.abs(jacobian.T @ OMEGA @ jacobian - OMEGA).max() < 1e-6


@pytest.mark.parametrize("name", ASPHERIC)
def test_lanes_follow_the_reference(name: str) -> None:
    """Rays of the kernels, traced back in double, land on the film point they were drawn for."""
    lens = lenses.load(name)
    prescription, order = lens.prescription, lens.first_order()
    settings = _core.ExactLensSettings(
        f_stop=order.f_number, focus_distance_m=4.0, half_diagonal_mm=12.0
    )
    exact = _core.ExactLens(prescription, settings)
    random = np.random.default_rng(2)
    film = (15 * (random.random((2000, 2)) - 0.5)).astype(np.float32)
    u = random.random((2000, 2)).astype(np.float32)
    nm = np.full(2000, 520, np.float32)
    origins, directions, weights, _ = exact.generate(film, u, nm)
    drawn = weights > 0
    assert drawn.mean() > 0.6
    pupil = prescription.first_order(587.5618).entrance_pupil_z
    at = 1e3 * origins[drawn].astype(np.float64) + (0, 0, pupil)
    toward = -directions[drawn].astype(np.float64)
    points, out, _, _, _, stopped = prescription.rays(at, toward, nm[drawn].astype(float), True)
    assert (stopped >= 0).mean() < 2e-3  # those that graze a rim
    there = points + out * ((exact.film_z_mm - points[:, 2]) / out[:, 2])[:, None]
    missed = np.abs(there[:, :2] + film[drawn])[stopped < 0]  # upright film
    assert missed.max() < 1e-3


def test_rays_say_which_surface_stops_them() -> None:
    lens = lenses.load("double-gauss-50mm-f2")
    rim = lens.surfaces[0].semi_diameter
    assert rim is not None
    # On the axis, past the rim, and so steeply that the barrel catches it further in.
    origins = np.array([[0.0, 0.0, -10.0], [0.0, 1.01 * rim, -10.0], [0.0, 0.0, 0.0]])
    along = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.8, 0.6]])
    _, _, iris, _, light, stopped = lens.prescription.rays(origins, along, np.full(3, 550.0), True)
    assert stopped[0] == -1
    assert stopped[1] == 0
    assert stopped[2] > 0
    assert np.isnan(iris[1]).all()
    assert (light[1:] == 0).all()
    free = lens.prescription.rays(origins[:2], along[:2], np.full(2, 550.0), False)
    assert (free[5] == -1).all()


@pytest.mark.parametrize("name", ["canon-rf-50mm-f1.2", "schneider-anamorphic-60mm"])
def test_the_bits_of_a_ray_do_not_depend_on_its_neighbours(name: str) -> None:
    """Lanes come to rest one by one; what other lanes still need must not move them."""
    lens = lenses.load(name)
    settings = _core.ExactLensSettings(f_stop=2.0, focus_distance_m=3.0, half_diagonal_mm=15.0)
    camera = _core.ExactLens(lens.prescription, settings)
    rng, n = np.random.default_rng(2), 4000
    film = rng.uniform(-8, 8, (n, 2)).astype(np.float32)
    at = rng.random((n, 2), dtype=np.float32)
    nm = np.full(n, 550, np.float32)
    whole = camera.generate(film, at, nm)
    for part in (slice(1, None, 2), slice(7, None)):
        alone = camera.generate(*(np.ascontiguousarray(values[part]) for values in (film, at, nm)))
        for ours, theirs in zip(whole, alone, strict=True):
            np.testing.assert_array_equal(np.asarray(ours)[part], theirs)
