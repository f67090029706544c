"""The meter's own picture: parts of a picture equal the whole, and printed commands repeat it."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from tests.faults.scene import write_scene

QUICK = ("--res", "48x32", "--spp", "2", "--light-paths", "off")
SKY = ("--sky", "30,20,10")
AUTO = ("--exposure", "auto", "--shutter", "1/50")


@pytest.fixture(autouse=True)
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Squares, one of which moves, with two cameras."""
    monkeypatch.chdir(tmp_path)
    return write_scene(tmp_path / "s.glb")


def render(*words: str, camera: str = "left", quick: tuple[str, ...] = QUICK) -> int:
    return main(["render", "s.glb", "--camera", camera, *quick, *SKY, *words])


def iso_of(path: str) -> float:
    return float(dg.load_frame(path).metadata["isoSpeed"])


@pytest.mark.parametrize(
    ("mode", "more"),
    [
        ("auto", ("--shutter", "1/50", "--ev", "0.7")),
        ("A", ("--iso", "400", "--ev=-0.3")),
        ("S", ("--shutter", "1/50", "--iso", "200")),
        ("P", ("--iso", "400")),
        ("S", ("--shutter", "1/50", "--iso", "200", "--lens", "double-gauss-50mm-f2")),
        ("P", ("--iso", "200", "--lens", "double-gauss-50mm-f2", "--meter", "matrix")),
    ],
)
def test_the_printed_command_draws_the_same_bits(
    mode: str, more: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert render("--exposure", mode, *more, "-o", "a.png", "-o", "a.exr") == 0
    told = capsys.readouterr().err
    printed = re.search(r"the same picture: (.*)\n", told)
    assert printed is not None
    assert f"{mode}, as metered" in told or "the meter" in told
    kept = [w for i, w in enumerate(more) if "--ev" not in w and more[i - 1] != "--ev"]
    assert render(*kept, *printed[1].split(), "-o", "b.png", "-o", "b.exr") == 0
    assert np.array_equal(dg.load_frame("a.exr").rgb, dg.load_frame("b.exr").rgb)
    shown = [dg.load_frame(f"{name}.exr") for name in "ab"]
    assert np.array_equal(shown[0].display(), shown[1].display())
    assert shown[0].metadata["exposure"] == mode
    assert shown[1].metadata["exposure"] == "manual"


@pytest.mark.parametrize(
    "words",
    [
        ("--crop", "0,0,24,32"),
        ("--spp", "7"),
        ("--seed", "9"),
        ("--samples", "1:2"),
        ("--threads", "1"),
        ("--res", "96x64"),
        ("--flare", "0"),
        ("--max-depth", "1"),
        ("--sensor", "ideal"),
        ("--frames", "7"),
        ("--stereo", "0.2"),
    ],
    ids=lambda words: words[0],
)
def test_a_part_or_another_quality_has_the_exposure_of_the_whole(
    words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert render(*AUTO, "-o", "a.exr", "-q") == 0
    quick = tuple(w for w in QUICK if words[0] not in ("--res", "--spp") or w not in QUICK[:4])
    quick += ("--spp", "2") if words[0] == "--res" else ()
    quick += ("--res", "48x32") if words[0] == "--spp" else ()
    assert render(*AUTO, *words, "-o", "b.#.exr" if words[0] == "--frames" else "b.exr", "-q",
                  quick=quick) == 0  # fmt: skip
    made = [str(path) for path in Path().glob("b*.exr")]
    assert made
    assert {iso_of(path) for path in made} == {iso_of("a.exr")}


def test_a_sequence_and_a_rig_share_the_exposure() -> None:
    assert render(*AUTO, "--frames", "0-24x12", "-o", "a.##.exr", "-q") == 0
    assert render(*AUTO, "-o", "r.exr", "-q", camera="left,right") == 0
    isos = {iso_of(str(path)) for path in Path().glob("*.exr")}
    assert len(list(Path().glob("*.exr"))) == 5
    assert len(isos) == 1


def test_the_spot_of_a_node_is_where_it_is_seen(capsys: pytest.CaptureFixture[str]) -> None:
    assert render(*AUTO, "--meter", "spot:Flier", "--time", "0.5", "-o", "a.exr") == 0
    node = capsys.readouterr().err
    assert render(*AUTO, "--meter", "spot:0,0", "--time", "0.5", "-o", "b.exr") == 0
    assert iso_of("a.exr") != iso_of("b.exr")
    assert "metered (spot:Flier)" in node


def test_the_closing_line_is_the_distance_from_the_meter(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """In light the sky is shown at 2^EV; the meter would show it as 0.18."""
    words = ("--camera", "left", "--position", "0,0,9", "--look-at", "0,0,10", *QUICK)
    for ev in (0.0, 1.0, -2.0):
        told = ["render", "s.glb", *words, "--sky", "0.36,0.36,0.36", "--ev", f"{ev}"]
        assert main([*told, "-o", "a.png"]) == 0
        stops = math.log2(0.36 * 2**ev / 0.18)
        where = f"{abs(stops):.1f} EV {'over' if stops > 0 else 'under'} the meter"
        assert f"daguerre: light, {where}\n" in capsys.readouterr().err


def test_python_exposes_as_the_command_line() -> None:
    scene = dg.load("s.glb")
    scene.set_environment(color=(30.0, 20.0, 10.0))
    camera = scene.camera("left").with_(exposure="auto", shutter_time=1 / 50)
    frame = dg.render(scene, camera, resolution=(48, 32), spp=2, light_paths="off")
    assert render(*AUTO, "-o", "a.png", "-o", "a.exr", "-q") == 0
    there = dg.load_frame("a.exr")
    assert frame.metadata["isoSpeed"] == there.metadata["isoSpeed"]
    assert np.array_equal(frame.display(), there.display())
    frame.save("b.png")
    assert Path("b.png").read_bytes()[-2000:] == Path("a.png").read_bytes()[-2000:]


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"exposure": "auto", "iso": 400.0}, "exposure auto chooses the ISO, but iso is set"),
        ({"exposure": "A", "shutter_angle": 90.0}, "but shutter_angle is set"),
        ({"exposure": "S", "f_stop": 4.0}, "exposure S chooses the f-stop, but f_stop is set"),
        ({"exposure": "P", "shutter_time": 0.1}, "but shutter_time is set"),
        ({"exposure": "automatic"}, "camera: exposure: wanted light, manual, auto, A, S, P"),
        ({"exposure": "auto", "meter": "center-weighted"}, "camera: meter: wanted centre, spot"),
        ({"exposure": "P", "lens": "pinhole"}, "a pinhole has none"),
    ],
)
def test_modes_do_not_change_what_is_set(fields: dict[str, object], message: str) -> None:
    scene = dg.load("s.glb")
    scene.set_environment(color=(1.0, 1.0, 1.0))
    with pytest.raises(dg.DaguerreError, match=re.escape(message)):
        dg.render(scene, scene.camera("left").with_(**fields), resolution=(8, 8), spp=1)


