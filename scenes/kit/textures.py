"""Pictures drawn by arithmetic. Colours are sRGB in [0, 1], shape (H, W, 3); all are seeded."""

from __future__ import annotations

import math
import struct
import tempfile
import zlib
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from numpy.typing import ArrayLike, NDArray

Picture = NDArray[np.floating]
Mask = NDArray[np.bool_]


def png(picture: Picture) -> bytes:
    """PNG bytes of an 8-bit RGB or RGBA picture."""
    pixels = (np.clip(picture, 0, 1) * 255 + 0.5).astype(np.uint8)
    height, width, channels = pixels.shape
    # Filter 1 (each byte less its left neighbour) keeps smooth pictures small.
    left = np.concatenate([np.zeros_like(pixels[:, :1]), pixels[:, :-1]], 1)
    rows = np.concatenate([np.ones((height, 1), np.uint8), (pixels - left).reshape(height, -1)], 1)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    color_type = {3: 2, 4: 6}[channels]
    header = struct.pack(">IIBBBBB", width, height, 8, color_type, 0, 0, 0)
    body = zlib.compress(rows.tobytes(), 9)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")
    )


def jpeg(picture: Picture, quality: int = 90) -> bytes:
    """JPEG bytes of an 8-bit RGB picture."""
    return _encoded(picture, "jpg", f"jpeg:{quality}")


def webp(picture: Picture, quality: int = 90) -> bytes:
    """WebP bytes of an 8-bit RGB or RGBA picture."""
    return _encoded(picture, "webp", f"webp:{quality}")


def _encoded(picture: Picture, suffix: str, compression: str) -> bytes:
    pixels = (np.clip(picture, 0, 1) * 255 + 0.5).astype(np.uint8)
    buffer = oiio.ImageBuf(np.ascontiguousarray(pixels))
    buffer.specmod().attribute("Compression", compression)
    buffer.specmod().attribute("oiio:UnassociatedAlpha", 1)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"picture.{suffix}"
        if not buffer.write(str(file)):
            raise OSError(f"cannot write {suffix}: {buffer.geterror()}")
        return file.read_bytes()


def noise(shape: tuple[int, int], scale_px: tuple[float, float], seed: int) -> Picture:
    """Tileable smooth noise, mean 0, deviation 1; `scale_px` is its grain (rows, columns)."""
    white = np.random.default_rng(seed).standard_normal(shape)
    fy = np.fft.fftfreq(shape[0])[:, None] * scale_px[0]
    fx = np.fft.rfftfreq(shape[1])[None, :] * scale_px[1]
    smooth = np.fft.irfft2(np.fft.rfft2(white) * np.exp(-2 * (fx**2 + fy**2)), shape)
    return (smooth - smooth.mean()) / smooth.std()


def ramp(t: Picture, stops: ArrayLike) -> Picture:
    """Colours (K, 3) spread evenly over t in [0, 1]."""
    colors = np.asarray(stops, float)
    x = np.linspace(0, 1, len(colors))
    return np.stack([np.interp(t, x, colors[:, k]) for k in range(3)], -1)


def normal_map(height: Picture, strength: float) -> Picture:
    """A normal map (+y up, rows run down) of a tileable height field."""
    dx = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) * strength
    dy = (np.roll(height, -1, 0) - np.roll(height, 1, 0)) * strength
    n = np.stack([-dx, dy, np.ones_like(dx)], -1)
    return n / np.linalg.norm(n, axis=-1, keepdims=True) * 0.5 + 0.5


def metallic_roughness(roughness: ArrayLike, metallic: ArrayLike) -> Picture:
    """The packing of glTF: G roughness, B metallic."""
    r, m = np.broadcast_arrays(np.asarray(roughness, float), np.asarray(metallic, float))
    return np.stack([np.zeros_like(r), r, m], -1)


