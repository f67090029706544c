"""Lenses whose parts lie off the axis, turned and anamorphic ones: pictures against the bench."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre import _core, lenses
from daguerre.pictures.exr.write import attributes
from daguerre.setup.camera import set_up
from daguerre.setup.camera_facts import camera_facts
from tests.camera.test_lens_models import LENS
from tests.support.pictures.statistical import batch_means, differences
from tests.support.scene import scenes

Array = NDArray[np.float64]
NM = 560.0
AWAY = 3.0  # m
REAR = (9, 10)  # the last element of the double Gauss, in air on both sides
PIXEL = 0.006  # mm
SHIFTED = {"decenter": ((REAR, (0.3, 0.0), (0.0, 1.0)),)}
SKEW = {
    "tilted": dg.Camera(lens=LENS, f_stop=4.0, tilt=(5.0, -3.0), focus_distance=AWAY),
    "decentred": dg.Camera(
        lens=LENS, f_stop=4.0, decenter=((REAR, (0.4, -0.3), (1.0, 0.5)),), focus_distance=AWAY
    ),
    "anamorphic": dg.Camera(
        lens="schneider-anamorphic-60mm", f_stop=4.0, sensor_size=(24.9, 20.7), focus_distance=AWAY
    ),
}


def paraxial_shift(moved: tuple[int, int], shift: float, tilt_deg: float) -> float:
    """Where the image of the point on the axis goes, mm: y, u through surfaces off the axis.

    A surface whose centre of curvature lies at height c refracts n' u' = n u - (y - c) (n' - n) / R
    but for a part that a flat one shares: n' u' = n u - y power + (n' - n) (shift / R + tilt), the
    tilt of the normal at its vertex.
    """
    lens = lenses.load(LENS)
    focused = lens.focused(AWAY)
    y, u, n = 0.0, 0.0, 1.0
    z = lens.vertices
    for i, s in enumerate(lens.surfaces):
        after = s.core_glass.index(NM)
        curvature = 1 / s.radius if s.radius else 0.0
        lean = place = 0.0
        if moved[0] <= i <= moved[1]:
            lean = math.radians(tilt_deg)  # about x, positive: the top leans toward -y .. +z
            place = shift - lean * (z[i] - z[moved[0]])
        u = (n * u - (after - n) * ((y - place) * curvature + lean)) / after
        n = after
        gap = (z[i + 1] if i + 1 < len(z) else focused.film_z_mm) - z[i]
        y += u * gap
    return y


def bench_spot(
    shift: tuple[float, float], tilt: tuple[float, float], f_stop: float, nm: float = NM
) -> Array:
    """Points (N, 2) on the film, mm, of rays from a point on the axis that fill the stop evenly."""
    focused = lenses.load(LENS).focused(AWAY)
    lens = focused.lens.decentered(REAR, shift, tilt)
    radius = 50 / f_stop / 2
    x, y = np.meshgrid(*[(np.arange(64) + 0.5) / 32 - 1] * 2)
    inside = np.hypot(x, y) < 1
    pupil = np.stack([x[inside], y[inside], 0 * x[inside]], 1) * radius
    start = np.array([0, 0, focused.entrance_pupil_z - 1e3 * AWAY])
    toward = pupil + np.array([0, 0, focused.entrance_pupil_z]) - start
    toward /= np.linalg.norm(toward, axis=1, keepdims=True)
    n = len(toward)
    points, directions, *_, stopped = lens.prescription.rays(
        np.tile(start, (n, 1)), toward, np.full(n, nm), False, True
    )
    p, d = np.asarray(points), np.asarray(directions)
    film = p + d * ((focused.film_z_mm - p[:, 2:]) / d[:, 2:])
    return film[np.asarray(stopped) < 0][:, :2]


def picture(camera: dg.Camera, spp: int = 8) -> tuple[Array, Array]:
    """Luminance of a point source on the axis, and the pixels' x and y on the film, mm."""
    scene = dg.Scene()
    shining = dg.Material(dg.Diffuse((0, 0, 0)), emission=(100, 100, 100))
    scene.add_instance(scene.add_mesh(*scenes.quad(2e-4)), shining, scenes.at(0, 0, -AWAY))
    # Light paths as `auto` chooses, of fewer indices: noise of moments 0.5 %, of places 0.04 um.
    options = {"resolution": (48, 48), "filter": "box", "light_paths": (8000, 0)}
    frame = dg.render(scene, camera, spp=spp, **options)
    side = camera.sensor_size[0]
    x = ((np.arange(48) + 0.5) / 48 - 0.5) * side
    place = np.stack(np.meshgrid(x, -x), -1) + camera.shift
    return np.asarray(frame.xyz, np.float64)[..., 1], place


def moments(light: Array, place: Array) -> tuple[Array, Array]:
    """Centre (2,), and the mean of r^2 (x, y) about it, which is 0 but for coma."""
    w = (light / light.sum()).reshape(-1, 1)
    xy = place.reshape(-1, 2)
    centre = (w * xy).sum(0)
    off = xy - centre
    return centre, (w * (off**2).sum(1, keepdims=True) * off).sum(0)


@pytest.mark.parametrize(
    ("shift", "tilt"), [((0.0, 0.2), (0.0, 0.0)), ((0.0, 0.0), (1.0, 0.0)), ((0.0, 0.1), (-0.7, 0))]
)
def test_the_image_on_the_bench_moves_as_paraxial_optics_says(shift: Any, tilt: Any) -> None:
    spot = bench_spot(shift, tilt, 16.0).mean(axis=0)
    assert spot[1] == pytest.approx(paraxial_shift(REAR, shift[1], tilt[0]), rel=0.02)
    assert abs(spot[0]) < 1e-6


@pytest.mark.parametrize(
    ("shift", "tilt"),
    [((0.3, 0.0), (0.0, 0.0)), ((0.1, -0.2), (0.0, 0.0)), ((0.0, 0.0), (3.0, -2.0))],
)
def test_a_picture_moves_as_the_bench_does(shift: Any, tilt: Any) -> None:
    """The image on the film is upside down, and so the picture goes the other way."""
    camera = dg.Camera(
        lens=LENS, f_stop=8.0, focus_distance=AWAY, sensor_size=(0.5, 0.5), iso=100
    ).with_(decenter=((REAR, shift, tilt),))
    centre, _ = moments(*picture(camera))
    expected = -bench_spot(shift, tilt, 8.0).mean(axis=0)
    np.testing.assert_allclose(centre, expected, atol=1.5e-3 + 0.02 * np.abs(expected).max())
    assert np.abs(expected).max() > 0.02  # there is something to see
    chief = set_up(dg.Scene(), camera, (48, 48), None).core.chief_rays()
    film = np.asarray(chief.film_points(np.array([[0.0, 0.0, -AWAY]])))[0]
    np.testing.assert_allclose(film, centre, atol=2e-3)


def test_a_decentred_element_brings_coma_onto_the_axis() -> None:
    camera = dg.Camera(lens=LENS, f_stop=2.8, focus_distance=AWAY, sensor_size=(0.5, 0.5))
    shift, still = (0.0, 0.4), (0.0, 0.0)
    spot = -bench_spot(shift, still, 2.8)
    centre, expected = moments(np.ones(len(spot)), spot)
    _, none = moments(*picture(camera))
    moved = camera.with_(decenter=((REAR, shift),), shift=(0.0, float(centre[1])))
    found, coma = moments(*picture(moved))
    np.testing.assert_allclose(found, centre, atol=3e-3)
    assert np.abs(none).max() < 0.1 * abs(expected[1])
    assert coma[1] == pytest.approx(expected[1], rel=0.15)
    assert abs(coma[0]) < 0.1 * abs(expected[1])


@pytest.mark.parametrize("kind", SKEW)
def test_the_film_point_of_a_chief_ray_is_where_it_came_from(kind: str) -> None:
    camera = SKEW[kind]
    half = np.array(camera.sensor_size) / 2
    film = half * np.random.default_rng(3).uniform(-1, 1, (200, 2))
    chief = set_up(dg.Scene(), camera, (36, 24), None).core.chief_rays()
    origins, directions = (np.asarray(part) for part in chief.rays(film))
    for points, far in ((origins + AWAY * directions, False), (directions, True)):
        back = np.asarray(chief.film_points(points, far))
        assert np.abs(back - film).max() < 1e-3 * PIXEL
    aside = np.asarray(chief.film_points(origins + AWAY * directions + [1e-5, 0, 0]))
    assert np.abs(aside - film).max(axis=1).min() > 1e-3 * PIXEL  # such a fault shows


@pytest.mark.parametrize("kind", SKEW)
def test_chief_rays_are_in_the_middle_of_the_rays_of_the_picture(kind: str) -> None:
    camera = SKEW[kind]
    core = set_up(dg.Scene(), camera, (36, 24), None).core
    half = np.array(camera.sensor_size) / 2
    film = half * np.random.default_rng(5).uniform(-0.7, 0.7, (12, 2))
    grid = (np.stack(np.meshgrid(*[np.arange(48)] * 2), -1).reshape(-1, 2) + 0.5) / 48
    u = np.tile(grid, (len(film), 1)).astype(np.float32)
    places = np.repeat(film, len(grid), axis=0).astype(np.float32)
    o, d, w = (np.asarray(a) for a in core.rays(places, u, np.full(len(u), 587.5618, np.float32)))
    passed = w > 0
    run = np.divide(-AWAY - o[:, 2], d[:, 2], out=np.zeros_like(w), where=passed)
    met = (o + d * run[:, None]).reshape(len(film), -1, 3)
    mean = (w.reshape(len(film), -1, 1) * met).sum(1) / w.reshape(len(film), -1, 1).sum(1)
    back = np.asarray(core.chief_rays().film_points(np.float64(mean)))
    np.testing.assert_allclose(back, film, atol=0.1 * PIXEL)


@pytest.mark.parametrize("kind", ["tilted", "anamorphic"])
def test_other_wavelengths_land_where_they_alone_would(kind: str) -> None:
    """Reprojected ones against the mean over pictures of one wavelength a path."""
    camera = SKEW[kind].with_(f_stop=2.5, **({} if kind == "anamorphic" else SHIFTED))
    scene = dg.Scene()
    mesh = scene.add_mesh(*scenes.quad(0.05))
    shining = dg.Material(dg.Diffuse((0, 0, 0)), emission=(3, 3, 3))
    for x, y in ((-1.0, 0.5), (-0.6, -0.3), (0.1, 0.0)):
        scene.add_instance(mesh, shining, scenes.at(x, y, -AWAY))
    scene.set_environment(color=(0.1, 0.1, 0.1))
    options: Any = {"resolution": (96, 64), "filter": "box", "crop": (0, 8, 48, 48)}
    both = batch_means(scene, camera, 8, 16, **options)
    alone = batch_means(scene, camera, 8, 64, seed=50, dispersion="end_secondary", **options)
    assert not differences(both, alone)
    assert differences(both * 1.03, alone)


def test_an_anamorphic_picture_says_how_to_view_it() -> None:
    camera = SKEW["anamorphic"]
    lens = lenses.load(str(camera.lens))
    squeeze = lens.first_order().efl / lens.first_order(section="x").efl
    assert lens.squeeze == pytest.approx(squeeze)
    assert 1.8 < squeeze < 2.1
    session = dg.Session(dg.Scene(), camera, resolution=(36, 30))
    assert any(f"width by {squeeze:.3g}" in note for note in session.notes)
    assert attributes(session.metadata)["pixelAspectRatio"] == pytest.approx(squeeze)
    flat = dg.Session(dg.Scene(), camera.with_(lens_model="thick"), resolution=(36, 30))
    assert flat.metadata["pixelAspectRatio"] == 1
    assert any("does not squeeze" in note for note in flat.notes)
    assert lenses.load(LENS).squeeze == 1


def test_an_anamorphic_picture_is_as_wide_as_its_metadata_says() -> None:
    """Far points near the axis, by world-to-NDC and by the lens's own chief rays."""
    camera = SKEW["anamorphic"].with_(focus_distance=math.inf)
    session = dg.Session(dg.Scene(), camera, resolution=(249, 207))
    chief = set_up(dg.Scene(), camera, (249, 207), None).core.chief_rays()
    points = np.array([[0.02, 0.0, -1.0], [0.0, 0.02, -1.0]])
    film = np.asarray(chief.film_points(points, True))
    ndc = np.c_[points, np.ones(2)] @ session.metadata["worldToNDC"]
    scaled = ndc[:, :2] / ndc[:, 3:] * np.array(camera.sensor_size) / 2
    np.testing.assert_allclose(scaled, film, atol=0.03 * np.abs(film).max())
    facts = camera_facts(camera, dg.Scene(), resolution=(249, 207))
    width = math.degrees(2 * math.atan(24.9 * facts.squeeze / 2 / 60.55))
    assert facts.field_of_view_deg[0] == pytest.approx(width, rel=1e-3)


def test_chief_rays_at_a_corner_that_stops_some_rays() -> None:
    """Stopped rays have no direction, and no say in the mean."""
    lens = lenses.load("schneider-anamorphic-60mm")
    settings = _core.ExactLensSettings(f_stop=4.0, focus_distance_m=5.0)
    exact = _core.ExactLens(lens.prescription, settings)
    u = (np.indices((48, 48)).reshape(2, -1).T + 0.5) / 48
    film = np.array([[14.345, 10.52]])
    many = np.repeat(film, len(u), axis=0).astype(np.float32)
    nm = np.full(len(u), 587.56, np.float32)
    _, directions, weights, _ = exact.generate(many, u.astype(np.float32), nm)
    on = weights > 0
    mean = (weights[on, None] * directions[on]).sum(axis=0, dtype=np.float64)
    camera = _core.Camera.exact(_core.Motion.still(np.eye(4)), exact)
    chief = camera.chief_rays().rays(film)[1][0]
    np.testing.assert_allclose(chief, mean / np.linalg.norm(mean), atol=1e-3)
