"""Pictures printed, woven and shown on a screen, by arithmetic; sRGB in [0, 1], shape (H, W, 3)."""

from __future__ import annotations

import math

import numpy as np

from daguerre.charts import markers
from kit.textures import Picture, noise, ramp

#: The ChArUco board: squares across and down, side of a square and of its marker, m.
BOARD = (8, 5, 0.030, 0.021)
DICTIONARY = "5X5_250"
_SQUARE, _CELL = 40, 4  # px; a marker has 7 cells: five bits and its border


def board() -> Picture:
    """A ChArUco board with a white margin of half a square."""
    columns, rows = BOARD[:2]
    paper = np.full((rows * _SQUARE, columns * _SQUARE), 0.93)
    number = 0
    for r in range(rows):
        for c in range(columns):
            cell = paper[r * _SQUARE :, c * _SQUARE :][:_SQUARE, :_SQUARE]
            if (r + c) % 2 == 0:
                cell[:] = 0.06
                continue
            inside = (_SQUARE - 7 * _CELL) // 2
            marker = np.pad(markers.bits(DICTIONARY, number), 1).astype(float)
            drawn = np.kron(marker, np.ones((_CELL, _CELL)))
            cell[inside:-inside, inside:-inside] = 0.06 + 0.87 * drawn
            number += 1
    margin = np.pad(paper, _SQUARE // 2, constant_values=0.93)
    return np.repeat(margin[..., None], 3, axis=2)


def outside(height: int = 256) -> Picture:
    """A bright sky over trees that are far out of focus."""
    y = np.repeat(np.arange(height)[:, None] / height, height, axis=1)
    trees = 0.66 + 0.07 * noise((height, height), (400, 20), 3)
    green = np.clip((y - trees) * 14 + 0.5, 0, 1)[..., None]
    leaves = noise((height, height), (9, 9), 4)[..., None] * 0.05
    sky = ramp(y, [(0.86, 0.93, 1.0), (0.97, 0.985, 1.0), (1.0, 0.99, 0.96)])
    bush = np.array((0.255, 0.28, 0.24)) * (1 + leaves * 3)
    return np.clip(sky * (1 - green) + bush * green, 0, 1)


def ridges(width: int = 320, height: int = 208) -> Picture:
    """Mountains behind one another, the far ones paler."""
    y, x = np.mgrid[0:height, 0:width] / (height, width)[0]
    sky = [(0.93, 0.80, 0.66), (0.96, 0.88, 0.78), (0.95, 0.91, 0.86)]
    picture = ramp(y / y.max(), sky)
    sun = np.hypot(x - 1.08, y - 0.27) < 0.085
    picture[sun] = (0.97, 0.62, 0.36)
    for k in range(6):
        line = 0.36 + 0.11 * k + (0.085 - 0.006 * k) * noise((1, width), (1, 50 - 5 * k), 90 + k)
        tone = ramp(
            np.array([[k / 5]]), [(0.70, 0.72, 0.78), (0.26, 0.38, 0.50), (0.05, 0.10, 0.17)]
        )
        picture = np.where((y > line)[..., None], tone, picture)
    return picture


def eclipse(size: int = 220) -> Picture:
    """A total eclipse: the corona's rays around a black disc."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size * 2 - 1
    r, a = np.hypot(x, y), np.arctan2(y, x)
    rays = 0.75 + 0.3 * np.sin(2 * a + 0.6) + 0.14 * np.sin(9 * a) + 0.08 * np.sin(23 * a + 1)
    glow = np.where(r > 0.34, np.exp(-(r - 0.34) / (0.16 * rays)), 0.0)
    return ramp(
        glow**0.8, [(0.035, 0.04, 0.07), (0.20, 0.25, 0.36), (0.72, 0.77, 0.84), (1, 1, 0.98)]
    )


def dunes(width: int = 320, height: int = 208) -> Picture:
    """Sand in low light."""
    y, x = np.mgrid[0:height, 0:width] / height
    bend = 0.15 * np.sin(2.6 * x + 0.5) + 0.05 * np.sin(7 * x + 2)
    slope = np.sin(10 * (y + bend) * (1 + 0.5 * y))
    ripple = 0.14 * np.sin(120 * (y + 0.35 * bend) * (1 - 0.4 * y)) * (slope > 0)
    shade = np.clip(0.52 + 0.42 * slope + ripple, 0, 1)
    sand = ramp(shade, [(0.27, 0.13, 0.10), (0.66, 0.38, 0.22), (0.93, 0.74, 0.52)])
    sky = ramp(np.clip(y / 0.3, 0, 1), [(0.36, 0.55, 0.72), (0.80, 0.84, 0.82)])
    edge = np.clip((y - 0.27 - 0.4 * bend * 0.5) * 90, 0, 1)[..., None]
    return sky * (1 - edge) + sand * edge


def clock(size: int = 256) -> Picture:
    """A dial of strokes."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size * 2 - 1
    r, a = np.hypot(x, y), np.arctan2(y, x) / (2 * math.pi)
    face = np.full((size, size), 0.93)
    for count, inner, width in ((60, 0.88, 0.007), (12, 0.76, 0.018)):
        aside = np.abs(a * count - np.round(a * count)) / count * 2 * math.pi * r
        face[(aside < width) & (r > inner) & (r < 0.94)] = 0.08
    return np.repeat(face[..., None], 3, axis=2)


def rug(size: int = 384) -> Picture:
    """Wool in stripes and diamonds."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size
    diamond = (np.abs((x * 8) % 1 - 0.5) + np.abs((y * 6) % 1 - 0.5)) * 2
    bands = ((diamond * 3).astype(int) % 3)[..., None]
    red, sand, blue = (
        np.array((0.44, 0.13, 0.11)),
        np.array((0.72, 0.62, 0.46)),
        np.array((0.13, 0.19, 0.28)),
    )
    color = np.where(bands == 0, red, np.where(bands == 1, blue, sand))
    border = np.minimum(np.minimum(x, 1 - x), np.minimum(y, 1 - y))
    color = np.where(((border > 0.03) & (border < 0.055))[..., None], sand, color)
    color = np.where((border < 0.03)[..., None], blue, color)
    return np.clip(color * (1 + 0.10 * noise((size, size), (1.2, 3), 7)[..., None]), 0, 1)


def screen(width: int = 640, height: int = 400) -> Picture:
    """An editor with a program, and beside it the grid that a lens made of a straight one."""
    picture = np.full((height, width, 3), (0.075, 0.085, 0.11))
    picture[:16] = (0.15, 0.16, 0.19)
    for k, dot in enumerate(((0.92, 0.38, 0.34), (0.93, 0.72, 0.29), (0.38, 0.76, 0.37))):
        picture[5:11, 8 + 12 * k : 14 + 12 * k] = dot
    _write(picture)
    y, x = np.mgrid[0:height, 0:width]
    u, v = (x - 462) / 150, (y - 208) / 150
    r2 = u * u + v * v
    bent = 1 + 0.22 * r2 + 0.05 * r2 * r2  # the inverse of barrel distortion, roughly
    lines = np.minimum(_from_line(u * bent), _from_line(v * bent))
    inside = (np.abs(u) < 1.06) & (np.abs(v) < 1.06)
    ink = np.clip(1.6 - lines * 150, 0, 1)[..., None] * inside[..., None]
    picture = np.where(inside[..., None], (0.11, 0.13, 0.17), picture)
    tone = ramp(
        np.clip(np.sqrt(r2) / 1.4, 0, 1),
        [(0.45, 0.90, 0.75), (0.95, 0.85, 0.40), (0.95, 0.42, 0.35)],
    )
    return picture * (1 - ink) + tone * ink


def _from_line(t: Picture) -> Picture:
    """Distance from the nearest of lines a fifth apart."""
    return np.asarray(np.abs(t * 5 - np.round(t * 5)) / 5)


def _write(picture: Picture) -> None:
    """Words of a program as bars, indented."""
    rng = np.random.default_rng(8)
    tones = ((0.80, 0.82, 0.85), (0.47, 0.71, 0.93), (0.87, 0.60, 0.85), (0.62, 0.80, 0.47))
    indent = 0
    for line in range(29):
        top, at = 26 + 12 * line, 44 + 18 * indent
        picture[top : top + 6, 14:26] = (0.25, 0.27, 0.31)
        for _ in range(rng.integers(0, 6)):
            long = int(rng.integers(10, 46))
            if at + long > 284:
                break
            picture[top : top + 6, at : at + long] = tones[rng.choice(4, p=(0.5, 0.2, 0.15, 0.15))]
            at += long + 7
        indent = int(np.clip(indent + rng.integers(-1, 2), 0, 4))


def squared(width: int = 300, height: int = 420) -> Picture:
    """A page of squared paper with lines of handwriting and a sketch of a lens."""
    y, x = np.mgrid[0:height, 0:width] + 0.0
    paper = np.full((height, width, 3), (0.93, 0.92, 0.87))
    rule = ((x % 10 < 1) | (y % 10 < 1))[..., None]
    paper = np.where(rule, (0.72, 0.80, 0.86), paper)
    ink = np.zeros((height, width), bool)
    rng = np.random.default_rng(12)
    for line in range(9):
        middle, end = 32 + 20 * line, rng.uniform(170, 270)
        wave = 4 * np.sin(x * 0.55 + line) * np.sin(x * 0.19 + 2 * line) + 2 * np.sin(x * 1.1)
        words = np.sin(x * 0.085 + 3 * line) > -0.75
        ink |= (np.abs(y - middle - wave) < 1.5) & (x > 26) & (x < end) & words
    for center, radius, left in ((240, 130, True), (60, 130, False)):
        d = np.hypot(x - center, y - 310)
        side = x < 150 if left else x > 150
        ink |= (np.abs(d - radius) < 1.3) & (np.abs(y - 310) < 60) & side
    for start in (-44, 0, 44):
        ray = 310 + np.where(x < 150, start, start * (1 - (x - 150) / 110))
        ink |= (np.abs(y - ray) < 0.9) & (x > 24) & (x < 262)
    return np.where(ink[..., None], (0.10, 0.13, 0.36), paper)


def spines(count: int = 16) -> Picture:
    """Colours of the backs of books, a column each, with a title."""
    rng = np.random.default_rng(4)
    tones = [(0.36, 0.10, 0.09), (0.10, 0.19, 0.30), (0.62, 0.50, 0.28), (0.14, 0.25, 0.18)]
    tones += [(0.75, 0.70, 0.60), (0.42, 0.26, 0.15), (0.16, 0.15, 0.17), (0.55, 0.32, 0.12)]
    picture = np.empty((64, 16 * count, 3))
    for k in range(count):
        column = picture[:, 16 * k : 16 * k + 16]
        column[:] = np.clip(np.array(tones[k % 8]) * rng.uniform(0.8, 1.25), 0, 1)
        gilt = (0.80, 0.66, 0.36) if np.mean(tones[k % 8]) < 0.45 else (0.15, 0.12, 0.10)
        column[12 : 12 + rng.integers(4, 20), 6:10] = gilt
        column[52:54] = gilt
    return picture
