"""The lens on the bench against closed forms, third-order theory and two other programs."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daguerre import _core, analysis, lenses
from daguerre.analysis.bench import Bench
from daguerre.analysis.illumination import Illumination
from daguerre.errors import InputError
from tests.lenses.test_lenses import WAVELENGTHS, lens_of, reference

D = 587.5618


@pytest.fixture(scope="module")
def gauss() -> lenses.Lens:
    return lenses.load("double-gauss-50mm-f2")


def made(folder: Path, surfaces: list[dict[str, Any]], **more: Any) -> lenses.Lens:
    path = folder / "made.json"
    path.write_text(json.dumps({"schema": "daguerre-lens/0.1", "surfaces": surfaces, **more}))
    return lenses.load(path)


def singlet(folder: Path, semi_diameter: float = 8.0) -> lenses.Lens:
    """A plano-convex lens, curved to the film, stop in front: much spherical aberration."""
    glass = {"nd": 1.5, "vd": None}
    return made(
        folder,
        [
            {"kind": "stop", "radius": None, "thickness": 0.001, "semi_diameter": semi_diameter},
            {"kind": "spherical", "radius": None, "thickness": 3, "glass": glass},
            {"kind": "spherical", "radius": -50, "thickness": None},
        ],
        coating="perfect",
    )


# Seidel sums ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["double_gauss_100mm", "cooke_triplet_50mm"])
def test_seidel_sums_agree_with_another_program(name: str, tmp_path: Path) -> None:
    data = reference(name)
    lens = lens_of(data, tmp_path)
    radius = 0.5 * data["entrance_pupil_diameter_mm"]
    slope = math.tan(math.radians(data["full_half_field_deg"]))
    sums, invariant, _ = lens.prescription.seidel(WAVELENGTHS["d"], radius, slope)
    theirs = data["seidel_rayoptics"]["per_surface"]
    for i, row in enumerate(sums):
        expected = [theirs[str(i + 1)][f"S-{k}"] for k in ("I", "II", "III", "IV", "V")]
        np.testing.assert_allclose(row[:5], expected, rtol=1e-6, atol=1e-9)
    assert abs(invariant) == pytest.approx(
        data["paraxial_d"]["rayoptics"]["optical_invariant"], rel=1e-6
    )


# Spots and focus ------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["double_gauss_100mm", "cooke_triplet_50mm"])
def test_spots_and_distortion_agree_with_two_programs(name: str, tmp_path: Path) -> None:
    data = reference(name)
    lens = lens_of(data, tmp_path)
    order = lens.first_order(WAVELENGTHS["d"])
    f_stop = order.efl / data["entrance_pupil_diameter_mm"]
    bench = unmounted(lens, f_stop)
    expected = data["spot_rms_centroid_d"][0]
    on_axis = analysis.pencil(bench)
    assert on_axis is not None
    rms = analysis.spot(on_axis, [WAVELENGTHS["d"]], [1], grid=96).rms
    assert 1e3 * rms == pytest.approx(expected["check_rms_radius_um"], rel=0.02)
    # Their chief rays aim at the paraxial pupil, ours at the real stop: a third-order step apart.
    row = data["distortion_chief_through_paraxial_entrance_pupil_d"][0]
    height = analysis.film_heights(bench, [row["field_deg"]])[0]
    assert height == pytest.approx(row["check_chief_y"], rel=2e-3)


def unmounted(lens: lenses.Lens, f_stop: float) -> Bench:
    """A lens whose file says no diameters, at the film of its table."""
    order = lens.first_order()
    radius = 0.5 * order.efl / f_stop
    # Stop size from the pupil's: by a paraxial ray, since the file has none.
    ray = lens.prescription.rays(
        np.array([[0, 1e-4 * radius, -10.0]]), np.array([[0, 0, 1.0]]), np.array([D]), False
    )
    iris = abs(float(ray[2][0, 1])) * 1e4
    return Bench(lens, f_stop, iris, lens.image_z, math.inf, 20.0, order)


def test_best_focus_of_one_spot_is_the_cores(gauss: lenses.Lens) -> None:
    bench = analysis.set_up(gauss, by="paraxial")
    light = analysis.pencil(bench)
    assert light is not None
    found = analysis.best_film_z([analysis.spot(light, grid=128)], bench.film_z)
    best = analysis.set_up(gauss)
    assert found == pytest.approx(best.film_z, abs=2e-3)
    # Neighbouring films are worse.
    here = analysis.spot(analysis.pencil(best), grid=64)  # type: ignore[arg-type]
    assert here.rms < min(here.moved(0.02).rms, here.moved(-0.02).rms)


def test_blur_of_a_point_out_of_focus_is_the_circle_of_confusion(gauss: lenses.Lens) -> None:
    """CoC = |s - s_f| / s * f^2 / (N (s_f - f)), distances from the thin lens (from the pupil)."""
    f_stop, focus = 16.0, 3000.0
    bench = analysis.set_up(gauss, f_stop=f_stop, focus_m=focus / 1e3, by="paraxial")
    f = bench.order.efl
    for distance in (1500.0, 2500.0, 6000.0, 1e6):
        light = analysis.pencil(bench, distance_mm=distance)
        assert light is not None
        points = analysis.spot(light, [D], [1], grid=96).points
        circle = abs(distance - focus) / distance * f**2 / (f_stop * (focus - f))
        # 2 %: the pupil is not in the front principal plane, from which the formula counts;
        # 0.8 um: what is left of aberrations.
        assert np.ptp(points[:, 1]) == pytest.approx(circle, rel=0.02, abs=8e-4)


def test_soap_bubble_of_a_singlet(tmp_path: Path) -> None:
    """I(r) / I(0) = 1 / |(1 + k r^2)(1 + 3 k r^2)|, k = B / A of y = A r + B r^3 (Seidel)."""
    bench = analysis.set_up(singlet(tmp_path), f_stop=24, by="paraxial")
    rows, _, convergence = bench.lens.prescription.seidel(D, 0.5 * bench.order.efl / 24, 0.0)
    b = 0.5 * rows[:, 0].sum() / convergence
    for k in (-0.25, 0.5):  # in front of the focus and behind it: ringed, and soft
        defocus = b / (k * convergence)
        light = analysis.pencil(bench.moved(bench.film_z + defocus))
        assert light is not None
        spot = analysis.spot(light, [D], [1], grid=400)
        share = np.linspace(0, 1, 21)
        edge = abs(defocus * convergence) * (share + k * share**3)
        energy = spot.encircled_energy(edge)
        np.testing.assert_allclose(energy, share**2, atol=1e-2)
        # The density of light is the formula's: the rim of one is brighter than its middle.
        bright = np.diff(energy) / np.diff(edge**2)
        middle = np.sqrt(0.5 * (share[1:] ** 2 + share[:-1] ** 2))
        formula = 1 / np.abs((1 + k * middle**2) * (1 + 3 * k * middle**2))
        scale = bright[5:].sum() / formula[5:].sum()
        np.testing.assert_allclose(bright[5:-1], scale * formula[5:-1], rtol=0.06)
        assert (bright[-2] > 2 * bright[5]) == (k < 0)


# Waves ----------------------------------------------------------------------------------------


def test_a_stopped_lens_has_the_mtf_of_a_perfect_one(gauss: lenses.Lens) -> None:
    bench = analysis.set_up(gauss, f_stop=16)
    light = analysis.pencil(bench)
    assert light is not None
    f = np.array([0, 10, 25, 50, 80, 105, 200.0])
    mtf = analysis.diffraction_mtf(light, f, [550], [1], grid=128)
    perfect = analysis.perfect_mtf(f, 16, 550)
    np.testing.assert_allclose(mtf, np.column_stack([perfect, perfect]), atol=2e-3)


def test_a_stopped_lens_has_airys_disc(gauss: lenses.Lens) -> None:
    """First dark ring at 1.22 lambda N; 83.8 % of the light within it (Born and Wolf 8.5.2)."""
    bench = analysis.set_up(gauss, f_stop=16)
    light = analysis.pencil(bench)
    assert light is not None
    ring = 1.22e-6 * 550 * 16
    psf = analysis.diffraction_psf(light, [550], [1], half_mm=2 * ring, pixels=200)
    assert psf is not None
    x, y = np.meshgrid(psf.axis_mm, psf.axis_mm)
    radius = np.hypot(x, y)
    assert psf.image[radius < ring].sum() == pytest.approx(0.838, abs=3e-3)
    dark = np.abs(radius - ring) < psf.pixel_mm
    assert psf.image[dark].max() < 2e-3 * psf.image.max()
    wave = analysis.wavefront(light, 550)
    assert wave is not None
    assert wave.rms_waves < 0.02
    assert analysis.strehl_ratio(wave) > 0.99


def test_optical_paths_agree_with_another_program(tmp_path: Path) -> None:
    """Ours are about plane waves, theirs about a sphere: apart by (where rays land)^2 / 2 R."""
    theirs = json.loads(
        (Path(__file__).parents[1] / "data/wavefront_cooke_triplet.json").read_text()
    )
    lens = lens_of(reference("cooke_triplet_50mm"), tmp_path)
    bench = unmounted(lens, lens.first_order(D).efl / 10)
    for field in theirs["fields"]:
        light = analysis.pencil(bench, float(analysis.film_heights(bench, [field["field_deg"]])[0]))
        assert light is not None
        z = bench.order.entrance_pupil.z
        to_pupil = (z - light.center[2]) / light.direction[2]
        at = np.column_stack([field["x"], field["y"], np.zeros(len(field["x"]))]) * 5
        middle = light.center + to_pupil * light.direction
        paths = _paths(light, np.concatenate([[middle], middle + at]))
        opd = -(paths[1:] - paths[0]) / (1e-6 * D)
        np.testing.assert_allclose(opd, field["opd_waves"], atol=0.01)
        assert np.ptp(opd) > 0.5


def _paths(light: analysis.Pencil, points: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Optical paths from a plane wave through points to the image point, mm."""
    back = (points - light.center) @ light.direction + 50
    origins = points - back[:, None] * light.direction
    rays = light.bench.rays(origins, np.tile(light.direction, (len(points), 1)), D, clip=False)
    image = np.array([*light.film, light.bench.film_z])
    return np.asarray(rays.path + ((image - rays.points) * rays.directions).sum(axis=1))


