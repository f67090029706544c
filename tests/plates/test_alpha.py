"""Alpha: what objects cover, through lens, shutter and glass, and what that is good for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from tests.plates.test_truth import CASES, GLASS, RED, SIZE, Case, look_at, real, shifted, thin
from tests.support.pictures.statistical import differences
from tests.support.scene import scenes


def alone(case: Case, sky: tuple[float, float, float] | None = (0.4, 0.5, 0.7)) -> dg.Scene:
    """The ball and nothing else of the set."""
    scene = dg.Scene()
    points, triangles, normals = scenes.sphere(24, 0.5)
    ball = scene.add_mesh(points, triangles, normals)
    scene.add_instance(ball, case.material, case.place, name="ball")
    if sky is not None:
        scene.set_environment(color=sky)
    return scene


@pytest.mark.parametrize("name", ["matte ground", "motion", "vignetted corner", "distorted"])
def test_over_an_even_sky_the_picture_is_that_before_it(name: str) -> None:
    """The sky is the plate: a picture of it alone, with the lens's shading."""
    case = CASES[name]
    options = {"resolution": SIZE, "spp": 32, "light_paths": "off"}
    empty = dg.Scene()
    empty.set_environment(color=(0.4, 0.5, 0.7))
    made, whole = [], []
    for i in range(8):
        sky = dg.render(empty, case.camera, seed=100 + i, **options).rgb
        frame = dg.render(
            alone(case), case.camera, seed=200 + i, background="transparent", **options
        )
        made.append(frame.rgb + (1 - frame.alpha[..., None]) * sky)
        whole.append(dg.render(alone(case), case.camera, seed=300 + i, **options).rgb)
        assert frame.rgb[frame.alpha == 0].max() == 0
    assert 0 < frame.alpha.mean() < 1
    luma = (0.2126, 0.7152, 0.0722)  # coverage is that of luminance
    over, wanted = (np.array(x, np.float64) @ luma for x in (made, whole))
    assert differences(over[..., None], wanted[..., None], alpha=1e-3) == []


def test_alpha_of_a_square_is_its_area_however_the_filter_weighs() -> None:
    """A square across half of the frame, sharp and blurred: its share of the light is a half."""
    for camera in (dg.Camera(), dg.Camera(f_stop=1.4, focus_distance=0.5)):
        for kind in ("box", "blackman_harris", "mitchell"):
            scene = dg.Scene()
            points, triangles = scenes.quad(0.5, -2.0)
            points[:, 0] -= 0.5  # its right edge goes through the middle of the picture
            scene.add_instance(scene.add_mesh(points, triangles), RED, np.eye(4))
            frame = dg.render(scene, camera, resolution=(40, 20), spp=64, filter=kind)
            assert frame.alpha.max() == pytest.approx(1, abs=0.2 if kind == "mitchell" else 1e-6)
            assert frame.alpha.mean() == pytest.approx(0.5, abs=0.01)


def test_glass_covers_or_keeps_a_hole() -> None:
    case = Case(thin(), material=GLASS)
    scene = alone(case)
    opaque = dg.render(scene, case.camera, resolution=SIZE, spp=32, background="transparent")
    holes = dg.render(
        scene, case.camera, resolution=SIZE, spp=32, background="transparent", see_through=True
    )
    middle = opaque.alpha > 0.999
    assert middle.sum() > 60
    inner = (slice(22, 26), slice(34, 38))
    assert holes.alpha[inner].mean() < 0.12  # two faces reflect 4 % each
    assert holes.rgb[inner].mean() < 0.15 * opaque.rgb[inner].mean() + 0.05
    assert (holes.alpha <= opaque.alpha + 1e-6).all()


def test_sheets_and_cutouts_let_the_plate_through() -> None:
    scene = dg.Scene()
    points, triangles = scenes.quad(2.0, -2.0)
    sheet = dg.Gltf(base_color=(0.5, 0.5, 0.5), metallic=0.0, roughness=0.0, transmission=1.0)
    scene.add_instance(scene.add_mesh(points, triangles), dg.Material(sheet), np.eye(4))
    frame = dg.render(scene, dg.Camera(), resolution=(16, 12), spp=256)
    # Fresnel's share is reflected, of the rest half passes: a mean over wavelengths of 0.5.
    assert frame.alpha.mean() == pytest.approx(1 - 0.5 * 0.96, abs=0.02)
    cut = dg.Gltf(base_color=(1, 1, 1), base_alpha=0.25, alpha_mode="blend")
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh(points, triangles), dg.Material(cut), np.eye(4))
    frame = dg.render(scene, dg.Camera(), resolution=(16, 12), spp=256)
    assert frame.alpha.mean() == pytest.approx(0.25, abs=0.01)


def test_every_exr_has_it(tmp_path: Path) -> None:
    case = Case(real(), place=shifted(0, 0.5, -1))
    frame = dg.render(alone(case, None), case.camera, resolution=SIZE, spp=8)
    frame.save(tmp_path / "a.exr")
    again = dg.load_frame(tmp_path / "a.exr")
    assert np.array_equal(again.alpha, frame.alpha)
    assert again.metadata["background"] == "environment"


def test_a_background_that_is_none() -> None:
    with pytest.raises(dg.UsageError, match="background: wanted environment, transparent, plate"):
        dg.RenderSettings.of(background="transparant")  # codespell:ignore transparant
    assert look_at((0, 0, 1), (0, 0, 0)).shape == (4, 4)
