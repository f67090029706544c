"""Aids for the eye: false colour, distance, tints and legends, marks and guides."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.color.srgb import to_linear
from daguerre.frame.frame import Frame
from daguerre.sensors.iso_speed import GREY
from daguerre.viewfinder import tint
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.false_colour import REACH, false_colour, stops_from_grey, zone_colours
from daguerre.viewfinder.image import image_of
from daguerre.viewfinder.readings import limits_of, readings_of
from daguerre.viewfinder.sight import depths_m, distance_at
from daguerre.viewfinder.stage import Stage

from .colour_blind import SEEN_BY, lab, seen
from .live import live, page
from .test_exposure import drawn

simplejpeg = pytest.importorskip("simplejpeg", reason="needs the extra view")
LENS = "double-gauss-50mm-f2"
#: Distances of the boards from the pupil, m.
BOARDS = (1.0, 2.0, 6.0)


def boards() -> dg.Scene:
    """Boards before a sky at three distances from the camera, side by side; the sky is on top."""
    made = dg.Scene()
    material = made.add_material(dg.Material(kind=dg.Diffuse((0.5, 0.5, 0.5))))
    for i, away in enumerate(BOARDS):
        x0, x1, y0, y1 = ((i - 1.5) / 5, (i - 0.5) / 5, -0.2, 0.1)
        corners = away * np.array(
            [[x0, y0, -1], [x1, y0, -1], [x1, y1, -1], [x0, y1, -1]], np.float32
        )
        mesh = made.add_mesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
        made.add_instance(mesh, material=material)
    made.set_environment(color=(1.0, 1.0, 1.0))
    made.add_camera("main", dg.Camera(transform=np.eye(4), focus_distance=2.0))
    return made


def stage(**changes: Any) -> Stage:
    made = boards()
    settings = dg.RenderSettings.of(resolution=(90, 60), spp=1)
    return Stage(made, made.camera().with_(lens=LENS, f_stop=4).with_(**changes), settings)


#: Middles of the boards in the picture, px, and their distances; then the sky.
PLACES = [(27, 33, 1.0), (45, 33, 2.0), (63, 33, 6.0), (45, 3, math.inf)]


# False colour


def patches(light: Any, **metadata: Any) -> Frame:
    """A frame of grey patches, side by side."""
    values = np.asarray(light, np.float32)[None, :, None]
    return Frame(np.repeat(values, 3, axis=2), metadata=metadata)


@pytest.mark.parametrize("ev", [0.0, -2.0, 1.5])
def test_stops_are_those_from_middle_grey(ev: float) -> None:
    wanted = np.arange(-7, 8) + 0.25
    frame = patches(GREY * 2.0 ** (wanted - ev), exposure="light", exposure_compensation=ev)
    assert stops_from_grey(frame)[0] == pytest.approx(wanted, abs=1e-5)


def test_stops_are_those_of_the_shown_picture_in_manual() -> None:
    facts = {"exposure": "manual", "expTime": 0.02, "aperture": 4.0, "isoSpeed": 400.0}
    frame = patches([2.0, 20.0, 200.0], **facts)
    shown = to_linear(frame.display()[0, :, 1] / 255)
    unclipped = shown < 0.9
    assert unclipped.sum() == 2
    found = 2.0 ** stops_from_grey(frame)[0] * GREY
    assert found[unclipped] == pytest.approx(shown[unclipped], rel=0.03)


def test_zones_are_whole_stops_about_grey() -> None:
    stops = [-math.inf, -9.0, -6.0, -0.6, -0.4, 0.0, 0.4, 0.6, 2.5001, 6.0, 12.0]
    zones = [-6, -6, -6, -1, 0, 0, 0, 1, 3, 6, 6]
    found = false_colour(patches(GREY * np.exp2(stops), exposure="light"))[0]
    assert np.array_equal(found, zone_colours()[np.array(zones) + REACH])


def test_what_is_no_number_is_black() -> None:
    found = false_colour(patches([np.nan, -1.0, np.inf], exposure="light"))[0]
    assert np.array_equal(found, zone_colours()[[0, 0, -1]])


@pytest.mark.parametrize("eyes", SEEN_BY)
def test_zones_are_in_order_and_apart_for_all_eyes(eyes: str) -> None:
    colours = lab(seen(zone_colours(), eyes))
    assert np.diff(colours[:, 0]).min() > 4  # of 100
    assert np.linalg.norm(np.diff(colours, axis=0), axis=1).min() > 5.5  # 2.3 is just noticeable


def test_middle_grey_keeps_its_grey() -> None:
    assert zone_colours()[REACH].tolist() == Frame.display(patches([GREY]))[0, 0].tolist()


# Distance


@pytest.mark.parametrize("given", [{}, {"lens": "thin"}, {"lens": "pinhole", "f_stop": None}])
def test_the_distance_of_a_point(given: dict[str, Any]) -> None:
    found = drawn(stage(**given), Dials())
    for x, y, wanted in PLACES:
        assert distance_at(found.session, x + 0.5, y + 0.5) == pytest.approx(wanted, abs=1e-3)
        assert depths_m(found.session)[y, x] == pytest.approx(wanted, abs=1e-3)


@pytest.mark.parametrize("origin", ["pupil", "sensor"])
def test_the_distance_is_that_of_the_ring_focused_there(origin: str) -> None:
    for x, y, _ in PLACES[:3]:
        found = drawn(stage(focus_distance=None, focus_at=(x, y), focus_from=origin), Dials())
        focus = readings_of(found)["focus_m"]
        assert distance_at(found.session, x, y) == pytest.approx(focus, abs=1e-3)


@pytest.mark.parametrize("near", [0.0, 1.5])
def test_what_is_clipped_has_no_distance(near: float) -> None:
    found = drawn(stage(near_clip=near), Dials())
    wanted = math.inf if near else 1.0
    assert distance_at(found.session, 27, 33) == pytest.approx(wanted, abs=1e-3)


# Tint by distance


def tinted(found: Any, kind: str = tint.DEPTH) -> tint.Tint:
    facts = readings_of(found)
    pixels = found.shot.photograph.shown(found.frame, found.shot.tone)
    made = tint.tint_of(kind, found.frame, found.session, pixels, (facts["near_m"], facts["far_m"]))
    assert made is not None
    return made


def part_of(colour: Any) -> int:
    """Part of the depth of field that a tinted pixel shows: 0 near, 1 sharp, 2 far."""
    colours = np.array([tint.NEAR, tint.SHARP, tint.FAR], float)
    colours /= np.linalg.norm(colours, axis=1, keepdims=True)
    return int(np.argmax(colours @ np.asarray(colour, float)))


@pytest.mark.parametrize(
    ("given", "parts"),
    [
        ({}, [0, 1, 2, 2]),
        ({"focus_distance": 1.0}, [1, 2, 2, 2]),
        ({"focus_distance": 6.0, "focus_from": "sensor"}, [0, 0, 1, 2]),
        ({"focus_distance": math.inf}, [0, 0, 0, 1]),
        ({"focus_distance": 3.0, "f_stop": 22}, [0, 1, 1, 2]),
        ({"lens": "pinhole", "f_stop": None}, [1, 1, 1, 1]),
    ],
)
def test_points_are_tinted_by_the_depth_of_field(given: Any, parts: list[int]) -> None:
    found = drawn(stage(**given), Dials())
    facts = readings_of(found)
    near, far = facts["near_m"] or 0.0, facts["far_m"] or math.inf
    if facts["f_stop"] is not None:
        more = 0.0 if given.get("focus_from") != "sensor" else facts["focus_m"] - 6.0
        wanted = [0 if m + more < near else 2 if m + more > far else 1 for *_, m in PLACES]
        assert wanted == parts
    pixels = tinted(found).pixels
    assert pixels is not None
    assert [part_of(pixels[y, x]) for x, y, _ in PLACES] == parts


def test_black_is_tinted_too() -> None:
    black = np.zeros((1, 3, 3), np.uint8)
    found = tint.by_depth(black, np.array([[1.0, 2.0, 3.0]]), (1.5, 2.5))
    assert [part_of(colour) for colour in found[0]] == [0, 1, 2]
    assert found.max(axis=2).min() > 30


@pytest.mark.parametrize("eyes", SEEN_BY)
@pytest.mark.parametrize("level", [0, 60, 128, 255])
def test_parts_are_apart_for_all_eyes(eyes: str, level: int) -> None:
    pixels = np.full((1, 3, 3), level, np.uint8)
    colours = tint.by_depth(pixels, np.array([[1.0, 2.0, 3.0]]), (1.5, 2.5))[0]
    near, sharp, far = lab(seen(colours, eyes))
    for one, other in ((near, sharp), (sharp, far), (near, far)):
        assert np.linalg.norm(one - other) > 15


def test_a_tilted_lens_says_why_it_is_not_tinted() -> None:
    made = tinted(drawn(stage(lens="thin", tilt=(5.0, 0.0)), Dials()))
    assert made.pixels is None
    assert "tilted" in made.note


# Messages to the page


@pytest.mark.parametrize("size", [(90, 60), (240, 160)])
@pytest.mark.parametrize("kind", [tint.FALSE_COLOUR, tint.DEPTH])
def test_the_tinted_picture_follows_the_picture(kind: str, size: tuple[int, int]) -> None:
    one = stage()
    one.settings = one.settings.with_(resolution=size)
    found = drawn(one, Dials())
    plain, more = image_of(found), image_of(found, tint=kind)
    assert plain.tint is None
    assert more.tint is not None
    assert more.histogram == plain.histogram
    assert more.bytes.startswith(plain.bytes)
    data = more.bytes[len(plain.bytes) :]
    assert len(data) == more.tint["bytes"]
    shape = (size[1], size[0], 3)
    wanted = found.shot.photograph.shown(found.frame, found.shot.tone)
    made = tint.tint_of(kind, found.frame, found.session, wanted, limits_of(found.session))
    assert made is not None
    assert made.pixels is not None
    if more.kind == "rgb":
        assert np.array_equal(np.frombuffer(data, np.uint8).reshape(shape), made.pixels)
    else:
        off = simplejpeg.decode_jpeg(data).astype(int) - made.pixels
        assert np.abs(off).mean() < 4


def test_tints_change_neither_the_command_nor_the_picture() -> None:
    pytest.importorskip("websockets", reason="needs the extra view")
    with live(stage()) as server, page(server) as one:
        one.until_rest(0)
        own, command = one.bytes, one.state["command"]
        for kind in (*tint.TINTS[1:], tint.NONE):
            one.send(show={"tint": kind})
            while (one.heads[-1]["tint"] or {"kind": "none"})["kind"] != kind:
                one.step()
            while one.state["show"]["tint"] != kind:
                one.step()
            assert one.heads[-1]["turn"] == 0
            assert one.bytes.startswith(own)
            assert one.state["command"] == command
        assert one.bytes == own
        assert one.refused == []


def test_the_loupe_tells_the_distance() -> None:
    pytest.importorskip("websockets", reason="needs the extra view")
    with live(stage()) as server, page(server) as one:
        one.until_rest(0)
        for x, y, wanted in PLACES:
            one.send(probe=[x, y])
            count = len(one.values)
            while len(one.values) == count:
                one.step()
            found = one.values[-1]["distance_m"]
            assert (math.inf if found is None else found) == pytest.approx(wanted, abs=1e-3)


# Moved as a whole


def test_a_macro_lens_that_moves_as_a_whole_says_so_when_it_is_near() -> None:
    whole = Dials().turned({"lens": "canon-ef-100mm-f2.8-macro"})
    for distance, said in (("1", 1), ("6", 0)):
        warnings = readings_of(drawn(stage(), whole.turned({"focus_distance": distance})))
        assert sum("focuses as a whole" in text for text in warnings["warnings"]) == said
