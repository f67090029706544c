"""A session without the core: sums that anyone can check, at a speed that the test chooses.

``python -m tests.support.program.fake_session render ...`` is the command line on top of it, so
that tests can send signals to a real process at a known moment. ``FAKE_SECONDS`` is how long a
sample takes.
"""

from __future__ import annotations

import os
import sys
import time
import types
from collections.abc import Callable
from typing import Any

import numpy as np

import daguerre
from daguerre import _core
from daguerre.camera.camera import Camera
from daguerre.errors import InputError
from daguerre.frame.frame import Frame
from daguerre.rendering.keywords import settings_of
from daguerre.rendering.pixels import crop_within
from daguerre.rendering.ranges import join_ranges
from daguerre.rendering.settings import RenderSettings
from daguerre.scene.scene import Scene


def sample_value(index: int, height: int, width: int) -> np.ndarray:
    """Value that sample ``index`` adds to every pixel; not symmetric in the indices."""
    y, x = np.mgrid[:height, :width]
    return ((index + 1) * 2654435761 + 97 * x + 7919 * y) % 65521


class FakeSession:
    """Keeps the contract of ``daguerre.rendering.session.Session``."""

    def __init__(
        self,
        scene: Scene,
        camera: Camera,
        *,
        settings: RenderSettings | None = None,
        built: object = None,
        piloted: object = None,
        origin: object = None,
        **keywords: Any,
    ) -> None:
        self.built = built or self
        self.torn = False
        self.settings = settings_of(settings, keywords)
        film, sampling = self.settings.film, self.settings.sampling
        if camera.f_stop is not None and camera.f_stop <= 0:
            raise InputError(f"camera: f_stop: wanted a number above 0, got {camera.f_stop}")
        self.width, self.height = film.resolution
        self.crop = crop_within(film.crop, (0, 0, *film.resolution))
        self.notes = ["autofocus: centre ray hit at 1.532 m"]
        self.warnings: list[str] = []
        self.key = {
            "scene": "a" * 64,
            "camera": f"{camera.f_stop}",
            "settings": f"{film} {sampling.seed} {sampling.filter} {self.settings.light}",
            "build": "fake 1",
        }
        self.metadata: dict[str, Any] = {
            "seed": sampling.seed,
            "aperture": camera.f_stop,
            "version": "0.1.0",
        }
        self.ranges: list[tuple[int, int]] = []
        self.round = None
        self.counters = _core.RenderCounters()
        self.flare_spots = self.survey_rays = 0
        self.light_paths = (0.0, 0.0)
        x0, y0, x1, y1 = self.crop
        self.shape = (y1 - y0, x1 - x0)
        self.sums = np.zeros(self.shape, np.uint64)
        bad = os.environ.get("FAKE_BAD")
        self.bad_samples: tuple[int, list[tuple[int, int, int]]] = (
            (1, [(2, 1, 5)]) if bad else (0, [])
        )

    def draw(self, begin: int, end: int, progress: Callable[[float], bool] | None = None) -> bool:
        seconds = float(os.environ.get("FAKE_SECONDS", "0"))
        if os.environ.get("FAKE_CRASH"):
            raise RuntimeError("the moon fell down")
        sums = self.sums.copy()
        for i in range(begin, end):
            until = time.monotonic() + seconds
            while time.monotonic() < until:
                time.sleep(min(seconds, 0.01))
                if progress is not None and not progress((i - begin) / (end - begin)):
                    return False
            sums += sample_value(i, *self.shape).astype(np.uint64)
        self.sums = sums
        self.ranges = join_ranges([*self.ranges, (begin, end)])
        self.counters += _core.RenderCounters(rays=(end - begin) * sums.size * 3)
        return True

    def with_truth(self, frame: Frame) -> Frame:
        return frame

    def over_plate(self, frame: Frame) -> Frame:
        return frame

    def frame(self, *, truth: bool = True, waves: bool = True, plate: bool = True) -> Frame:
        count = max(1, sum(b - a for a, b in self.ranges))
        grey = (self.sums / count / 65521).astype(np.float32)
        aovs = {}
        if self.settings.film.aovs:
            names = ["depth.Z", *(f"{g}.{c}" for g in "PN" for c in "XYZ")]
            names += [f"{group}.{c}" for group in ("albedo", "denoise_albedo") for c in "RGB"]
            aovs = dict.fromkeys([*names, *(f"denoise_normal.{c}" for c in "XYZ")], grey)
            aovs["object_id"] = np.full(self.shape, 4_000_000_000, np.uint32)
        return Frame(
            rgb=np.stack([grey] * 3, axis=2),
            xyz=np.stack([grey] * 3, axis=2),
            alpha=np.ones(self.shape, np.float32),
            variance=np.zeros((*self.shape, 3), np.float32),
            samples=np.full(self.shape, count, np.uint32),
            aovs=aovs,
            metadata={
                **self.metadata,
                "scene_hash": self.key["scene"],
                "bad_samples": self.bad_samples[0],
            },
            bad_samples=self.bad_samples,
        )

    def state(self) -> dict[str, np.ndarray]:
        low, high = self.sums & np.uint64(0xFFFFFFFF), self.sums >> np.uint64(32)
        return {"sums": np.stack([low, high, 0 * low, 0 * low], axis=2).astype(np.uint32)}

    def set_state(
        self, state: dict[str, np.ndarray], ranges: list[tuple[int, int]], round: None = None
    ) -> None:
        low, high = (state["sums"][:, :, i].astype(np.uint64) for i in range(2))
        self.sums = low | high << np.uint64(32)
        self.ranges = list(ranges)


def load(
    path: object,
    *,
    time: float = 0.0,
    variant: str | None = None,
    allow_dirs: object = (),
    animated: bool = False,
) -> Scene:
    scene = Scene()
    scene.add_camera("Camera", Camera())
    return scene


def install(patch: Callable[[object, str, object], None] = setattr) -> None:
    """Puts the fakes where the command line looks for the real ones."""
    module = types.ModuleType("daguerre.rendering.session")
    module.Session = FakeSession  # type: ignore[attr-defined]
    sys.modules["daguerre.rendering.session"] = module
    patch(daguerre, "load", load)


if __name__ == "__main__":
    install()
    from daguerre.cli import main

    sys.exit(main())
