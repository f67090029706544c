"""Switches of ghosts, stars and scatter: each picture at rest has the bits of its command."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.rendering.session import Session
from daguerre.viewfinder.beside import other_of
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.stage import Stage
from daguerre.viewfinder.switches import SWITCHES, on_in, possible
from tests.faults.scene import write_scene

from .chromium import Browser, browser, program
from .live import Live
from .test_page import LAMP, check_bits, command_of, pixels, rests, shows, stage_of, turn_of
from .test_painter import scene

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
in_chromium = [
    pytest.mark.skipif(program() is None, reason="needs chromium"),
    pytest.mark.xdist_group("chromium"),
]
LENS = "double-gauss-50mm-f2"
ALL = {"flare": "auto", "diffraction": "1", "scatter": "auto"}
MORE = {"flare_order": "4", "flare_highlights": "off", "diffraction_bands": "8"}
FLAGS = {"flare": "--flare=auto", "diffraction": "--diffraction", "scatter": "--scatter=auto"}


# Dials


@pytest.mark.parametrize("off", ["off", "0", None])
def test_what_needs_a_switch_goes_off_with_it(off: str | None) -> None:
    dials = Dials().turned({**ALL, **MORE})
    one = dials.turned({"flare": off})
    assert "flare_order" not in one.texts
    assert one.texts["flare_highlights"] == "off"  # scatter needs it, too
    none = one.turned({"scatter": off, "diffraction": None if off is None else "0"})
    assert none.texts.keys() & {*MORE} == set()
    made = none.settings(dg.RenderSettings())
    assert on_in(made) == []


def test_a_switch_that_was_off_takes_nothing_back() -> None:
    dials = Dials().turned({"flare_order": "4"})
    assert dials.turned({"scatter": "off"}).texts["flare_order"] == "4"


def test_what_a_stage_has_on_can_be_turned_off() -> None:
    base = dg.RenderSettings.of(flare=1000, flare_order=4, diffraction=dg.Diffraction(8), scatter=5)
    assert on_in(Dials().settings(base)) == [*SWITCHES]
    off = Dials().turned({"flare": "off", "diffraction": "0", "scatter": "off"})
    assert off.settings(base) == dg.RenderSettings()


def test_bands_and_zones_are_those_of_the_dials() -> None:
    dials = Dials().turned({"diffraction": "1", "diffraction_bands": "8", "diffraction_zones": "3"})
    assert dials.settings(dg.RenderSettings()).diffraction == dg.Diffraction(8, 3)
    with pytest.raises(dg.UsageError, match="need --diffraction"):
        Dials().turned({"diffraction_bands": "8"}).settings(dg.RenderSettings())


def test_paths_that_the_lens_scatters_are_not_parts_of_the_camera() -> None:
    dials = Dials().turned({"scatter": "auto", "scatter.barrel": "0.02"})
    camera = dg.Camera(lens=LENS)
    assert dials.camera(camera).scatter == dg.LensScatter(barrel=0.02)
    assert Dials().turned({"scatter": "auto"}).camera(camera).scatter == camera.scatter


def test_a_flag_without_another_form_has_no_words_when_off() -> None:
    assert Dials().turned({"diffraction": "0"}).words() == []


@pytest.mark.parametrize(
    ("dial", "model", "kept"),
    [
        ("lens", "thin", {"diffraction", "diffraction_bands"}),
        ("lens", "pinhole", set()),
        ("lens_model", "thin", {"diffraction", "diffraction_bands"}),
        ("lens", "tessar-50mm-f2.8", ALL.keys() | MORE.keys()),
    ],
)
def test_a_lens_takes_back_what_it_cannot_have(dial: str, model: str, kept: set[str]) -> None:
    dials = Dials().turned({"lens": LENS, **ALL, **MORE}).turned({dial: model})
    assert dials.texts.keys() & (ALL.keys() | MORE.keys()) == kept


def test_the_settings_before_the_dials_have_none_of_them() -> None:
    asked = {**ALL, **MORE, "spp": "3", "seed": "2"}
    base = dg.RenderSettings.of(resolution=(60, 40), noise=0.1)
    given = Dials().turned(asked).settings(base)
    assert Dials().before(given) == base


# Pictures


@pytest.fixture
def stage() -> Stage:
    made = scene()
    settings = dg.RenderSettings.of(resolution=(60, 40), spp=2)
    return Stage(made, made.camera(), settings)


@pytest.mark.parametrize("model", ["pinhole", "thin", "exact"])
def test_models_and_pictures_beside_have_what_they_can(stage: Stage, model: str) -> None:
    shot = stage.shot(Dials().turned({"lens": LENS, **ALL, **MORE}))
    one, other = shot.by_model(model, 1, 1), other_of(stage, shot, {"lens_model": model}).shot
    assert on_in(shot.settings) == [*SWITCHES]
    assert on_in(one.settings) == on_in(other.settings) == possible(model)
    if model != "exact":  # exact ones are drawn on the page, below
        for made in (one, other):
            Session(made.scene, made.camera, settings=made.settings)


# The page


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as found:
        yield found


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_scene(tmp_path_factory.mktemp("scene") / "scene.glb", LAMP)


@pytest.fixture
def server(file: Path) -> Iterator[Live]:
    with stage_of(file, f_stop="8") as running:
        yield running


def click(page: Browser, dial: str) -> None:
    """Presses a switch, and waits for its picture."""
    before = turn_of(page)
    page.click(f"[data-switch={dial}]")
    rests(page, before)


def is_pressed(page: Browser, dial: str) -> bool:
    found = page.run(f"document.querySelector('[data-switch={dial}]').ariaPressed")
    return bool(found == "true")


@pytest.mark.parametrize("dial", SWITCHES)
class TestOnThePage:
    """A switch on and off."""

    pytestmark = in_chromium

    def test_the_command_names_it_and_the_bits_agree(
        self, window: Browser, server: Live, tmp_path: Path, dial: str
    ) -> None:
        page = shows(window, server)
        shown, before = command_of(page), pixels(server)
        assert not is_pressed(page, dial)
        click(page, dial)
        assert is_pressed(page, dial)
        assert FLAGS[dial] in command_of(page)
        check_bits(page, server, tmp_path)
        assert not np.array_equal(pixels(server), before)
        click(page, dial)
        assert not is_pressed(page, dial)
        assert command_of(page) == shown
        assert np.array_equal(pixels(server), before)
        assert page.errors == []


class TestOpening:
    """Switches that the command line turned on, and lenses that cannot have them."""

    pytestmark = in_chromium

    def test_a_switch_comes_back_as_it_was_given(self, window: Browser, file: Path) -> None:
        given = {"f_stop": "8", "flare": "500", "flare_order": "4"}
        with stage_of(file, **given) as server:
            page = shows(window, server)
            shown = command_of(page)
            assert "--flare=500" in shown
            click(page, "flare")
            assert "--flare" not in command_of(page)
            click(page, "flare")
            assert command_of(page) == shown

    def test_an_ideal_lens_says_that_it_has_none(self, window: Browser, file: Path) -> None:
        with stage_of(file, lens="thin") as server:
            page = shows(window, server)
            page.until("document.querySelector('[data-switch=flare]').disabled")
            button = "document.querySelector('[data-switch=flare]')"
            assert "this lens has none" in page.run(f"{button}.title")
            assert not page.run("document.querySelector('[data-switch=diffraction]').disabled")
