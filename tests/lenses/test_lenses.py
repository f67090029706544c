"""The lens library, its reader, and lenses on the bench, against published numbers."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from daguerre import _core, lenses
from daguerre.errors import InputError, UsageError
from tests.support.lenses.lens_names import CLASSICS

SHARED = Path(__file__).parents[3] / "shared" / "data"
WAVELENGTHS = {"F": 486.1327, "d": 587.5618, "C": 656.2725}


# The library ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CLASSICS)
def test_guided_rays_see_what_a_blind_search_sees(name: str) -> None:
    """A white wall through the lens: the aim against boxes of slopes and the whole last surface."""
    lens = lenses.load(name)
    stop = {"f_stop": lens.nominal.f_number, "focus_distance_m": 4.0}
    drawn = (_core.PupilDraw.aimed, _core.PupilDraw.slope_boxes, _core.PupilDraw.rear_disc)
    exact, *others = (
        _core.ExactLens(lens.prescription, _core.ExactLensSettings(**stop, draw=draw))
        for draw in drawn
    )
    assert exact.aim_fallback_segments == 0
    random = np.random.default_rng(1)
    count, scores = 20000, []
    for radius in (0.0, 5.0, 10.0, 15.0, 20.0):
        film = np.full((count, 2), (0.8 * radius, 0.6 * radius), np.float32)
        means, variances = [], []
        for camera in (exact, *others):
            u = random.random((count, 2), dtype=np.float32)
            weights = camera.generate(film, u, np.full(count, 550, np.float32))[2] * camera.h0
            means.append(weights.mean(dtype=np.float64))
            variances.append(weights.var(dtype=np.float64) / count)
        if max(means) > 0:
            scores += [
                (means[0] - mean) / math.sqrt(variances[0] + variance)
                for mean, variance in zip(means[1:], variances[1:], strict=True)
            ]
    assert max(map(abs, scores)) < 4.5
    assert len(scores) >= 8


def test_unknown_names_get_the_nearest() -> None:
    with pytest.raises(InputError, match="double-gauss-50mm-f2"):
        lenses.load("double-gaus-50mm")
    with pytest.raises(InputError, match="no lens of the library"):
        lenses.load("zzz")
    with pytest.raises(InputError, match="no such file"):
        lenses.load("nowhere/lens.json")
    with pytest.raises(InputError, match="no such file"):
        lenses.load("lens.zmx")


def test_a_lens_is_itself() -> None:
    lens = lenses.load("double-gauss-50mm-f2")
    assert lenses.load(lens) is lens
    with pytest.raises(
        UsageError, match=r"configuration: wanted None for a loaded lens, got 'far'"
    ):
        lenses.load(lens, "far")


# First-order data and exact rays ------------------------------------------------------------------


def reference(name: str) -> dict[str, Any]:
    """Reference data of two independent programs, from the project's data folder."""
    path = SHARED / "reference" / f"{name}.json"
    if not path.is_file():
        pytest.skip(f"no reference data at ../shared/data/reference/{name}.json")
    return dict(json.loads(path.read_text()))


def lens_of(data: dict[str, Any], folder: Path) -> lenses.Lens:
    """The reference's prescription as a lens file, with its indices as tables."""
    surfaces = []
    for s in data["surfaces"]:
        table = [[WAVELENGTHS[line], s["n"][line]] for line in "FdC"]
        is_air = all(n == 1 for _, n in table)
        surfaces.append(
            {
                "kind": "spherical",
                "radius": s["radius"],
                "thickness": s["thickness"],
                "stop": s["stop"],
                "glass": None if is_air else {"table": table},
            }
        )
    path = folder / "reference.json"
    path.write_text(json.dumps({"schema": "daguerre-lens/0.1", "surfaces": surfaces}))
    return lenses.load(path)


@pytest.mark.parametrize("name", ["double_gauss_100mm", "cooke_triplet_50mm"])
def test_rays_agree_with_two_programs_to_a_nanometre(name: str, tmp_path: Path) -> None:
    data = reference(name)
    lens = lens_of(data, tmp_path)
    rays = data["real_rays"]
    assert len(rays) == 24
    points = lens.trace(
        [r["launch_point"] for r in rays],
        [r["direction"] for r in rays],
        [WAVELENGTHS[r["wavelength"]] for r in rays],
    )
    expected = np.array([[float(v) for v in r["rayoptics_image_xy"]] for r in rays])
    np.testing.assert_allclose(points[:, :2], expected, rtol=0, atol=1e-9)
    assert points.dtype == np.float64


