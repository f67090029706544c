"""The published comparison of polynomial lenses, repeated: samples and error at equal CPU time.

    python bench/polynomial_camera.py --json [--seconds 20] [--rounds 3] [--resolution 120x80]

After Hanika and Dachsbacher 2014 (CGF 33(2)): one scene through a zoom of more than 30 surfaces
(US 5,537,259, 70-200 mm f/2.8), with lamps out of focus. ``rear disc``: exact, points of the last
surface are drawn, and most rays are stopped; ``boxes``: exact, slopes from a box around the exit
pupil per film radius; ``guided``: exact, points of the iris are aimed at;
``taylor``: the series of degree 5 about the axis in place of the fitted rays; ``fit N``: fitted to
degree N. All but the first two aim alike. Each draws for so many CPU seconds, in turn, and
again with other seeds. ``rel_mse`` is the mean of (x - r)^2 / (r^2 + 0.01) against ``guided`` with
``--reference`` times the seconds, ``ray_error`` the angle (rad, RMS) to the exact ray of the same
samples.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
from numpy.typing import NDArray

import daguerre as dg
from daguerre import _core
from daguerre.setup import lens as camera_prescription

EXACT = _core.ExactLens  # the class itself, while sessions get lenses of other makers
LENS = Path(__file__).parent / "lenses" / "us5537259.json"
DEGREES = (3, 5, 7, 9)
TAYLOR = 5

Picture = NDArray[np.float64]
Maker = Callable[[_core.Prescription, _core.ExactLensSettings], _core.ExactLens]


def scene() -> dg.Scene:
    """Balls on a floor at 3 m in the light of the sky; 60 lamps 5 to 12 m away."""
    made = dg.Scene()
    made.set_environment(color=(0.3, 0.35, 0.4))
    size = np.array([(-9, 0, -14), (9, 0, -14), (9, 0, 1), (-9, 0, 1)], float)
    floor = made.add_mesh(size - (0, 0.4, 0), np.array([(0, 2, 1), (0, 3, 2)]))
    made.add_instance(floor, dg.Material(dg.Diffuse((0.4, 0.35, 0.3))), np.eye(4))
    random = np.random.default_rng(1)
    for k in range(66):
        x, y, z = random.uniform((-1.6, -0.3, -12), (1.6, 1.2, -5))
        place = np.eye(4)
        place[:3, 3] = x * -z / 8, y * -z / 8, z
        colour = tuple(40 * random.uniform(0.4, 1, 3))
        radius = 0.01
        if k < 6:
            place[:3, 3], colour, radius = (0.2 * k - 0.5, -0.2, -3 - 0.1 * k), (2, 2, 2), 0.05
        made.add_light(dg.SphereLight(colour, radius), place)
    return made


def guided(lens: _core.Prescription, settings: _core.ExactLensSettings) -> _core.ExactLens:
    """The exact lens as it is."""
    return EXACT(lens, settings)


def drawn(draw: _core.PupilDraw) -> Maker:
    """The exact lens, drawn otherwise: from boxes, or the whole last surface without any aim."""

    def make(lens: _core.Prescription, settings: _core.ExactLensSettings) -> _core.ExactLens:
        settings.draw = draw
        return EXACT(lens, settings)

    return make


def fitted(degree: int) -> Maker:
    """By polynomials of a degree."""

    def make(lens: _core.Prescription, settings: _core.ExactLensSettings) -> _core.ExactLens:
        settings.fit_degree = degree
        return EXACT(lens, settings)

    return make


def taylor(prescription: _core.Prescription, settings: _core.ExactLensSettings) -> _core.ExactLens:
    """By the series about the axis, in the basis of a fit of its degree."""
    settings.fit_degree = TAYLOR
    lens = EXACT(prescription, settings)
    fit = dg.polynomial.LensFit(lens.fit)
    u = qmc_points(4000)
    f, q = disc(u[:, :2]) * lens.fit.film_half[0], disc(u[:, 2:4])
    pupil = lens.fit.pupil
    m = (q - f / lens.fit.film_half[0] * pupil.by_film) / pupil.by_slope
    nm = 380 + 400 * u[:, 4]
    system = dg.polynomial.from_lens(
        dg.lenses.load(LENS),
        degree=TAYLOR,
        wavelength=dg.polynomial.wavelength_nodes(380, 780, 5),
        reverse=True,
        film_z=settings.film_z_mm,
    )
    cosines = -m / np.sqrt(1 + (m**2).sum(axis=1, keepdims=True))
    out = system(np.concatenate([f, cosines], axis=1), nm)
    origins = np.concatenate([out[:, :2], np.zeros((len(out), 1))], axis=1)
    across = (out[:, 2:] ** 2).sum(axis=1, keepdims=True)
    directions = np.concatenate([out[:, 2:], -np.sqrt(np.maximum(1e-6, 1 - across))], axis=1)
    other = fit.refitted(f, m, nm, origins, directions)
    return lens.with_fit(other.core)


def qmc_points(count: int) -> Picture:
    """Evenly spread over five dimensions (Roberts 2018)."""
    g = 1.1673039782614187
    return (0.5 + np.outer(np.arange(1, count + 1), g ** -np.arange(1, 6))) % 1


def disc(u: Picture) -> Picture:
    """The unit disc, evenly."""
    r, a = np.sqrt(u[:, :1]), 2 * np.pi * u[:, 1:]
    return np.concatenate([r * np.cos(a), r * np.sin(a)], axis=1)


def variants() -> dict[str, Maker]:
    """Cameras to compare, by name."""
    return {
        "rear disc": drawn(_core.PupilDraw.rear_disc),
        "boxes": drawn(_core.PupilDraw.slope_boxes),
        "guided": guided,
        "taylor": taylor,
        **{f"fit {degree}": fitted(degree) for degree in DEGREES},
    }


class Drawing:
    """A session whose camera has the lens of a maker."""

    def __init__(self, made: dg.Scene, make: Maker, resolution: tuple[int, int], seed: int) -> None:
        camera = dg.Camera(
            lens=str(LENS), lens_model="exact", f_stop=2.9, focus_distance=3.0, sensor_size=(36, 24)
        )
        self.setup_seconds = self.ray_error = 0.0

        def timed(
            prescription: _core.Prescription, settings: _core.ExactLensSettings
        ) -> _core.ExactLens:
            started = time.process_time()
            lens = make(prescription, settings)
            self.setup_seconds = time.process_time() - started
            self.ray_error = ray_error(lens)
            return lens

        camera_prescription._glass.cache_clear()  # it would have the lens of another maker
        with mock.patch.object(camera_prescription._core, "ExactLens", timed):
            self.session = dg.Session(
                made, camera, resolution=resolution, seed=seed, filter="box", light_paths="off"
            )
        self.samples, self.seconds = 0, 0.0

    def draw(self, seconds: float, chunk: int = 4) -> None:
        """Until it has used so many CPU seconds in all."""
        while self.seconds < seconds:
            started = time.process_time()
            self.session.draw(self.samples, self.samples + chunk)
            self.seconds += time.process_time() - started
            self.samples += chunk

    def picture(self) -> Picture:
        """Linear RGB."""
        return np.asarray(self.session.frame().rgb, np.float64)


def ray_error(lens: _core.ExactLens) -> float:
    """Between the rays of a lens and those of its surfaces, rad."""
    u = qmc_points(4096).astype(np.float32)
    film, nm = np.ascontiguousarray((u[:, :2] - 0.5) * (36, 24), np.float32), 380 + 400 * u[:, 4]
    drawn = [
        one.generate(film, np.ascontiguousarray(u[:, 2:4]), np.ascontiguousarray(nm))
        for one in (lens, lens.without_fit())
    ]
    both = (drawn[0][2] > 0) & (drawn[1][2] > 0)
    apart = np.asarray(drawn[0][1] - drawn[1][1], np.float64)[both]
    return float(np.sqrt((apart**2).sum(axis=1).mean()))


def rel_mse(picture: Picture, reference: Picture) -> float:
    """Relative mean squared error over all pixels and channels."""
    return float(((picture - reference) ** 2 / (reference**2 + 0.01)).mean())


def run(given: argparse.Namespace) -> dict[str, Any]:
    """The whole measurement as one JSON object."""
    made, size = scene(), given.resolution
    reference = Drawing(made, guided, size, 1)
    reference.draw(given.reference * given.seconds, 32)
    truth = reference.picture()
    found: dict[str, dict[str, Any]] = {name: {"errors": [], "rates": []} for name in variants()}
    for seed in range(2, 2 + given.rounds):
        for name, make in variants().items():
            drawing = Drawing(made, make, size, seed)
            drawing.draw(given.seconds)
            entry = found[name]
            entry["errors"].append(rel_mse(drawing.picture(), truth))
            entry["rates"].append(drawing.samples / drawing.seconds)
            entry["setup_seconds"] = drawing.setup_seconds
            entry["ray_error"] = drawing.ray_error
    for entry in found.values():
        entry["rel_mse"] = float(np.mean(entry["errors"]))
        entry["samples_per_pixel"] = float(np.mean(entry.pop("rates"))) * given.seconds
    base = found["guided"]
    for entry in found.values():
        entry["samples_against_guided"] = entry["samples_per_pixel"] / base["samples_per_pixel"]
        entry["efficiency_against_guided"] = base["rel_mse"] / entry["rel_mse"]
    return {
        "bench": "polynomial_camera",
        "lens": "US 5,537,259",
        "surfaces": len(dg.lenses.load(LENS).surfaces),
        "cpu_seconds": given.seconds,
        "resolution": list(size),
        "reference_samples": reference.samples,
        "variants": found,
        "simd_target": _core.simd_target(),
        "version": dg.__version__,
    }


def main() -> int:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--reference", type=float, default=20)
    parser.add_argument(
        "--resolution", type=lambda t: tuple(map(int, t.split("x"))), default=(120, 80)
    )
    given = parser.parse_args()
    result = run(given)
    if given.json:
        print(json.dumps(result, indent=2))
        return 0
    for name, e in result["variants"].items():
        print(
            f"{name:8} {e['samples_per_pixel']:7.0f} spp  relMSE {e['rel_mse']:.3g}  "
            f"{e['efficiency_against_guided']:.2f} x  rays off by {e['ray_error']:.2g} rad RMS"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
