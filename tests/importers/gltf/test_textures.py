"""Textures seen from afar, and the light that their codes stand for; whole renders."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import pytest

import daguerre as dg
from daguerre.pictures import images
from daguerre.scene.materials import Gltf, TextureSlot
from tests.support.formats.make_gltf import png
from tests.support.scene import scenes

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
PIXELS = (32, 20)


def picture(scene: dg.Scene, spp: int, seed: int = 0, **camera) -> np.ndarray:
    camera = dg.Camera(lens="pinhole", **camera)
    return dg.render(scene, camera, resolution=PIXELS, spp=spp, seed=seed, max_depth=1).rgb


def ground(min_filter: str, **material) -> dg.Scene:
    """Random texels from below the camera to the horizon, 64 of them per metre; they shine."""
    scene = dg.Scene()
    texels = np.random.default_rng(1).integers(0, 256, (128, 128, 3), np.uint8)
    slot = TextureSlot(scene.add_texture(texels, srgb=True, min_filter=min_filter))
    kind = Gltf(base_color=(0, 0, 0), emissive=(1, 1, 1), emissive_texture=slot, **material)
    corners = np.array([[-1, -1, -1], [1, -1, -1], [1, -1, 1], [-1, -1, 1]]) * (50, 1, 50)
    mesh = scene.add_mesh(corners, [[0, 2, 1], [0, 3, 2]], uv=corners[:, [0, 2]] / 2)
    scene.add_instance(mesh, kind)
    return scene


def relative_error(image: np.ndarray, reference: np.ndarray) -> float:
    a, b = image @ LUMINANCE, reference @ LUMINANCE
    return float(np.mean((a - b) ** 2 / (b**2 + 0.01)))


def test_mip_maps_remove_most_of_the_noise_and_keep_the_converged_picture():
    reference = picture(ground("linear"), 2048, seed=9)
    point, mean = (picture(ground(f), 4) for f in ("linear", "linear_mipmap_linear"))
    # Measured: 1/6 of the squared error at 4 samples per pixel.
    assert relative_error(mean, reference) < 0.25 * relative_error(point, reference)
    converged = picture(ground("linear_mipmap_linear"), 512)
    assert relative_error(converged, reference) < 3e-4
    assert converged.mean() == pytest.approx(reference.mean(), rel=2e-3)


@pytest.mark.parametrize("lens", ["pinhole", "double-gauss-50mm-f2"])
def test_neither_ranges_nor_threads_change_a_bit(lens):
    camera = dg.Camera(
        lens=lens, **({} if lens == "pinhole" else {"f_stop": 2, "focus_distance": 3})
    )
    pictures = []
    for threads, ranges in ((1, [(0, 8)]), (2, [(0, 3), (3, 8)]), (3, [(3, 8), (0, 3)])):
        session = dg.Session(
            ground("linear_mipmap_linear"), camera, resolution=PIXELS, threads=threads
        )
        for begin, end in ranges:
            session.draw(begin, end)
        pictures.append(session.frame().rgb)
    assert pictures[0].max() > 0
    assert np.array_equal(pictures[0], pictures[1])
    assert np.array_equal(pictures[0], pictures[2])


def wall(scene: dg.Scene, kind: Gltf, size: float = 30) -> dg.Scene:
    """A square 10 m ahead that fills the frame."""
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * size - (0, 0, 10)
    uv = np.array([[0, 1], [1, 1], [1, 0], [0, 0]])
    scene.add_instance(scene.add_mesh(corners, [[0, 1, 2], [0, 2, 3]], uv=uv), kind)
    return scene


def test_a_lamp_from_an_atlas_is_as_bright_by_every_strategy():
    """A corner of a dark image is lit, and the lamp shows that corner alone: its mean over a wide
    cone would bring in what is not on the lamp, and no light sample could find that."""
    scene = dg.Scene()
    wall(scene, Gltf(base_color=(0.8, 0.8, 0.8), metallic=0.0))
    texels = np.zeros((64, 64, 3), np.uint8)
    texels[:16, :16] = 255
    corner = TextureSlot(scene.add_texture(texels, srgb=True), transform=(0.25, 0, 0, 0, 0.25, 0))
    points, triangles = scenes.quad(3)
    uv = points[:, :2] / 6 + 0.5
    lamp = Gltf(base_color=(0, 0, 0), emissive=(5, 5, 5), emissive_texture=corner)
    toward_wall = np.array([[-1, 0, 0, 5], [0, 1, 0, 0], [0, 0, -1, -5], [0, 0, 0, 1]])
    scene.add_instance(scene.add_mesh(points, triangles, uv=uv), lamp, toward_wall)
    camera = dg.Camera(lens="pinhole", focal_length=150)
    light, bsdf, mis = (
        dg.render(scene, camera, resolution=PIXELS, spp=256, max_depth=1, strategy=s).rgb.mean()
        for s in ("light", "bsdf", "mis")
    )
    assert light > 0.05
    assert bsdf == pytest.approx(light, rel=0.02)
    assert mis == pytest.approx(light, rel=0.01)


def test_cutouts_keep_their_coverage_and_no_dark_rim():
    """A quarter of the texels stands, white on a black matte: far away it covers a quarter."""
    scene = dg.Scene()
    texels = np.zeros((1024, 1024, 4), np.uint8)
    texels[::2, ::2] = 255
    slot = TextureSlot(scene.add_texture(texels, srgb=True, filter="nearest"))
    for factor, expected in ((1.0, 0.25), (0.0, 0.0)):
        kind = Gltf(
            base_color=(factor,) * 3,
            base_color_texture=slot,
            metallic=0.0,
            specular=0.0,
            alpha_mode="mask",
        )
        scene.instances.clear()
        scene.set_environment(color=(1, 1, 1))
        wall(scene, kind)
        rgb = picture(scene, 256)
        # Opaque parts are white in a white world: 1 everywhere; black: the sky through the holes.
        assert rgb.mean() == pytest.approx(1 - 0.25 + expected, abs=0.01)


def test_distant_bumps_of_metal_keep_their_brightness():
    """Steep random bumps on a metal: the mean over few big pixels, with and without levels."""
    rng = np.random.default_rng(2)
    slopes = rng.normal(0, 0.35, (256, 256, 2))
    normals = np.dstack([slopes, np.ones((256, 256))])
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    texels = np.rint((normals * 0.5 + 0.5) * 255).astype(np.uint8)
    means = []
    for min_filter in ("linear", "linear_mipmap_linear"):
        scene = dg.Scene()
        slot = TextureSlot(scene.add_texture(texels, min_filter=min_filter))
        wall(scene, Gltf(roughness=0.2, normal_texture=slot), 60)
        sky = np.zeros((32, 64, 3))
        sky[:10] = 1  # high up, where a flat mirror would not send the camera's rays
        scene.set_environment(sky)
        means.append(picture(scene, 256).mean())
    assert means[0] > 0.05
    assert means[1] == pytest.approx(means[0], rel=0.1)


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


@pytest.mark.parametrize(
    "extra",
    [
        chunk(b"gAMA", struct.pack(">I", 100000)),
        chunk(b"sRGB", b"\0"),
        chunk(b"cHRM", struct.pack(">8I", 31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600)),
        chunk(b"iCCP", b"odd\0\0" + zlib.compress(b"\0" * 128)),
        chunk(b"bKGD", struct.pack(">HHH", 1, 2, 3)),
    ],
)
def test_colour_chunks_of_png_are_ignored_as_gltf_asks(extra):
    values = np.array([[[10, 100, 250], [0, 128, 255]]], np.uint8)
    data = png(values)
    with_chunk = data[:33] + extra + data[33:]  # after IHDR
    assert np.array_equal(images.decode(with_chunk, "a.png"), values)


def test_palettes_become_colours_and_sixteen_bits_stay():
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 1, 8, 3, 0, 0, 0))
    palette = chunk(b"PLTE", bytes((1, 2, 3, 200, 100, 50)))
    data = chunk(b"IDAT", zlib.compress(b"\0\1\0"))
    end = chunk(b"IEND", b"")
    magic = b"\x89PNG\r\n\x1a\n"
    assert images.decode(magic + header + palette + data + end, "p").tolist() == [
        [[200, 100, 50], [1, 2, 3]]
    ]
    clear = chunk(b"tRNS", bytes((255, 51)))
    assert images.decode(magic + header + palette + clear + data + end, "p").tolist() == [
        [[200, 100, 50, 51], [1, 2, 3, 255]]
    ]
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 1, 16, 4, 0, 0, 0))
    data = chunk(b"IDAT", zlib.compress(b"\0" + struct.pack(">4H", 1, 65535, 32768, 0)))
    grey = images.decode(magic + header + data + end, "p")
    assert grey.shape == (1, 2, 2)
    assert grey[0, :, 0].tolist() == pytest.approx([1 / 65535, 32768 / 65535])
    assert grey[0, :, 1].tolist() == [1.0, 0.0]