@pytest.mark.parametrize("name", ["double_gauss_100mm", "cooke_triplet_50mm"])
def test_first_order_agrees_with_two_programs(name: str, tmp_path: Path) -> None:
    data = reference(name)
    lens = lens_of(data, tmp_path)
    order, expected = lens.first_order(WAVELENGTHS["d"]), data["paraxial_d"]["rayoptics"]
    last = float(lens.vertices[-1])
    assert order.efl == pytest.approx(expected["efl"], rel=1e-10)
    assert order.bfl == pytest.approx(expected["bfl"], rel=1e-10)
    assert order.ffl == pytest.approx(expected["ffl"], rel=1e-10)
    assert order.entrance_pupil.z == pytest.approx(
        expected["entrance_pupil_z_from_first_vertex"], rel=1e-7
    )
    # That program measures from the paraxial image less the last gap: off by back focus minus gap.
    offset = order.bfl - data["surfaces"][-1]["thickness"]
    assert order.exit_pupil.z - last == pytest.approx(
        expected["exit_pupil_z_from_last_vertex"] - offset, rel=1e-6
    )


def test_every_shared_lens_file_loads() -> None:
    folder = SHARED / "lenses"
    if not folder.is_dir():
        pytest.skip("no lens files at ../shared/data/lenses")
    efl = {}
    for path in sorted(folder.glob("*.json")):
        efl[path.stem] = lenses.load(path).first_order().efl
    assert len(efl) == 143
    assert all(math.isfinite(length) and length > 0 for length in efl.values())


def test_first_order_of_the_fifty() -> None:
    order = lenses.load("double-gauss-50mm-f2").first_order()
    assert order.efl == pytest.approx(100.015 / 2, rel=1e-5)  # US 2,673,491, indices of the patent
    assert order.bfl == pytest.approx(71.445 / 2, rel=1e-5)
    assert order.back_focal_point - order.back_principal_point == pytest.approx(order.efl)
    assert order.front_principal_point - order.front_focal_point == pytest.approx(order.efl)
    assert order.front_nodal_point == pytest.approx(order.front_principal_point)


def test_trace_takes_one_or_many_and_marks_lost_rays() -> None:
    lens = lenses.load("tessar-50mm-f2.8")
    one = lens.trace([0, 1, -10], [0, 0, 1], 550.0)
    assert one.shape == (1, 3)
    many = lens.trace(
        [[0, 1, -10], [0, 300, -10], [0, 12.5, -10]], [[0, 0, 2], [0, 0, 1], [0, 0, 1]]
    )
    assert np.isfinite(many[0]).all()
    assert np.isnan(many[1]).all()
    assert np.isnan(lens.trace([0, 12.5, -10], [0, 0, 1], clip=True)).all()
    for bad in ([[0, 0]], [[np.nan, 0, 0]]):
        with pytest.raises(InputError):
            lens.trace(bad, [0, 0, 1])
    with pytest.raises(InputError, match="directions: wanted non-zero vectors"):
        lens.trace([0, 0, -10], [0, 0, 0])
    with pytest.raises(InputError, match="wavelength"):
        lens.trace([0, 0, -10], [0, 0, 1], [500.0, 550.0])
    with pytest.raises(InputError, match="200 to 2500"):
        lens.trace([0, 0, -10], [0, 0, 1], 55.0)


def test_a_lens_shows_itself() -> None:
    for name in CLASSICS:
        lens = lenses.load(name)
        text = repr(lens)
        assert lens.name in text
        assert "stop" in text
        widened = any(s.widened_from for s in lens.surfaces)
        assert len(text.splitlines()) == len(lens.surfaces) + 3 + widened
        root = ElementTree.fromstring(lens._repr_svg_())
        space = "{http://www.w3.org/2000/svg}"
        assert root.tag == f"{space}svg"
        assert len(root.findall(f"{space}polygon")) >= 3
        assert len(root.findall(f"{space}polyline")) >= 8  # axis, film, stop and rays
        order, page = lens.first_order(), lens._repr_html_()
        ElementTree.fromstring(page.replace("<br>", " "))
        assert "<svg" in page
        assert f"{order.efl:.2f} mm  f/{order.f_number:.2f}" in page


# Bad files ----------------------------------------------------------------------------------------


def example() -> dict[str, Any]:
    """A small valid lens."""
    glass = {"nd": 1.5168, "vd": 64.17, "name": "N-BK7"}
    return {
        "schema": "daguerre-lens/0.1",
        "name": "singlet",
        "nominal": {"efl_mm": 96.7, "f_number": 8.0},
        "surfaces": [
            {
                "kind": "spherical",
                "radius": 100,
                "thickness": 5,
                "semi_diameter": 12,
                "glass": glass,
            },
            {
                "kind": "spherical",
                "radius": -100,
                "thickness": 2,
                "semi_diameter": 12,
                "glass": None,
            },
            {"kind": "stop", "radius": None, "thickness": 90, "semi_diameter": 6, "glass": None},
        ],
        "configurations": [{"name": "infinity", "gaps": {"2": 93.5}}],
    }


def write(folder: Path, data: Any) -> Path:
    """The data as a file."""
    path = folder / "lens.json"
    path.write_text(data if isinstance(data, str) else json.dumps(data))
    return path


def test_a_small_lens_loads(tmp_path: Path) -> None:
    lens = lenses.load(write(tmp_path, example()))
    assert lens.surfaces[2].thickness == 93.5  # the configuration overrides
    assert lens.first_order().efl == pytest.approx(97.6, rel=0.01)
    assert lens.nominal.f_number == 8
    assert lens.coating == "mgf2"