def wood(size: int = 1024, planks: int = 6) -> tuple[Picture, Picture, Picture]:
    """Oiled walnut boards, grain along u: base colour, metallic-roughness, normal map."""
    shape = (size, size)
    k = size / 1024
    v = (np.arange(size) + 0.5) / size * planks
    board = v.astype(int)
    rng = np.random.default_rng(5)
    offset = rng.uniform(0, 40, planks)[board][:, None]
    # Rings: a board cuts a trunk lengthwise, so the distance to the pith bends slowly along u.
    bend = noise(shape, (90 * k, 420 * k), 1) * 0.55 + noise(shape, (22 * k, 260 * k), 2) * 0.10
    rings = 0.5 + 0.5 * np.sin((v[:, None] * 2.6 + bend + offset) * 2 * math.pi)
    rings = rings**1.7
    pores = noise(shape, (1.0 * k, 34 * k), 3)
    fine = noise(shape, (1.6 * k, 90 * k), 4)
    shade = rng.uniform(-0.13, 0.13, planks)[board][:, None]
    tone = np.clip(
        0.52 + shade - 0.34 * rings + 0.07 * fine - 0.06 * np.maximum(pores - 1.1, 0), 0, 1
    )
    color = ramp(
        tone, [(0.13, 0.075, 0.045), (0.33, 0.195, 0.115), (0.52, 0.335, 0.20), (0.66, 0.46, 0.29)]
    )
    edge = np.abs(v - np.round(v)) / planks * size  # px from the nearest joint
    joint = np.exp(-((edge / (1.3 * k)) ** 2))[:, None]
    color *= (1 - 0.8 * joint)[..., None]
    roughness = np.clip(0.34 + 0.09 * rings + 0.05 * fine + 0.3 * joint, 0.2, 1)
    height = -0.25 * rings - 0.3 * np.maximum(pores - 0.8, 0) - 2.5 * joint + 0.08 * fine
    half = slice(None, None, 2)
    return (
        color,
        metallic_roughness(roughness, 0)[half, half],
        normal_map(height, 0.13)[half, half],
    )


def planet_bands(width: int = 256) -> Picture:
    """A gas giant: bands of cream and rust, torn by turbulence, and one red spot."""
    height = width // 2
    y, x = np.mgrid[0:height, 0:width] / height
    swirl = noise((height, width), (5, 22), 11) * 0.018
    t = 0.5 + 0.5 * np.sin(2 * math.pi * (5.2 * (y + swirl) + 0.6 * np.sin(9 * y)))
    color = ramp(
        t, [(0.50, 0.30, 0.19), (0.75, 0.55, 0.38), (0.90, 0.80, 0.64), (0.80, 0.68, 0.55)]
    )
    spot = np.exp(-((((x - 0.9) / 0.09) ** 2 + ((y - 0.66) / 0.05) ** 2) ** 2))[..., None]
    return color * (1 - spot) + np.array([0.66, 0.25, 0.13]) * spot


def planet_seas(width: int = 256) -> Picture:
    """A blue world with land, ice and clouds."""
    height = width // 2
    y = (np.arange(height)[:, None] + 0.5) / height
    land = noise((height, width), (14, 14), 21) + 0.5 * noise((height, width), (5, 5), 22)
    t = np.clip(0.5 + 1.6 * (land - 0.55), 0, 1)
    color = ramp(
        t, [(0.03, 0.13, 0.36), (0.05, 0.25, 0.50), (0.24, 0.36, 0.14), (0.52, 0.45, 0.27)]
    )
    white = np.clip(noise((height, width), (4, 12), 23) - 0.7, 0, 1)
    white = np.maximum(white, np.clip((np.abs(y - 0.5) - 0.42) * 14, 0, 1))[..., None]
    return color * (1 - white) + 0.95 * white


