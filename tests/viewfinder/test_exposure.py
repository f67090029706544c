"""Exposure in the viewfinder: how it starts, what its meter chooses, and that rings turn back."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre import cli
from daguerre.rendering import auto_exposure, meter_picture
from daguerre.rendering.over_meter import exposure_in_words
from daguerre.rendering.prepare import Prepared
from daguerre.viewfinder import saving
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.drawn import Drawn
from daguerre.viewfinder.opening import opened
from daguerre.viewfinder.readings import readings_of
from daguerre.viewfinder.stage import Stage

from .live import live, page
from .test_painter import Seen, scene

pytest.importorskip("simplejpeg", reason="needs the extra view")
SIZE = (60, 40)
#: A lit floor that a usual ISO exposes.
BRIGHT = 200.0


def bright(light: float = BRIGHT, **changes: Any) -> Stage:
    """A stage with a lit floor."""
    made = scene()
    made.set_environment(color=(light,) * 3)
    camera = made.camera().with_(f_stop=None).with_(**changes)
    return Stage(made, camera, dg.RenderSettings.of(resolution=SIZE, spp=2))


def drawn(stage: Stage, dials: Dials) -> Drawn:
    """The picture at rest."""
    seen = Seen(stage)
    try:
        seen.request(1, dials)
        return seen.until_rest(1)[-1]
    finally:
        seen.painter.close()


def shown(stage: Stage, dials: Dials) -> NDArray[np.uint8]:
    """Pixels of the picture at rest."""
    found = drawn(stage, dials)
    return found.shot.photograph.shown(found.frame, found.shot.tone)


# How it starts


def test_it_starts_in_manual_at_an_iso_metered_once() -> None:
    stage = bright()
    dials, said = opened(stage, Dials())
    chosen, _ = auto_exposure.choose(
        stage.scene, stage.camera.with_(exposure="auto"), stage.settings
    )
    assert f"--exposure manual --iso {dials.texts['iso']}" == chosen.words
    assert dials.texts.keys() == {"exposure", "iso"}
    assert said == ""
    meter = readings_of(drawn(stage, dials))["meter"]
    assert abs(meter["over"]) < 0.1


@pytest.mark.parametrize(
    ("given", "of_file", "wanted"),
    [
        ({"exposure": "light"}, {}, {"exposure": "light"}),
        ({"exposure": "A"}, {}, {"exposure": "A"}),
        ({"iso": "400"}, {}, {"iso": "400", "exposure": "manual"}),
        ({"iso": "100"}, {}, {"iso": "100", "exposure": "manual"}),
        ({}, {"iso": 400}, {"exposure": "manual"}),
        ({}, {"exposure": "manual"}, {}),
        ({}, {"exposure": "auto"}, {}),
    ],
)
def test_what_is_given_stays(given: Any, of_file: Any, wanted: Any) -> None:
    assert opened(bright(**of_file), Dials.of(given)) == (Dials(wanted, given), "")


def test_compensation_stays_on_its_ring() -> None:
    plain, _ = opened(bright(), Dials())
    more, _ = opened(bright(), Dials.of({"exposure_compensation": "1"}))
    assert more.texts == {**plain.texts, "exposure_compensation": "1"}


def test_what_the_opening_cannot_expose_is_said_of_the_mode_on_the_dial() -> None:
    dials, said = opened(bright(0.01), Dials())
    assert dials.texts["exposure"] == "manual"
    assert re.fullmatch(
        r"ISO 100 \.\. 6400 cannot expose this: the picture is \S+ EV too dark", said
    )


@pytest.mark.parametrize(
    ("changes", "said"),
    [({"light": 0.0}, "no light to meter"), ({"shutter_time": 0.0}, "the shutter was frozen")],
)
def test_without_a_reading_it_starts_in_light_and_says_so(changes: Any, said: str) -> None:
    dials, text = opened(bright(**changes), Dials())
    assert "exposure" not in dials.texts
    assert said in text
    assert text.endswith("so the exposure mode is light")


def test_a_picture_that_only_light_shows_stays_in_light() -> None:
    stage = bright()
    stage.tone = "soft"
    assert opened(stage, Dials()) == (Dials(), "")
    with pytest.raises(dg.UsageError, match="--tone soft"):
        stage.shot(Dials().turned({"exposure": "manual"}))


def test_the_page_says_what_the_opening_found() -> None:
    pytest.importorskip("websockets", reason="needs the extra view")
    stage = bright(0.0)
    dials, said = opened(stage, Dials())
    with live(stage, dials, said=said) as server, page(server) as one:
        one.until_rest(0)
        assert one.state["note"].startswith("no light to meter")
        assert one.state["mode"] == "light"


# Choices of the meter

CHOSEN = {"auto": {"iso"}, "A": {"shutter_s"}, "S": {"f_stop"}, "P": {"shutter_s", "f_stop"}}


@pytest.mark.parametrize("mode", CHOSEN)
def test_the_rings_show_what_a_mode_chose(mode: str) -> None:
    stage = bright(20.0, focus_distance=3.0)
    plain = readings_of(drawn(stage, Dials()))
    found = readings_of(drawn(stage, Dials().turned({"exposure": mode})))
    names = ("iso", "shutter_s", "f_stop")
    assert {name for name in names if found[name] != plain[name]} == CHOSEN[mode]
    assert found["ev"] == 0


@pytest.mark.parametrize("mode", CHOSEN)
def test_a_mode_draws_the_picture_of_the_render(mode: str) -> None:
    stage = bright(focus_distance=3.0)
    dials = Dials().turned({"exposure": mode, "exposure_compensation": "0.333"})
    found = drawn(stage, dials)
    shot = stage.shot(dials)
    alone = dg.render(stage.scene, shot.camera, settings=stage.settings)
    assert np.array_equal(found.frame.rgb, alone.rgb)
    assert np.array_equal(shown(stage, dials), alone.display())
    assert readings_of(found)["ev"] == 0.333


@pytest.mark.parametrize("mode", CHOSEN)
def test_manual_keeps_what_a_mode_chose(mode: str) -> None:
    pytest.importorskip("websockets", reason="needs the extra view")
    stage = bright(focus_distance=3.0)
    with live(stage, Dials.of({"exposure": mode})) as server, page(server) as one:
        one.until_rest(0)
        metered = one.bytes
        one.send(turn={"exposure": "manual"})
        one.until_rest(1)
        assert one.bytes == metered
        assert one.state["mode"] == "manual"
        assert "iso" in one.state["dials"]
        one.send(turn={"exposure": mode})
        one.until_rest(2)
        assert one.bytes == metered


def test_a_ring_that_the_mode_turns_is_refused_in_one_sentence() -> None:
    with pytest.raises(dg.UsageError, match="exposure auto chooses the ISO, but iso is set"):
        bright().shot(Dials().turned({"exposure": "auto"}).turned({"iso": "200"}))


def test_the_meter_looks_anew_only_where_it_would_see_something_else(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    looks: list[Prepared] = []
    draw = meter_picture.meter_picture
    monkeypatch.setattr(
        meter_picture, "meter_picture", lambda one: (looks.append(one), draw(one))[1]
    )
    stage = bright()
    dials = Dials().turned({"exposure": "auto"})
    for turn, new in (
        ({}, True),
        ({"exposure_compensation": "1"}, False),
        ({"look": "film"}, False),
        ({"white_balance": "5600"}, False),
        ({"spp": "3"}, False),
        ({"seed": "3"}, False),
        ({"meter": "matrix"}, False),
        ({"exposure": "A"}, False),
        ({"exposure": "auto"}, False),
        ({"iso": "100", "exposure": "P"}, True),  # by another stop
        ({"exposure": "auto"}, False),
        ({"f_stop": "2"}, True),
        ({"focus_distance": "2"}, True),
        ({"focus_at": "10,10"}, True),
        ({"place.position": "0,1,3"}, True),
        ({"lens": "pinhole", "f_stop": None, "focus_at": None}, True),
    ):
        before = len(looks)
        dials = dials.turned(turn)
        drawn(stage, dials)
        assert (len(looks) > before) == new, turn


def test_pictures_on_the_way_do_not_wait_for_the_meter() -> None:
    stage = bright()
    stage.settings = stage.settings.with_(resolution=(480, 320), spp=1)
    dials = Dials().turned({"exposure": "auto", "place.position": "0,1,2"})
    before = drawn(stage, dials).shot.camera.iso
    seen = Seen(stage)
    try:
        seen.request(1, dials.turned({"place.position": "0,0.3,2"}))
        *quick, last = seen.until_rest(1)
    finally:
        seen.painter.close()
    assert quick
    assert {one.session.camera.iso for one in quick} == {before}
    assert last.session.camera.iso != before


@pytest.mark.parametrize("pattern", ["centre", "spot", "spot:10,30", "matrix", "highlight"])
@pytest.mark.parametrize("mode", ["light", "manual", "auto"])
def test_the_needle_is_the_closing_line_of_render(mode: str, pattern: str) -> None:
    dials = Dials().turned({"exposure": mode, "meter": pattern, "exposure_compensation": "0.7"})
    found = drawn(bright(), dials)
    over = readings_of(found)["meter"]["over"]
    words = exposure_in_words(found.session, found.frame)
    assert words == f"{mode}, {abs(over):.1f} EV {'over' if over > 0 else 'under'} the meter"


def test_a_spot_is_a_pixel_of_the_whole_picture_also_in_small_ones() -> None:
    stage = bright()
    stage.settings = stage.settings.with_(resolution=(480, 320), spp=1)
    seen = Seen(stage)
    try:
        seen.request(1, Dials().turned({"meter": "spot:400,300"}))
        over = [readings_of(one)["meter"]["over"] for one in seen.until_rest(1)]
    finally:
        seen.painter.close()
    assert len(over) > 2
    assert over == pytest.approx([over[-1]] * len(over), abs=0.15)


# Rings turn back

#: Texts of clicks of each ring, from where it was found.
CLICKS = {
    "focus_distance": ("2", "1.9", "1.8"),
    "f_stop": ("5", "4.5", "4"),
    "shutter_time": ("1/60", "1/80", "1/100"),
    "iso": ("125", "160", "200"),
    "exposure_compensation": ("0.333", "0.667", "1.000"),
    "white_balance": ("6410", "6330", "6250"),
    "blades": ("3", "4", "5"),
    "look": ("film", "standard", "neutral"),
    "spp": ("3", "4", "5"),
}


@pytest.mark.parametrize("mode", ["light", "manual"])
@pytest.mark.parametrize("ring", CLICKS)
def test_a_ring_turned_up_and_down_restores_the_picture(mode: str, ring: str) -> None:
    stage = bright(iso=643 if mode == "manual" else 100)
    start = Dials().turned({"exposure": mode})
    before = shown(stage, start)
    dials = start
    for text in (*CLICKS[ring], *CLICKS[ring][-2::-1]):
        dials = dials.turned({ring: text})
        stage.exposed(stage.shot(dials))
    dials = dials.turned({ring: None})
    assert dials == start
    assert np.array_equal(shown(stage, dials), before)


@pytest.mark.parametrize("text", ["100", "100.0"])
def test_the_default_as_a_text_is_the_default(text: str) -> None:
    for mode in ("light", "manual"):
        start = Dials().turned({"exposure": mode})
        again = start.turned({"iso": "800"}).turned({"iso": text, "exposure_compensation": "0"})
        assert np.array_equal(shown(bright(), again), shown(bright(), start))


# Files


@pytest.mark.parametrize(
    "turns",
    [
        {"exposure": "light", "iso": "800"},
        {"exposure": "manual", "iso": "643", "look": "film"},
        {"exposure": "auto", "exposure_compensation": "0.5"},
        {"exposure": "auto", "sensor": "nikon-d5100", "seed": "5"},
        {"exposure": "light", "sensor": "nikon-d5100", "iso": "400", "seed": "5"},
    ],
)
def test_a_saved_picture_is_that_of_the_command(turns: Any, tmp_path: Path) -> None:
    from tests.faults.scene import write_scene

    file = write_scene(tmp_path / "scene.glb")
    made = dg.load(file)
    stage = Stage(made, made.camera(), dg.RenderSettings.of(resolution=SIZE, spp=2))
    dials = Dials().turned(turns)
    kept = saving.save(drawn(stage, dials), tmp_path, "png")
    words = [str(file), "--res", "60x40", "--spp", "2", "--quiet", *dials.words()]
    assert cli.main(["render", *words, "-o", str(tmp_path / "a.png")]) == 0, shlex.join(words)
    assert np.array_equal(_pixels(kept), _pixels(tmp_path / "a.png"))


def _pixels(path: Path) -> NDArray[np.uint8]:
    from PIL import Image

    return np.asarray(Image.open(path))
