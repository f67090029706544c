"""Size of a picture that a scene file names: the default of the command line."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

import daguerre as dg
from daguerre.cli import main

_PBRT = """Film "rgb" "integer xresolution" 30 "integer yresolution" 20
Camera "{}"
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
"""
_MITSUBA = """<scene version="3.0.0"><emitter type="constant"/><sensor type="perspective">
<film type="hdrfilm"><integer name="width" value="30"/><integer name="height" value="20"/></film>
</sensor></scene>"""
FILES = {"a.pbrt": _PBRT.format("perspective"), "a.xml": _MITSUBA}


@pytest.fixture(params=FILES)
def scene(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    Path(request.param).write_text(FILES[request.param])
    return str(request.param)


@pytest.mark.parametrize(
    ("flags", "size"),
    [([], (30, 20)), (["--res", "12x8"], (12, 8)), (["--res", "50%"], (15, 10)),
     (["--crop", "left=3,top=0,right=30,bottom=20"], (27, 20))],
)  # fmt: skip
def test_a_picture_has_the_size_that_the_file_names(
    scene: str, flags: list[str], size: tuple[int, int]
) -> None:
    assert main(["render", scene, "-o", "a.png", "--spp", "1", "--quiet", *flags]) == 0
    with Image.open("a.png") as picture:
        assert picture.size == size


def test_a_crop_beyond_it_is_refused(scene: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        main(
            [
                "render",
                scene,
                "-o",
                "a.png",
                "--spp",
                "1",
                "--crop",
                "left=0,top=0,right=31,bottom=20",
            ]
        )
        == 2
    )
    assert "--crop: wanted left < right within 0..30" in capsys.readouterr().err


def test_info_and_exports_have_it(scene: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert dg.load(scene).film_size() == (30, 20)
    assert main(["info", scene]) == 0
    assert "at 30x20" in capsys.readouterr().out
    for name in ("b.pbrt", "b.xml"):
        assert main(["export-scene", scene, "-o", name]) == 0
        assert dg.load(name).film_size() == (30, 20)


def test_a_panorama_of_pbrt_needs_no_flag(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "p.pbrt"
    path.write_text(_PBRT.format("spherical").replace("20", "15"))
    assert main(["info", str(path)]) == 0
    assert "at 30x15" in capsys.readouterr().out
