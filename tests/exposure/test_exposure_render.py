"""``daguerre render`` into photographs: the exposure triangle, meters, brackets, raw files."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import exifread
import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.color import spaces
from tests.support.formats.make_gltf import Builder

#: A sky of 100 cd/m2: at f/4, 1/50 s and ISO 100 a value of 1 is 100 h0 / 50 lux s.
SKY = 100.0
QUICK = ["--res", "32x32", "--spp", "4", "--sky", "100,100,100", "--quiet", "--light-paths", "off"]
BASE = {
    "--exposure": "manual",
    "--f-stop": "4",
    "--shutter": "1/50",
    "--iso": "100",
    "--focus": "2",
}
#: Linear value of that picture: 10 / ISO lux s is 0.18.
VALUE = SKY * math.pi / 4 / 16 / 50 * 100 * 0.018


@pytest.fixture(autouse=True)
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Nothing but a camera."""
    monkeypatch.chdir(tmp_path)
    made = Builder()
    made.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01}})
    made.node(camera=0, name="Camera")
    return made.glb(tmp_path / "s.glb")


def render(*outputs: str, more: tuple[str, ...] = (), **flags: str) -> int:
    given = BASE | {"--" + name.replace("_", "-"): value for name, value in flags.items()}
    words = [word for pair in given.items() if pair[1] for word in pair]
    files = [word for path in outputs for word in ("-o", path)]
    return main(["render", "s.glb", *files, *words, *QUICK, *more])


def linear(path: str) -> float:
    """Mean light of a picture in sRGB."""
    pixels = oiio.ImageBuf(path).get_pixels(oiio.FLOAT)
    return float(spaces.decoded(np.asarray(pixels, np.float32), "srgb").mean())


def exif(path: str) -> dict[str, str]:
    with Path(path).open("rb") as file:
        return {key: str(v) for key, v in exifread.process_file(file, details=False).items()}


def test_a_luminance_has_the_value_that_iso_12232_says() -> None:
    assert render("a.tif") == 0
    assert linear("a.tif") == pytest.approx(VALUE, rel=0.01)


@pytest.mark.parametrize(
    "changes",
    [
        {"iso": "50"},
        {"shutter": "1/100"},
        {"f_stop": f"{4 * math.sqrt(2)}"},
        {"ev": "-1"},
        {"exposure_time": "1/100"},
        {"exposure_f_stop": f"{4 * math.sqrt(2)}"},
        {"responsivity": "0.5"},
    ],
    ids=lambda c: next(iter(c)),
)
def test_a_stop_halves_the_light_of_the_picture(changes: dict[str, str]) -> None:
    assert render("a.tif") == 0
    assert render("b.tif", **changes) == 0
    assert linear("b.tif") == pytest.approx(linear("a.tif") / 2, rel=2e-3)


def test_a_stop_halves_the_jpeg_and_the_raw_numbers() -> None:
    for name, iso in (("a", "100"), ("b", "200")):
        assert render(f"{name}.jpg", f"{name}.dng", iso=iso, sensor="ideal") == 0
    assert linear("b.jpg") == pytest.approx(2 * linear("a.jpg"), rel=0.02)
    rawpy = pytest.importorskip("rawpy")
    means = []
    for name in "ab":
        with rawpy.imread(f"{name}.dng") as raw:
            means.append(
                raw.raw_image_visible.astype(float).mean() - raw.black_level_per_channel[0]
            )
    assert means[1] == pytest.approx(2 * means[0], rel=0.01)


@pytest.mark.parametrize("sensor", ["", "ideal", "nikon-d5100"])
def test_exif_is_what_a_camera_writes(sensor: str) -> None:
    outputs = ["a.jpg", "a.dng"] if sensor else ["a.jpg"]
    assert render(*outputs, shutter="1/125", iso="400", sensor=sensor) == 0
    for path in outputs:
        facts = exif(path)
        assert facts["EXIF ExposureTime"] == "1/125"
        assert facts["EXIF FNumber"] == "4"
        assert facts["EXIF ISOSpeedRatings"] == "400"
    if sensor == "nikon-d5100":
        assert exif("a.jpg")["Image Model"] == "D5100"


