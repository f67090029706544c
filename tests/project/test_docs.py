"""The texts stay true: every flag is documented, and every documented flag exists."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
import typer.main

from daguerre import cli

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
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
    from daguerre.io.gltf.extensions import KNOWN

    text = (DOCS / "gltf.md").read_text()
    read = text.split("## Extensions that are read")[1].split("## ")[0]
    cells = [row.split("|")[1] for row in read.splitlines() if row.startswith("|")]
    named = {name for cell in cells for name in re.findall(r"`(\w+)`", cell)}
    assert named == KNOWN


def test_links_between_pages_lead_somewhere():
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *DOCS.glob("**/*.md")]
    for page in pages:
        for target in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text()):
            if "://" not in target:
                assert (page.parent / target).exists(), f"{page.name}: {target}"
