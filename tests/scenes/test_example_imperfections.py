"""The scenes of scenes/imperfections.py, and the page of the gallery that is made with them."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
import typer.main

import daguerre as dg
from daguerre import analysis, cli
from daguerre.analysis.ghosts import Ghosts
from daguerre.post.recipe import from_words
from tests.support.scene.example_scenes import make

ROOT = Path(__file__).resolve().parents[2]
GALLERY = ROOT / "docs" / "gallery"
sys.path.insert(0, str(ROOT / "script" / "docs" / "gallery"))

import axial_colour  # noqa: E402
import polynomial_ghosts  # noqa: E402
import word_page  # noqa: E402
from agreement import compare, displacement, fringes  # noqa: E402
from sheet import compose  # noqa: E402
from ways import Panel, Word  # noqa: E402
from words import WEAK, WORDS  # noqa: E402

SCENES = ("wheel", "chart", "fair", "strings", "wall", "dusk", "starry", "rule")
COMMANDS = [c for word in WORDS for panel in word_page.panels(word) for c in panel.commands]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("imperfections")
    make("imperfections", made)
    return made


def test_same_bytes_every_time(folder: Path, tmp_path: Path) -> None:
    make("imperfections", tmp_path)
    for name in SCENES:
        assert (tmp_path / f"{name}.glb").read_bytes() == (folder / f"{name}.glb").read_bytes()
        assert (tmp_path / f"{name}.glb").stat().st_size < 5_000_000


@pytest.mark.parametrize("name", SCENES)
def test_loads_without_a_warning_and_shines(folder: Path, name: str) -> None:
    scene = dg.load(folder / f"{name}.glb")
    assert scene.warnings == []
    camera = scene.cameras.get("50 mm") or scene.cameras["Camera"]
    frame = dg.render(scene, camera.with_(lens="pinhole"), spp=4, resolution=(48, 32), max_depth=1)
    assert np.isfinite(frame.rgb).all()
    assert (frame.rgb.max(axis=2) > 0.003).mean() > 0.5


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_are_understood(command: str) -> None:
    program, *rest = shlex.split(command)
    if program == "python":
        assert (ROOT / rest[0]).exists()
        return
    name, *flags = rest
    given = typer.main.get_command(cli.app).commands[name].make_context(name, flags).params
    if name == "post":
        assert from_words(given["effect"])


def test_every_picture_is_written_by_a_command() -> None:
    written = set(re.findall(r"out/imperfections/(\w+)\.exr", " ".join(COMMANDS)))
    shown = {p.file for word in WORDS for p in word_page.panels(word) if p.file}
    assert shown <= written


def test_the_page_is_what_the_words_say() -> None:
    assert (GALLERY / "imperfections.md").read_text() == word_page.page()
    assert word_page.RECORD.read_text() == word_page.record()
    for word in WORDS:
        assert (GALLERY / f"{word.name}.jpg").stat().st_size < 400_000


@pytest.fixture(scope="module")
def workplace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which the page's commands find their scenes."""
    made = tmp_path_factory.mktemp("page")
    make("imperfections", made / "out" / "imperfections")
    lamps = [ROOT / "scenes" / "lens_scenes.py", "--only", "lamps"]
    subprocess.run([sys.executable, *lamps], check=True, cwd=made, capture_output=True)
    return made


@pytest.mark.slow
@pytest.mark.parametrize("word", WORDS, ids=lambda word: word.name)
def test_small_pictures_of_every_word(word: Word, workplace: Path) -> None:
    """All commands, at a tenth of the size: each writes what the next one reads."""
    for panel in word_page.panels(word):
        for command in panel.commands:
            program, *rest = shlex.split(small(command))
            own = [] if program == "python" else ["-m", "daguerre.cli"]
            subprocess.run([sys.executable, *own, *rest], check=True, cwd=workplace)
    assert compose(word, workplace / "out" / "imperfections").ndim == 3


