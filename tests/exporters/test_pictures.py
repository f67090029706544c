"""Pictures of materials: factors, channels, mirrors and transforms stay what the core reads."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

import daguerre as dg
from daguerre.exporters.outgoing.folder import OutgoingFolder
from daguerre.exporters.outgoing.picture_file import write_pixels
from daguerre.exporters.outgoing.pictures import BakedPicture, Baker
from daguerre.files.notes import Notes
from daguerre.scene.parts import Texture

RNG = np.random.default_rng(4)


def baker(pixels: np.ndarray, **more: object) -> Baker:
    """A baker of one texture."""
    return Baker([Texture(pixels, **more)], Notes())  # type: ignore[arg-type]


def looked_up(picture: BakedPicture, uv: np.ndarray) -> np.ndarray:
    """Nearest values at texture coordinates of the mesh, shape (N, 2)."""
    a, b, c, d, e, f = picture.transform
    at = np.stack([a * uv[:, 0] + b * uv[:, 1] + c, d * uv[:, 0] + e * uv[:, 1] + f], 1)
    height, width = picture.pixels.shape[:2]
    index = []
    for axis, size in ((0, width), (1, height)):
        t = at[:, axis]
        if picture.wrap[axis] == "repeat":
            t = t - np.floor(t)
        elif picture.wrap[axis] == "mirror":
            t = t - 2 * np.floor(t / 2)
            t = np.where(t > 1, 2 - t, t)
        else:
            t = np.clip(t, 0, 1)
        index.append(np.minimum((t * size).astype(int), size - 1))
    return picture.linear[index[1], index[0]]


def test_bytes_without_a_factor_stay_bytes() -> None:
    pixels = RNG.integers(0, 256, (4, 6, 4)).astype(np.uint8)
    made = baker(pixels, srgb=True).color(dg.TextureSlot(0), (1.0, 1.0, 1.0))
    assert isinstance(made, BakedPicture)
    np.testing.assert_array_equal(made.pixels, pixels[:, :, :3])
    assert made.srgb


def test_a_factor_multiplies_light_not_codes() -> None:
    pixels = np.full((1, 1, 3), 188, np.uint8)  # about 0.5 of the light
    made = baker(pixels, srgb=True).color(dg.TextureSlot(0), (0.5, 1.0, 0.25))
    assert isinstance(made, BakedPicture)
    light = ((188 / 255 + 0.055) / 1.055) ** 2.4
    np.testing.assert_allclose(made.linear[0, 0], [0.5 * light, light, 0.25 * light], rtol=1e-5)


def test_channels_of_numbers_are_linear_and_a_missing_alpha_is_one() -> None:
    pixels = RNG.integers(0, 256, (3, 3, 3)).astype(np.uint8)
    one = baker(pixels)
    green = one.number(dg.TextureSlot(0), 1.0, 1)
    assert isinstance(green, BakedPicture)
    np.testing.assert_allclose(green.linear[:, :, 0], pixels[:, :, 1] / 255, rtol=1e-6)
    alpha = one.number(dg.TextureSlot(0), 0.5, 3)
    assert isinstance(alpha, BakedPicture)
    np.testing.assert_allclose(alpha.linear, 0.5)
    assert one.number(None, 0.3, 1) == 0.3


def test_alpha_of_an_srgb_texture_is_linear() -> None:
    pixels = np.full((1, 1, 4), 128, np.uint8)
    alpha = baker(pixels, srgb=True).number(dg.TextureSlot(0), 1.0, 3)
    assert isinstance(alpha, BakedPicture)
    assert alpha.linear[0, 0, 0] == pytest.approx(128 / 255)


@pytest.mark.parametrize("wrap", [("mirror", "mirror"), ("mirror", "clamp"), ("repeat", "mirror")])
def test_a_mirrored_texture_is_one_that_repeats_its_mirror_image(wrap: tuple[str, str]) -> None:
    slot = dg.TextureSlot(0, transform=(0.7, 0.2, 0.3, -0.4, 1.2, 0.1))
    pixels = RNG.random((4, 5, 3)).astype(np.float32)
    made = baker(pixels, wrap=wrap).color(slot, (1.0, 1.0, 1.0))
    assert isinstance(made, BakedPicture)
    plain = made.without_mirrors()
    assert "mirror" not in plain.wrap
    uv = RNG.uniform(-3, 3, (400, 2))
    np.testing.assert_array_equal(looked_up(plain, uv), looked_up(made, uv))


def test_the_scale_of_a_normal_map_is_in_its_pixels() -> None:
    normal = np.array([0.3, -0.2, math.sqrt(1 - 0.13)])
    pixels = (normal / 2 + 0.5).astype(np.float32).reshape(1, 1, 3)
    made = baker(pixels).normals(dg.TextureSlot(0), 0.5)
    assert made is not None
    expected = normal * (0.5, 0.5, 1)
    found = 2 * made.linear[0, 0].astype(float) - 1
    np.testing.assert_allclose(found, expected / np.linalg.norm(expected), atol=1e-6)
    assert baker(pixels).normals(None, 1.0) is None


def test_a_written_picture_has_the_date_of_a_reproducible_build(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Equal scenes give equal files, whatever the time is."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    folder = OutgoingFolder(tmp_path / "room.pbrt")
    name = write_pixels(folder, "sky", np.ones((2, 3, 3), np.float32))
    with OpenEXR.File(str(tmp_path / name)) as file:
        assert file.header()["capDate"] == "1970:01:02 00:00:00"
