"""Colours that OpenEXR and Radiance files state, against published matrices."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.color.adaptation import adaptation
from daguerre.color.encodings import encoding_of
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.pictures.iris import read_grey
from daguerre.pictures.light import read_environment
from daguerre.pictures.stated_colors import of_exr
from daguerre.plates.files import read as read_plate
from tests.support.pictures.stated_light import (
    AP0,
    AP1,
    P3,
    REC709,
    REC2020,
    TO_REC709,
    XYZ,
    exr,
    hdr,
)

RNG = np.random.default_rng(7)
#: Greys with a little colour, which every space here has without negative numbers.
LIGHT = (0.5 + 0.1 * RNG.random((3, 4, 3))).astype(np.float32)
IDS = {AP0: "lin_ap0_scene", AP1: "lin_ap1_scene", REC2020: "lin_rec2020_scene",
       P3: "lin_p3d65_scene", XYZ: "lin_ciexyzd65_scene"}  # fmt: skip


def expected(corners: tuple[float, ...], pixels: Any = LIGHT) -> Any:
    return pixels @ np.array(TO_REC709[corners]).T


@pytest.mark.parametrize("corners", TO_REC709, ids=["ap0", "ap1", "2020", "p3", "prophoto", "xyz"])
def test_primaries_are_converted_by_the_published_matrices(
    tmp_path: Path, corners: tuple[float, ...]
) -> None:
    path = exr(tmp_path / "a.exr", LIGHT, chromaticities=corners)
    notes = Notes()
    sky, frame, plate = read_environment(path, notes), dg.load_frame(path), read_plate(path)
    np.testing.assert_allclose(frame.rgb, expected(corners), atol=2e-5)
    np.testing.assert_allclose(sky, frame.rgb, atol=1e-6)
    np.testing.assert_array_equal(plate.pixels, frame.rgb)
    (told,) = notes.sentences()
    assert told.startswith("colors are converted to linear Rec.709 from ")
    assert "chromaticities" in told
    assert "a.exr" in told
    assert frame.metadata["notes"][0] in told
    assert frame.metadata["notes"][0] in plate.notes
    adapted = corners not in (REC2020, P3, XYZ)
    assert ("its white is adapted (Bradford)" in told) == adapted


@pytest.mark.parametrize("corners", IDS)
def test_an_interop_id_counts_more_than_chromaticities(
    tmp_path: Path, corners: tuple[float, ...]
) -> None:
    path = exr(tmp_path / "a.exr", LIGHT, colorInteropID=IDS[corners])
    np.testing.assert_allclose(dg.load_frame(path).rgb, expected(corners), atol=2e-5)
    other = REC2020 if corners == AP0 else AP0
    path = exr(tmp_path / "b.exr", LIGHT, colorInteropID=IDS[corners], chromaticities=other)
    frame = dg.load_frame(path)
    np.testing.assert_allclose(frame.rgb, expected(corners), atol=2e-5)
    assert "chromaticities says" in frame.metadata["notes"][1]


def test_the_flag_of_an_aces_container_counts_most(tmp_path: Path) -> None:
    header = {"acesImageContainerFlag": 1, "colorInteropID": "lin_rec709_scene"}
    frame = dg.load_frame(exr(tmp_path / "a.exr", LIGHT, chromaticities=AP1, **header))
    np.testing.assert_allclose(frame.rgb, expected(AP0), atol=2e-5)
    assert len(frame.metadata["notes"]) == 3


@pytest.mark.parametrize("key", ["oiio:ColorSpace", "colorspace"])
@pytest.mark.parametrize(
    ("name", "corners"),
    [
        ("ACEScg", AP1),
        ("ACES - ACEScg", AP1),
        ("ACES2065-1", AP0),
        ("lin_rec2020", REC2020),
        ("Linear P3-D65", P3),
        ("CIE XYZ-D65 - Scene-referred", XYZ),
    ],
)
def test_names_count_where_nothing_else_does(
    tmp_path: Path, key: str, name: str, corners: tuple[float, ...]
) -> None:
    frame = dg.load_frame(exr(tmp_path / "a.exr", LIGHT, **{key: name}))
    np.testing.assert_allclose(frame.rgb, expected(corners), atol=2e-5)
    frame = dg.load_frame(exr(tmp_path / "b.exr", LIGHT, chromaticities=REC709, **{key: name}))
    np.testing.assert_array_equal(frame.rgb, LIGHT)


def test_a_curve_that_the_file_states_is_undone(tmp_path: Path) -> None:
    path = exr(tmp_path / "a.exr", LIGHT, colorInteropID="srgb_rec709_scene")
    np.testing.assert_allclose(dg.load_frame(path).rgb, ((LIGHT + 0.055) / 1.055) ** 2.4, rtol=1e-5)
    path = exr(tmp_path / "b.exr", -LIGHT, colorInteropID="g22_rec709_scene")
    np.testing.assert_allclose(dg.load_frame(path).rgb, -(LIGHT**2.2), rtol=1e-5)


@pytest.mark.parametrize("white", [(0.32168, 0.33767), (0.3457, 0.3585), (1 / 3, 1 / 3)])
def test_other_whites_are_adapted(tmp_path: Path, white: tuple[float, float]) -> None:
    """Rec.709 primaries: XYZ of the file, adapted by Bradford's matrix (Lindbloom), to Rec.709."""
    corners = (*REC709[:6], *white)
    grey = exr(tmp_path / "grey.exr", np.full((1, 2, 3), 0.5), chromaticities=corners)
    np.testing.assert_allclose(read_environment(grey), 0.5, atol=1e-6)
    frame = dg.load_frame(exr(tmp_path / "a.exr", LIGHT, chromaticities=corners))
    xyz = np.array([(x, y, 1 - x - y) for x, y in np.reshape(REC709, (4, 2))[:3]]).T
    light = np.linalg.inv(np.array(TO_REC709[XYZ])) @ np.ones(3)
    own = xyz * np.linalg.solve(xyz, np.array([white[0], white[1], 1 - sum(white)]) / white[1])
    to_d65 = adaptation(white, (0.3127, 0.3290))
    np.testing.assert_allclose(to_d65 @ own @ np.ones(3), light, atol=1e-4)
    matrix = np.array(TO_REC709[XYZ]) @ to_d65 @ own
    np.testing.assert_allclose(frame.rgb, LIGHT @ matrix.T, atol=3e-5)