def moon(width: int = 128) -> Picture:
    """Grey rock."""
    n = noise((width // 2, width), (4, 4), 31) + noise((width // 2, width), (11, 11), 32)
    return ramp(np.clip(0.5 + 0.18 * n, 0, 1), [(0.25, 0.24, 0.23), (0.72, 0.70, 0.66)])


def ring_bands(size: int = 256) -> Picture:
    """Rings seen from above, RGBA: alpha is 0 in the gaps, for an alpha mask."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size * 2 - 1
    r = np.hypot(x, y)
    t = 0.5 + 0.5 * np.sin(70 * r + 2.4 * np.sin(23 * r))
    color = ramp(t, [(0.48, 0.39, 0.27), (0.86, 0.76, 0.58)])
    solid = (r > 0.56) & (r < 0.985) & ~((r > 0.80) & (r < 0.835))
    return np.concatenate([color, solid[..., None].astype(float)], -1)


def dial(size: int = 512) -> tuple[Picture, Picture]:
    """A brass calendar plate with engraved ticks: base colour and metallic-roughness."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size * 2 - 1
    r, a = np.hypot(x, y), np.arctan2(y, x) / (2 * math.pi)
    px = 2.0 / size

    def ticks(count: int, r0: float, r1: float, width: float) -> Picture:
        d = np.abs(a * count - np.round(a * count)) / count * 2 * math.pi * r
        return ((d < width) & (r > r0) & (r < r1)).astype(float)

    ink = ticks(12, 0.52, 0.93, 2.2 * px) + ticks(72, 0.84, 0.93, 1.2 * px)
    ink += ticks(360, 0.89, 0.93, 0.8 * px)
    for radius in (0.5, 0.80, 0.945):
        ink += np.abs(r - radius) < 1.4 * px
    star = np.cos(8 * 2 * math.pi * a) * 0.10 + 0.26
    ink += np.abs(r - star) < 1.6 * px
    ink = np.clip(ink, 0, 1)
    brushed = noise((size, size), (40, 1.2), 41) * 0.03
    color = np.array([0.88, 0.70, 0.38]) + brushed[..., None]
    color = color * (1 - ink)[..., None] + np.array([0.09, 0.06, 0.04]) * ink[..., None]
    rough = np.clip(0.22 + 0.6 * ink + brushed, 0.1, 1)
    return color, metallic_roughness(rough, 1 - 0.9 * ink)


def brass_patina(size: int = 256) -> tuple[Picture, Picture]:
    """Old brass, polished where fingers reach: base colour and metallic-roughness."""
    n = noise((size, size), (18, 18), 51) + 0.6 * noise((size, size), (5, 5), 52)
    t = np.clip(0.62 + 0.22 * n, 0, 1)
    color = ramp(t, [(0.46, 0.32, 0.16), (0.80, 0.60, 0.30), (0.91, 0.75, 0.44)])
    return color, metallic_roughness(np.clip(0.42 - 0.26 * t, 0.12, 1), 1.0)


def book_cover(width: int = 256) -> tuple[Picture, Picture]:
    """Green cloth with a gilt frame and star: base colour and metallic-roughness."""
    height = width * 3 // 2
    y, x = np.mgrid[0:height, 0:width] + 0.5
    weave = 0.06 * np.sin(x * 2.1) * np.sin(y * 2.1) + 0.05 * noise((height, width), (6, 6), 61)
    color = np.array([0.07, 0.20, 0.16]) * (1 + 2 * weave[..., None])
    edge = np.minimum(np.minimum(x, width - x), np.minimum(y, height - y)) / width
    gilt = (np.abs(edge - 0.07) < 0.009) | (np.abs(edge - 0.10) < 0.004)
    dx, dy = (x - width / 2) / width, (y - height * 0.42) / width
    r, a = np.hypot(dx, dy), np.arctan2(dy, dx)
    gilt |= r < 0.10 + 0.07 * np.cos(8 * a)
    gilt |= np.abs(r - 0.235) < 0.008
    gilt |= (np.abs(y / height - 0.80) < 0.012) & (np.abs(dx) < 0.22)
    gilt |= (np.abs(y / height - 0.84) < 0.006) & (np.abs(dx) < 0.13)
    g = gilt[..., None]
    return np.where(g, (0.93, 0.74, 0.40), color), metallic_roughness(
        np.where(gilt, 0.25, 0.85), gilt.astype(float)
    )


def pages(size: int = 128) -> Picture:
    """The edge of a block of paper: one line per leaf."""
    lines = noise((size, size), (0.8, 200), 71) * 0.06
    return np.clip(np.array([0.86, 0.80, 0.66]) + lines[..., None], 0, 1)


def _spade(x: Picture, y: Picture) -> Mask:
    heart = _heart(x, -y - 0.12)
    return heart | (
        (np.abs(x) < 0.05 + 0.28 * np.clip(y - 0.1, 0, 1) ** 1.5) & (y > 0) & (y < 0.62)
    )


def _heart(x: Picture, y: Picture) -> Mask:
    x, y = np.abs(x) * 1.9, -y * 1.9 + 0.25
    return (x**2 + y**2 - 1) ** 3 - x**2 * y**3 < 0


def _diamond(x: Picture, y: Picture) -> Mask:
    return np.abs(x) / 0.44 + np.abs(y) / 0.6 < 1


# Ranks as five rows of three squares.
_GLYPHS = {"A": "010101111101101", "7": "111001010010010", "4": "101101111001001"}
_LAYOUTS = {
    "A": [(0, 0, 0.34)],
    "4": [(sx * 0.24, sy * 0.42, 0.14) for sx in (-1, 1) for sy in (-1, 1)],
    "7": [(sx * 0.24, sy * 0.42, 0.14) for sx in (-1, 1) for sy in (-1, 0, 1)] + [(0, -0.21, 0.14)],
}


def card(rank: str, suit: str, width: int = 160) -> Picture:
    """A playing card face; suit is spade, heart or diamond."""
    height = round(width * 88 / 63)
    y, x = np.mgrid[0:height, 0:width] + 0.5
    x, y = (x - width / 2) / width, (y - height / 2) / width  # card width = 1
    pip = {"spade": _spade, "heart": _heart, "diamond": _diamond}[suit]
    ink = np.zeros((height, width), bool)
    for cx, cy, s in _LAYOUTS[rank]:
        flip = -1 if cy > 0.01 else 1
        ink |= pip((x - cx) / s, flip * (y - cy) / s)
    for turn in (1, -1):  # the index in two corners
        u, w = turn * x + 0.44, turn * y + 0.645
        column, row = np.floor(u / 0.028).astype(int), np.floor(w / 0.028).astype(int)
        inside = (column >= 0) & (column < 3) & (row >= 0) & (row < 5)
        bits = np.array([int(b) for b in _GLYPHS[rank]])
        ink |= inside & (bits[np.clip(row * 3 + column, 0, 14)] == 1)
        ink |= pip((turn * x + 0.398) / 0.085, (turn * y + 0.43) / 0.085)
    red = np.array([0.72, 0.06, 0.07]) if suit != "spade" else np.array([0.05, 0.05, 0.06])
    return np.where(ink[..., None], red, np.array([0.93, 0.91, 0.86]))


def die(size: int = 64) -> Picture:
    """Six faces of a die side by side: 1 6 2 5 3 4."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size * 2 - 1
    near = 0.52
    spots = {
        1: [(0, 0)],
        2: [(-near, -near), (near, near)],
        3: [(-near, -near), (0, 0), (near, near)],
        4: [(i, j) for i in (-near, near) for j in (-near, near)],
        6: [(i, j) for i in (-near, near) for j in (-near, 0, near)],
    }
    spots[5] = [*spots[4], (0, 0)]
    faces = []
    for value in (1, 6, 2, 5, 3, 4):
        ink = np.zeros((size, size), bool)
        for cx, cy in spots[value]:
            ink |= np.hypot(x - cx, y - cy) < 0.19
        faces.append(np.where(ink[..., None], (0.93, 0.90, 0.84), (0.50, 0.035, 0.045)))
    return np.concatenate(faces, 1)


def night_sky(height: int = 64) -> Picture:
    """The glow over a town, from the roofs (bottom) to the dark."""
    t = np.linspace(0, 1, height)[:, None] * np.ones((1, 8))
    return ramp(t, [(0.04, 0.08, 0.20), (0.08, 0.14, 0.34), (0.24, 0.22, 0.38), (0.55, 0.34, 0.27)])
