"""The construction kit: systems from elements, from lenses and from ghosts, against exact rays."""

from __future__ import annotations

import dataclasses
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
import daguerre.polynomial as po
from daguerre.errors import InputError, UsageError
from daguerre.lenses import glasses
from tests.support.lenses.lens_names import CLASSICS

D_LINE = 587.5618
ROOT = Path(__file__).resolve().parents[2]


def rays_through(lens, count=200, share=0.3, seed=4):
    """Rays on the plane of the first vertex, well inside pupil and field; the same on the film."""
    order, rng = lens.first_order(), np.random.default_rng(seed)
    field = share * min(0.35, 20 / abs(order.efl))
    pupil = share * order.entrance_pupil.diameter / 2
    slopes = rng.uniform(-field, field, (count, 2))
    points = rng.uniform(-pupil, pupil, (count, 2)) - order.entrance_pupil.z * slopes
    cosines = slopes / np.sqrt(1 + (slopes**2).sum(1, keepdims=True))
    rays = np.hstack([points, cosines])
    return rays, exact(lens, rays, lens.image_z)


def exact(lens, rays, film_z, ghost=None, clip=False):
    """The exact rays on the film; NaN where they do not arrive."""
    dz = np.sqrt(1 - (rays[:, 2:] ** 2).sum(1, keepdims=True))
    origins = np.hstack([rays[:, :2], np.zeros_like(dz)])
    p, d, _, _, _, stopped = lens.prescription.rays(
        origins, np.hstack([rays[:, 2:], dz]), np.full(len(rays), D_LINE), clip, ghost=ghost
    )
    out = np.hstack([p[:, :2] + ((film_z - p[:, 2:]) / d[:, 2:]) * d[:, :2], d[:, :2]])
    out[stopped >= 0] = np.nan
    return out


@pytest.mark.parametrize("name", CLASSICS)
def test_the_error_of_a_lens_falls_with_rays_and_degree(name):
    lens = dg.lenses.load(name)
    before = np.inf
    for degree in (1, 3, 5):
        system = po.from_lens(lens, degree)
        errors = []
        for share in (0.2, 0.1):
            rays, wanted = rays_through(lens, share=share)
            errors.append(np.abs(system(rays) - wanted)[:, :2].max())
        assert np.log2(errors[0] / errors[1]) == pytest.approx(degree + 2, abs=0.35)
        assert errors[1] < 0.1 * before
        before = errors[1]


@pytest.mark.parametrize("name", CLASSICS)
def test_degree_one_is_the_matrix_of_the_lens(name):
    lens = dg.lenses.load(name)
    order = lens.first_order()
    system = po.from_lens(lens, 1, object_z=order.front_focal_point, film_z=order.back_focal_point)
    f = order.efl
    wanted = np.kron([[0, f], [-1 / f, 0]], np.eye(2))
    np.testing.assert_allclose(system.matrix, wanted, atol=1e-12 * abs(f))


@pytest.mark.parametrize("name", CLASSICS)
@pytest.mark.parametrize("distance", [np.inf, 3000.0])
def test_degree_three_is_the_seidel_sums_of_the_prescription(name, distance):
    lens = dg.lenses.load(name)
    order = lens.first_order()
    gap = distance - order.entrance_pupil.z + order.front_focal_point  # to the front focus, mm
    film = order.back_focal_point
    if np.isfinite(distance):
        # Newton: x x' = f^2, with x from the object to the front focus.
        film += order.efl**2 / gap
    system = po.from_lens(lens, 3, film_z=film, object_z=-7.0)
    assert system.pupil == pytest.approx(order.entrance_pupil.z + 7)
    rows, _, convergence = lens.prescription.seidel(D_LINE, 5.0, 0.2, distance)
    terms = system.seidel(object_distance=distance)
    wanted = rows[:, :5].sum(axis=0)
    np.testing.assert_allclose(
        terms.sums(5.0, 0.2), wanted, rtol=1e-8, atol=1e-9 * np.abs(rows).max()
    )
    assert 5.0 * terms.convergence == pytest.approx(convergence)


def test_the_sums_of_one_surface_into_glass():
    """Welford's S1 = -A^2 h (u'/n' - u/n), A = n (h c + u), behind which lies glass."""
    system = po.propagate(120) @ po.refract(po.sphere(40), 1.0, 1.5)
    assert system.matrix[0, 0] == pytest.approx(0, abs=1e-12)
    h, slope = 3.0, -3.0 * 0.5 / 40 / 1.5
    assert system.seidel().sums(h, 0.1)[0] == pytest.approx(-((h / 40) ** 2) * h * slope / 1.5)