def test_an_exr_is_never_changed_and_keeps_what_it_was_exposed_with() -> None:
    frames = []
    for name, iso in (("a", ""), ("b", "3200")):
        assert render(f"{name}.exr", iso=iso) == 0
        frames.append(dg.load_frame(f"{name}.exr"))
    assert np.array_equal(frames[0].rgb, frames[1].rgb)
    assert frames[1].metadata["isoSpeed"] == 3200
    assert frames[1].metadata["expTime"] == pytest.approx(1 / 50)


def test_pictures_are_plain_unless_exposure_is_asked_for() -> None:
    """Linear 1 is white: a sky of 100 is far beyond."""
    assert render("a.jpg", "a.png", "a.tif", iso="", exposure="") == 0
    for path in ("a.jpg", "a.png", "a.tif"):
        assert linear(path) == pytest.approx(1, abs=0.01)
    frame = dg.Frame(np.full((8, 8, 3), 0.25, np.float32))
    for path in ("b.jpg", "b.tif", "b.png"):
        frame.save(path)
        assert linear(path) == pytest.approx(0.25, abs=0.01)


def test_the_meter_makes_what_it_reads_grey(capsys: pytest.CaptureFixture[str]) -> None:
    quick = [flag for flag in QUICK if flag != "--quiet"]
    words = ["--f-stop", "4", "--shutter", "1/50", "--focus", "2", "-o", "a.tif", "-o", "a.exr"]
    for pattern in ("centre", "spot", "matrix", "spot:3,4"):
        more = ["--exposure", "auto", "--meter", pattern]
        assert main(["render", "s.glb", *words, *quick, *more]) == 0
        assert linear("a.tif") == pytest.approx(0.18, rel=0.01)
        told = capsys.readouterr().err
        assert "100 cd/m2, EV100 9.6; the same picture: --exposure manual --iso 102\n" in told
        assert "daguerre: auto, as metered\n" in told
    assert dg.load_frame("a.exr").metadata["isoSpeed"] == 102
    quick[-2:-2] = ["--shutter", "1/100"]
    assert main(["render", "s.glb", *words, *quick, "--exposure", "auto", "--ev", "-0.5"]) == 0
    assert linear("a.tif") == pytest.approx(0.18 / math.sqrt(2), rel=0.01)
    told = capsys.readouterr().err
    assert "-0.5 EV; the same picture: --exposure manual --iso 144 --ev 0\n" in told
    assert "auto, 0.5 EV under the meter" in told


def test_the_meter_stays_within_the_sensor(capsys: pytest.CaptureFixture[str]) -> None:
    quick = [flag for flag in QUICK if flag != "--quiet"]
    words = ["--f-stop", "16", "--shutter", "1/4000", "--focus", "2", "--sensor", "nikon-d5100"]
    assert main(["render", "s.glb", "-o", "a.jpg", *words, *quick, "--exposure", "auto"]) == 0
    top = dg.sensors.load("nikon-d5100").iso_range[1]
    told = capsys.readouterr().err
    assert f"--iso {min(top, 6400):g}" in told
    assert "EV too dark" in told


def test_a_sensor_that_lacks_iso_100_is_exposed_at_its_own() -> None:
    """And with a meter that finds no light, too."""
    slow = dg.sensors.load("sony-imx571-mono")
    assert slow.iso_range[0] > 100
    assert render("a.jpg", sensor="sony-imx571-mono", iso="") == 0
    assert exif("a.jpg")["EXIF ISOSpeedRatings"] == f"{slow.base_iso:.0f}"
    words = ["--f-stop", "4", "--shutter", "1/50", "--focus", "2", "--res", "8x8", "--spp", "1"]
    more = ["--sensor", "sony-imx571-mono", "--exposure", "auto", "--quiet"]
    assert main(["render", "s.glb", "-o", "b.dng", *words, *more]) == 0


