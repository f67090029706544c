"""``daguerre develop`` agrees with ``render`` in every exposure mode, and names the mode."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.color import spaces
from tests.faults.scene import write_scene

QUICK = ["--res", "48x32", "--spp", "4", "--light-paths", "off"]


@pytest.fixture(autouse=True)
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return write_scene(tmp_path / "s.glb")


def pixels(path: str) -> np.ndarray:
    return np.asarray(oiio.ImageBuf(path).get_pixels(oiio.UINT8)).astype(int)


def picture(path: str, **metadata: object) -> None:
    """A file of even grey whose 1 is exposed to a quarter of white at ISO 200."""
    rgb = np.full((32, 48, 3), 0.18, np.float32)
    facts = {"luminance_exposure": 10 / 0.18 / 800, "expTime": 0.01, "isoSpeed": 200.0}
    dg.Frame(rgb=rgb, metadata=facts | metadata).save(path)


MODES = {
    "light": [],
    "light, EV": ["--ev", "-1.5"],
    "light, ISO": ["--iso", "6400"],
    "light, white": ["--wb", "4000"],
    "manual, white": ["--exposure", "manual", "--iso", "400", "--wb", "0.35,0.36"],
    "manual": ["--exposure", "manual", "--iso", "400"],
    "manual, EV": ["--exposure", "manual", "--ev", "2"],
    "auto": ["--exposure", "auto"],
    "auto, EV": ["--exposure", "auto", "--ev", "1"],
    "A": ["--exposure", "A", "--f-stop", "8"],
    "P": ["--exposure", "P", "--meter", "matrix"],
}


@pytest.mark.parametrize("flags", MODES.values(), ids=MODES)
def test_a_frame_is_developed_as_it_was_rendered(flags: list[str]) -> None:
    bright = "--exposure" in flags
    flags = [*QUICK, "-q", *flags, "--sky", "60,50,40" if bright else "1,0.8,0.6"]
    assert main(["render", "s.glb", "-o", "d.exr", "-o", "d.png", *flags]) == 0
    assert main(["develop", "d.exr", "-o", "e.png"]) == 0
    one, other = pixels("d.png"), pixels("e.png")
    assert 20 < one.mean() < 235
    # Above white ``light`` has no shoulder in hue: only colours within sRGB are compared.
    frame = dg.load_frame("d.exr")
    shown = frame.rgb * 2 ** float(frame.metadata.get("exposure_compensation") or 0)
    inside = ((shown >= 0) & (shown <= 1)).all(axis=2) | bright
    assert inside.mean() > 0.5
    assert np.abs(one - other)[inside].max() <= 1
    raw = ["--sensor", "ideal", "--seed", "5"]
    assert main(["render", "s.glb", "-o", "f.png", *flags, *raw]) == 0
    assert main(["develop", "d.exr", "-o", "g.png", *raw]) == 0
    assert pixels("f.png").mean() == pytest.approx(pixels("g.png").mean(), abs=1)


def test_the_mode_can_be_changed_and_auto_prints_its_own(
    capsys: pytest.CaptureFixture[str],
) -> None:
    picture("l.exr", exposure="light")
    means = {}
    for words in ("light", "manual", "auto", "auto --ev 1", "auto --meter spot:3,4"):
        assert main(["develop", "l.exr", "-o", "x.png", "--exposure", *words.split()]) == 0
        means[words] = pixels("x.png").mean()
    assert means["light"] == pytest.approx(118, abs=1)
    assert means["manual"] == pytest.approx(60, abs=1)  # 0.045
    assert means["auto"] == means["auto --meter spot:3,4"] == pytest.approx(118, abs=1)
    assert means["auto --ev 1"] == pytest.approx(162, abs=1)  # 0.36
    told = capsys.readouterr().err
    assert "metered (centre): 0.18 cd/m2, EV100 0.5; the same picture: --exposure manual --iso 800"
    assert "+1 EV; the same picture: --exposure manual --iso 1600" in told
    assert main(["develop", "l.exr", "-o", "y.png", "--exposure", "manual", "--iso", "1600"]) == 0
    assert pixels("y.png").mean() == means["auto --ev 1"]
    for words in (["--exposure", "auto", "--sensor", "ideal"], ["--sensor", "ideal"]):
        assert main(["develop", "l.exr", "-o", "z.png", *words]) == 0
        assert pixels("z.png").mean() == pytest.approx(118, abs=2)


def test_the_mode_is_told_where_the_picture_is_another_than_before(
    capsys: pytest.CaptureFixture[str],
) -> None:
    def told(path: str, *flags: str) -> str:
        assert main(["develop", path, "-o", "x.png", *flags]) == 0
        return capsys.readouterr().err.replace("daguerre: wrote x.png\n", "")

    picture("l.exr", exposure="light")
    picture("m.exr", exposure="manual")
    picture("n.exr")
    before = "before 1.0 {} exposed the picture: add --exposure manual for that\n"
    assert told("l.exr").endswith(f"in light; {before.format('develop')}")
    assert told("l.exr", "--iso", "800").endswith(f"in light; {before.format('--iso')}")
    bright = pixels("x.png")
    assert told("l.exr", "--exposure", "light") == ""
    assert (pixels("x.png") == bright).all()
    assert told("m.exr", "--iso", "800") == ""
    assert "n.exr names no exposure mode: developed as manual; --exposure light" in told("n.exr")
    assert told("n.exr", "--exposure", "manual") == ""


def test_files_without_an_exposure_can_be_shown_in_light(
    capsys: pytest.CaptureFixture[str],
) -> None:
    dg.Frame(rgb=np.full((32, 48, 3), 0.18, np.float32)).save("bare.exr")
    assert main(["develop", "bare.exr", "-o", "x.png"]) == 3
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "bare.exr: expTime: wanted the exposure time in s, got none; --exposure light" in told
    assert main(["develop", "bare.exr", "-o", "x.png", "--exposure", "light", "--ev", "1"]) == 0
    assert pixels("x.png").mean() == pytest.approx(162, abs=1)


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (["--exposure", "S"], "--exposure S: the picture is already taken; wanted light, manual"),
        (["--exposure", "bright"], "--exposure: wanted light, manual"),
        (["--exposure", "auto", "--iso", "100"], "--exposure auto and --iso: wanted one of them"),
        (["--meter", "spot"], "--meter needs --exposure auto"),
        (["--exposure", "auto", "--meter", "sport"], "--meter: wanted centre"),
        (["--exposure", "auto", "--meter", "spot:ball"], "as a frame has no nodes; got 'ball'"),
        (["--exposure", "auto", "--meter", "spot:99,0"], "wanted a point inside the picture"),
    ],
)
def test_modes_that_it_refuses(
    capsys: pytest.CaptureFixture[str], flags: list[str], message: str
) -> None:
    picture("l.exr", exposure="light")
    assert main(["develop", "l.exr", "-o", "x.png", *flags]) == 2
    told = capsys.readouterr().err
    assert message in told
    assert told.count("\n") == 1
    assert not Path("x.png").exists()


def test_raw_files_keep_their_exposure(capsys: pytest.CaptureFixture[str]) -> None:
    picture("l.exr", exposure="light")
    assert main(["develop", "l.exr", "-o", "x.dng", "--sensor", "ideal"]) == 0
    for flags in (["--exposure", "light"], ["--meter", "spot"]):
        assert main(["develop", "x.dng", "-o", "x.png", *flags]) == 2
        assert f"{flags[0]} applies to frames of `render`" in capsys.readouterr().err
    assert main(["develop", "x.dng", "-o", "x.png", "--ev", "1"]) == 0
    assert pixels("x.png").mean() == pytest.approx(162, abs=2)


@pytest.mark.parametrize("sensor", ["ideal", "nikon-d5100", "sony-a7r-ii"])
def test_dngs_of_light_are_equally_bright_at_any_iso(sensor: str) -> None:
    """A value of 1 gives 55.6 / ISO lux s: ISO sets the noise alone, EV the brightness."""
    pytest.importorskip("rawpy", reason="needs the extra raw")
    lit = [*QUICK, "-q", "--sky", "0.9,0.9,0.9", "--sensor", sensor, "--aov", "exposure,saturated"]
    means, lux_s = {}, {}
    for iso, ev in ((200, 0), (800, 0), (3200, 0), (800, -1)):
        name = f"{iso}{ev}"
        files = ["-o", f"{name}.dng", "-o", f"{name}.exr"]
        assert main(["render", "s.glb", *files, *lit, "--iso", str(iso), "--ev", str(ev)]) == 0
        assert main(["develop", f"{name}.dng", "-o", f"{name}.tif", "-q"]) == 0
        light = spaces.decoded(oiio.ImageBuf(f"{name}.tif").get_pixels(oiio.FLOAT), "srgb")
        means[iso, ev] = light[4:-4, 4:-4].mean()
        frame = dg.load_frame(f"{name}.exr")
        lux_s[iso, ev] = frame.aovs["exposure.Y"]
        assert frame.aovs["saturated.G"].mean() < 0.01
    assert means[200, 0] > 0.1
    assert means[800, 0] == pytest.approx(means[200, 0], rel=0.02)
    assert means[3200, 0] == pytest.approx(means[200, 0], rel=0.03)
    assert means[800, -1] == pytest.approx(means[800, 0] / 2, rel=0.03)
    np.testing.assert_allclose(lux_s[800, 0], lux_s[200, 0] / 4, rtol=1e-5)
    np.testing.assert_allclose(lux_s[800, -1], lux_s[800, 0] / 2, rtol=1e-5)
    assert frame.xyz is not None
    np.testing.assert_allclose(
        lux_s[800, -1], frame.xyz[..., 1] * 10 / 0.18 / 800 / 2, rtol=1e-3, atol=1e-7
    )
