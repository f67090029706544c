"""Profiles as lensfun reads and applies them (package ``lensfunpy``, extra ``compare``)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from daguerre.export import LensfunProfile
from daguerre.export.lensfun.frame import Frame
from daguerre.export.lensfun.traced import Vignetting
from daguerre.export.lensfun.xml import as_xml

WIDTH = 6000
RADII = 240


def read(profile: LensfunProfile) -> Read:
    """Reads a profile from its text, and finds its camera and lens; skips without lensfunpy."""
    lensfunpy = pytest.importorskip("lensfunpy", reason="lensfunpy is not installed")
    database = lensfunpy.Database(xml=as_xml(profile), load_common=False, load_bundled=False)
    (camera,) = database.cameras
    found = database.find_lenses(camera, profile.maker, profile.name)
    assert [lens.model for lens in found] == [profile.name]
    return Read(lensfunpy, found[0], camera.crop_factor, profile.frame)


@dataclass
class Read:
    """A lens of lensfun's database, for pictures of one frame."""

    package: Any
    lens: Any
    crop: float
    frame: Frame

    def modifier(self, size: Sequence[int], focal_mm: float, *setting: float) -> Any:
        """Makes the corrector of pictures of a size, at a focal length, f-stop and distance.

        lensfun puts the edge of the film at the centres of the outermost pixels. The crop factor
        makes good for it; without, a picture 1500 px wide is up to 0.2 px of 24 MP off.
        """
        edge = math.hypot(*size) / math.hypot(size[0] - 1, size[1] - 1)
        made = self.package.Modifier(self.lens, self.crop * edge, *size)
        f_stop, distance_m = setting or (8.0, 1000.0)
        made.initialize(focal_mm, f_stop, distance_m, scale=1.0, pixel_format=np.float32)
        return made

    def corrected(self, shown_mm: np.ndarray, focal_mm: float) -> np.ndarray:
        """Image heights of red, green and blue, shape (3, N), in the corrected picture, mm."""
        size = np.array((WIDTH, round(WIDTH * self.frame.short_mm / self.frame.long_mm)))
        modifier = self.modifier(size.tolist(), focal_mm)
        middle = (size - 1) / 2
        radii = np.linspace(0, 1.25, RADII)
        there = [
            modifier.apply_subpixel_geometry_distortion(*(middle * (1 + r)), 1, 1)[0, 0]
            for r in radii
        ]
        real = np.linalg.norm(np.array(there) - middle, axis=2) / np.hypot(*middle)
        mm = self.frame.corner_mm * math.hypot(*(size - 1)) / math.hypot(*size)
        return mm * np.array([np.interp(shown_mm[k] / mm, real[:, k], radii) for k in range(3)])

    def gain(self, heights_mm: np.ndarray, light: Vignetting) -> np.ndarray:
        """Factors on the light at image heights along the diagonal."""
        size = 901, round(900 * self.frame.short_mm / self.frame.long_mm) + 1
        setting = light.focal_mm, light.f_stop, light.distance_m
        picture = np.ones((size[1], size[0], 3), np.float32)
        assert self.modifier(size, *setting).apply_color_modification(picture)
        along = np.linspace(0, 1, 301)
        x, y = (np.round((side - 1) / 2 * (1 + along)).astype(int) for side in size)
        radii = np.hypot(x - (size[0] - 1) / 2, y - (size[1] - 1) / 2)
        radii *= self.frame.corner_mm / (0.5 * math.hypot(*size))
        return np.interp(heights_mm, radii, picture[y, x, 0])