def test_a_black_picture_is_kept(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--f-stop", "4", "--shutter", "1/50", "--focus", "2", "--res", "8x8", "--spp", "1"]
    assert main(["render", "s.glb", "-o", "a.png", *words, "--exposure", "auto"]) == 0
    assert "no light to meter, so the exposure mode is light" in capsys.readouterr().err
    assert linear("a.png") == 0


def test_a_bracket_is_three_times(capsys: pytest.CaptureFixture[str]) -> None:
    assert render("a.tif", "a.dng", "a.exr", bracket="-2,0,1", sensor="ideal") == 0
    names = {path.name for path in Path().iterdir()} - {"s.glb"}
    assert names == {"a.exr", *(f"a_{n}ev.{e}" for n in ("-2", "0", "+1") for e in ("tif", "dng"))}
    base = linear("a_0ev.tif")
    assert linear("a_-2ev.tif") == pytest.approx(base / 4, rel=0.03)
    assert linear("a_+1ev.tif") == pytest.approx(2 * base, rel=0.03)
    assert exif("a_-2ev.dng")["EXIF ExposureTime"] == "1/200"
    assert exif("a_+1ev.dng")["EXIF ExposureTime"] == "1/25"


def test_a_raw_file_of_any_scene(capsys: pytest.CaptureFixture[str]) -> None:
    assert render("a.dng", iso="") == 0
    assert exif("a.dng")["Image Model"]
    assert render("p.dng", iso="", f_stop="", focus="", lens="pinhole") == 0


WRONG: dict[str, Any] = {
    "format": (["-o", "a.gif"], 2, "got '.gif'"),
    "mode": (["-o", "a.jpg", "--exposure", "auto:spot"], 2, "--exposure: wanted light"),
    "exposure": (["-o", "a.jpg", "--exposure", "m"], 2, "--exposure: wanted light, manual, auto"),
    "meter": (["-o", "a.jpg", "--meter", "sport"], 2, "did you mean 'spot'"),
    "no spot": (["-o", "a.jpg", "--meter", "matrix:3,4"], 2, "--meter: wanted centre, spot"),
    "spot outside": (
        ["-o", "a.jpg", "--exposure", "auto", "--meter", "spot:32,0"], 2, "a pixel of the picture",
    ),
    "spot node": (
        ["-o", "a.jpg", "--exposure", "auto", "--meter", "spot:Camra"], 3, "did you mean 'Camera'",
    ),
    "spot unseen": (
        ["-o", "a.jpg", "--exposure", "auto", "--meter", "spot:Camera"], 3, "is not in view",
    ),
    "time twice": (["-o", "a.jpg", "--exposure", "A", "--shutter", "1/48"], 2, "got both"),
    "angle twice": (["-o", "a.jpg", "--exposure", "P", "--shutter-angle", "90"], 2, "got both"),
    "stop twice": (["-o", "a.jpg", "--exposure", "S", "--f-stop", "4"], 2, "got both"),
    "no stop": (["-o", "a.jpg", "--exposure", "S", "--lens", "pinhole"], 2, "a pinhole has none"),
    "iso twice": (["-o", "a.jpg", "--exposure", "auto", "--iso", "100"], 2, "got both"),
    "iso": (["-o", "a.jpg", "--iso", "-100"], 2, "--iso: wanted a number above 0"),
    "iso nan": (["-o", "a.jpg", "--iso", "nan"], 2, "--iso"),
    "sensor iso": (
        ["-o", "a.dng", "--sensor", "nikon-d5100", "--iso", "1e6"], 2, "--iso: sensor nikon-d5100",
    ),
    "sensor": (["-o", "a.dng", "--sensor", "nikon-d510"], 2, "did you mean 'nikon-d5100'"),
    "sensor file": (["-o", "a.dng", "--sensor", "no.json"], 3, "no.json"),
    "bracket": (["-o", "a.jpg", "--bracket", "-2,zero"], 2, "--bracket: wanted exposures in EV"),
    "bracket twice": (["-o", "a.jpg", "--bracket", "1,1"], 2, "each once"),
    "bracket far": (["-o", "a.jpg", "--bracket", "0,99"], 2, "within 20 EV"),
    "bracket of exr": (["-o", "a.exr", "--bracket", "0,1"], 2, "--bracket needs an output"),
    "look": (["-o", "a.jpg", "--look", "flimic"], 2, "did you mean 'filmic'"),
    "tone": (["-o", "a.jpg", "--exposure", "manual", "--tone", "soft"], 2, "set by --look"),
    "frozen": (["-o", "a.dng", "--exposure", "manual", "--shutter", "0"], 3, "expTime"),
    "bands": (["-o", "a.exr", "--bands", "2"], 2, "--bands: wanted 3 .. 64"),
    "wb": (["-o", "a.jpg", "--wb", "12"], 2, "white_balance"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_wrong_flags_are_told_before_anything_is_drawn(
    case: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words, code, message = WRONG[case]
    assert main(["render", "s.glb", *words, *QUICK]) == code
    told = capsys.readouterr().err
    assert message in told
    assert "Traceback" not in told
    assert {path.name for path in Path().iterdir()} == {"s.glb"}