def change(path: str, value: Any) -> Callable[[dict[str, Any]], None]:
    """Sets ``surfaces.1.radius`` and the like."""

    def apply(data: dict[str, Any]) -> None:
        *parents, last = [int(k) if k.isdecimal() else k for k in path.split(".")]
        for key in parents:
            data = data[key]  # type: ignore[index]
        data[last] = value  # type: ignore[index]

    return apply


@pytest.mark.parametrize(
    ("edit", "says"),
    [
        (change("schema", "daguerre-lens/9"), "schema"),
        (change("surfaces", []), "surfaces"),
        (change("surfaces", None), "surfaces"),
        (change("surfaces.1.kind", "cube"), r"surfaces\[1\]\.kind"),
        (change("surfaces.1.conic", "k"), r"surfaces\[1\]\.conic"),
        (change("surfaces.0.asphere", {"b4": 1e-5}), r"surfaces\[0\]\.asphere\.b4"),
        (change("surfaces.0.radius", 0), r"surfaces\[0\]\.radius"),
        (change("surfaces.0.radius", "big"), r"surfaces\[0\]\.radius.*number"),
        (change("surfaces.0.thickness", -3), r"surfaces\[0\]\.thickness"),
        (change("surfaces.0.thickness", None), r"surfaces\[0\]\.thickness"),
        (change("surfaces.0.semi_diameter", 120), r"surfaces\[0\]\.semi_diameter"),
        (change("surfaces.0.semi_diameter", -1), r"surfaces\[0\]\.semi_diameter"),
        (change("surfaces.0.glass", {"vd": 50}), r"surfaces\[0\]\.glass\.nd"),
        (change("surfaces.0.glass.nd", 0.5), r"surfaces\[0\]\.glass\.nd"),
        (change("surfaces.0.glass.vd", 1), r"surfaces\[0\]\.glass\.vd"),
        (change("surfaces.0.glass", {"table": []}), r"surfaces\[0\]\.glass\.table"),
        (change("surfaces.0.glass", {"table": [[500, 0.2]]}), r"surfaces\[0\]\.glass\.table\[0\]"),
        (change("surfaces.1.stop", True), "stop"),
        (change("surfaces.2.kind", "spherical"), "stop"),
        (change("configurations.0.gaps", {"7": 1}), r"configurations\[0\]\.gaps"),
        (change("configurations.0.gaps", {"x": 1}), r"configurations\[0\]\.gaps"),
        (change("coating", "gold"), "coating"),
    ],
)
def test_bad_files_name_file_and_place(
    edit: Callable[[dict[str, Any]], None], says: str, tmp_path: Path
) -> None:
    data = example()
    edit(data)
    path = write(tmp_path, data)
    with pytest.raises(InputError, match=says) as caught:
        lenses.load(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


DAMAGED = [
    "",
    "{",
    "[1, 2]",
    "null",
    '{"schema": "daguerre-lens/0.1", "surfaces": [NaN]}',
    "[" * 5000,
]


@pytest.mark.parametrize("text", DAMAGED)
def test_damaged_files_are_one_message(text: str, tmp_path: Path) -> None:
    path = write(tmp_path, text)
    with pytest.raises(InputError, match=r"lens\.json"):
        lenses.load(path)


def test_a_configuration_is_chosen_by_name(tmp_path: Path) -> None:
    data = example()
    data["configurations"].append({"name": "close", "gaps": {"2": 120}})
    path = write(tmp_path, data)
    assert lenses.load(path, "close").surfaces[2].thickness == 120
    with pytest.raises(InputError, match="infinity"):
        lenses.load(path, "infinite")


# The exact lens -----------------------------------------------------------------------------------


def exact(f_stop: float = 2.0, focus_m: float = 3.0, *, from_sensor: bool = False) -> Any:
    """The 50 mm double Gauss as a camera lens."""
    lens = lenses.load("double-gauss-50mm-f2")
    settings = _core.ExactLensSettings(
        f_stop=f_stop, focus_distance_m=focus_m, focus_from_sensor=from_sensor
    )
    return _core.ExactLens(lens.prescription, settings)


def test_what_the_lens_cannot_do_is_said_with_the_limit() -> None:
    with pytest.raises(_core.LensError, match=r"f/2 or narrower"):
        exact(f_stop=1.2)
    with pytest.raises(_core.LensError, match="nearest possible"):
        exact(focus_m=0.05)
    with pytest.raises(_core.LensError, match="nearest possible"):
        exact(focus_m=0.15, from_sensor=True)
    assert exact(focus_m=math.inf).film_z_mm < exact(focus_m=1.0).film_z_mm


def test_h0_follows_the_f_number_and_the_coating() -> None:
    lens = exact(f_stop=4.0, focus_m=math.inf)
    ideal = math.pi / (4 * 4.0**2)
    assert lens.h0 == pytest.approx(ideal * lens.transmittance, rel=0.03)
    assert 0.93 < lens.transmittance < 0.99
