"""Lens files that do not give the size of their stop: sized by other data, or refused by name."""

from __future__ import annotations

import copy
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.cli import main
from daguerre.lenses.errors import LensError
from tests.faults.scene import write_scene
from tests.support.lenses import lens_writers as write
from tests.support.lenses.triplet import TRIPLET

#: Files that are kept beside the project.
CASES = Path(__file__).parents[3] / "shared" / "cases" / "files"
STOP = 4
WRITERS = {
    "json": lambda data: json.dumps({"schema": "daguerre-lens/0.1", **data}),
    "zmx": write.zmx,
    "seq": write.seq,
    "txt": write.optical_bench,
    "dat": write.pbrt,
}


def unsized(others: bool = True) -> dict[str, Any]:
    """The triplet without the size of its stop, and with no other diameter unless ``others``."""
    data = copy.deepcopy(TRIPLET)
    for i, surface in enumerate(data["surfaces"]):
        if i == STOP or not others:
            surface["semi_diameter"] = None
    return data


def loaded(folder: Path, suffix: str, data: dict[str, Any]) -> lenses.Lens:
    data = copy.deepcopy(data)
    if suffix == "dat":  # its rows need a number: 0 is unknown
        for surface in data["surfaces"]:
            surface["semi_diameter"] = surface["semi_diameter"] or 0.0
    path = folder / f"lens.{suffix}"
    path.write_text(WRITERS[suffix](data))
    return lenses.load(str(path))


@pytest.mark.parametrize("suffix", WRITERS)
def test_the_stop_is_as_wide_as_other_diameters_let_the_axial_beam(
    tmp_path: Path, suffix: str
) -> None:
    lens = loaded(tmp_path, suffix, unsized())
    stop = lens.surfaces[STOP]
    assert stop.semi_diameter is not None
    assert stop.derived
    share = 1e-4 * lens.first_order().entrance_pupil.diameter / 2
    ray = np.array([[0, share, -9.0]]), np.array([[0, 0, 1.0]])
    heights = lens.prescription.path(*ray, 587.5618, False)[:, 1] / 1e-4
    assert heights[STOP] == pytest.approx(stop.semi_diameter, rel=1e-6)
    room = [(s.semi_diameter or 0) / h for s, h in zip(lens.surfaces, heights, strict=True)]
    assert min(room) == pytest.approx(1, rel=1e-6)
    limit = min((i for i in range(len(room)) if i != STOP), key=lambda i: room[i])
    (note,) = [n for n in lens.notes if "size of the stop" in n]
    assert f"surface {STOP}" in note
    assert f"through surface {limit}" in note


@pytest.mark.parametrize("suffix", [suffix for suffix in WRITERS if suffix != "json"])
def test_without_any_diameter_the_stop_is_refused_by_name(tmp_path: Path, suffix: str) -> None:
    with pytest.raises(LensError, match=rf"lens\.{suffix}: surface 4.*stop.*got none") as caught:
        loaded(tmp_path, suffix, unsized(others=False))
    assert (caught.value.code, caught.value.surface) == ("lens-no-stop", STOP)


def test_a_prescription_without_diameters_is_traced_and_not_rendered(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lens = loaded(tmp_path, "json", unsized(others=False))
    assert lens.first_order().stop_semi_diameter == math.inf
    assert np.isfinite(lens.trace([[0, 4.0, -9.0]], [[0, 0, 1.0]], [587.5618])).all()
    file, out = str(tmp_path / "lens.json"), str(tmp_path / "out.exr")
    scene = write_scene(tmp_path / "scene.glb", 1e3)
    for words in (
        ["lens", file],
        ["lens", file, "--json"],
        ["lens", file, "--export", str(tmp_path / "lens.osl")],
        ["export-lens", file, "-o", str(tmp_path / "lens.xml")],
        ["render", str(scene), "--lens", file, "-o", out],
        ["render", str(scene), "--lens", file, "--lens-model", "thin", "--f-stop", "8", "-o", out],
    ):
        assert main(words) == 3, words
        assert f"surface {STOP}: wanted a clear diameter of the stop" in capsys.readouterr().err


def test_a_stated_f_number_goes_before_other_diameters(tmp_path: Path) -> None:
    lens = loaded(tmp_path, "json", {**unsized(), "nominal": {"f_number": 8.0}})
    assert lens.first_order().f_number == pytest.approx(8)
    assert not any("stop" in note for note in lens.notes)


def test_an_obstruction_in_the_stop_stays(tmp_path: Path) -> None:
    data = unsized()
    data["surfaces"][STOP]["inner_semi_diameter"] = 0.5
    assert loaded(tmp_path, "json", data).surfaces[STOP].inner_semi_diameter == 0.5


def test_a_near_object_opens_its_beam_from_its_own_distance(tmp_path: Path) -> None:
    """The axial beam of an object at 200 mm meets the front at another height."""
    data = unsized()
    data["configurations"] = [{"name": "near", "gaps": {}, "object_distance_mm": 200.0}]
    near, far = (loaded(tmp_path, "json", d) for d in (data, unsized()))
    sizes = [lens.surfaces[STOP].semi_diameter for lens in (near, far)]
    assert sizes[0] != pytest.approx(sizes[1], rel=0.005)


@pytest.mark.parametrize("size", [None, math.inf])
def test_no_lens_is_made_with_a_stop_of_unknown_size(size: float | None) -> None:
    lens = lenses.load("double-gauss-50mm-f2")
    lens = lens.rebuilt(lens.surfaces, nominal=lenses.Nominal())
    i = next(i for i, s in enumerate(lens.surfaces) if s.stop)
    surfaces = list(lens.surfaces)
    surfaces[i] = surfaces[i].replaced(semi_diameter=size)
    with pytest.raises(LensError, match=rf"surface {i}: semi_diameter: .*stop"):
        lens.rebuilt(surfaces)


def test_an_f_number_beyond_all_numbers_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LensError, match="finite stop"):
        loaded(tmp_path, "json", {**unsized(), "nominal": {"f_number": 1e-310}})


@pytest.mark.skipif(not CASES.is_dir(), reason="../shared/cases/files is not here")
@pytest.mark.parametrize(
    "name", ["crash_pbrt_stop0.dat", "zmx_enpd0.zmx", "zmx_stop_without_diam.zmx"]
)
def test_a_lamp_is_drawn_through_a_stop_that_was_sized(name: str, tmp_path: Path) -> None:
    """Light followed from a small lamp aims at the pupil, which was of infinite size."""
    words = [str(CASES / "tri_lamp.gltf"), "--lens", str(CASES / name)]
    out = tmp_path / "out.exr"
    assert main(["render", *words, "-o", str(out), "--spp", "2", "--res", "24x16"]) == 0
    assert np.isfinite(dg.load_frame(out).rgb).all()