@pytest.mark.parametrize("lens", ["thin", "double-gauss-50mm-f2"])
def test_ratios_follow_the_numbers(lens: str) -> None:
    """A white world on the axis: time and ISO exactly, stops by N^2, of glass by its h0."""
    scene = dg.Scene()
    scene.set_environment(color=(1.0, 1.0, 1.0))
    base = dg.Camera(lens=lens, exposure="manual", iso=100.0, shutter_time=0.02, f_stop=4.0)
    base = base.with_(sensor_size=(0.6, 0.4), focus_distance=1e6)
    from daguerre.exposure import display_gain

    def shown(**changes: float) -> tuple[float, float]:
        camera = base.with_(**changes)
        frame = dg.render(scene, camera, resolution=(6, 4), spp=64)
        return float(frame.rgb.mean() * display_gain(frame.metadata)), frame.metadata["h0"]

    one, h0 = shown()
    assert shown(iso=200.0)[0] / one == pytest.approx(2, rel=0.01)
    assert shown(shutter_time=0.01)[0] / one == pytest.approx(0.5, rel=0.01)
    closed, less = shown(f_stop=8.0)
    assert closed / one == pytest.approx(less / h0, rel=0.01)
    if lens == "thin":
        assert closed / one == pytest.approx(1 / 4, rel=0.01)


def test_a_stop_is_in_the_range_of_the_lens(capsys: pytest.CaptureFixture[str]) -> None:
    lens = ("--lens", "double-gauss-50mm-f2", "--shutter", "1/8000", "--iso", "100")
    assert render("--exposure", "S", *lens, "-o", "a.exr") == 0
    assert dg.load_frame("a.exr").metadata["aperture"] == pytest.approx(2, abs=0.01)
    told = capsys.readouterr().err
    assert re.search(
        r"exposure S: f/2 .. f/22 cannot expose this: the picture is .* EV too dark", told
    )


@pytest.mark.parametrize("lens", ["thin", "pinhole"])
@pytest.mark.parametrize(
    ("mode", "ends"),
    [
        ("auto", r"ISO 100 \.\. 6400"),
        ("A", r"1/8000 \.\. 1/15 s"),
        ("S", r"f/\S+ \.\. f/22"),
        ("P", r"1/8000 \.\. 1/15 s and f/\S+ \.\. f/16"),
    ],
)
def test_what_the_limits_leave_missing_is_told(
    mode: str, ends: str, lens: str, capsys: pytest.CaptureFixture[str]
) -> None:
    night = ("--sky", "1e-3,1e-3,1e-3", "--lens", lens, "-o", "a.png")
    if lens == "pinhole" and mode in ("S", "P"):
        assert render("--exposure", mode, *night) == 2
        assert "a pinhole has none; use auto or A" in capsys.readouterr().err
        return
    assert render("--exposure", mode, *night) == 0
    told = capsys.readouterr().err
    assert re.search(f"exposure {mode}: {ends} cannot expose this: .* EV too dark", told)


@pytest.mark.parametrize("lens", ["thin", "double-gauss-50mm-f2"])
@pytest.mark.parametrize("mode", ["auto", "A", "S", "P"])
def test_a_metered_picture_is_as_metered(
    mode: str, lens: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Within 0.05 EV; the stop changes vignetting and the pupil of glass."""
    given = {
        "auto": ("--shutter", "1/50"),
        "A": ("--iso", "3200"),
        "S": ("--iso", "800", "--shutter", "1/40"),
        "P": ("--iso", "800"),
    }[mode]
    words = ("--exposure", mode, "--lens", lens, *given)
    assert render(*words, "-o", "a.exr", quick=("--res", "96x64", "--spp", "16")) == 0
    assert f"{mode}, as metered\n" in capsys.readouterr().err


@pytest.mark.parametrize("mode", ["bright", "", 3, None, {1: None}, bytearray(b"auto")], ids=repr)
def test_an_exposure_mode_that_does_not_exist_is_named(mode: object) -> None:
    with pytest.raises(dg.UsageError, match="camera: exposure: wanted light, manual, auto, A, S"):
        dg.render(dg.Scene(), dg.Camera(exposure=mode), resolution=(8, 8), spp=1)  # type: ignore[arg-type]