@pytest.mark.parametrize(
    "header",
    [
        {},
        {"chromaticities": REC709},
        {"chromaticities": (*REC709[:6], 0.31271, 0.32902)},
        {"colorInteropID": "lin_rec709_scene"},
        {"oiio:ColorSpace": "scene_linear"},
        {"whiteLuminance": 1.0},
        {"adoptedNeutral": np.array([0.4476, 0.4074], np.float32)},  # the camera's white balance
    ],
)
def test_plain_light_keeps_its_bits(tmp_path: Path, header: dict[str, Any]) -> None:
    light = (LIGHT * np.float32(1 / 3)).astype(np.float32)
    path = exr(tmp_path / "a.exr", light, **header)
    notes = Notes()
    np.testing.assert_array_equal(read_environment(path, notes), light)
    frame = dg.load_frame(path)
    np.testing.assert_array_equal(frame.rgb, light)
    assert (notes.sentences(), frame.metadata.get("notes")) == ([], None)


@pytest.mark.parametrize(
    ("corners", "why"),
    [
        ((*REC709[:6], math.nan, 0.329), "not finite"),
        ((0.1, 0.1, 0.2, 0.2, 0.3, 0.3, 0.25, 0.25), "on a line"),
        ((*REC709[:6], 0.3127, 0.0), "white is not a color"),
        ((0.0,) * 8, "on a line"),
        ((*REC709[:6], 0.55, 0.44), "outside of the primaries"),
        ((*REC709[:6], -0.3, 0.3), "white is not a color"),
        ((1e30, *REC709[1:]), "not finite"),
    ],
)
def test_impossible_primaries_are_a_note(
    tmp_path: Path, corners: tuple[float, ...], why: str
) -> None:
    path = exr(tmp_path / "a.exr", LIGHT, chromaticities=corners)
    notes = Notes()
    np.testing.assert_array_equal(read_environment(path, notes), LIGHT)
    np.testing.assert_array_equal(dg.load_frame(path).rgb, LIGHT)
    (told,) = notes.sentences()
    assert why in told
    assert "read as linear Rec.709" in told


def test_the_luminance_of_white_is_a_note(tmp_path: Path) -> None:
    path = exr(tmp_path / "a.exr", LIGHT, whiteLuminance=100.0)
    notes = Notes()
    np.testing.assert_array_equal(read_environment(path, notes), LIGHT)
    assert "1 is 100 cd/m2" in notes.sentences()[0]
    assert dg.load_frame(path).metadata["whiteLuminance"] == 100


def test_unknown_names_and_wrong_types_are_notes(tmp_path: Path) -> None:
    for header, told in (
        ({"colorInteropID": "lin_mars_scene"}, "'lin_mars_scene' is an unknown color space"),
        ({"colorInteropID": "unknown"}, "the color space is unknown"),
        ({"colorInteropID": "data", "chromaticities": AP0}, "says data: no colors are converted"),
    ):
        frame = dg.load_frame(exr(tmp_path / "a.exr", LIGHT, **header))
        np.testing.assert_array_equal(frame.rgb, LIGHT)
        assert told in frame.metadata["notes"][0]
    assert "wanted 8 numbers" in of_exr({"chromaticities": 0.5}).remarks[0]


def test_colors_outside_of_rec709_keep_their_luminance(tmp_path: Path) -> None:
    pixels = np.full((2, 4, 3), 0.5, np.float32)
    pixels[0, :2] = (0.1, 0.9, 0.1)  # a green that no light of Rec.709 has
    notes = Notes()
    sky = read_environment(exr(tmp_path / "a.exr", pixels, chromaticities=AP0), notes)
    light = expected(AP0, pixels)
    assert light.min() < -0.1
    assert sky.min() >= 0
    luminance = np.array([0.2126, 0.7152, 0.0722])
    np.testing.assert_allclose(sky @ luminance, light @ luminance, rtol=1e-3)
    assert notes.sentences()[1].startswith("2 pixels outside of the gamut of Rec.709")


