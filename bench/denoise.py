"""Denoising six scenes: error before and after against a long reference, and what it destroys.

    python bench/denoise.py [--json] [--spp 64] [--reference 256] [--scenes NAME ..]

The scenes are made by ``scenes/`` and drawn at 360 x 240. Errors are relative: the root of the mean
of (picture - reference)^2 less the reference's own variance, over value^2 + 0.01, the value being
that of the denoised reference (of a noisy one, pixels that are dark by chance would weigh more).
"99 %" leaves out the worst hundredth of the pixels. "known" is what ``denoise.error_left`` says
from the picture's own samples. "detail" is the share that is left of differences between a pixel
and the mean of its 3 x 3, of light below twice white, by what the reference has of them. "light" is
the mean after over that before.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre as dg
from daguerre.rendering.denoise import Cleaner, denoise
from daguerre.rendering.session import Session

ROOT = Path(__file__).resolve().parent.parent
SIZE = 360, 240
WHITE = 2.0
Image = NDArray[np.floating[Any]]


@dataclass(frozen=True)
class Case:
    """A scene: the program that makes it, its file, and how it is seen."""

    program: str
    path: str
    camera: dict[str, Any] = field(default_factory=dict)
    time: float = 0.0
    options: dict[str, Any] = field(default_factory=dict)

    def session(self, seed: int) -> Session:
        """A picture of it, with all that denoising needs."""
        file = ROOT / "out" / self.path
        if not file.exists():
            made = [str(file)] if self.program == "night_table.py" else []
            file.parent.mkdir(parents=True, exist_ok=True)
            subprocess.run(
                [sys.executable, ROOT / "scenes" / self.program, *made],
                check=True,
                cwd=ROOT,
                stdout=sys.stderr,
            )
        scene = dg.load(file)
        scene = scene.at(self.time) if self.time else scene
        camera = scene.camera(next(iter(scene.cameras))).with_(**self.camera)
        kept = {"resolution": SIZE, "aovs": True, "halves": True, "seed": seed}
        return Session(scene, camera, **kept, **self.options)


GAUSS = {"lens": "double-gauss-50mm-f2", "f_stop": 2.0}
NOKTON = {"lens": "voigtlander-nokton-50mm-f1.5", "f_stop": 1.5, "focus_distance": 1.6}
CASES = {
    "night_table": Case("night_table.py", "night_table.glb", GAUSS),
    "photographer": Case("lens_scenes.py", "lens_scenes/photographer.glb", GAUSS),
    "glass": Case("extensions.py", "extensions/glass.glb"),
    "billiards": Case("motion.py", "motion/billiards.glb", {"shutter_time": 1 / 24}, 0.25),
    "desk": Case("calibrated.py", "calibrated/desk.glb"),
    "strings": Case("imperfections.py", "imperfections/strings.glb", NOKTON, 0.0, {"max_depth": 1}),
}


@dataclass(frozen=True)
class Truth:
    """A long render, and the weight of an error in each value."""

    rgb: Image
    variance: Image
    weight: Image

    @classmethod
    def of(cls, case: Case, samples: int) -> Truth:
        """Draws it."""
        session = case.session(seed=77)
        session.draw(0, samples)
        frame = session.frame()
        clean = denoise(frame).rgb.astype(np.float64)
        return cls(frame.rgb, frame.variance, 1 / (clean**2 + 0.01))

    def errors(self, picture: Image) -> tuple[float, float]:
        """Relative error over all pixels, and without the worst hundredth."""
        squared = (picture - self.rgb).astype(np.float64) ** 2
        left = ((squared - self.variance) * self.weight).mean(2)
        far = (squared * self.weight).mean(2)
        good = left[far <= np.quantile(far, 0.99)]
        return rooted(left.mean()), rooted(good.mean())

    def detail(self, picture: Image) -> float:
        """Fine differences of the picture that are the reference's too: noise has none of them."""
        return float((fine(picture) * fine(self.rgb) * self.weight).sum())


def rooted(value: float) -> float:
    """Root; of an error below what the reference can tell 0."""
    return float(np.sqrt(max(value, 0)))


def fine(picture: Image) -> Image:
    """Each pixel less the mean of its 3 x 3."""
    shown = np.clip(picture, 0, WHITE).astype(np.float64)
    around = np.pad(shown, ((1, 1), (1, 1), (0, 0)), "edge")
    height, width = shown.shape[:2]
    shifts = [(y, x) for y in range(3) for x in range(3)]
    return shown - sum(around[y : y + height, x : x + width] for y, x in shifts) / 9


def measure(name: str, spp: int, reference: int) -> dict[str, Any]:
    """One scene."""
    truth = Truth.of(CASES[name], reference)
    session = CASES[name].session(seed=1)
    session.draw(0, spp)
    frame = session.frame()
    scene = np.maximum(frame.rgb, 0)
    only_colour = Cleaner()(scene)
    first_surface = Cleaner.of(_with_first_surface(frame))(scene)
    seconds = time.process_time()
    clean = denoise(frame)
    row: dict[str, Any] = {"scene": name, "spp": spp, "cpu_s": time.process_time() - seconds}
    pictures = {
        "before": frame.rgb,
        "colour_only": only_colour,
        "first_surface": first_surface,
        "after": clean.rgb,
    }
    for key, picture in pictures.items():
        row[key], row[f"{key}_99"] = truth.errors(picture)
        row[f"{key}_detail"] = truth.detail(picture) / truth.detail(frame.rgb)
    row["known"] = clean.metadata["denoised_noise"]
    row["light"] = float(clean.rgb.mean(dtype=np.float64) / frame.rgb.mean(dtype=np.float64))
    return row


def _with_first_surface(frame: dg.Frame) -> dg.Frame:
    """The guides that know no glass, no mirrors and no light paths."""
    from dataclasses import replace

    aovs = {f"denoise_albedo.{c}": frame.aovs[f"albedo.{c}"] for c in "RGB"}
    aovs |= {f"denoise_normal.{c}": frame.aovs[f"N.{c}"] for c in "XYZ"}
    return replace(frame, aovs=aovs, splats=None)


def main() -> None:
    """Measures and prints a table, or JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--reference", type=int, default=256)
    parser.add_argument("--scenes", nargs="+", choices=list(CASES), default=list(CASES))
    given = parser.parse_args()
    if not given.json:
        print("| scene | before | colour alone | first surface | after | known | detail | light |")
        print("|---|---|---|---|---|---|---|---|")
    for name in given.scenes:
        row = measure(name, given.spp, given.reference)
        if given.json:
            print(json.dumps(row), flush=True)
            continue
        pairs = [
            f"{row[k]:.3f} ({row[f'{k}_99']:.3f})"
            for k in ("before", "colour_only", "first_surface", "after")
        ]
        words = [*pairs, f"{row['known']:.3f}", f"{row['after_detail']:.2f}", f"{row['light']:.3f}"]
        print(f"| `{name}` | {' | '.join(words)} |", flush=True)


if __name__ == "__main__":
    main()
