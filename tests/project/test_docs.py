"""The texts stay true: every flag is documented, and every documented flag exists."""

from __future__ import annotations

import importlib
import json
import re
from pathlib import Path
from typing import Any

import pytest
import typer.main

from daguerre import cli
from daguerre.pictures.images import decode

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
RECORDS = sorted((ROOT / "bench" / "records").glob("*.md"))
BUILT_IN = {"--help", "--help-all", "--version"}


def flags_of_the_program() -> set[str]:
    root = typer.main.get_command(cli.app)
    commands = [root, *root.commands.values()]
    params = [p for command in commands for p in command.params if p.param_type_name == "option"]
    names = [name for p in params for name in (*p.opts, *p.secondary_opts)]
    return {name for name in names if name.startswith("--")} - BUILT_IN


def flags_in(text: str) -> set[str]:
    return set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", text)) - BUILT_IN


def test_command_line_page_names_every_flag():
    documented = flags_in((DOCS / "cli.md").read_text())
    assert documented == flags_of_the_program()


def test_command_line_page_names_every_command():
    text = (DOCS / "cli.md").read_text()
    for name in typer.main.get_command(cli.app).commands:
        assert f"daguerre {name}" in text


@pytest.mark.parametrize(
    "name",
    [
        *("README.md", "scenes/README.md", "script/demo"),
        *("docs/motion.md", "docs/ground-truth.md", "docs/coming-from.md"),
        *("docs/gallery/README.md", "docs/gallery/calibrated.md"),
        *("docs/first-picture.md", "docs/for-photographers.md", "docs/for-look-development.md"),
        *("docs/for-vision.md", "docs/for-optics.md", "docs/units.md"),
        *(f"docs/tutorials/{path.name}" for path in DOCS.glob("tutorials/*.md")),
    ],
)
def test_commands_in_texts_use_flags_that_exist(name):
    lines = [s for s in (ROOT / name).read_text().splitlines() if "daguerre" in s or "--" in s]
    used = flags_in("\n".join(s for s in lines if "pip " not in s and "cmake" not in s))
    assert used <= flags_of_the_program()


def test_lens_in_the_format_page_is_a_lens(tmp_path):
    from daguerre import lenses

    text = (DOCS / "lens-format.md").read_text()
    block = re.search(r"```json\n(.*?)```", text, re.DOTALL)
    assert block is not None
    data = json.loads(block.group(1))
    file = tmp_path / "doublet.json"
    file.write_text(block.group(1))
    order = lenses.load(file).first_order()
    assert order.efl == pytest.approx(data["nominal"]["efl_mm"], rel=2e-3)


def test_gltf_page_names_every_extension_that_is_read():
    from daguerre.importers.gltf.extensions import KNOWN

    text = (DOCS / "gltf.md").read_text()
    read = text.split("## Extensions that are read")[1].split("## ")[0]
    cells = [row.split("|")[1] for row in read.splitlines() if row.startswith("|")]
    named = {name for cell in cells for name in re.findall(r"`(\w+)`", cell)}
    assert named == KNOWN


def test_links_between_pages_lead_somewhere():
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *RECORDS, *DOCS.glob("**/*.md")]
    for page in pages:
        for target in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text()):
            if "://" not in target:
                assert (page.parent / target).exists(), f"{page.name}: {target}"


@pytest.fixture
def gallery(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Pictures and sheets of the gallery, by the place that a link to them names."""
    monkeypatch.syspath_prepend(str(ROOT / "script" / "docs" / "gallery"))
    pictures, words, thumbnails = (
        importlib.import_module(name) for name in ("pictures", "words", "thumbnails")
    )
    shown = [*pictures.PICTURES, *pictures.GLASS, *pictures.LIGHT, *pictures.MOTION]
    places = {f"README.md#{picture.name}": picture for picture in shown}
    return places | {f"imperfections.md#{thumbnails.slug(w.heading)}": w for w in words.WORDS}


def commands_of(shown: Any) -> list[str]:
    """Commands of a picture of the gallery; of a sheet, those of the traced pictures."""
    if hasattr(shown, "commands"):
        return [command for command, _ in shown.commands("out")]
    return [row[0].commands[0] for row in shown.rows if row[0].commands]


def bare(command: str) -> str:
    """A command without its output, and without what only makes it visible."""
    return re.sub(r" (-o \S+|--tone soft|--ev \S+)", "", command)


def test_the_lecture_has_the_commands_of_its_pictures(gallery: dict[str, Any]) -> None:
    text = (DOCS / "for-teachers.md").read_text()
    typed = {bare(line) for line in text.splitlines()}
    places = re.findall(r"\[!\[[^\]]*\]\(gallery/(\w+)\.jpg\)\]\(gallery/([^)]+)\)", text)
    assert len(places) >= 30
    for file, place in places:
        assert gallery[place].name == file
        assert {bare(command) for command in commands_of(gallery[place])} <= typed, place


def test_pictures_of_the_gallery_have_the_size_that_their_commands_say(
    gallery: dict[str, Any],
) -> None:
    for picture in gallery.values():
        if not hasattr(picture, "commands") or picture.by_script:
            continue
        sizes = [panels_of(command) for command, _ in picture.commands("out")]
        count = sum(n for n, _, _ in sizes)
        _, wide, high = sizes[0]
        pixels = decode((DOCS / "gallery" / f"{picture.name}.jpg").read_bytes(), picture.name)
        rows = round(round(high / picture.squeeze) * count / picture.columns)
        assert pixels.shape[:2] == (rows, wide * picture.columns), picture.name


def panels_of(command: str) -> tuple[int, int, int]:
    """How many pictures a command writes, and their width and height."""
    frames = re.search(r"--frames (\d+)-(\d+)", command)
    count = int(frames[2]) - int(frames[1]) + 1 if frames else 1
    crop = re.search(r"--crop left=(\d+),top=(\d+),right=(\d+),bottom=(\d+)", command)
    if crop:
        left, top, right, bottom = map(int, crop.groups())
        return count, right - left, bottom - top
    size = re.search(r"--res (\d+)x(\d+)", command)
    assert size is not None, command
    return count, int(size[1]), int(size[2])