def test_waves_bend_as_their_rays_do(gauss: lenses.Lens) -> None:
    """Malus: the gradient of W over directions is where the rays land, off axis too."""
    bench = analysis.set_up(gauss)
    light = analysis.pencil(bench, 12.0)
    assert light is not None
    wave = analysis.wavefront(light, grid=96)
    assert wave is not None
    landing = -np.gradient(np.where(wave.lit, wave.path, np.nan), wave.step, axis=0)
    at = light.grid(40)
    rays = light.trace(at)
    off = light.on_film(rays.at(bench.film_z))
    cosines = light.on_film(light.film + rays.directions[:, :2])
    cell = np.rint((cosines - wave.cosines[0, 0]) / wave.step).astype(int)
    inside = rays.passed & (cell >= 0).all(axis=1) & (cell < 96).all(axis=1)
    step = landing[cell[inside, 1], cell[inside, 0]] - off[inside, 1]
    assert np.isfinite(step).sum() > 500
    assert np.nanmedian(np.abs(step)) < 5e-4
    assert np.nanmax(np.abs(step)) < 8e-3
    assert np.ptp(off[inside, 1]) > 0.1


def test_rays_that_miss_the_grid_of_directions_are_made_good(
    gauss: lenses.Lens, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A coarse fit of the window sends rays beside the grid of directions: W is hardly moved."""
    light = analysis.pencil(analysis.set_up(gauss), 12.0)
    assert light is not None
    fine = analysis.wavefront(light, grid=48)
    monkeypatch.setattr("daguerre.analysis.wavefronts.DEGREE", 2)
    coarse = analysis.wavefront(light, grid=48)
    assert fine is not None
    assert coarse is not None
    both = fine.lit & coarse.lit
    off = (coarse.path - fine.path)[both]
    assert np.std(off) < 0.02 * np.std(fine.path[both])
    assert np.std(off) < 5e-5


def test_a_moved_film_is_another_bench(gauss: lenses.Lens) -> None:
    bench = analysis.set_up(gauss)
    here, there = (analysis.pencil(b) for b in (bench, bench.moved(bench.film_z + 0.3)))
    assert here is not None
    assert there is not None
    assert analysis.spot(here).moved(0.3).rms == pytest.approx(analysis.spot(there).rms, rel=1e-3)
    waves, moved = analysis.wavefront(here), analysis.wavefront(there)
    assert waves is not None
    assert moved is not None
    assert waves.defocused(0.3).rms_waves == pytest.approx(moved.rms_waves, rel=1e-3)


def test_waves_and_rays_agree_where_aberrations_are_large(gauss: lenses.Lens) -> None:
    bench = analysis.set_up(gauss)
    light = analysis.pencil(bench, 8.0)
    assert light is not None
    f = np.array([3.0, 6.0, 10.0])
    waves = analysis.diffraction_mtf(light, f)
    rays = analysis.geometric_mtf(analysis.spot(light, grid=128), f)
    # Diffraction itself takes a few per cent at f/2; the rest is common to both.
    np.testing.assert_allclose(waves, rays, atol=0.04)
    light = analysis.pencil(bench.stopped(4), 8.0)
    assert light is not None
    psf = analysis.diffraction_psf(light, [D], [1], half_mm=0.12)
    assert psf is not None
    # Light is conserved, and its centre is the rays'.
    assert psf.image.sum() == pytest.approx(1, abs=0.02)
    assert psf.image.sum(axis=0) @ psf.axis_mm == pytest.approx(0, abs=1e-4)
    assert psf.image.sum(axis=1) @ psf.axis_mm == pytest.approx(0, abs=2e-3)


# The field ------------------------------------------------------------------------------------


def test_field_curvature_is_third_order_close_to_the_axis(gauss: lenses.Lens) -> None:
    """Focus -(S3 + S4) / (2 n'u'^2), sagittal, and -(3 S3 + S4) / (2 n'u'^2), tangential."""
    bench = analysis.set_up(gauss, by="paraxial")
    height = 1.0
    slope = height / bench.order.efl
    rows, _, u = gauss.prescription.seidel(D, 0.5 * bench.order.entrance_pupil.diameter, slope)
    s = rows.sum(axis=0)
    curve = analysis.field_curvature(bench, [0.0, height])
    assert curve.sagittal[0] == pytest.approx(0, abs=1e-5)
    assert curve.sagittal[1] == pytest.approx(-(s[2] + s[3]) / (2 * u**2), rel=0.03)
    assert curve.tangential[1] == pytest.approx(-(3 * s[2] + s[3]) / (2 * u**2), rel=0.03)
    shift = analysis.distortion(bench, [height]).percent[0]
    assert shift == pytest.approx(100 * s[4] / (2 * u) / height, rel=0.03)


def test_a_fisheye_keeps_close_to_its_own_projection() -> None:
    """Olympus's fisheye is equisolid: f x angle would be 10 % off at its edge."""
    bench = analysis.set_up(lenses.load("olympus-zuiko-fisheye-8mm-f2.8"))
    found = analysis.distortion(bench, np.linspace(0, bench.field_mm, 5))
    assert found.law == "equisolid"
    assert np.abs(found.percent).max() < 0.5
    shape = found.ideal_mm[1:] / np.sin(np.radians(found.angle_deg[1:]) / 2)
    assert shape == pytest.approx(shape[0])


def test_a_symmetric_lens_is_astigmatic_off_the_axis_only(gauss: lenses.Lens) -> None:
    bench = analysis.set_up(gauss, f_stop=8)
    for height, apart in ((0.0, 0.0), (15.0, 0.05)):
        light = analysis.pencil(bench, height)
        assert light is not None
        spot = analysis.spot(light, [D], [1])
        # Spots that are narrowest along one axis and along the other lie apart.
        place = [
            -float(np.cov(spot.points[:, k], spot.slopes[:, k])[0, 1])
            / float(spot.slopes[:, k].var())
            for k in range(2)
        ]
        assert abs(place[0] - place[1]) == pytest.approx(apart, abs=1e-3 if apart == 0 else 0.04)


def test_light_on_the_axis_is_that_of_the_marginal_ray(gauss: lenses.Lens) -> None:
    """E / L = pi sin^2: science of a lens without losses; cos^4 falls as both angles say."""
    lens = lenses.load("double-gauss-50mm-f2")
    bench = analysis.set_up(lens, f_stop=8, by="paraxial")
    light = analysis.relative_illumination(bench, [0.0, 5.0])
    edge = analysis.pupil_outline(bench, 0.0)
    sine2 = float((edge[:-1] ** 2).sum(axis=1).mean())
    transmittance = light.irradiance[0] / (math.pi * sine2)
    assert 0.9 < transmittance < 0.99
    assert math.sqrt(sine2) == pytest.approx(1 / 16, rel=2e-3)
    assert light.relative[1] == pytest.approx(light.cos4_film[1], abs=0.02)


def test_mechanical_vignetting_narrows_the_pupil(gauss: lenses.Lens) -> None:
    wide, stopped = analysis.set_up(gauss), analysis.set_up(gauss, f_stop=11)
    for bench, round_there in ((wide, False), (stopped, True)):
        outline = analysis.pupil_outline(bench, 18.0)
        across, along = np.ptp(outline, axis=0)
        ratio = along / across
        # A pupil that nothing cuts is only foreshortened.
        assert (ratio > 0.8) == round_there


def test_colours_come_apart_as_first_order_says(gauss: lenses.Lens) -> None:
    bench = analysis.set_up(gauss, by="paraxial")
    foci = analysis.axial_colour(bench, [486.1327, D, 656.2725])
    for value, nm in zip(foci, (486.1327, D, 656.2725), strict=True):
        expected = gauss.first_order(nm).back_focal_point - bench.order.back_focal_point
        assert value == pytest.approx(expected, abs=1e-9)
    spherical = analysis.spherical_aberration(bench, [0.0, 1.0])
    assert spherical[0] == pytest.approx(0, abs=1e-4)
    lateral = analysis.lateral_colour(bench, [0.0, 10.0])
    assert np.abs(lateral[0]).max() < 1e-9
    assert lateral[1, 1] == pytest.approx(0, abs=1e-9)
    assert abs(lateral[1, 0]) > 1e-4


def test_angles_and_heights_are_inverse(gauss: lenses.Lens) -> None:
    bench = analysis.set_up(gauss)
    heights = analysis.film_heights(bench, [0, 5, 20])
    angles = np.degrees(analysis.chief_rays(bench, heights).angles)
    np.testing.assert_allclose(angles, [0, 5, 20], atol=1e-6)
    assert np.isnan(analysis.film_heights(bench, [80])).all()


def test_settings_that_a_lens_does_not_have_are_errors(gauss: lenses.Lens) -> None:
    with pytest.raises(InputError, match="f/2"):
        analysis.set_up(gauss, f_stop=1.0)
    with pytest.raises(InputError, match="nearest possible"):
        analysis.set_up(gauss, focus_m=0.01)


# The camera and the bench ---------------------------------------------------------------------


def test_a_point_seen_by_the_camera_is_the_benchs_spread(gauss: lenses.Lens) -> None:
    """Camera rays that end in a small ball, weighed and binned on the film, against the PSF.

    The light that the camera records from a ball of radiance 1 is the weights of its rays that hit;
    where it lands is the PSF. The bench sends light from the point, the camera looks for it.
    """
    f_stop, focus, distance, height = 2.0, 3.0, 1.2, 6.0
    bench = analysis.set_up(gauss, f_stop=f_stop, focus_m=focus, by="paraxial")
    light = analysis.pencil(bench, height, distance_mm=1e3 * distance)
    assert light is not None
    assert light.source is not None
    spot = analysis.spot(light, [550], [1], grid=256)
    settings = _core.ExactLensSettings(f_stop=f_stop, focus_distance_m=focus)
    camera = _core.ExactLens(gauss.prescription, settings)
    rng = np.random.default_rng(5)
    half, radius, count = 0.6, 2.0, 1_200_000  # mm on the film, mm of the ball
    # Film points of the camera are upright: the image of the scene, turned.
    off = rng.uniform(-half, half, (count, 2)) + spot.centroid
    film = -(light.film + off).astype(np.float32)
    lens_points = rng.random((count, 2), dtype=np.float32)
    origins, directions, weights, _ = camera.generate(
        film, lens_points, np.full(count, 550, np.float32)
    )
    # Camera frame, m: -z is the view, the pupil's centre the origin; x right, y up.
    pupil_z = bench.order.entrance_pupil.z
    ball = (light.source - [0, 0, pupil_z]) * 1e-3 * [-1, 1, 1]
    ball = ball if ball[1] * directions[weights > 0, 1].mean() > 0 else ball * [1, -1, 1]
    to_ball = ball - origins
    along = (to_ball * directions).sum(axis=1)
    miss = np.linalg.norm(to_ball - along[:, None] * directions, axis=1)
    seen = np.where(miss < 1e-3 * radius, weights, 0.0)
    assert (seen > 0).sum() > 10_000
    # Both along the tangential axis, in bins; the ball's own picture widens the camera's.
    edges = np.linspace(-half, half, 16)
    blur = radius * abs(bench.order.efl) / (1e3 * distance)
    soft = spot.points + disc(rng, len(spot.points)) * blur
    theirs, _ = np.histogram(soft[:, 1] - spot.centroid[1], edges, weights=spot.weights)
    y = off[:, 1] - spot.centroid[1]
    ours, _ = np.histogram(y, edges, weights=seen)
    error, _ = np.histogram(y, edges, weights=seen**2)
    total = seen.sum()
    z = (ours / total - theirs) / np.sqrt(np.maximum(error, error.max() * 1e-3)) * total
    assert theirs.max() > 0.08
    assert np.abs(z).max() < 4.5


def disc(rng: np.random.Generator, count: int) -> np.ndarray[Any, Any]:
    """Points of the picture of a ball: a disc, shape (count, 2)."""
    r, turn = np.sqrt(rng.random(count)), 2 * np.pi * rng.random(count)
    return np.column_stack([r * np.cos(turn), r * np.sin(turn)])


def test_light_relative_to_a_dark_axis_is_unknown() -> None:
    """An iris that is tilted by 89 degrees lets no light through on the axis."""
    dark = Illumination(*np.array([[0.0, 5.0], [0.0, 0.2], [1.0, 0.9], [1.0, 0.9]]))
    assert np.isnan(dark.relative).all()
    lit = Illumination(*np.array([[0.0, 5.0], [0.4, 0.2], [1.0, 0.9], [1.0, 0.9]]))
    assert lit.relative.tolist() == [1.0, 0.5]