def test_a_pupil_is_seen_through_what_is_put_before_it():
    lens = po.from_lens("tessar-50mm-f2.8")
    assert lens.pupil is not None
    assert (lens @ po.propagate(10)).pupil == pytest.approx(lens.pupil + 10)
    before = po.propagate(7) @ po.refract(po.sphere(-90), 1.5, 1.0) @ po.propagate(5)
    pupil = (lens @ before).pupil
    assert pupil is not None
    # A paraxial ray from the axis there crosses the axis again at the lens's own pupil.
    x, _, d, _ = before.matrix @ [-pupil * 0.1, 0, 0.1, 0]
    assert x + lens.pupil * d == pytest.approx(0, abs=1e-12)


def test_a_lens_in_three_lines():
    system = (
        po.refract(po.sphere(-50), 1.5, 1.0) @ po.propagate(5) @ po.refract(po.sphere(50), 1.0, 1.5)
    )
    power = 0.5 / 50 + 0.5 / 50 - 5 / 1.5 * (0.5 / 50) ** 2  # the lensmaker's
    assert system.matrix[2, 0] == pytest.approx(-power)
    text = str(system)
    for name in ("spherical", "coma", "astigmatism", "field curvature", "distortion"):
        assert name in text
    assert repr(system) == text


def test_the_right_one_comes_first():
    bend, go = po.refract(po.sphere(30), 1.0, 1.6), po.propagate(10)
    ray = np.array([1.0, 0.5, 0.02, -0.01])
    np.testing.assert_allclose((bend @ go)(ray), bend(go(ray)), atol=1e-8)
    assert abs((go @ bend)(ray) - bend(go(ray))).max() > 1e-3


def test_elements_against_closed_forms():
    d = np.array([0.3, -0.1])
    go = po.propagate(10, degree=15)(np.array([1.0, 2.0, *d]))
    np.testing.assert_allclose(go[:2], [1, 2] + 10 * d / np.sqrt(1 - d @ d), rtol=1e-8)
    # A plane divides the cosines by the ratio of the indices; a mirror leaves those of its plane.
    into = po.refract(po.plane(), 1.0, 1.5)(np.array([1.0, 2.0, *d]))
    np.testing.assert_allclose(into, [1, 2, *(d / 1.5)])
    np.testing.assert_allclose(po.reflect(po.plane())(np.array([1.0, 2.0, *d])), [1, 2, *d])
    # A concave mirror (its centre behind the light that arrives) has the focus R / 2 in front.
    assert po.reflect(po.sphere(-100)).matrix[2, 0] == pytest.approx(-2 / 100)
    # A paraboloid has no spherical aberration for an object at infinity.
    focus = po.propagate(50, degree=9) @ po.reflect(po.conic(-100, -1), degree=9)
    np.testing.assert_allclose(focus(np.array([[20.0, 5.0, 0, 0]]))[0, :2], 0, atol=1e-6)
    assert abs(focus.seidel().spherical) < 1e-18
    # Cylinders bend across their axis, and a toroid in both sections.
    across = po.refract(po.cylinder(40, "x"), 1.0, 1.5).matrix
    assert across[2, 0] == 0
    assert across[3, 1] == pytest.approx(-0.5 / 1.5 / 40)
    both = po.refract(po.toroid(40, 80), 1.0, 1.5).matrix
    assert both[2, 0] == pytest.approx(-0.5 / 1.5 / 40)
    assert both[3, 1] == pytest.approx(-0.5 / 1.5 / 80)
    same = po.refract(po.asphere(np.inf, {2: 1 / 80}), 1.0, 1.5).matrix
    np.testing.assert_allclose(same, po.refract(po.sphere(40), 1.0, 1.5).matrix)


