"""One picture in every front end: the command line, Python, merge, post, notebooks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.rendering.merged import merge
from tests.faults.scene import write_scene

#: Skies that are not white in ``light``, and in a photograph.
DIM, BRIGHT = (0.9, 0.8, 0.6), (60.0, 50.0, 40.0)
#: Flags, and the same for ``Camera``.
MODES: dict[str, tuple[list[str], dict[str, Any]]] = {
    "light": ([], {}),
    "light, EV": (["--ev", "-1.5"], {"exposure_compensation": -1.5}),
    "light, ISO": (["--iso", "6400", "--f-stop", "4"], {"iso": 6400.0, "f_stop": 4.0}),
    "light, white": (["--wb", "4000"], {"white_balance": 4000.0}),
    "manual": (["--exposure", "manual", "--iso", "400"], {"exposure": "manual", "iso": 400.0}),
    "auto": (["--exposure", "auto", "--ev", "1"], {"exposure": "auto", "exposure_compensation": 1}),
    "A": (["--exposure", "A", "--meter", "matrix"], {"exposure": "A", "meter": "matrix"}),
}
every_mode = pytest.mark.parametrize(("flags", "changes"), MODES.values(), ids=MODES)


@pytest.fixture(autouse=True)
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    return write_scene(tmp_path / "s.glb")


def sky_of(photograph: bool) -> tuple[float, ...]:
    return BRIGHT if photograph else DIM


def render(*words: str) -> None:
    sky = ["--sky", ",".join(map(str, sky_of("--exposure" in words)))]
    size = ["--res", "48x32", "--light-paths", "off", "--spp", "8", "-q"]
    assert main(["render", "s.glb", *size, *sky, *words]) == 0


def pixels(path: str) -> Any:
    return np.asarray(oiio.ImageBuf(path).get_pixels(oiio.UINT8)).astype(int)


@every_mode
def test_python_saves_and_shows_what_the_command_line_writes(
    flags: list[str], changes: dict[str, Any]
) -> None:
    render(*flags, *(word for end in ("png", "jpg", "tif", "exr") for word in ("-o", f"a.{end}")))
    loaded = dg.load("s.glb")
    loaded.set_environment(color=sky_of("exposure" in changes))
    camera = loaded.camera().with_(**changes)
    frame = dg.render(loaded, camera, resolution=(48, 32), spp=8, light_paths="off")
    for end in ("png", "jpg", "tif"):
        frame.save(f"b.{end}")
        assert Path(f"a.{end}").read_bytes() == Path(f"b.{end}").read_bytes(), end
    assert 20 < pixels("a.png").mean() < 235
    np.testing.assert_array_equal(frame.display(), pixels("a.png"))
    assert frame._repr_png_() == Path("a.png").read_bytes()
    np.testing.assert_array_equal(np.rint(frame.encoded() * 255), pixels("a.png"))
    dg.load_frame("a.exr").save("c.png")
    assert np.abs(pixels("c.png") - pixels("a.png")).max() <= 1


@every_mode
def test_passes_are_merged_into_the_picture_of_their_mode(
    flags: list[str], changes: dict[str, Any]
) -> None:
    render(*flags, "-o", "whole.png")
    for span in ("0:3", "3:8"):
        render(*flags, "--samples", span, "-o", f"{span[0]}.exr")
    assert main(["merge", "3.exr", "0.exr", "-o", "m.png", "-q"]) == 0
    np.testing.assert_array_equal(pixels("m.png"), pixels("whole.png"))


def test_passes_of_two_modes_have_that_of_the_first(capsys: pytest.CaptureFixture[str]) -> None:
    render("--samples", "0:4", "-o", "light.exr", "--sky", "60,50,40", "--ev", "-6")
    render("--samples", "4:8", "-o", "manual.exr", "--exposure", "manual", "--iso", "400")
    render("-o", "m.png", "--exposure", "manual", "--iso", "400")
    render("-o", "l.png", "--sky", "60,50,40", "--ev", "-6")
    for order, mode, wanted in (
        (["light.exr", "manual.exr"], "light", "l.png"),
        (["manual.exr", "light.exr"], "manual", "m.png"),
    ):
        capsys.readouterr()
        assert main(["merge", *order, "-o", "x.png"]) == 0
        assert f"the picture has the first one's ({mode})" in capsys.readouterr().err
        np.testing.assert_array_equal(pixels("x.png"), pixels(wanted))
        frame = merge([Path(name) for name in order])
        assert frame.metadata["exposure"] == mode
    capsys.readouterr()
    render("--samples", "0:1", "-o", "more.exr", "--exposure", "manual", "--iso", "400")
    assert main(["merge", "manual.exr", "more.exr", "-o", "x.png"]) == 0
    assert "exposure" not in capsys.readouterr().err


@every_mode
def test_post_shows_a_file_in_its_mode(flags: list[str], changes: dict[str, Any]) -> None:
    render(*flags, "-o", "a.exr", "-o", "a.png")
    nothing = ["--effect", "glare:share=0"]
    assert main(["post", "a.exr", "-o", "b.png", *nothing, "-q"]) == 0
    assert main(["post", "a.exr", "-o", "b.exr", *nothing, "-q"]) == 0
    assert np.abs(pixels("b.png") - pixels("a.png")).max() <= 1
    dg.load_frame("b.exr").save("c.png")
    np.testing.assert_array_equal(pixels("c.png"), pixels("b.png"))
