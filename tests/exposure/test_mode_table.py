"""Golden table of exposure: files, flags and outputs with their mode, EV, ISO and mean.

The world is a white sky of 0.1 cd/m2, so the linear mean of a picture is 0.1 g 2^EV.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.color import spaces
from tests.support.formats.make_gltf import Builder

SKY = 0.1
#: f/4, 1/50 s: g of manual at ISO 1.
UNIT = 0.018 * math.pi / 4 / 16 / 50
GREY = 0.18
FAST = ("--f-stop", "4", "--shutter", "1/50")
QUICK = ("--res", "16x16", "--spp", "1", "--light-paths", "off", "--quiet")
RIG = ("--iso", "25600")
MANUAL = ("--exposure", "manual")
#: ISO that a meter wants for this sky at f/4 and 1/50 s, and the gain of the highest that it sets.
WANTED = GREY / SKY / UNIT
TOP = 6400 * UNIT


@dataclass(frozen=True)
class Row:
    """A command and what comes of it.

    Attributes:
        scene: Name of the scene's file.
        words: Flags.
        mode: Mode in the metadata.
        gain: g 2^EV.
        ev: EV in the metadata.
        iso: ISO in the metadata.
        develop: Flags of ``develop``, which then makes the picture; None: ``render`` does.
    """

    scene: str
    words: tuple[str, ...]
    mode: str
    gain: float
    ev: float = 0.0
    iso: float = 100.0
    develop: tuple[str, ...] | None = None
    kind: str = field(default=".tif")


def gltf(*words: str, mode: str = "light", gain: float = 1.0, **more: object) -> Row:
    return Row("s.glb", words, mode, gain, **more)  # type: ignore[arg-type]


USD_SCALE = 0.02 * 8 / 4**2 * 2 * 2**1  # time, ISO / 100, f-stop, responsivity, exposure
ROWS: dict[str, Row] = {
    # The default, and flags that leave its brightness alone.
    "light": gltf(),
    "light named": gltf("--exposure", "light"),
    "light iso": gltf("--iso", "400", iso=400.0),
    "light stop": gltf("--f-stop", "8"),
    "light time": gltf("--shutter", "1/500"),
    "light frozen": gltf("--shutter", "0"),
    "light split": gltf("--exposure-time", "1/10", "--exposure-f-stop", "2"),
    "light responsivity": gltf("--responsivity", "4"),
    "light wb": gltf("--wb", "6504"),
    "light look": gltf("--look", "neutral"),
    "light sensor": gltf("--sensor", "ideal", "--seed", "3"),
    "light sensor iso": gltf("--sensor", "ideal", "--iso", "1600", iso=1600.0),
    "light meter": gltf("--meter", "spot"),
    "light lens": gltf("--lens", "double-gauss-50mm-f2", "--f-stop", "4"),
    "light pinhole": gltf("--lens", "pinhole"),
    "light ev": gltf("--ev", "1", gain=2.0, ev=1.0),
    "light ev down": gltf("--ev=-2", gain=0.25, ev=-2.0),
    "light ev sensor": gltf("--ev", "1", "--sensor", "ideal", gain=2.0, ev=1.0),
    "light ev wb": gltf("--ev", "1", "--wb", "6504", gain=2.0, ev=1.0),
    "light jpg": gltf(kind=".jpg"),
    "light png": gltf(kind=".png"),
    "light png ev": gltf("--ev", "1", gain=2.0, ev=1.0, kind=".png"),
    "light crop": gltf("--crop", "4,4,12,12"),
    # By hand.
    "manual": gltf(*FAST, *MANUAL, *RIG, mode="manual", gain=25600 * UNIT, iso=25600.0),
    "manual iso": gltf(*FAST, *MANUAL, "--iso", "51200", mode="manual", gain=51200 * UNIT,
                       iso=51200.0),
    "manual stop": gltf("--shutter", "1/50", "--f-stop", "2", *MANUAL, *RIG, mode="manual",
                        gain=4 * 25600 * UNIT, iso=25600.0),
    "manual time": gltf("--shutter", "1/25", "--f-stop", "4", *MANUAL, *RIG, mode="manual",
                        gain=2 * 25600 * UNIT, iso=25600.0),
    "manual ev": gltf(*FAST, *MANUAL, *RIG, "--ev", "1", mode="manual", gain=2 * 25600 * UNIT,
                      ev=1.0, iso=25600.0),
    "manual ev 0": gltf(*FAST, *MANUAL, *RIG, "--ev", "0", mode="manual", gain=25600 * UNIT,
                        iso=25600.0),
    "manual split time": gltf(*FAST, *MANUAL, *RIG, "--exposure-time", "1/25", mode="manual",
                              gain=2 * 25600 * UNIT, iso=25600.0),
    "manual split stop": gltf(*FAST, *MANUAL, *RIG, "--exposure-f-stop", "2", mode="manual",
                              gain=4 * 25600 * UNIT, iso=25600.0),
    "manual responsivity": gltf(*FAST, *MANUAL, *RIG, "--responsivity", "2", mode="manual",
                                gain=2 * 25600 * UNIT, iso=25600.0),
    "manual wb": gltf(*FAST, *MANUAL, *RIG, "--wb", "6504", mode="manual", gain=25600 * UNIT,
                      iso=25600.0),
    "manual look": gltf(*FAST, *MANUAL, *RIG, "--look", "neutral", mode="manual",
                        gain=25600 * UNIT, iso=25600.0),
    "manual sensor": gltf(*FAST, *MANUAL, *RIG, "--sensor", "ideal", mode="manual",
                          gain=25600 * UNIT, iso=25600.0),
    "manual png": gltf(*FAST, *MANUAL, *RIG, mode="manual", gain=25600 * UNIT, iso=25600.0,
                       kind=".png"),
    "manual pinhole": gltf("--lens", "pinhole", "--shutter", "1/50", *MANUAL, *RIG, mode="manual",
                           gain=25600 * UNIT / 4, iso=25600.0),
    # By the meter.
    "auto": gltf("--shutter", "1", "--f-stop", "4", "--exposure", "auto", mode="auto", gain=1.8,
                 iso=round(WANTED / 50)),
    "auto ev": gltf("--shutter", "1", "--f-stop", "4", "--exposure", "auto", "--ev=-1",
                    mode="auto", gain=0.9, iso=round(WANTED / 100)),
    "auto spot": gltf("--shutter", "1", "--f-stop", "4", "--exposure", "auto", "--meter", "spot",
                      mode="auto", gain=1.8, iso=round(WANTED / 50)),
    "auto matrix": gltf("--shutter", "1", "--f-stop", "4", "--exposure", "auto", "--meter",
                        "matrix", mode="auto", gain=1.8, iso=round(WANTED / 50)),
    "auto highlight": gltf("--shutter", "1", "--f-stop", "2", "--exposure", "auto", "--meter",
                           "highlight", "--ev=-1", mode="auto", gain=5.0,
                           iso=round(WANTED / 400 / 0.18)),
    "auto night": gltf(*FAST, "--exposure", "auto", mode="auto", gain=TOP, iso=6400.0),
    "auto sensor": gltf("--shutter", "1", "--f-stop", "4", "--exposure", "auto", "--sensor",
                        "ideal", mode="auto", gain=1.8, iso=round(WANTED / 50)),
    "A night": gltf("--f-stop", "4", "--exposure", "A", *RIG, mode="A",
                    gain=25600 * UNIT * 50 / 15, iso=25600.0),
    "A": gltf("--f-stop", "1", "--exposure", "A", *RIG, mode="A", gain=1.8, iso=25600.0),
    "S": gltf("--shutter", "1", "--exposure", "S", "--iso", "1600", mode="S", gain=1.8,
              iso=1600.0),
    "P": gltf("--exposure", "P", "--iso", "102400", mode="P", gain=1.8, iso=102400.0),
    # Files.
    "usd": Row("plain.usda", (), "light", 1.0),
    "usd exposure": Row("ev.usda", (), "light", 2.0, 1.0),
    "usd manual": Row("camera.usda", (), "manual", USD_SCALE, 1.0, 800.0),
    "usd manual named": Row("camera.usda", ("--exposure", "light"), "light", 2.0, 1.0, 800.0),
    "usd manual ev 0": Row("camera.usda", ("--ev", "0"), "manual", USD_SCALE / 2, 0.0, 800.0),
    "usd fallbacks": Row("iso.usda", (), "manual", 4.0, 0.0, 400.0),
    "pbrt": Row("plain.pbrt", (), "light", 1.0),
    "pbrt iso": Row("iso.pbrt", (), "light", 4.0, 2.0),
    "pbrt time": Row("time.pbrt", (), "light", 2.0, 1.0),
    "mitsuba": Row("plain.xml", (), "light", 1.0),
    "calibration": gltf("--calibration", "camera.yml", "--res", "16x12"),
    # From the file of a frame.
    "develop light": gltf("--iso", "800", iso=800.0, develop=()),
    "develop light ev": gltf("--ev", "1", gain=4.0, ev=1.0, develop=("--ev", "1")),
    "develop light sensor": gltf(develop=("--sensor", "ideal", "--iso", "400")),
    "develop light look": gltf(develop=("--look", "neutral", "--wb", "6504")),
    "develop manual": gltf(*FAST, *MANUAL, *RIG, mode="manual", gain=25600 * UNIT, iso=25600.0,
                           develop=()),
    "develop manual iso": gltf(*FAST, *MANUAL, *RIG, mode="manual", gain=51200 * UNIT,
                               iso=25600.0, develop=("--iso", "51200")),
    "develop auto": gltf("--shutter", "1", "--f-stop", "4", "--exposure", "auto", mode="auto",
                         gain=1.8, iso=round(WANTED / 50), develop=()),
    "develop light as manual": gltf(*FAST, *RIG, gain=25600 * UNIT, iso=25600.0,
                                    develop=("--exposure", "manual")),
    "develop manual as light": gltf(*FAST, *MANUAL, *RIG, mode="manual", gain=1.0, iso=25600.0,
                                    develop=("--exposure", "light")),
}  # fmt: skip


@pytest.fixture(autouse=True)
def scenes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing but a camera, in files of all kinds."""
    monkeypatch.chdir(tmp_path)
    made = Builder()
    made.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01}})
    made.node(camera=0, name="Camera")
    made.glb(tmp_path / "s.glb")
    for name, lines in {
        "plain": "",
        "ev": "float exposure = 1",
        "iso": "float exposure:iso = 400",
        "camera": "float exposure:time = 0.02\nfloat exposure:iso = 800\nfloat exposure:fStop = 4\n"
        "float exposure:responsivity = 2\nfloat exposure = 1",
    }.items():
        Path(f"{name}.usda").write_text(
            f'#usda 1.0\n(metersPerUnit = 1\nupAxis = "Y")\ndef Camera "eye"\n{{\n{lines}\n}}\n'
        )
    for name, film, eye in (
        ("plain", "", ""),
        ("iso", '"float iso" [400]', ""),
        ("time", "", '"float shutteropen" [0] "float shutterclose" [2]'),
    ):
        Path(f"{name}.pbrt").write_text(
            f'Camera "perspective" "float fov" [40] {eye}\n'
            f'Film "rgb" "integer xresolution" [16] "integer yresolution" [16] {film}\nWorldBegin\n'
        )
    Path("plain.xml").write_text(
        '<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="40"/>'
        "</sensor></scene>"
    )
    Path("camera.yml").write_text(
        "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n"
        "   rows: 3\n   cols: 3\n   dt: d\n   data: [500., 0., 320., 0., 500., 240., 0., 0., 1.]\n"
        "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n"
        "   data: [0., 0., 0., 0., 0.]\n"
    )