def test_a_decentred_surface_is_expanded_about_the_ray_that_reaches_it():
    shift, tilt = (1.0, -0.5, 0.0), (2.0, 1.0, 0.0)
    tessar = dg.lenses.load("tessar-50mm-f2.8")
    front, rear, stop = (tessar.surfaces[i] for i in (0, 1, 4))
    lens = tessar.rebuilt([front, rear, stop]).decentered((0, 0), shift[:2], tilt[:2])
    n = front.core_glass.index(D_LINE)
    into = po.place(shift, tilt)
    system = po.refract(po.sphere(front.radius), 1.0, n, about=into.image) @ into
    with pytest.raises(UsageError, match="about the ray on which the first ends"):
        _ = po.place(shift, tilt, back=True) @ system
    system = po.place(shift, tilt, back=True, about=system.image) @ system
    system = po.propagate(front.thickness, about=system.image) @ system
    system = po.refract(po.plane(), n, 1.0, about=system.image) @ system
    system = po.propagate(40, about=system.image) @ system
    whole = po.from_lens(lens, film_z=front.thickness + 40)
    assert abs(whole.image[1]) > 0.1
    np.testing.assert_allclose(system.coefficients, whole.coefficients, rtol=1e-9, atol=1e-12)
    assert "base ray" in str(whole)
    with pytest.raises(UsageError, match="axial symmetry"):
        whole.seidel()


def test_inverse_jacobian_and_truncation():
    lens = dg.lenses.load("tessar-50mm-f2.8")
    system = po.from_lens(lens, 7)
    rays = rays_through(lens, 20, 0.15)[0]
    np.testing.assert_allclose((system.inverse() @ system)(rays), rays, atol=1e-9)
    np.testing.assert_array_equal(
        system.truncated(3).coefficients, po.from_lens(lens, 3).coefficients
    )
    h = 1e-6
    for v in range(4):
        step = h * np.eye(4)[v]
        slope = (system(rays + step) - system(rays - step)) / (2 * h)
        np.testing.assert_allclose(system.jacobian(rays)[:, :, v], slope, atol=1e-6)
    assert system.monomials.shape == (330, 4)
    assert system.coefficients.shape == (4, 330)
    np.testing.assert_allclose(
        system(rays[0]),
        system.coefficients @ np.prod(rays[0] ** system.monomials, axis=1),
        rtol=1e-12,
    )


def test_wavelengths():
    lens = dg.lenses.load("double-gauss-50mm-f2")
    nodes = po.wavelength_nodes(400, 700, 9)
    system = po.from_lens(lens, 5, wavelength=nodes)
    assert system.coefficients.shape == (9, 4, 126)
    rays = rays_through(lens, 30)[0]
    nm = np.random.default_rng(2).uniform(400, 700, 30)
    alone = [po.from_lens(lens, 5, wavelength=x)(ray) for x, ray in zip(nm, rays, strict=True)]
    np.testing.assert_allclose(system(rays, nm), alone, atol=2e-6)
    np.testing.assert_allclose(system.at(nm[0])(rays[0]), alone[0], atol=2e-6)
    glass = glasses.find("N-BK7")
    bend = po.refract(po.sphere(50), 1.0, glass, wavelength=nodes)
    one = po.refract(po.sphere(50), 1.0, float(glass.index(nodes[2])))
    np.testing.assert_allclose(bend.coefficients[2], one.coefficients)
    assert (po.propagate(3) @ bend).wavelengths.tolist() == nodes.tolist()
    with pytest.raises(UsageError, match="a wavelength between 400, 700 nm"):
        system(rays, 710)
    with pytest.raises(UsageError, match="same wavelengths"):
        _ = bend @ po.refract(po.plane(), 1.0, glass)


def test_reverse_is_the_way_back():
    lens = dg.lenses.load("sonnar-50mm-f2").focused(2.0)
    there, back = po.from_lens(lens, 7), po.from_lens(lens, 7, reverse=True)
    rays = rays_through(lens.lens, 20, 0.15)[0]
    turn = np.array([1, 1, -1, -1])
    np.testing.assert_allclose(back(there(rays) * turn) * turn, rays, atol=1e-6)


