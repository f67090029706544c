"""Relative illumination of the bench against the light that the renderer finds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre import analysis, lenses
from daguerre.analysis.bench import Bench
from daguerre.analysis.light_search import light_at
from daguerre.color.spaces import LUMINANCE_709
from daguerre.color.spectra import rgb_mixes
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM
from tests.support.pictures.light_of_renderer import light_of_renderer

Array = NDArray[np.float64]

# Pupils far from their paraxial places, black corners, fisheyes, an iris behind the glass.
TEN = (
    "arri-signature-prime-58mm-f1.7",
    "canon-50mm-f0.95",
    "canon-ef-15mm-f2.8-fisheye",
    "double-gauss-50mm-f2",
    "laikin-fisheye-5mm-f1.8",
    "leica-elcan-50mm-f2",
    "meyer-primoplan-58mm-f1.9",
    "nikon-z-14-30mm-f4",
    "olympus-xa-35mm-f2.8",
    "zeiss-hologon-15mm-f8",
)
STOPS = (1, 2, 4, 8)  # times the widest f-stop
SHARES = np.array([0, 0.5, 0.7, 0.85, 0.93, 0.97, 1.0])


def faults(name: str, zoom: float | None) -> list[str]:
    """Film points at four stops where bench and renderer differ."""
    wide = analysis.set_up(lenses.load(name), zoom_mm=zoom)
    benches = [wide.stopped(stop * wide.f_stop) for stop in STOPS]
    return [f"f/{bench.f_stop:.3g} {fault}" for bench in benches for fault in at(bench)]


def at(bench: Bench) -> list[str]:
    symmetric = bench.lens.prescription.is_axially_symmetric
    ways = [(0.0, 1.0)] if symmetric else [(0.0, 1.0), (1.0, 0.0), (0.8, 0.6)]
    points = np.vstack([np.outer(SHARES * bench.field_mm, way) for way in ways])
    light = analysis.spectral_illumination(bench, points, [DESIGN_WAVELENGTH_NM], grid=56)[:, 0]
    found, wanted = light / light[0], light_of_renderer(bench, points)
    limit = np.where(wanted >= 0.05, 0.02 * wanted, 0.001)
    off = ~(np.abs(found - wanted) <= limit)  # NaN is off, too
    return [
        f"at {p[0]:.2f}, {p[1]:.2f} mm: bench {b:.4f}, renderer {r:.4f}"
        for p, b, r in zip(points[off], found[off], wanted[off], strict=True)
    ]


@pytest.mark.parametrize("name", TEN)
def test_bench_is_renderer(name: str) -> None:
    zooms = lenses.load(name).zoom_range_mm
    assert faults(name, zooms[0] if zooms else None) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", lenses.names())
def test_bench_is_renderer_for_every_lens(name: str) -> None:
    for zoom in lenses.load(name).zoom_range_mm or (None,):
        assert faults(name, zoom) == []


def test_bench_is_a_rendered_white_world() -> None:
    """At this stop the paraxial exit pupil misses the light of the corner."""
    lens, f_stop, zoom = "nikon-z-14-30mm-f4", 32.0, 14.42
    camera = dg.Camera(lens=lens, f_stop=f_stop, zoom=zoom)
    scene, size = dg.Scene(), (60, 40)
    scene.set_environment(color=(1, 1, 1))
    frame = dg.render(scene, camera, resolution=size, spp=128)
    x, y = ((np.arange(n) + 0.5 - n / 2) * 36 / 60 for n in size)
    radius = np.hypot(x, y[:, None])

    bench = analysis.set_up(lenses.load(lens), f_stop=f_stop, zoom_mm=zoom)
    nm, mixes = rgb_mixes(7)
    heights = np.linspace(0, radius.max(), 12)
    film = np.column_stack([0 * heights, heights])
    light = analysis.spectral_illumination(bench, film, nm) @ mixes.sum(axis=2) @ LUMINANCE_709
    ratio = frame.rgb @ LUMINANCE_709 / np.interp(radius, heights, light / light[0])
    rings = [ratio[np.abs(radius - r) < 1].mean() for r in (2, 5, 9, 13, 17, 19, 20.4)]
    assert rings == pytest.approx(np.ones(7), abs=0.01)


def test_the_pupil_of_a_stopped_down_corner_has_an_outline() -> None:
    bench = analysis.set_up(lenses.load("nikon-z-14-30mm-f4"), zoom_mm=14.42, f_stop=32)
    outline = analysis.pupil_outline(bench, 0.97 * bench.field_mm)
    light = light_at(bench, np.array([0, 0.97 * bench.field_mm]), DESIGN_WAVELENGTH_NM)
    assert light is not None
    assert (outline >= light.low).all()
    assert (outline <= light.high).all()
    assert (np.ptp(outline, axis=0) > 0.8 * (light.high - light.low)).all()


def test_light_is_found_without_a_bound_from_the_last_surface() -> None:
    lens = lenses.load("canon-50mm-f0.95")
    last = lens.surfaces[-1].replaced(tilt=(1e-7, 0.0, 0.0))
    bench = analysis.set_up(lens, f_stop=7.6)
    tilted = replace(bench, lens=replace(lens, surfaces=(*lens.surfaces[:-1], last)))
    film = np.array([[0.0, 0.0], [0.0, 20.0]])
    near, everywhere = (
        analysis.spectral_illumination(b, film, [DESIGN_WAVELENGTH_NM]) for b in (bench, tilted)
    )
    assert everywhere == pytest.approx(near, rel=5e-3)  # the wide window has few rays in the iris


def test_far_beyond_the_image_circle_is_no_light() -> None:
    bench = analysis.set_up(lenses.load("tessar-50mm-f2.8"), f_stop=8)
    assert light_at(bench, np.array([0.0, 90.0]), DESIGN_WAVELENGTH_NM) is None
    assert analysis.pupil_outline(bench, 90.0).shape == (0, 2)
