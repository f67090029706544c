"""Two pictures behind a divider: another lens, stop or model at the same settings."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre import lenses
from daguerre.frame.frame import Frame
from daguerre.viewfinder import image, tint
from daguerre.viewfinder.dials import Dials, texts_of_words
from daguerre.viewfinder.drawn import Drawn, PictureRequest
from daguerre.viewfinder.false_colour import false_colour
from daguerre.viewfinder.readings import limits_of, readings_of
from daguerre.viewfinder.stage import Stage

from .chromium import Browser, program
from .live import Live, live
from .live import page as page_of
from .test_page import shows
from .test_painter import Seen, scene

simplejpeg = pytest.importorskip("simplejpeg", reason="needs the extra view")
LENS, SLOWER = "double-gauss-50mm-f2", "canon-ef-24-70mm-f2.8"
WIDEST = lenses.load(SLOWER).first_order().f_number
#: Focuses to 2.7 m at the nearest.
FAR_ONLY = "telephoto-200mm-f1.8"


@pytest.fixture
def stage() -> Stage:
    made = scene()
    settings = dg.RenderSettings.of(resolution=(60, 40), spp=4)
    return Stage(made, made.camera(), settings)


def drawn(stage: Stage, dials: Dials, beside: dict[str, str]) -> list[Drawn]:
    """Pictures of a request with another one beside it."""
    seen = Seen(stage)
    try:
        request = PictureRequest(1, stage, dials, stage.shot(dials), beside=beside)
        seen.painter.request(request)
        return seen.until_rest(1)
    finally:
        seen.painter.close()


def alone(stage: Stage, dials: Dials) -> Frame:
    shot = stage.exposed(stage.shot(dials))
    return dg.render(shot.scene, shot.camera, settings=shot.settings)


@pytest.mark.parametrize(
    ("turned", "beside", "texts"),
    [
        ({}, {"lens": SLOWER}, {"lens": SLOWER, "f_stop": repr(WIDEST), "focus_distance": "3"}),
        ({"f_stop": "8"}, {"lens": SLOWER}, {"lens": SLOWER, "f_stop": "8", "focus_distance": "3"}),
        ({"iso": "400"}, {"f_stop": "4"}, {"f_stop": "4"}),
        ({}, {"lens_model": "thin"}, {"lens_model": "thin"}),
        (
            {"f_stop": None, "t_stop": "2.2"},
            {"lens": SLOWER},
            {"lens": SLOWER, "f_stop": repr(WIDEST), "focus_distance": "3"},
        ),
    ],
    ids=["as wide as it can", "same stop", "stop", "model", "from a T-stop"],
)
@pytest.mark.parametrize("mode", ["light", "auto"])
def test_each_picture_has_the_bits_of_that_drawn_alone(
    stage: Stage, turned: Any, beside: Any, texts: Any, mode: str
) -> None:
    turned = {name: text for name, text in turned.items() if (name, mode) != ("iso", "auto")}
    base = {"lens": LENS, "f_stop": "2.1", "focus_distance": "3", "exposure": mode, **turned}
    dials = Dials().turned(base)
    last = drawn(stage, dials, beside)[-1]
    chosen = last.shot.chosen
    same = {} if chosen is None else {**texts_of_words(chosen.words), "exposure": "manual"}
    first, other = (panel.frame for panel in last.panels)
    assert last.samples == 4
    assert last.whole
    assert np.array_equal(first.rgb, last.frame.rgb)
    assert np.array_equal(first.rgb, alone(stage, dials).rgb)
    assert np.array_equal(other.rgb, alone(stage, dials.turned({**same, **texts})).rgb)
    assert not np.array_equal(other.rgb, first.rgb)


def test_a_point_in_focus_gives_the_other_lens_its_distance(stage: Stage) -> None:
    dials = Dials().turned({"lens": LENS, "focus_at": "30,34"})
    last = drawn(stage, dials, {"lens": SLOWER})[-1]
    distance = last.session.prepared.setup.lens.focus_distance_m
    texts = {"lens": SLOWER, "f_stop": "4", "focus_distance": repr(distance)}
    assert np.array_equal(last.panels[1].frame.rgb, alone(stage, dials.turned(texts)).rgb)


def test_both_pictures_come_small_at_first(stage: Stage) -> None:
    stage.settings = stage.settings.with_(resolution=(240, 160))
    first = drawn(stage, Dials().turned({"lens": LENS}), {"f_stop": "8"})[0]
    assert [panel.frame.width for panel in first.panels] == [60, 60]
    assert not first.whole


def test_names_say_lens_stop_and_model(stage: Stage) -> None:
    dials = Dials().turned({"lens": LENS, "f_stop": "4"})
    names = [p.name for p in drawn(stage, dials, {"lens": SLOWER})[-1].panels]
    assert names == ["Double Gauss 50 mm f/2 · f/4", "Canon EF 24-70 mm f/2.8 L II USM · f/4"]
    names = [p.name for p in drawn(stage, dials, {"lens_model": "pinhole"})[-1].panels]
    assert [name.split(" · ")[-1] for name in names] == ["exact", "pinhole"]


def test_a_lens_that_cannot_focus_there_leaves_the_first_picture(stage: Stage) -> None:
    dials = Dials().turned({"lens": LENS, "focus_distance": "0.6"})
    last = drawn(stage, dials, {"lens": FAR_ONLY})[-1]
    assert last.panels == ()
    assert np.array_equal(last.frame.rgb, alone(stage, dials).rgb)
    told = [text for text in readings_of(last)["warnings"] if "beside" in text]
    assert told == [
        "No picture beside this one: The lens does not focus that near: focus farther away, or "
        "move the camera back."
    ]


def test_brightness_turns_both_pictures_without_new_samples(stage: Stage) -> None:
    beside = {"f_stop": "8"}
    dials = Dials().turned({"lens": LENS, "exposure": "manual", "iso": "100"})
    brighter = dials.turned({"iso": "200"})
    seen = Seen(stage)
    try:
        seen.painter.request(PictureRequest(1, stage, dials, stage.shot(dials), beside=beside))
        seen.until_rest(1)
        seen.painter.request(
            PictureRequest(2, stage, brighter, stage.shot(brighter), beside=beside)
        )
        pictures = seen.until_rest(2)
    finally:
        seen.painter.close()
    assert len(pictures) == 1
    for panel, texts in zip(pictures[0].panels, ({}, beside), strict=True):
        assert np.array_equal(panel.frame.rgb, alone(stage, brighter.turned(texts)).rgb)


def test_pictures_do_not_bleed_into_each_other() -> None:
    flat = np.full((40, 100, 3), 120, np.uint8)
    grain = np.random.default_rng(1).integers(0, 255, flat.shape, np.uint8)
    for parts in [flat, grain], [grain, flat]:
        kind, data = image.encoded(image.side_by_side([p.repeat(5, axis=0) for p in parts]), 88)
        assert kind == "jpeg"
        halves = np.hsplit(simplejpeg.decode_jpeg(data), 2)
        side = [part is flat for part in parts].index(True)
        assert np.abs(halves[side][:, :100].astype(int) - 120).max() <= 1


def test_the_histogram_is_that_of_the_picture_of_the_dials(stage: Stage) -> None:
    dials = Dials().turned({"lens": LENS, "exposure": "manual", "iso": "100"})
    both = drawn(stage, dials, {"f_stop": "22"})[-1]
    own = image.image_of(replace(both, panels=()))
    assert image.image_of(both).histogram == own.histogram
    other = replace(both, frame=both.panels[1].frame, panels=())
    assert image.image_of(other).histogram != own.histogram


def halves(data: bytes, width: int) -> list[NDArray[np.uint8]]:
    """Two pictures of 60 x 40, each in a half of their rows."""
    rows = np.frombuffer(data, np.uint8).reshape(40, width, 3)
    return [half[:, :60] for half in np.hsplit(rows, 2)]


def test_each_side_is_tinted_by_its_own_exposure(stage: Stage) -> None:
    dials = Dials().turned({"lens": LENS, "exposure": "manual", "iso": "102400"})
    both = drawn(stage, dials, {"f_stop": "22"})[-1]
    made = image.image_of(both, tint=tint.FALSE_COLOUR)
    assert made.tint is not None
    assert made.tint["note"] == ""
    found = halves(made.bytes[-made.tint["bytes"] :], made.size[0])
    wanted = [false_colour(panel.frame) for panel in both.panels]
    assert all(map(np.array_equal, found, wanted))
    assert not np.array_equal(*wanted)


def test_each_side_is_tinted_by_its_own_depth_of_field(stage: Stage) -> None:
    both = drawn(stage, Dials().turned({"lens": LENS, "f_stop": "2.1"}), {"f_stop": "22"})[-1]
    made = image.image_of(both, tint=tint.DEPTH)
    assert made.tint is not None
    found = halves(made.bytes[-made.tint["bytes"] :], made.size[0])
    for pixels, panel in zip(found, both.panels, strict=True):
        shown = image.shown(panel.frame, panel.shot)
        wanted = tint.tint_of(
            tint.DEPTH, panel.frame, panel.session, shown, limits_of(panel.session)
        )
        assert wanted is not None
        assert np.array_equal(pixels, wanted.pixels)
    assert limits_of(both.panels[0].session) != limits_of(both.panels[1].session)


def test_a_side_without_a_tint_says_why(stage: Stage) -> None:
    dials = Dials().turned({"lens": "thin", "tilt": "5,0"})
    both = drawn(stage, dials, {"lens": LENS})[-1]
    made = image.image_of(both, tint=tint.DEPTH)
    assert made.tint is not None
    assert "tilted" in made.tint["note"]


def test_a_wish_for_another_picture_beside_shows_other_light(stage: Stage) -> None:
    dials = Dials()
    shot = stage.shot(dials)
    requests = [
        PictureRequest(1, stage, dials, shot, beside=one) for one in (None, {"f_stop": "8"})
    ]
    assert requests[0].is_lit_as(requests[0])
    assert not requests[0].is_lit_as(requests[1])


# The server


@pytest.fixture
def server(stage: Stage) -> Iterator[Live]:
    pytest.importorskip("websockets", reason="needs the extra view")
    with live(stage, Dials.of({"lens": LENS, "f_stop": "2.1"})) as running:
        yield running


def test_the_picture_at_rest_has_both_at_full_size(server: Live) -> None:
    with page_of(server) as one:
        one.until_rest(0)
        command = one.state["command"]
        one.send(show={"beside": {"lens": SLOWER}})
        head = one.until_rest(1)
        assert (head["divided"], head["part"], head["size"][1]) == (True, 60, 40)
        width = head["size"][0]
        sent = np.frombuffer(one.bytes, np.uint8)[: 40 * width * 3].reshape(40, width, 3)
        picture = server.hub.picture
        assert picture is not None
        for i, panel in enumerate(picture.panels):
            begin = i * width // 2
            assert np.array_equal(sent[:, begin : begin + 60], panel.frame.display())
        while one.state["read"] != 1:
            one.step()
        assert one.state["show"]["beside"] == {"lens": SLOWER}
        assert one.state["command"] == command
        assert not one.state["undoes"]


def test_values_are_those_of_the_side_under_the_pointer(server: Live) -> None:
    with page_of(server) as one:
        one.until_rest(0)
        one.send(show={"beside": {"f_stop": "8"}})
        one.until_rest(1)
        picture = server.hub.picture
        assert picture is not None
        for part, panel in enumerate(picture.panels):
            one.send(probe=[31, 22, part])
            count = len(one.values)
            while len(one.values) == count:
                one.step()
            assert one.values[-1]["rgb"] == [float(v) for v in panel.frame.rgb[22, 31]]
        one.send(probe=[31, 22, 2])
        while one.values[-1] is not None:
            one.step()


@pytest.mark.parametrize(
    ("beside", "told"),
    [
        ({"lens": "/etc/passwd"}, "wanted a name of the library"),
        ({"f_stop": "wide"}, "--f-stop"),
        ({"lens": LENS, "f_stop": "4"}, "show: beside: wanted one text, of lens, f_stop, lens_m"),
        ({"iso": "100"}, "show: beside: wanted one text"),
        ({"f_stop": 4}, "show: beside: wanted one text"),
        ([], "show: beside: wanted one text"),
    ],
)
def test_others_are_refused(server: Live, beside: Any, told: str) -> None:
    with page_of(server) as one:
        one.send(show={"beside": beside})
        while not one.refused:
            one.step()
        assert told in one.refused[0]
        assert server.hub.number == 0


def test_models_and_a_picture_beside_exclude_each_other(server: Live) -> None:
    with page_of(server) as one:
        one.send(show={"models": True, "beside": {"f_stop": "4"}})
        while not one.refused:
            one.step()
        assert one.refused == ["show: wanted models or a picture beside, got both"]


def test_models_end_a_picture_beside_and_it_ends_them(server: Live) -> None:
    beside = {"f_stop": "4"}
    with page_of(server) as one:
        one.until_rest(0)
        for change, models, other in (
            ({"beside": beside}, False, beside),
            ({"models": True}, True, None),
            ({"tint": "depth"}, True, None),
            ({"beside": beside}, False, beside),
        ):
            one.send(show=change)
            while (one.state["show"]["models"], one.state["show"]["beside"]) != (models, other):
                one.step()
        assert one.state["show"]["tint"] == "depth"
        assert one.refused == []


# The page


@pytest.fixture
def finder(page: Browser, server: Live) -> Browser:
    return shows(page, server)


def choose(page: Browser, value: Any) -> None:
    """Chooses an option of Beside, and waits for its picture."""
    text = "" if value is None else json.dumps(value, separators=(",", ":"))
    page.run(
        f"(() => {{ const e = document.getElementById('beside'); e.value = {json.dumps(text)};"
        "e.dispatchEvent(new Event('change')); })()"
    )
    hidden = str(value is None).lower()
    page.until(
        f"document.getElementById('divider').hidden === {hidden}"
        " && document.getElementById('frame').ariaBusy === 'false'"
    )


def canvas(page: Browser) -> NDArray[np.uint8]:
    """Pixels on the screen, (H, W, 3)."""
    found = page.run(
        "(() => { const c = document.getElementById('picture');"
        "const {data} = c.getContext('2d').getImageData(0, 0, c.width, c.height);"
        "return [c.height, c.width, ...data]; })()"
    )
    return np.array(found[2:], np.uint8).reshape(*found[:2], 4)[..., :3]


def parted(page: Browser, server: Live, column: int) -> bool:
    """Whether the first picture is left of a column, and the other one right of it."""
    picture = server.hub.picture
    assert picture is not None
    first, other = (panel.frame.display() for panel in picture.panels)
    return np.array_equal(canvas(page), np.hstack([first[:, :column], other[:, column:]]))


@pytest.mark.skipif(program() is None, reason="needs chromium")
@pytest.mark.xdist_group("chromium")
class TestPage:
    def test_keys_and_mouse_move_the_divider(self, finder: Browser, server: Live) -> None:
        choose(finder, {"lens_model": "pinhole"})
        assert parted(finder, server, 30)
        finder.run("document.getElementById('divider').focus()")
        for key, percent in [("ArrowLeft", 49), ("PageUp", 59), ("Home", 0), ("End", 100)]:
            finder.press(key)
            now = "document.getElementById('divider').getAttribute('aria-valuenow')"
            assert finder.run(now) == str(percent)
            assert parted(finder, server, round(0.6 * percent))
        finder.press("Home")
        width = finder.run("document.getElementById('picture').clientWidth")
        finder.drag("#divider", 0.75 * width)
        assert parted(finder, server, 45)
        assert finder.errors == []

    def test_a_click_in_the_other_half_focuses_there(self, finder: Browser, server: Live) -> None:
        choose(finder, {"f_stop": "4"})
        number = server.hub.number
        width, height = finder.run(
            "(({clientWidth: w, clientHeight: h}) => [w, h])(document.getElementById('picture'))"
        )
        finder.click("#picture", 0.26 * width, 0.31 * height)
        finder.until(f"document.getElementById('frame').dataset.turn > {number}")
        assert server.hub.dials.texts["focus_at"] == "45,32"

    def test_the_loupe_tells_the_values_of_its_side(self, finder: Browser, server: Live) -> None:
        choose(finder, {"f_stop": "8"})
        finder.click("[data-toggle=loupe]")
        picture = server.hub.picture
        assert picture is not None
        x, y = finder.place("#picture")
        box = finder.run("document.getElementById('picture').getBoundingClientRect().width")
        text = "document.querySelector('#loupe p').textContent"
        for share, part in [(0.25, 0), (0.75, 1)]:
            finder.run("document.querySelector('#loupe p').textContent = ''")
            finder.mouse("mouseMoved", x + (share - 0.5) * box, y + 20)
            finder.run("new Promise((done) => setTimeout(done, 60))")
            finder.mouse("mouseMoved", x + (share - 0.5) * box + 1, y + 20)
            middle = picture.panels[0].frame.width / 2  # an answer to the move before may come late
            right = f"(parseInt({text}) > {middle}) === {'true' if part else 'false'}"
            place, told, *_ = finder.until(f"{text} && {right} && {text}").split("\n")
            column, row = (int(v) for v in place.split(","))
            red = float(told.removeprefix("R "))
            value = float(picture.panels[part].frame.rgb[row, column, 0])
            assert red == pytest.approx(value, rel=1e-3)
            other = float(picture.panels[1 - part].frame.rgb[row, column, 0])
            assert red != pytest.approx(other, rel=1e-3)

    def test_the_parade_is_that_of_the_picture_of_the_dials(
        self, finder: Browser, server: Live
    ) -> None:
        finder.click("[data-toggle=parade]")
        parade = (
            "document.getElementById('parade').getContext('2d').getImageData(0, 0, 256, 80)"
            ".data.join()"
        )
        own = finder.run(parade)
        choose(finder, {"f_stop": "22"})
        assert finder.run(parade) == own

    def test_stops_are_offered_by_how_far_they_are(self, finder: Browser, server: Live) -> None:
        texts = "[...document.querySelectorAll('#beside option')].map((one) => one.textContent)"
        stops = [text for text in finder.run(texts) if text.startswith("f/")]
        assert stops[:2] == ["f/2.8, 0.7 stops narrower", "f/4, 2 stops narrower"]
        choose(finder, {"f_stop": "4"})
        before = server.hub.number
        server.turn({"f_stop": "8"})
        finder.until(
            f"document.getElementById('frame').dataset.turn > {before} && "
            "document.getElementById('beside').selectedOptions[0].textContent"
            " === 'f/4, 2 stops wider'"
        )

    def test_the_lens_picker_chooses_the_other_lens(self, finder: Browser, server: Live) -> None:
        before = server.hub.dials
        finder.run(
            "(() => { const e = document.getElementById('beside'); e.value = 'pick';"
            "e.dispatchEvent(new Event('change')); })()"
        )
        finder.until("document.querySelectorAll('#lens-list [role=option]').length > 100")
        assert not finder.run("document.getElementById('lens-take').checkVisibility()")
        finder.run("document.getElementById('lens-search').value = 'canon 24-70'")
        finder.run("document.getElementById('lens-search').dispatchEvent(new Event('input'))")
        finder.until("document.querySelectorAll('#lens-list [role=option]').length < 20")
        finder.click("#lens-list [role=option]:first-child")
        finder.press("Enter")
        finder.until("!document.getElementById('divider').hidden")
        assert "Canon EF 24-70" in finder.run("document.getElementById('names').textContent")
        assert "Canon EF 24-70" in finder.run(
            "document.getElementById('beside').selectedOptions[0].textContent"
        )
        assert server.hub.dials == before
        choose(finder, None)
        assert finder.run("document.getElementById('names').textContent") == ""