@pytest.mark.parametrize("ghost", [(1, 0), (2, 1), (6, 3), (7, 0)])
def test_spots_of_ghosts_against_the_exact_trace(ghost):
    """Parallel light at 3 degrees: the ghost's spot on the film, its centre and its size."""
    lens = dg.lenses.load("tessar-50mm-f2.8")
    pupil = 0.35 * lens.first_order().entrance_pupil.diameter / 2
    u = np.linspace(-1, 1, 21)
    points = np.stack(np.meshgrid(u, u), -1).reshape(-1, 2)
    points = pupil * points[np.hypot(*points.T) <= 1]
    rays = np.hstack([points, np.tile([0.0, np.sin(np.radians(3))], (len(points), 1))])
    wanted = exact(lens, rays, lens.image_z, ghost)[:, :2]
    assert np.isfinite(wanted).all()
    size = np.sqrt(((wanted - wanted.mean(0)) ** 2).sum(1).mean())
    errors = []
    for degree in (1, 3, 5, 7):
        spot = po.from_lens(lens, degree, ghost=ghost)(rays)[:, :2]
        errors.append(np.sqrt(((spot - wanted) ** 2).sum(1).mean()) / size)
    assert errors[3] < errors[2] < errors[1] < errors[0]
    assert errors[3] < 5e-3
    # Either order names the same ghost, and the iris lies on its way.
    one, other = ghost
    same = po.from_lens(lens, 3, ghost=(other, one))
    np.testing.assert_array_equal(
        same.coefficients, po.from_lens(lens, 3, ghost=ghost).coefficients
    )
    assert po.from_lens(lens, 3, ghost=ghost, to_iris=-1).matrix.shape == (4, 4)


