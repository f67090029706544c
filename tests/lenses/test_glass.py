"""Glass: the makers' catalogues, their names, and what a lens file may say of a glass."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from daguerre import _core, lenses
from daguerre.errors import InputError
from daguerre.files.json_item import Item
from daguerre.lenses import glasses
from daguerre.lenses.errors import LensError
from daguerre.lenses.glass_json import glass_from_json

VISIBLE = np.arange(400.0, 701.0, 10.0)


def all_glasses() -> list[glasses.GlassData]:
    return [glasses.find(name, maker) for maker in glasses.MAKERS for name in glasses.names(maker)]


def read(value: object) -> tuple[_core.Glass, str]:
    found = glass_from_json(Item(value, "glass", Item({}, "lens.json")))
    return found.medium.core, found.label


def test_every_formula_gives_the_nd_and_vd_that_its_maker_states() -> None:
    everything = all_glasses()
    assert len(everything) > 1600
    stated = [g for g in everything if g.stated_nd is not None]
    assert len(stated) > 1600
    for g in stated:
        assert g.nd == pytest.approx(g.stated_nd, abs=5e-5), g.name
        assert g.vd == pytest.approx(g.stated_vd, rel=3.5e-3), g.name
    worst = np.array([abs(g.nd - (g.stated_nd or 0)) for g in stated])
    assert np.median(worst) < 2e-6


def test_nd_and_vd_alone_are_as_good_as_promised() -> None:
    errors = []
    for g in all_glasses():
        if g.maker not in ("materials", "Corning"):
            abbe = _core.Glass.abbe(g.nd, g.vd)
            errors.append(max(abs(g.core.index(nm) - abbe.index(nm)) for nm in VISIBLE))
    assert np.median(errors) < 2.6e-4


def test_names_are_found_as_people_write_them() -> None:
    for name in ("N-BK7", "n-bk7", "NBK7", "N BK7", "N-BK7 (Schott)"):
        found = glasses.find(name)
        assert (found.name, found.maker, found.note) == ("N-BK7", "Schott", "")
    old = glasses.find("BK7")
    assert old.name == "N-BK7"
    assert old.note == "BK7: took N-BK7 (Schott)"
    assert glasses.find("LaK10").name == "N-LAK10"
    assert glasses.find("SF6").maker == "Schott"
    assert glasses.find("SF6", "hikari").maker == "Hikari"
    assert glasses.find("S-LAH58 (OHARA)").maker == "Ohara"
    assert glasses.find("NICF-V (Nikon)").maker == "Hikari"
    assert glasses.find("fluorite").nd == pytest.approx(1.43384, abs=2e-5)
    assert glasses.find("fused silica").vd == pytest.approx(67.8, abs=0.1)
    assert glasses.find("acrylic").nd == pytest.approx(1.4914, abs=2e-3)


def test_unknown_names_get_the_nearest_ones() -> None:
    with pytest.raises(LensError, match=r"did you mean 'N-LAK3[34]") as caught:
        glasses.find("N-LAK33C")
    assert caught.value.code == "lens-glass"
    with pytest.raises(LensError, match="of Ohara"):
        glasses.find("N-BK7", "Ohara")
    with pytest.raises(LensError, match="did you mean 'Schott'"):
        glasses.find("N-BK7", "Schot")


def test_internal_transmittance_of_the_data_sheet() -> None:
    # SCHOTT data sheet of F2: 0.994 at 420 nm and 25 mm is not met by 10 mm of SF6.
    f2 = glasses.find("F2", "Schott")
    assert f2.internal_transmittance(546.0, 25) > 0.99
    sf6 = glasses.find("SF6", "Schott")
    assert 0.6 < float(sf6.internal_transmittance(400.0)) < 0.95
    thick = sf6.internal_transmittance([400.0, 410.0], 20)
    assert thick == pytest.approx(sf6.internal_transmittance([400.0, 410.0], 10) ** 2)


def test_media() -> None:
    assert read({"name": "air"})[0].index(500) == 1
    assert read({"name": "vacuum"})[0].index(500) == pytest.approx(1 / _core.air_index(500))
    water, label = read({"name": "Water"})
    assert label == "water"
    assert water.index(589.3) == pytest.approx(1.33299, abs=1e-5)


def test_numbers_decide_the_index_and_names_the_absorption() -> None:
    sf6 = glasses.find("SF6", "Schott")
    glass, label = read({"nd": 1.8052, "vd": 25.4, "name": "SF6 (Schott) / S-TIH6 (Ohara)"})
    assert label.startswith("SF6")
    assert glass.index(587.5618) == pytest.approx(1.8052, abs=1e-12)
    assert glass.absorption_per_mm(400) == sf6.core.absorption_per_mm(400) > 0
    assert not read({"nd": 1.79, "vd": 25.4, "name": "SF6"})[0].absorption_per_mm(400)  # another
    assert not read({"nd": 1.8052, "vd": 25.4})[0].absorption_per_mm(400)
    assert read({"nd": 1.5168, "vd": 64.17})[1] == "1.5168/64.17"
    assert read({"name": "N-BK7"})[0].index(435.8343) == pytest.approx(1.52668, abs=1e-5)
    own = {"thickness_mm": 5, "table": [[400, 0.5], [700, 1]]}
    dyed = read({"name": "N-BK7", "internal_transmittance": own})[0]
    assert np.exp(-5 * dyed.absorption_per_mm(400)) == pytest.approx(0.5)


def test_formulas_in_a_file() -> None:
    bk7 = {"b": [1.03961212, 0.231792344, 1.01046945], "c": [0.00600069867, 0.0200179144, 103.56]}
    assert read({"sellmeier": bk7})[0].index(587.5618) == pytest.approx(1.5168, abs=1e-5)
    root = {"coefficients": [2.25], "powers": [0]}
    assert read({"polynomial": root})[0].index(500) == pytest.approx(1.5)
    vacuum = read({"polynomial": root, "against_vacuum": True})[0]
    assert vacuum.index(500) == pytest.approx(1.5 / _core.air_index(500), rel=1e-14)
    assert read({"table": [[400, 1.6], [700, 1.5]], "name": "x"})[1] == "x"


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("BK7", "glass: wrong type"),
        ({}, r"glass\.nd: missing"),
        ({"vd": 50, "name": "N-BK7"}, r"glass\.nd: missing"),
        ({"name": "unobtainium"}, r"lens\.json: glass\.name: glass 'unobtainium'.*\[lens-glass\]"),
        ({"nd": 1.5, "vd": 3}, r"glass\.vd: wanted an Abbe number"),
        ({"table": []}, r"glass\.table: wanted"),
        (
            {"table": [[500, 1.5], [500, 1.6]]},
            r"glass\.table: wavelengths must differ, got two indices",
        ),
        ({"table": [[500, 0.2]]}, r"glass\.table\[0\]\[1\]: out of range"),
        ({"sellmeier": {"b": [1], "c": []}}, r"glass\.sellmeier: wanted as many c as b"),
        ({"sellmeier": {"b": [-2], "c": [0.1]}}, r"glass\.sellmeier: .*refractive index"),
        ({"polynomial": {"coefficients": [1, "x"], "powers": [0, 1]}}, r"coefficients\[1\]: wrong"),
        (
            {"nd": 1.5, "internal_transmittance": {"thickness_mm": 0, "table": [[400, 1]]}},
            r"thickness_mm: out of range",
        ),
        (
            {"nd": 1.5, "internal_transmittance": {"thickness_mm": 1, "table": [[400, 0]]}},
            r"internal_transmittance\.table\[0\]\[1\]: out of range",
        ),
    ],
)
def test_bad_glasses_are_refused_by_place(value: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read(value)


def singlet(folder: Path, glass: object, **changes: object) -> lenses.Lens:
    surface = {"kind": "spherical", "semi_diameter": 10, "thickness": 8}
    data = {
        "schema": "daguerre-lens/0.1",
        "surfaces": [
            {**surface, "radius": 100, "glass": glass},
            {**surface, "radius": -100, "thickness": 1},
            {"kind": "stop", "radius": None, "semi_diameter": 8, "thickness": 90},
        ],
        **changes,
    }
    path = folder / "singlet.json"
    path.write_text(json.dumps(data))
    return lenses.load(path)


def test_t_stop_of_a_bare_absorbing_singlet(tmp_path: Path) -> None:
    glass = {"polynomial": {"coefficients": [2.25], "powers": [0]}}
    bare = singlet(tmp_path, glass, coating="uncoated")
    share = (1 - 0.04) ** 2
    assert bare.axial_transmittance([450, 600]) == pytest.approx([share, share], abs=1e-12)
    assert bare.t_stop(4) == pytest.approx(4 / math.sqrt(share))
    tau = {"thickness_mm": 8, "table": [[400, 0.5], [700, 0.9]]}
    dark = singlet(tmp_path, {**glass, "internal_transmittance": tau}, coating="uncoated")
    assert dark.axial_transmittance([400, 700]) == pytest.approx([0.5 * share, 0.9 * share])
    assert dark.t_stop(4, [400, 700]) == pytest.approx(4 / math.sqrt(0.7 * share))
    assert bare.t_stop() == pytest.approx(bare.t_stop(bare.first_order().f_number))


def test_coatings_lose_less_and_less(tmp_path: Path) -> None:
    kinds = ("uncoated", "mgf2", "broadband", "perfect")
    light = [
        float(np.mean(singlet(tmp_path, {"name": "N-BK7"}, coating=c).axial_transmittance(VISIBLE)))
        for c in kinds
    ]
    assert light == sorted(light)
    assert light[2] > 0.99
    green = singlet(tmp_path, {"nd": 1.6, "vd": 50}, coating="v-coat").axial_transmittance(550.0)
    assert green == pytest.approx(1, abs=1e-6)


def test_a_lens_under_water(tmp_path: Path) -> None:
    dry = singlet(tmp_path, {"name": "N-BK7"})
    wet = singlet(tmp_path, {"name": "N-BK7"}, object_medium={"name": "water"})
    assert wet.first_order().efl > 1.3 * dry.first_order().efl
