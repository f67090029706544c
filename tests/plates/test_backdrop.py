"""The plate as the background of a picture: the composite in one render."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.frame.over import change_of_rgb
from daguerre.rendering.session import Session
from tests.plates.test_truth import CASES, SIZE
from tests.support.formats.make_gltf import triangle
from tests.support.pictures.statistical import differences

OPTIONS = {"resolution": SIZE, "spp": 32, "light_paths": "off"}


def plate(name: str, seed: int) -> np.ndarray:
    return dg.render(CASES[name].scene("empty"), CASES[name].camera, seed=seed, **OPTIONS).rgb


@pytest.mark.parametrize("name", ["motion", "vignetted corner"])
def test_the_render_over_the_plate_is_that_of_the_whole_scene(name: str) -> None:
    case = CASES[name]
    made, whole = [], []
    for i in range(8):
        caught = case.scene("caught")
        caught.set_plate(plate(name, 100 + i))
        made.append(dg.render(caught, case.camera, seed=200 + i, background="plate", **OPTIONS).rgb)
        whole.append(dg.render(case.scene("full"), case.camera, seed=300 + i, **OPTIONS).rgb)
    assert differences(np.array(made, float), np.array(whole, float), alpha=1e-3) == []


def test_it_is_the_composite_of_the_parts_to_the_bit() -> None:
    case = CASES["matte ground"]
    caught = case.scene("caught")
    caught.set_plate(plate("matte ground", 1))
    objects, over = (
        dg.render(caught, case.camera, background=background, **OPTIONS)
        for background in ("transparent", "plate")
    )
    made = change_of_rgb(objects).of(caught.plate.pixels)
    assert np.array_equal(over.rgb, made)
    assert np.array_equal(over.alpha, objects.alpha)
    assert np.array_equal(over.catcher, objects.catcher)
    assert over.metadata["background"] == "plate"


def test_crops_and_overscan_have_their_part_of_the_plate() -> None:
    case = CASES["distorted"]
    caught = case.scene("caught")
    caught.set_plate(plate("distorted", 1))
    whole = dg.render(caught, case.camera, background="plate", **OPTIONS)
    x0, y0, x1, y1 = crop = (20, 10, 60, 40)
    part = dg.render(caught, case.camera, background="plate", crop=crop, **OPTIONS)
    assert np.array_equal(part.rgb, whole.rgb[y0:y1, x0:x1])
    around = dg.render(caught, case.camera, background="plate", overscan=4, **OPTIONS)
    assert np.array_equal(around.without_overscan().rgb, whole.rgb)
    beside = around.alpha == 0
    beside[4:-4, 4:-4] = False
    assert around.rgb[beside].min() <= 0  # there is no plate, and shadows take nothing off it


def test_a_larger_plate_of_the_same_shape_is_resized() -> None:
    width, height = SIZE
    fine = np.zeros((2 * height, 2 * width, 3), np.float32)
    fine[:, :width] = (1.0, 0.5, 0.25)
    scene = dg.Scene()
    scene.set_plate(fine)
    rgb = dg.render(scene, dg.Camera(), background="plate", **OPTIONS).rgb
    even = rgb[:, : width // 2 - 2].reshape(-1, 3)
    np.testing.assert_allclose(even, np.broadcast_to((1.0, 0.5, 0.25), even.shape), rtol=1e-5)
    assert abs(rgb[:, width // 2 + 2 :]).max() < 1e-6


def test_what_cannot_be_a_background_is_refused() -> None:
    scene = dg.Scene()
    with pytest.raises(dg.UsageError, match=r"plate: wanted a photograph \(--plate\), got none"):
        dg.render(scene, dg.Camera(), background="plate", **OPTIONS)
    scene.set_plate(np.ones((48, 48, 3)))
    with pytest.raises(
        dg.InputError, match=r"72 x 48 px, as the picture, or a multiple of it, got 48 x 48 px"
    ):
        dg.render(scene, dg.Camera(), background="plate", **OPTIONS)
    scene.set_plate(np.ones((48, 72, 3)), dg.Camera(focal_length=35))
    with pytest.raises(dg.UsageError, match="wanted a photo by the camera that renders"):
        dg.render(scene, dg.Camera(), background="plate", **OPTIONS)


@pytest.mark.parametrize("mode", ["manual", "auto", "A", "S", "P"])
def test_a_plate_is_in_light_alone(mode: str) -> None:
    """It is exposed already: another mode would expose it again."""
    scene = dg.Scene()
    scene.set_plate(np.ones((48, 72, 3)))
    wanted = f"exposure mode light, .* got {mode}; use --background transparent, then `daguerre com"
    with pytest.raises(dg.UsageError, match=wanted):
        dg.render(scene, dg.Camera(exposure=mode), background="plate", **OPTIONS)
    for other in ("transparent", "environment"):
        dg.render(scene, dg.Camera(exposure=mode), background=other, **OPTIONS)


def test_samples_go_on_and_the_plate_is_not_denoised() -> None:
    case = CASES["matte ground"]
    caught = case.scene("caught")
    caught.set_plate(plate("matte ground", 1))
    session = Session(caught, case.camera, resolution=SIZE, background="plate", light_paths="off")
    session.draw(0, 4)
    alone = session.frame(plate=False)
    assert alone.rgb[alone.alpha == 0].max() == 0
    assert np.array_equal(session.frame().rgb, session.over_plate(alone).rgb)
    noisy = replace(alone, rgb=alone.rgb + 1)
    assert not np.array_equal(session.over_plate(noisy).rgb, session.frame().rgb)


def file_of(folder: Path) -> Path:
    return triangle().glb(folder / "one.glb")


@pytest.mark.parametrize(
    ("flags", "words"),
    [
        (["-o", "a.exr"], "--plate"),
        (["--plate", "p.exr", "-o", "a.dng"], "daguerre composite"),
        (["--plate", "p.exr", "-o", "a.exr", "--samples", "0:2"], "daguerre composite"),
        (["--plate", "p.exr", "-o", "a.exr", "--res", "40x40"], "40 x 40 px"),
        (["--plate", "p.exr", "-o", "a.png", "--exposure", "manual"], "daguerre composite"),
        (["--plate", "p.exr", "-o", "a.exr", "--exposure", "auto"], "daguerre composite"),
        (["--plate", "p.exr", "-o", "a.png", "--look", "standard"], "daguerre composite"),
    ],
)
def test_the_command_line_says_what_it_wants(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
    flags: list[str], words: str,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    dg.Frame(np.full((20, 30, 3), 0.5, np.float32)).save("p.exr")
    scene = file_of(tmp_path)
    common = ["--background", "plate", "--lens", "pinhole", "--sky", "1,1,1", "--spp", "2", "-q"]
    size = [] if "--res" in flags else ["--res", "30x20"]
    assert main(["render", str(scene), *common, *size, *flags]) in (2, 3)
    told = capsys.readouterr().err
    assert "background (--background): plate" in told
    assert words in told
    assert not list(tmp_path.glob("a.*"))


def test_a_render_over_a_plate_by_the_command_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    dg.Frame(np.full((20, 30, 3), 0.5, np.float32)).save("p.exr")
    scene = file_of(tmp_path)
    common = ["--background", "plate", "--plate", "p.exr", "--lens", "pinhole", "--sky", "1,1,1"]
    files = ["-o", "a.exr", "-o", "a.png"]
    assert main(["render", str(scene), *common, "--spp", "4", "--res", "30x20", "-q", *files]) == 0
    frame = dg.load_frame("a.exr")
    assert frame.rgb[frame.alpha == 0] == pytest.approx(0.5)
    assert frame.alpha.max() == 1
    assert Path("a.png").stat().st_size > 100
