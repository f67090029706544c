"""Pictures of surfaces by script: (H, W, 3), 8 bits, sRGB."""

from __future__ import annotations

import numpy as np

SIZE = 512
Color = tuple[float, float, float]


def boards(color: Color, count: int = 8) -> np.ndarray:
    """Floorboards with grain; ``color`` is their mean, linear."""
    rng = np.random.default_rng(11)
    y, x = _grid()
    board = (y * count).astype(int)
    shade = rng.uniform(0.75, 1.25, count)[board]
    grain = np.sin(2 * np.pi * (x * 3 + rng.uniform(0, 1, count)[board]) + 40 * y * count)
    line = np.abs((y * count) % 1 - 0.5) > 0.47
    ends = np.abs((x + rng.uniform(0, 1, count)[board]) % 1 - 0.5) > 0.495
    return _picture(color, shade * (1 + 0.12 * grain) * np.where(line | ends, 0.35, 1))


def tiles(color: Color, count: int = 4) -> np.ndarray:
    """Square tiles in two shades, with joints."""
    y, x = _grid()
    i, j = (x * count).astype(int), (y * count).astype(int)
    shade = np.where((i + j) % 2, 0.7, 1.2)
    joint = (np.abs((x * count) % 1 - 0.5) > 0.48) | (np.abs((y * count) % 1 - 0.5) > 0.48)
    return _picture(color, np.where(joint, 0.4, shade))


def stripes(color: Color, count: int = 12) -> np.ndarray:
    """Wallpaper with upright stripes and rows of dots."""
    y, x = _grid()
    shade = 1 + 0.15 * np.sign(np.sin(2 * np.pi * count * x))
    dots = np.hypot((x * count) % 1 - 0.5, (y * count) % 1 - 0.5) < 0.15
    return _picture(color, np.where(dots, 0.6, shade))


def weave(color: Color, count: int = 32) -> np.ndarray:
    """Cloth with a border of lines, as on a rug."""
    y, x = _grid()
    threads = 1 + 0.3 * np.sin(2 * np.pi * count * x) * np.sin(2 * np.pi * count * y)
    edge = np.minimum(np.minimum(x, 1 - x), np.minimum(y, 1 - y))
    return _picture(color, threads * np.where((edge * 20).astype(int) % 3 == 1, 0.4, 1))


def writing(color: Color) -> np.ndarray:
    """A blackboard with lines of chalk."""
    rng = np.random.default_rng(5)
    y, x = _grid()
    row = (y * 10).astype(int)
    wave = 0.5 + 0.25 * np.sin(2 * np.pi * x * rng.integers(14, 30, 10)[row])
    line = np.abs((y * 10) % 1 - wave) < 0.06
    inside = (x > 0.08) & (x < rng.uniform(0.4, 0.9, 10)[row]) & (row > 0) & (row < 8)
    return _picture(color, np.where(line & inside, 12.0, 1.0))


def painting() -> np.ndarray:
    """A picture for a wall: hills under a sky."""
    y, x = _grid()
    made = np.stack([0.35 + 0.3 * y, 0.45 + 0.25 * y, 0.7 - 0.1 * y], axis=-1)
    for i, color in enumerate([(0.3, 0.4, 0.35), (0.25, 0.3, 0.18), (0.15, 0.2, 0.1)]):
        edge = 0.45 + 0.17 * i + 0.06 * np.sin(2 * np.pi * (x * (1.5 + i) + 0.3 * i))
        made = np.where((y > edge)[..., None], color, made)
    return _coded(made)


def _grid() -> tuple[np.ndarray, np.ndarray]:
    line = (np.arange(SIZE) + 0.5) / SIZE
    y, x = np.meshgrid(line, line, indexing="ij")
    return y, x


def _picture(color: Color, factor: np.ndarray) -> np.ndarray:
    return _coded(np.asarray(color) * factor[..., None])


def _coded(linear: np.ndarray) -> np.ndarray:
    """Codes linear values as sRGB."""
    value = np.clip(linear, 0, 1)
    coded = np.where(value <= 0.0031308, 12.92 * value, 1.055 * value ** (1 / 2.4) - 0.055)
    return np.rint(255 * coded).astype(np.uint8)