def small(command: str) -> str:
    """The same with a tenth of the pixels on each side, and little light; from any folder."""

    def tenth(number: re.Match[str]) -> str:
        return str(int(number[0]) // 10)

    for flag in (r"--res \d+x\d+", r"--crop [a-z\d=,]+"):
        command = re.sub(flag, lambda m: re.sub(r"\d+", tenth, m[0]), command)
    for flag, value in (("spp", 2), ("light-paths", 1000), ("flare", 1000)):
        command = re.sub(rf"--{flag} \d+", f"--{flag} {value}", command)
    command = re.sub(r"(?<![\w/])(?=(scenes|script)/)", f"{ROOT}/", command)
    return f"{command} --count 2" if "polynomial_ghosts" in command else command


def test_displacement_finds_a_planted_shift() -> None:
    y, x = np.mgrid[:120, :180].astype(np.float32)

    def waves(right: float, down: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
        u, v = x - right, y - down
        grey = 0.5 + 0.2 * np.sin(u / 4) * np.cos(v / 5) + 0.1 * np.sin((u + v) / 7)
        return np.repeat(grey[:, :, None], 3, axis=2).astype(np.float32)

    assert displacement(waves(0, 0), waves(0, 0)) < 1e-4
    assert displacement(waves(0, 0), waves(0.4, -0.7)) == pytest.approx(0.806, abs=0.05)
    assert displacement(waves(0, 0), waves(2.0, 0)) == pytest.approx(2.0, abs=0.1)
    coloured = np.stack([waves(0.3, 0)[..., 0], waves(0, 0)[..., 1], waves(0, -0.6)[..., 2]], 2)
    assert fringes(coloured)["red"] == pytest.approx(0.3, abs=0.03)
    assert fringes(coloured)["blue"] == pytest.approx(0.6, abs=0.05)


def test_figures_of_a_picture_twice_as_bright() -> None:
    one = np.full((40, 40, 3), 0.5, np.float32)
    figures = compare(one, 2 * one)
    assert figures["light"] == pytest.approx(2)
    assert figures["relmse"] == pytest.approx(0.25 / 0.26)


def test_panels_show_the_same_part_of_the_frame(tmp_path: Path) -> None:
    """A picture whose data window reaches farther is cut to that of the first."""
    for name, (x, y, width, height) in {"one": (20, 10, 30, 20), "two": (5, 4, 60, 40)}.items():
        spec = oiio.ImageSpec(width, height, 3, oiio.FLOAT)
        spec.x, spec.y = x, y
        spec.full_width, spec.full_height = 100, 60
        at = np.stack(np.meshgrid(np.arange(x, x + width), np.arange(y, y + height)), 2) / 100
        picture = oiio.ImageBuf(spec)
        pixels = np.concatenate([at, 0 * at[:, :, :1]], axis=2).astype(np.float32)
        picture.set_pixels(spec.roi, pixels)
        assert picture.write(str(tmp_path / f"{name}.exr"))
    sheet = compose(Word("w", "", "", ((Panel("a", "one"), Panel("b", "two")),)), tmp_path)
    assert np.array_equal(sheet[26:46, :30], sheet[26:46, 36:66])


def test_the_cylinder_has_a_quarter_of_a_dioptre() -> None:
    """On the axis both foci lie f^2 / 4 m apart, to first order."""
    bench = analysis.set_up(dg.lenses.load(ROOT / WEAK))
    foci = analysis.field_curvature(bench, [0.0])
    apart = abs(float(foci.sagittal[0] - foci.tangential[0]))
    assert apart == pytest.approx(85.0**2 * 0.25e-3, rel=0.05)


def test_each_colour_is_sharp_where_axial_colour_says() -> None:
    lens = dg.lenses.load("minolta-mc-rokkor-58mm-f1.2")
    film = analysis.set_up(lens, focus_m=3.0)
    sharp = axial_colour.sharp_distances(film, 3.0)
    for nm, distance in zip(axial_colour.CHANNEL_NM, sharp, strict=True):
        there = analysis.set_up(lens, focus_m=distance)
        image = there.film_z + float(analysis.axial_colour(there, [nm])[0])
        assert image == pytest.approx(film.film_z, abs=0.01)


def test_ghosts_by_polynomials_land_where_exact_rays_do(monkeypatch: pytest.MonkeyPatch) -> None:
    """Middle and size of a ghost that is all on the film, 5 degrees off the axis."""
    monkeypatch.setattr(polynomial_ghosts, "RAYS", 64 * 64)
    bench = analysis.set_up(dg.lenses.load("zeiss-biotar-50mm-f1.4"), f_stop=4)
    exact = Ghosts(bench, 5.0).find((2, 0))
    toward = (0.0, np.sin(np.radians(5)), np.cos(np.radians(5)))
    red, green, blue = polynomial_ghosts.landings(bench, exact, toward, 7)
    middle = green.mean(axis=0)
    assert middle == pytest.approx(exact.center, abs=0.05)
    radius = np.sqrt(((green - middle) ** 2).sum(axis=1).mean())
    assert radius == pytest.approx(exact.radius, rel=0.05)
    assert abs(red.mean(axis=0)[1] - blue.mean(axis=0)[1]) > 0.01  # they have colours
