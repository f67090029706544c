"""Pictures through polynomial lenses are those through the exact ones.

Where points land and in which colour, the outlines of their discs of blur, the fall of light, focus
pulled while the shutter is open. Lamps are drawn from the light's side, so that discs are clean. A
polynomial of degree 1 is the planted fault that comparisons must see.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from tests.support.pictures.statistical import welch_p
from tests.support.scene import scenes

Array = NDArray[np.float64]
GAUSS = {"lens": "double-gauss-50mm-f2"}
ZOOM = {"lens": "nikon-af-s-70-200mm-f2.8", "zoom": 100.0}
FISHEYE = {"lens": "olympus-zuiko-fisheye-8mm-f2.8"}
TILTED = {**GAUSS, "tilt": (3.0, 0.0)}
SIZE = (120, 80)


def lamps(camera: dict[str, Any], distance: float, luminance: float = 1.0) -> dg.Scene:
    """Small white lamps over the field, 5 x 3, at one depth; of a fisheye over the sphere."""
    scene = dg.Scene()
    half = {"nikon-af-s-70-200mm-f2.8": 0.18, "double-gauss-50mm-f2": 0.34}.get(camera["lens"])
    for i in range(-2, 3):
        for j in range(-1, 2):
            if half is not None:
                at = np.array([i / 2.5 * half, j / 1.8 * half * 2 / 3, -1.0]) * distance
            else:
                angle, turn = np.radians(0.1 + 44.0 * np.hypot(i, j)), np.arctan2(j, i)
                across = np.sin(angle)
                at = distance * np.array(
                    [across * np.cos(turn), across * np.sin(turn), -np.cos(angle)]
                )
            scene.add_light(
                dg.SphereLight((luminance,) * 3, 2e-3 * distance),
                scenes.at(*(float(v) for v in at)),
            )
    return scene


def picture(scene: dg.Scene, camera: dict[str, Any], model: str, **options: Any) -> Array:
    if model != "polynomial":
        camera = {k: v for k, v in camera.items() if k not in ("degree", "fit_tolerance")}
    made = dg.Camera(**camera, lens_model=model)
    frame = dg.render(
        scene, made, **({"resolution": SIZE, "spp": 4, "light_paths": (10000, 0)} | options)
    )
    if model == "polynomial":
        assert frame.metadata["camera"]["lens_model"] == "polynomial"
    return np.asarray(frame.rgb, np.float64)


Windows = list[tuple[slice, slice]]


def windows_of(rgb: Array) -> Windows:
    """Around separate spots within the picture."""
    bright = rgb.sum(axis=2)
    left = bright > 1e-2 * bright.max()
    found = []
    while left.any():
        y, x = np.unravel_index(np.argmax(np.where(left, bright, 0)), left.shape)
        window = slice(max(0, y - 6), y + 7), slice(max(0, x - 6), x + 7)
        if 6 <= y < rgb.shape[0] - 6 and 6 <= x < rgb.shape[1] - 6:
            found.append(window)
        left[window] = False
    return found


def spots(rgb: Array, windows: Windows) -> tuple[Array, Array]:
    """Centroids (N, 3, 2) and mean squared radii (N, 3) per channel, px."""
    middles, radii = [], []
    for window in windows:
        part = rgb[window]
        rows, columns = np.mgrid[window]
        weight = part.sum(axis=(0, 1)) + 1e-12
        cx = (part * columns[..., None]).sum(axis=(0, 1)) / weight
        cy = (part * rows[..., None]).sum(axis=(0, 1)) / weight
        away = (columns[..., None] - cx) ** 2 + (rows[..., None] - cy) ** 2
        middles.append(np.stack([cx, cy], axis=1))
        radii.append((part * away).sum(axis=(0, 1)) / weight)
    return np.array(middles), np.array(radii)


@pytest.mark.parametrize(
    "camera", [GAUSS, ZOOM, FISHEYE, TILTED], ids=["gauss", "zoom", "fisheye", "tilt"]
)
def test_points_land_where_they_land_through_the_exact_lens(camera: dict[str, Any]) -> None:
    """A grid of points, in three colours: distortion, lateral and longitudinal colour."""
    setting = {**camera, "focus_distance": 3.0, "f_stop": 4.0, "fit_tolerance": 100.0}
    scene = lamps(camera, 3.0)
    exact, fitted, wrong = (
        picture(scene, {**setting, **changes}, model)
        for model, changes in (("exact", {}), ("polynomial", {}), ("polynomial", {"degree": 1}))
    )
    windows = windows_of(exact)
    assert len(windows) >= 5
    (a, b), (c, d), (e, _) = (spots(rgb, windows) for rgb in (exact, fitted, wrong))
    assert np.abs(a - c).max() < 0.05
    assert np.abs(b - d).max() < 0.05 * b.max()
    assert np.abs(a - e).max() > 0.05


@pytest.mark.parametrize(
    "camera",
    [{**GAUSS, "f_stop": 2.0}, {**GAUSS, "f_stop": 2.8, "blades": 6}, {**ZOOM, "f_stop": 2.9}],
    ids=["cat's eyes", "blades", "zoom"],
)
def test_discs_of_blur_have_the_same_outline(camera: dict[str, Any]) -> None:
    near = 2.0 if camera["lens"] == ZOOM["lens"] else 0.7
    setting = {**camera, "focus_distance": near, "fit_tolerance": 100.0}
    scene = lamps(camera, 30.0)

    def outline(**changes: Any) -> NDArray[np.bool_]:
        model = changes.pop("model", "polynomial")
        rgb = picture(scene, setting | changes, model, resolution=(300, 200), spp=32).sum(axis=2)
        return np.asarray(rgb > 0.4 * np.median(rgb[rgb > 0.05 * rgb.max()]))

    def alike(a: NDArray[np.bool_], b: NDArray[np.bool_]) -> float:
        return float((a & b).sum() / (a | b).sum())

    exact = outline(model="exact")
    assert 0.01 < exact.mean() < 0.7
    assert alike(exact, outline()) >= 0.985
    assert alike(exact, outline(degree=1)) < 0.98


@pytest.mark.parametrize("camera", [GAUSS, FISHEYE], ids=["gauss", "fisheye"])
def test_a_white_world_darkens_alike_toward_the_corners(camera: dict[str, Any]) -> None:
    def batches(model: str, seed: int, **changes: Any) -> Array:
        setting = {**camera, "focus_distance": 3.0, "f_stop": 2.8, **changes}
        options: dict[str, Any] = {"resolution": (24, 16), "spp": 16, "filter": "box"}
        return np.array(
            [
                picture(
                    scenes.furnace(), setting, model, seed=seed + k, light_paths="off", **options
                )
                for k in range(8)
            ]
        )

    exact, fitted = batches("exact", 1), batches("polynomial", 100)
    lit = exact.mean(axis=0) > 0.01
    count = lit.sum()
    assert welch_p(exact, fitted)[lit].min() > 1 - 0.99 ** (1 / count)
    means = [x[:, lit].reshape(8, -1).mean(axis=1)[:, None] for x in (exact, fitted)]
    assert welch_p(means[0], means[1]).min() > 0.001
    assert welch_p(means[0], 1.02 * means[1]).min() < 0.001  # seen


def test_focus_pulled_while_the_shutter_is_open() -> None:
    setting = {
        **GAUSS,
        "f_stop": 2.8,
        "focus_distance": dg.keys([(0.0, 1.0), (1.0, 5.0)]),
        "shutter_time": 1.0,
        "shutter_offset": 0.0,
    }
    scene = lamps(GAUSS, 3.0)
    exact, fitted = (picture(scene, setting, model) for model in ("exact", "polynomial"))
    assert np.abs(exact - fitted).sum() < 0.01 * exact.sum()
    still = picture(scene, {**setting, "focus_distance": 3.0}, "polynomial")
    assert np.abs(exact - still).sum() > 0.1 * exact.sum()


def test_bits_do_not_depend_on_threads_and_ranges() -> None:
    camera = dg.Camera(**GAUSS, lens_model="polynomial", f_stop=2.0, focus_distance=2.0)

    def drawn(*ranges: tuple[int, int], threads: int = 1) -> Array:
        session = dg.Session(scenes.lamp_room(), camera, resolution=(24, 16), threads=threads)
        for begin, end in ranges:
            session.draw(begin, end)
        return np.asarray(session.frame().rgb)

    whole = drawn((0, 8))
    assert np.array_equal(whole, drawn((0, 8), threads=3))
    assert np.array_equal(whole, drawn((4, 8), (0, 4), threads=2))