def test_channels_of_xyz(tmp_path: Path) -> None:
    path = exr(tmp_path / "a.exr", LIGHT, "XYZ")
    for light in (read_environment(path), dg.load_frame(path).rgb):
        np.testing.assert_allclose(light, expected(XYZ), atol=2e-5)
    place = exr(tmp_path / "b.exr", np.full((2, 2, 4), 0.5), ("Y", "P.X", "P.Y", "P.Z"))
    np.testing.assert_array_equal(read_environment(place), 0.5)


def test_grey_keeps_its_bits(tmp_path: Path) -> None:
    for corners in (XYZ, AP0):
        path = exr(tmp_path / "a.exr", LIGHT[..., :1], "Y", chromaticities=corners)
        grey = np.repeat(LIGHT[..., :1], 3, axis=2)
        np.testing.assert_array_equal(read_environment(path), grey)
        frame = dg.load_frame(path)
        np.testing.assert_array_equal(frame.rgb, grey)
        assert "notes" not in frame.metadata


def test_luminance_with_chroma_is_refused(tmp_path: Path) -> None:
    path = exr(tmp_path / "a.exr", LIGHT, ("Y", "RY", "BY"))
    for read in (read_environment, dg.load_frame):
        with pytest.raises(InputError, match=r"a\.exr: channels: .* luminance and chroma"):
            read(path)


def test_data_are_not_converted(tmp_path: Path) -> None:
    path = exr(tmp_path / "iris.exr", LIGHT, chromaticities=AP0)
    np.testing.assert_array_equal(read_grey(path), LIGHT.mean(axis=2))
    np.testing.assert_array_equal(read_environment(path, is_data=True), LIGHT)


@pytest.mark.parametrize("corners", [AP0, AP1, REC2020, REC709])
def test_radiance_primaries(tmp_path: Path, corners: tuple[float, ...]) -> None:
    pixel = (1.0, 0.875, 0.75)
    line = "PRIMARIES= " + " ".join(f"{x:.5f}" for x in corners) + "\n"
    notes = Notes()
    light = read_environment(hdr(tmp_path / "a.hdr", pixel, line), notes)
    if corners == REC709:
        assert light[0, 0].tolist() == list(pixel)
        assert notes.sentences() == []
    else:
        np.testing.assert_allclose(light[0, 0], expected(corners, np.array(pixel)), atol=3e-5)
        assert "(PRIMARIES)" in notes.sentences()[0]


def test_radiance_xyz_has_white_e(tmp_path: Path) -> None:
    """In Radiance (1, 1, 1) of XYZ is white: ``ra_xyze`` adapts to equal energy."""
    notes = Notes()
    light = read_environment(hdr(tmp_path / "a.hdr", (0.5, 0.5, 0.5), kind="xyze"), notes)
    np.testing.assert_allclose(light, 0.5, atol=1e-6)
    assert "CIE XYZ, white E (format xyze)" in notes.sentences()[0]
    assert [p.name for p in tmp_path.iterdir()] == ["a.hdr"]
    pixel = (1.0, 0.75, 0.5)
    light = read_environment(hdr(tmp_path / "b.hdr", pixel, kind="xyze"))
    matrix = np.array(TO_REC709[XYZ]) @ adaptation((1 / 3, 1 / 3), (0.3127, 0.3290))
    np.testing.assert_allclose(light[0, 0], matrix @ pixel, atol=3e-5)


def test_radiance_corrections_and_bad_lines(tmp_path: Path) -> None:
    lines = "EXPOSURE=2\nCOLORCORR=1 2 4\n" + f"# {'long command ' * 8}\n" * 80
    light = read_environment(hdr(tmp_path / "a.hdr", (1.0, 1.0, 1.0), lines + "EXPOSURE=2\n"))
    assert light[0, 0].tolist() == [1 / 4, 1 / 8, 1 / 16]
    with pytest.raises(InputError, match="PRIMARIES: wanted 8 numbers"):
        read_environment(hdr(tmp_path / "b.hdr", (1.0, 1.0, 1.0), "PRIMARIES= 1 2 3\n"))
    with pytest.raises(InputError, match="COLORCORR: wanted a positive number"):
        read_environment(hdr(tmp_path / "d.hdr", (1.0, 1.0, 1.0), "COLORCORR=1 0 1\n"))
    notes = Notes()
    path = hdr(tmp_path / "c.hdr", (1.0, 0.5, 0.25), "PRIMARIES= 0 0 0 0 0 0 0 0\n")
    assert read_environment(path, notes)[0, 0].tolist() == [1, 0.5, 0.25]
    assert "on a line" in notes.sentences()[0]


def test_a_swap_of_primaries_would_be_seen() -> None:
    swapped = (*AP0[2:4], *AP0[:2], *AP0[4:])
    light = of_exr({"chromaticities": swapped}).light(LIGHT)
    assert np.abs(light - expected(AP0)).max() > 0.05
    assert encoding_of("lin_ap0_scene") == of_exr({"chromaticities": AP0}).encoding
