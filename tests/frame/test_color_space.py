"""Frames in files of other colour spaces, read by OpenImageIO, OpenColorIO and Daguerre."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.color.spaces import LINEAR
from daguerre.errors import UsageError
from daguerre.frame.frame import Frame
from daguerre.pictures.exr.crops import join_crops
from tests.support.pictures.stated_light import AP0, AP1, REC709, TO_REC709, XYZ

RNG = np.random.default_rng(3)
RGB = RNG.random((6, 8, 3)).astype(np.float32) * 4
CORNERS = {"lin_rec709": REC709, "acescg": AP1, "aces": AP0, "xyz": XYZ}
IDS = {"lin_rec709": "lin_rec709_scene", "acescg": "lin_ap1_scene", "aces": "lin_ap0_scene",
       "xyz": "lin_ciexyzd65_scene"}  # fmt: skip
#: Names in OpenColorIO's configuration.
OCIO = {"lin_rec709": "Linear Rec.709 (sRGB)", "acescg": "ACEScg", "aces": "ACES2065-1",
        "xyz": "CIE XYZ-D65 - Scene-referred"}  # fmt: skip


def layered() -> Frame:
    """A frame with layers of light, a ratio, and data."""
    whole = np.ones((6, 8), np.float32)
    aovs = {f"albedo.{c}": RGB[..., i] / 4 for i, c in enumerate("RGB")} | {"depth.Z": 3 * whole}
    return Frame(
        RGB,
        alpha=whole / 2,
        aovs=aovs,
        variance=RGB / 9,
        samples=np.full((6, 8), 5, np.uint32),
        flare=RGB / 3,
        catcher=-RGB / 5,
        catcher_ratio=RGB / 4,
    )


def stored(path: Path, layer: str = "") -> Any:
    """R, G, B of a layer as they stand in the file, read by OpenImageIO, and the header."""
    picture = oiio.ImageBuf(str(path))
    names = picture.spec().channelnames
    pixels = picture.get_pixels(oiio.FLOAT)
    return pixels[:, :, [names.index(layer + c) for c in "RGB"]], picture.spec()


@pytest.mark.parametrize("name", LINEAR)
def test_a_file_states_its_colors_and_is_read_back(tmp_path: Path, name: str) -> None:
    frame = layered()
    frame.save(tmp_path / "a.exr", colour_space=name)
    pixels, spec = stored(tmp_path / "a.exr")
    assert spec.getattribute("chromaticities") == pytest.approx(CORNERS[name], abs=1e-6)
    assert spec.get_string_attribute("colorInteropID") == IDS[name]
    if name != "lin_rec709":
        wanted = RGB @ np.linalg.inv(np.array(TO_REC709[CORNERS[name]])).T
        np.testing.assert_allclose(pixels, wanted, atol=2e-4)
    for layer, share in (("flare", 3), ("catcher", -5), ("albedo", 4)):
        np.testing.assert_allclose(
            stored(tmp_path / "a.exr", f"{layer}.")[0] * share, pixels, atol=9e-6
        )
    back = dg.load_frame(tmp_path / "a.exr")
    for field in ("rgb", "flare", "catcher", "catcher_ratio"):
        np.testing.assert_allclose(getattr(back, field), getattr(frame, field), atol=3e-6)
    np.testing.assert_allclose(back.layer("albedo"), RGB / 4, atol=2e-6)
    for field in ("variance", "samples", "alpha"):
        np.testing.assert_array_equal(getattr(back, field), getattr(frame, field))
    np.testing.assert_array_equal(back.aovs["depth.Z"], 3)
    back.save(tmp_path / "b.exr")  # in the space of its file
    np.testing.assert_allclose(stored(tmp_path / "b.exr")[0], pixels, atol=5e-6)
    if name == "lin_rec709":
        np.testing.assert_array_equal(back.rgb, RGB)


def test_a_grey_ratio_stays_grey(tmp_path: Path) -> None:
    for name in LINEAR:
        frame = Frame(RGB, catcher=RGB * 0, catcher_ratio=np.full_like(RGB, 0.5))
        frame.save(tmp_path / "a.exr", colour_space=name)
        with OpenEXR.File(str(tmp_path / "a.exr"), separate_channels=True) as file:
            planes = file.channels()
            ratio = [planes[f"catcher_ratio.{c}"].pixels for c in "RGB"]
        np.testing.assert_allclose(ratio, 0.5, atol=1e-6)


@pytest.mark.parametrize("name", LINEAR)
def test_values_are_those_of_opencolorio(tmp_path: Path, name: str) -> None:
    ocio = pytest.importorskip("PyOpenColorIO", reason="needs the extra color")
    config = ocio.Config.CreateFromBuiltinConfig("ocio://studio-config-latest")
    if config.getColorSpace(OCIO[name]) is None:
        pytest.skip(f"this configuration has no {OCIO[name]}")
    Frame(RGB).save(tmp_path / "a.exr", colour_space=name)
    pixels, _ = stored(tmp_path / "a.exr")
    wanted = RGB.copy()
    config.getProcessor(OCIO["lin_rec709"], OCIO[name]).getDefaultCPUProcessor().applyRGB(wanted)
    within = 2.0**-11 if name == "aces" else 1e-6
    np.testing.assert_allclose(pixels, wanted, rtol=within, atol=1e-6)


def test_aces_is_an_image_container(tmp_path: Path) -> None:
    """SMPTE ST 2065-4: half floats R, G, B, A in scanlines, not compressed, and its attributes."""
    bright = RGB.copy()
    bright[0, 0] = 1e6
    facts = {"adoptedNeutral": (0.4476, 0.4074)}
    frame = Frame(bright, variance=RGB, samples=np.ones((6, 8), np.uint32), metadata=facts)
    frame.save(tmp_path / "a.exr", colour_space="aces")
    _, spec = stored(tmp_path / "a.exr")
    assert sorted(spec.channelnames) == ["A", "B", "G", "R"]
    assert str(spec.format) == "half"
    assert spec.tile_width == 0
    assert spec.get_string_attribute("compression") == "none"
    assert spec.get_int_attribute("acesImageContainerFlag") == 1
    assert spec.getattribute("adoptedNeutral") == pytest.approx((0.32168, 0.33767))
    assert (tmp_path / "a.exr").read_bytes()[4:8] == b"\2\0\0\0"  # version 2, no flags
    back = dg.load_frame(tmp_path / "a.exr")
    np.testing.assert_allclose(back.rgb[1:], RGB[1:], atol=4 * 2.0**-10)
    assert np.isfinite(back.rgb).all()
    assert back.metadata["colorspace"] == "aces"


def test_aces_with_other_channels_is_none(tmp_path: Path) -> None:
    layered().save(tmp_path / "a.exr", colour_space="aces")
    _, spec = stored(tmp_path / "a.exr")
    assert str(spec.format) == "float"
    assert spec.get_int_attribute("acesImageContainerFlag") == 0
    assert {"depth.Z", "variance.R", "flare.G"} <= set(spec.channelnames)


@pytest.mark.parametrize("name", ["acescg", "aces"])
def test_crops_are_joined_bit_for_bit(tmp_path: Path, name: str) -> None:
    Frame(RGB, metadata={"resolution": (8, 6)}).save(tmp_path / "whole.exr", colour_space=name)
    for i, (top, bottom) in enumerate(((0, 2), (2, 6))):
        facts = {"resolution": (8, 6), "crop": (0, top, 8, bottom)}
        part = Frame(RGB[top:bottom], metadata=facts)
        part.save(tmp_path / f"{i}.exr", colour_space=name)
    join_crops([tmp_path / "0.exr", tmp_path / "1.exr"], tmp_path / "joined.exr")
    whole, joined = (dg.load_frame(tmp_path / f"{one}.exr") for one in ("whole", "joined"))
    np.testing.assert_array_equal(joined.rgb, whole.rgb)
    assert joined.metadata["colorspace"] == name


def test_spaces_that_a_frame_cannot_have(tmp_path: Path) -> None:
    for name, why in (
        ("srgb", "encoded for a display"),
        ("rec2020", "encoded for a display"),
        ("camera", "--sensor"),
        ("acesgc", "did you mean 'acescg'"),
    ):
        with pytest.raises(UsageError, match=why):
            Frame(RGB).save(tmp_path / "a.exr", colour_space=name)
    with pytest.raises(UsageError, match=r"a\.png: colour_space is for \.exr"):
        Frame(RGB).save(tmp_path / "a.png", colour_space="acescg")
    assert not list(tmp_path.iterdir())
