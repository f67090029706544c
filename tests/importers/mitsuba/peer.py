"""Mitsuba itself, where it is installed: pictures of a file by both, and blocks of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.importers.mitsuba.reader import read_all

BLOCK = 16
Picture = NDArray[np.float64]


def peer() -> Any:
    """Module of Mitsuba; a test without it is skipped."""
    mitsuba = pytest.importorskip("mitsuba", reason="mitsuba 3.9.1 is not installed")
    mitsuba.set_variant("scalar_rgb")
    return mitsuba


def theirs(path: Path, spp: int) -> Picture:
    """Picture of a file by Mitsuba, linear Rec.709."""
    mitsuba = peer()
    scene = mitsuba.load_file(str(path), parallel=False)
    found = np.array(mitsuba.render(scene, spp=spp, seed=1), np.float64)
    return found[:, :, :3]


def ours(path: Path, spp: int, **options: Any) -> Picture:
    """Picture of the same file by us, with the settings of its first camera."""
    scene, settings, _ = read_all(path, **options)
    chosen = next(iter(settings.values()))
    frame = dg.render(
        scene,
        scene.camera(),
        resolution=chosen.resolution,
        filter=chosen.filter,
        max_depth=chosen.max_depth or 64,
        spp=spp,
        seed=7,
    )
    return frame.rgb.astype(np.float64)


def blocks(picture: Picture, size: int = BLOCK) -> Picture:
    """Means of square blocks of pixels."""
    height, width = (side // size for side in picture.shape[:2])
    whole = picture[: height * size, : width * size]
    return np.asarray(whole.reshape(height, size, width, size, 3).mean(axis=(1, 3)))


def same_blocks(a: Picture, b: Picture, share: float = 0.05, size: int = BLOCK) -> None:
    """Checks that means of blocks agree within a share of them, or of the mean picture."""
    assert a.shape == b.shape
    first, second = blocks(a, size), blocks(b, size)
    allowed = share * np.maximum(second, 0.1 * second.mean())
    worst = np.abs(first - second) / allowed
    assert worst.max() <= 1, f"{worst.max():.2f} times the allowance, at {np.argmax(worst)}"