def linear(path: Path) -> float:
    """Mean light of a picture in sRGB."""
    pixels = oiio.ImageBuf(str(path)).get_pixels(oiio.FLOAT)
    return float(spaces.decoded(np.asarray(pixels, np.float32), "srgb").mean())


@pytest.mark.parametrize("name", ROWS)
def test_a_command_has_its_mode_and_its_brightness(name: str) -> None:
    row = ROWS[name]
    sky = ["--sky", ",".join([f"{SKY}"] * 3)]
    words = ["render", row.scene, *QUICK, *sky, "-o", "a.exr", *row.words]
    picture = Path(f"a{row.kind}")
    assert main(words if row.develop is not None else [*words, "-o", str(picture)]) == 0
    frame = dg.load_frame("a.exr")
    assert frame.metadata["exposure"] == row.mode
    assert (frame.metadata.get("exposure_compensation") or 0.0) == pytest.approx(row.ev, abs=1e-5)
    assert frame.metadata["isoSpeed"] == pytest.approx(row.iso, abs=1, rel=0.015)
    seen = float(frame.rgb.mean())  # whatever the exposure
    assert seen == pytest.approx(SKY, rel=0.2 if name == "light lens" else 0.02)
    if row.develop is not None:
        assert main(["develop", "a.exr", "-q", *row.develop, "-o", str(picture)]) == 0
    close = {".jpg": 0.05, ".png": 0.05}.get(row.kind, 0.02)
    noisy = 0.05 if "--sensor" in (*row.words, *(row.develop or ())) else 0.0
    assert linear(picture) == pytest.approx(min(row.gain * seen, 1), rel=close + noisy)


def test_there_are_sixty_of_them() -> None:
    assert len(ROWS) >= 60