@pytest.mark.parametrize("ghost", [(0, 1), (2, 1), (6, 3), (7, 5)])
def test_the_light_of_a_ghost_is_that_of_its_reflections(ghost):
    """On the axis, surfaces without coatings reflect ((n1 - n2) / (n1 + n2))^2."""
    lens = dg.lenses.load("tessar-50mm-f2.8")
    lens = dataclasses.replace(lens, coating="uncoated").rebuilt(lens.surfaces)
    axis = (np.array([[0.0, 0.0, -5.0]]), np.array([[0.0, 0.0, 1.0]]), np.array([D_LINE]))
    n = [1.0] + [s.core_glass.index(D_LINE) for s in lens.surfaces]
    r = [((a - b) / (a + b)) ** 2 for a, b in pairwise(n)]
    near, far = sorted(ghost)
    wanted = r[near] * r[far]
    for i in [*range(far), *range(near + 1, far), *range(near + 1, len(r))]:
        wanted *= 1 - r[i]
    for order in (ghost, ghost[::-1]):
        for to_film in (True, False):
            start = axis[0] if to_film else axis[0] + [0, 0, 200]
            way = axis[1] if to_film else -axis[1]
            found = lens.prescription.rays(start, way, axis[2], False, to_film, ghost=order)
            assert found[5][0] == -1
            assert found[4][0] == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: po.from_lens("tessar-50mm-f2.8", 0), "1 to 15"),
        (lambda: po.from_lens("tessar-50mm-f2.8", 16), "1 to 15"),
        (lambda: po.from_lens("tessar-50mm-f2.8", 2.5), "1 to 15"),
        (lambda: po.from_lens("tessar-50mm-f2.8", ghost=(1, 1)), "two surfaces"),
        (lambda: po.from_lens("tessar-50mm-f2.8", ghost=(1, 99)), r"surfaces of 0 \.\. "),
        (lambda: po.from_lens("tessar-50mm-f2.8", ghost="ab"), "ghost: surface"),
        (lambda: po.from_lens("tessar-50mm-f2.8", wavelength=[600, 500]), "ascend"),
        (
            lambda: po.from_lens("tessar-50mm-f2.8", about=(0, 0, 0.95, 0)),
            "surface 3: Taylor expansion",
        ),
        (lambda: po.from_lens("tessar-50mm-f2.8", about=(0, 0, 1, 0)), "goes forward"),
        (lambda: po.from_lens("tessar-50mm-f2.8", to_iris=1), "crossing of the iris"),
        (lambda: po.refract(po.asphere(40, {3: 1e-5}), 1.0, 1.5), "odd powers of r at the vertex"),
        (lambda: po.refract(po.sphere(40), 1.0, -1.5), "refractive index"),
        (lambda: po.refract(po.plane(), 1.5, 1.0, about=(0, 0, 0.9, 0)), "totally reflected"),
        (lambda: po.sphere(0), "other than 0"),
        (lambda: po.propagate(np.nan), "distance in mm: wanted a number, got nan"),
        (lambda: po.propagate(1, about=(0, 0, 0)), "a ray"),
        (lambda: po.propagate(1)(np.zeros(3)), "shape"),
        (lambda: po.propagate(1, degree=1).seidel(), "degree of at least 3"),
        (lambda: po.refract(po.cylinder(40), 1.0, 1.5).seidel(), "axial symmetry"),
        (lambda: po.from_lens("tessar-50mm-f2.8", "seven"), "1 to 15"),
        (lambda: po.from_lens("tessar-50mm-f2.8", np.array([3, 5])), "1 to 15"),
        (lambda: po.from_lens("tessar-50mm-f2.8", ghost=(1.5, 2)), "whole number"),
        (lambda: po.from_lens("tessar-50mm-f2.8", ghost=(np.inf, 1)), "ghost: surface"),
        (lambda: po.from_lens("tessar-50mm-f2.8", ghost=(10**30, 1)), "ghost: surface"),
        (lambda: po.from_lens("tessar-50mm-f2.8", ghost=(4, 1)), "surface 4, which has one medium"),
        (lambda: po.from_lens("tessar-50mm-f2.8", to_iris="first"), "whole number"),
        (lambda: po.from_lens("tessar-50mm-f2.8", wavelength=1), "200 to 2500 nm"),
        (lambda: po.from_lens("tessar-50mm-f2.8", wavelength="red"), "wanted nm, got 'red'"),
        (lambda: po.from_lens("tessar-50mm-f2.8", film_z="far"), "film_z: wanted a number"),
        (lambda: po.from_lens("tessar-50mm-f2.8", about="axis"), "x, y, dx, dy"),
        (lambda: po.propagate("far"), "wanted a number, got 'far'"),
        (lambda: po.sphere("flat"), "radius in mm: wanted a number"),
        (lambda: po.conic(50, np.float32("nan")), "conic: k"),
        (lambda: po.asphere(50, {4: np.nan}), r"coefficient of r\^4"),
        (lambda: po.asphere(50, {"four": 1e-6}), "power of r: wanted a whole number"),
        (lambda: po.asphere(50, [1e-6]), "coefficients by power of r"),
        (lambda: po.refract(50, 1.0, 1.5), r"form: wanted a form such as sphere\(50\)"),
        (lambda: po.reflect(None), "form: wanted"),
        (lambda: po.refract(po.sphere(50), 1.0, "N-BK7"), "refractive index: wanted a glass"),
        (lambda: po.place("up"), "decenter: wanted three finite numbers"),
        (lambda: po.wavelength_nodes(400, 700, 2.5), "2 to 64"),
        (lambda: po.wavelength_nodes("violet", 700, 3), "wanted a number above 0"),
        (lambda: po.propagate(1)("ray"), r"rays: wanted \(x, y, dx, dy\)"),
        (lambda: po.propagate(1).truncated(2.5), "whole number"),
        (lambda: po.propagate(1).at(None), "wavelength in nm"),
        (lambda: po.propagate(1).seidel(object_distance=0), "must not be 0 mm"),
        (lambda: po.propagate(1).seidel(pupil=np.nan), "pupil in mm"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises((InputError, UsageError), match=message):
        make()


def test_the_place_of_what_has_no_expansion_is_named():
    lens = dg.lenses.load("tessar-50mm-f2.8")
    surfaces = list(lens.surfaces)
    surfaces[3] = surfaces[3].replaced(kind="aspheric", asphere={5: 1e-8})
    with pytest.raises(InputError, match=r"surface 3: Taylor expansion: .*smooth") as error:
        po.from_lens(lens.rebuilt(surfaces))
    assert lens.source in str(error.value)


def test_the_page_runs_and_prints_what_it_says(capsys):
    """The blocks of docs/polynomial.md up to the fitted lenses, one after another."""
    page = (ROOT / "docs" / "polynomial.md").read_text().split("## Fitted lenses")[0]
    names: dict[str, object] = {}
    printed = []
    for block in re.findall(r"```python\n(.*?)```", page, re.DOTALL):
        exec(compile(block, "docs/polynomial.md", "exec"), names)
        printed.append(capsys.readouterr().out)
    (shown,) = re.findall(r"```\n\n```\n(.*?)```", page, re.DOTALL)
    assert printed[0] == shown
    spot = names["spot"]
    assert isinstance(spot, np.ndarray)
    assert spot.shape == (2, 2)
    assert np.isfinite(spot).all()


def test_every_function_of_the_kit_is_on_its_page():
    page = (ROOT / "docs" / "polynomial.md").read_text()
    modules = ("elements", "forms", "lens_system", "system", "terms", "wavelengths")
    kit = [n for n in po.__all__ if getattr(po, n).__module__.rsplit(".")[-1] in modules]
    assert len(kit) > 12
    assert [n for n in kit if n not in page] == []
