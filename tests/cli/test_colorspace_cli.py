"""``--colorspace`` of ``render`` and ``develop``; passes, resuming, darkroom; ``--env``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.color.spaces import LINEAR
from daguerre.rendering.passes import read_pass
from tests.importers.mitsuba.scene_files import camera, written
from tests.support.pictures.stated_light import AP0, AP1, TO_REC709, exr

SMALL = ("--res", "8x6", "--seed", "3")
BALL = (
    camera(),
    '<shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="0.7 0.3 0.1"/></bsdf>'
    '</shape><emitter type="constant"><rgb name="radiance" value="1 0.9 0.8"/></emitter>',
)


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return written(tmp_path, *BALL)


def render(scene: Path, *words: object) -> int:
    return main(["render", str(scene), *SMALL, *map(str, words), "--quiet"])


def rgb(path: str) -> Any:
    return dg.load_frame(path).rgb


def test_linear_spaces_are_written_and_read_back(scene: Path) -> None:
    assert render(scene, "--spp", 4, "-o", "plain.exr", "-o", "plain.png") == 0
    for name in LINEAR:
        out = ("-o", f"{name}.exr", "-o", f"{name}.png")
        assert render(scene, "--spp", 4, "--colorspace", name, *out) == 0
        within = 2.0**-10 if name == "aces" else 2e-6
        np.testing.assert_allclose(rgb(f"{name}.exr"), rgb("plain.exr"), atol=within)
        # Pictures for display do not change.
        assert np.array_equal(
            oiio.ImageBuf(f"{name}.png").get_pixels(), oiio.ImageBuf("plain.png").get_pixels()
        )
    np.testing.assert_array_equal(rgb("lin_rec709.exr"), rgb("plain.exr"))
    stored = oiio.ImageBuf("acescg.exr").get_pixels(oiio.FLOAT)[..., :3]
    assert np.abs(stored - rgb("plain.exr")).max() > 0.02


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("--colorspace", "srgb", "-o", "a.exr"), "encoded for a display"),
        (("--colorspace", "p3", "-o", "a.exr"), "encoded for a display"),
        (("--colorspace", "camera", "-o", "a.exr"), "--sensor adds the sensor's channels"),
        (("--colorspace", "aces2", "-o", "a.exr"), "did you mean 'aces'"),
        (("--colorspace", "acescg", "-o", "a.png"), "needs an .exr output"),
    ],
)
def test_wrong_spaces(
    scene: Path, words: tuple[str, ...], why: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["render", str(scene), *SMALL, *words]) == 2
    assert why in capsys.readouterr().err


def test_an_aces_file_with_aovs_says_that_it_is_no_container(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("--spp", "2", "--colorspace", "aces", "--aov", "depth", "-o", "a.exr")
    assert main(["render", str(scene), *SMALL, *words]) == 0
    assert "not an ACES image container" in capsys.readouterr().err
    spec = oiio.ImageBuf("a.exr").spec()
    assert spec.get_int_attribute("acesImageContainerFlag") == 0
    assert spec.getattribute("chromaticities") == pytest.approx(AP0, abs=1e-6)


def test_passes_keep_their_sums_and_their_space(scene: Path) -> None:
    for name, more in (("plain", ()), ("wide", ("--colorspace", "acescg"))):
        for i, part in enumerate(("0:2", "2:4")):
            out = ("-o", f"{name}{i}.exr")
            assert render(scene, "--spp", 4, "--samples", part, *more, *out) == 0
        assert main(["merge", f"{name}0.exr", f"{name}1.exr", "-o", f"{name}.exr"]) == 0
    assert read_pass("wide0.exr").key == read_pass("plain0.exr").key
    for part, words in read_pass("plain0.exr").state.items():
        np.testing.assert_array_equal(read_pass("wide0.exr").state[part], words)
    wide = dg.load_frame("wide.exr")
    assert wide.metadata["colorspace"] == "acescg"
    np.testing.assert_allclose(wide.rgb, rgb("plain.exr"), atol=2e-6)
    # A space is no part of a picture's identity.
    assert main(["merge", "plain0.exr", "wide1.exr", "-o", "mixed.exr"]) == 0
    np.testing.assert_array_equal(rgb("mixed.exr"), rgb("plain.exr"))


def test_a_render_resumes_from_a_checkpoint_in_another_space(scene: Path) -> None:
    assert render(scene, "--spp", 8, "-o", "whole.exr") == 0
    assert render(scene, "--samples", "0:4", "--colorspace", "xyz", "-o", "part.exr") == 0
    Path("part.exr").rename("a.checkpoint.exr")
    assert render(scene, "--spp", 8, "--colorspace", "acescg", "-o", "a.exr", "--resume") == 0
    assert not Path("a.checkpoint.exr").exists()
    np.testing.assert_allclose(rgb("a.exr"), rgb("whole.exr"), atol=2e-6)
    assert dg.load_frame("a.exr").metadata["samples"] == 8


def test_the_darkroom_works_in_rec709_and_keeps_the_space(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rng = np.random.default_rng(5)
    light = rng.random((8, 8, 3)).astype(np.float32)
    exr(Path("plain.exr"), light)
    wide = light @ np.linalg.inv(np.array(TO_REC709[AP1])).T
    exr(Path("wide.exr"), wide, chromaticities=AP1)
    effect = ("--effect", "saturation-vignetting:k1=-0.5")
    for name in ("plain", "wide"):
        words = (f"{name}.exr", "-o", f"{name}-out.exr", *effect)
        assert main(["post", *words]) == 0
        assert main(["post", f"{name}.exr", "-o", f"{name}.png", *effect]) == 0
    assert "a written .exr has the file's again" in capsys.readouterr().err
    spec = oiio.ImageBuf("wide-out.exr").spec()
    assert spec.getattribute("chromaticities") == pytest.approx(AP1, abs=1e-6)
    np.testing.assert_allclose(rgb("wide-out.exr"), rgb("plain-out.exr"), atol=5e-5)
    shown = [oiio.ImageBuf(f"{name}.png").get_pixels(oiio.UINT8) for name in ("plain", "wide")]
    assert np.abs(shown[0].astype(int) - shown[1]).max() <= 1


def test_an_environment_in_aces_lights_like_its_twin(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sky = np.full((8, 16, 3), (0.4, 0.3, 0.2), np.float32)
    exr(Path("aces.exr"), sky, chromaticities=AP0)
    exr(Path("plain.exr"), (sky @ np.array(TO_REC709[AP0]).T).astype(np.float32))
    for name in ("aces", "plain"):
        words = ("--env", f"{name}.exr", "--spp", "4", "-o", f"out-{name}.exr")
        assert main(["render", str(scene), *SMALL, *words]) == 0
        told = capsys.readouterr().err
        assert ("colors are converted to linear Rec.709 from ACES AP0" in told) == (name == "aces")
    np.testing.assert_allclose(rgb("out-aces.exr"), rgb("out-plain.exr"), rtol=1e-3)


@pytest.mark.parametrize("name", LINEAR)
def test_develop_writes_scene_light(scene: Path, name: str) -> None:
    facts = {"exposure": "light", "version": "x"}
    light = np.float32([[[0.5, 0.25, 0.125], [8.0, 4.0, 2.0], [0.0, 1.0, 0.0]]] * 2)
    dg.Frame(light, metadata=facts).save("in.exr")
    assert main(["develop", "in.exr", "-o", "out.exr", "--colorspace", name]) == 0
    np.testing.assert_allclose(rgb("out.exr"), light, rtol=2e-3, atol=2e-3)
    spec = oiio.ImageBuf("out.exr").spec()
    assert spec.get_int_attribute("acesImageContainerFlag") == (name == "aces")


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("--colorspace", "acescg", "-o", "a.png"), "linear light needs .exr"),
        (("--colorspace", "xyz", "--look", "film", "-o", "a.exr"), "without a tone curve"),
        (("--colorspace", "camera", "-o", "a.exr"), "wanted a raw picture"),
    ],
)
def test_develop_refuses(
    scene: Path, words: tuple[str, ...], why: str, capsys: pytest.CaptureFixture[str]
) -> None:
    dg.Frame(np.ones((4, 4, 3), np.float32), metadata={"exposure": "light"}).save("in.exr")
    assert main(["develop", "in.exr", *words]) == 2
    assert why in capsys.readouterr().err
    assert not Path("a.exr").exists()


def test_develop_reads_the_space_of_a_frame(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    light = np.full((4, 4, 3), (0.5, 0.25, 0.125), np.float32)
    for name in ("lin_rec709", "acescg"):
        dg.Frame(light, metadata={"exposure": "light"}).save(f"{name}.exr", colour_space=name)
        assert main(["develop", f"{name}.exr", "-o", f"{name}.png"]) == 0
    assert "colors are converted" in capsys.readouterr().err
    pixels = [oiio.ImageBuf(f"{n}.png").get_pixels(oiio.UINT8) for n in ("lin_rec709", "acescg")]
    assert np.abs(pixels[0].astype(int) - pixels[1]).max() <= 1


def test_a_raw_picture_keeps_the_cameras_colors(scene: Path) -> None:
    facts = {"expTime": 1 / 125, "aperture": 2.8, "luminance_exposure": 10 / 0.18 / 200}
    facts |= {"isoSpeed": 200}
    light = np.full((64, 64, 3), (0.2, 0.1, 0.05), np.float32)
    dg.Frame(light, metadata=facts).save("in.exr")
    assert main(["develop", "in.exr", "--sensor", "ideal", "-o", "own.exr",
                 "--colorspace", "camera"]) == 0  # fmt: skip
    spec = oiio.ImageBuf("own.exr").spec()
    assert spec.get_string_attribute("colorInteropID") == "unknown"
    assert spec.getattribute("chromaticities") is None
    assert np.isfinite(rgb("own.exr")).all()
