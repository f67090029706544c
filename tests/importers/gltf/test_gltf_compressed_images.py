"""KHR_texture_basisu and EXT_texture_webp: pixels as they were, whatever they are packed in."""

from __future__ import annotations

import json
import re
import struct
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest

from daguerre.errors import InputError
from daguerre.files import extras
from daguerre.importers.gltf import reader as gltf
from daguerre.pictures import images
from tests.support.formats.make_gltf import Builder, png, triangle

KTX2 = {
    key: bytes.fromhex(text)
    for key, text in json.loads((Path(__file__).parents[2] / "data/ktx2.json").read_text())[
        "files"
    ].items()
}
# The packed picture: blocks of 4 x 4 pixels of one colour each, and an edge that cuts some.
_Y, _X = np.mgrid[0:10, 0:18] // 4
PICTURE = np.stack([_X * 60, _Y * 100, 255 - _X * 50, np.where(_X < 2, 255, 64)], -1)
PLAIN = np.full((4, 4, 3), 7, np.uint8)
RED = np.tile(np.array([200, 100, 0, 128], np.uint8), (8, 8, 1))


def webp(folder: Path) -> bytes:
    spec = oiio.ImageSpec(8, 8, 4, oiio.UINT8)
    spec.attribute("oiio:UnassociatedAlpha", 1)
    spec.attribute("compression", "lossless")
    out = oiio.ImageOutput.create(str(folder / "made.webp"))
    out.open(str(folder / "made.webp"), spec)
    out.write_image(RED)
    out.close()
    return (folder / "made.webp").read_bytes()


def scene(name: str, data: bytes, *, plain: bool, required: bool = False) -> Builder:
    b = triangle()
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = b.accessor([[0, 0]] * 3)
    b.json["meshes"][0]["primitives"][0]["material"] = 0
    packed = b.add("images", {"bufferView": b.view(data), "mimeType": "image/ktx2"})
    texture: dict[str, Any] = {"extensions": {name: {"source": packed}}}
    if plain:
        texture["source"] = b.add("images", {"bufferView": b.view(png(PLAIN))})
    info = {"index": b.add("textures", texture)}
    b.add("materials", {"pbrMetallicRoughness": {"baseColorTexture": info}, "normalTexture": info})
    b.json["extensionsUsed"] = [name]
    b.json["extensionsRequired"] = [name] if required else []
    return b


@pytest.mark.parametrize("key", ["etc1s", "uastc", "uastc zstd", "etc1s opaque"])
def test_ktx2_pixels(key: str) -> None:
    pytest.importorskip("opengl_basisu", reason="needs the extra compression")
    got = images.decode(KTX2[key], "here")
    wanted = PICTURE[:, :, :3] if "opaque" in key else PICTURE
    assert got.dtype == np.uint8
    # ETC1S stores colours of flat blocks in 5 bits.
    np.testing.assert_allclose(got.astype(int), wanted, atol=5 if "etc1s" in key else 2)


def test_the_use_of_a_texture_tells_its_transfer_function(tmp_path: Path) -> None:
    pytest.importorskip("opengl_basisu", reason="needs the extra compression")
    b = scene("KHR_texture_basisu", KTX2["uastc"], plain=True, required=True)
    read = gltf.read(b.glb(tmp_path / "a.glb"))
    assert [t.srgb for t in read.textures] == [True, False]  # colour and normals of one linear file
    assert all(t.pixels.shape == (10, 18, 4) for t in read.textures)
    assert not read.warnings


def test_webp_pixels(tmp_path: Path) -> None:
    b = scene("EXT_texture_webp", webp(tmp_path), plain=True, required=True)
    np.testing.assert_array_equal(gltf.read(b.glb(tmp_path / "a.glb")).textures[0].pixels, RED)


def test_without_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    hint = re.escape(extras.hint("opengl_basisu"))
    path = tmp_path / "a.glb"
    read = gltf.read(scene("KHR_texture_basisu", KTX2["uastc"], plain=True).glb(path))
    np.testing.assert_array_equal(read.textures[0].pixels, PLAIN)
    assert any("fallback image" in w and "2 uses" in w for w in read.warnings), read.warnings
    read = gltf.read(scene("KHR_texture_basisu", KTX2["uastc"], plain=False).glb(path))
    assert not read.textures
    assert any("is left out" in w and extras.hint("opengl_basisu") in w for w in read.warnings)
    with pytest.raises(InputError, match=r"extensionsRequired\[0\]: .*opengl_basisu.*" + hint):
        gltf.read(scene("KHR_texture_basisu", KTX2["uastc"], plain=True, required=True).glb(path))


@pytest.mark.parametrize(
    ("place", "form", "value", "message"),
    [
        (12, "<I", 37, r"vkFormat: wanted 0 \(Basis Universal\), got 37"),
        (20, "<I", 0, "size: wanted at least 1x1, got 0x10"),
        (20, "<I", 1 << 30, "image size: wanted at most|bytes of UASTC"),
        (28, "<I", 2, "a 2D texture"),
        (32, "<I", 4, "a 2D texture"),
        (36, "<I", 6, "a 2D texture"),
        (40, "<I", 99, "levelCount: wanted at most 32, got 99"),
        (44, "<I", 3, "supercompressionScheme"),
        (80, "<Q", 1 << 60, "level 0: wanted at most"),
        (96, "<Q", 1 << 40, "level 0: wanted 240 bytes of UASTC, got 1099511627776"),
    ],
)
def test_headers_that_claim_too_much(place: int, form: str, value: int, message: str) -> None:
    data = bytearray(KTX2["uastc zstd"])
    struct.pack_into(form, data, place, value)
    with pytest.raises(InputError, match="^here: .*(" + message + ")"):
        images.decode(bytes(data), "here")


def test_damaged_and_cut_files_end_in_pixels_or_one_error(tmp_path: Path) -> None:
    pytest.importorskip("opengl_basisu", reason="needs the extra compression")
    rng = np.random.default_rng(3)
    errors = 0
    for key in ("etc1s", "uastc", "uastc zstd"):
        for step in range(300):
            data = bytearray(KTX2[key])
            for place in rng.integers(12, len(data), rng.integers(1, 4)):
                data[place] = rng.integers(256)
            try:
                images.decode(bytes(data if step % 4 else data[: step * len(data) // 300]), "here")
            except InputError:
                errors += 1
    assert errors > 200
    cut = webp(tmp_path)[:-4]
    with pytest.raises(InputError, match="truncated WebP"):
        images.decode(cut, "here")
