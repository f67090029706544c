"""The manual is whole: every page in the navigation, no broken link, a place for every name."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer.main

from daguerre import cli, units

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
TOOLS = ROOT / "script" / "docs" / "manual"
TUTORIALS = [DOCS / "first-picture.md", *DOCS.glob("tutorials/*.md")]
GUIDES = sorted([*DOCS.glob("for-*.md"), *TUTORIALS])
LINK = re.compile(r"\]\(([^)\s#]*)(#[^)\s]*)?(?: \"[^\"]*\")?\)")


@pytest.fixture
def tools(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """The modules that make the site, which import each other by name."""
    monkeypatch.syspath_prepend(str(TOOLS))
    import api
    import check
    import stage

    yield {"api": api, "check": check, "stage": stage}
    for name in ("api", "check", "docstrings", "stage"):
        sys.modules.pop(name, None)


def pages_of(entries: Any) -> Iterator[str]:
    """The pages of a navigation, depth first."""
    for entry in entries:
        for value in entry.values():
            yield from [value] if isinstance(value, str) else pages_of(value)


def without_code(text: str) -> str:
    text = re.sub(r"^(```+).*?^\1", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"`[^`\n]+`", lambda m: m[0].replace("](", ""), text)


def anchors(page: Path) -> set[str]:
    """Anchors of a page as a forge makes them of its headings, and those that it names itself."""
    text = without_code(page.read_text())
    found = set(re.findall(r'<a (?:id|name)="([^"]+)"', text))
    for heading in re.findall(r"^#+ (.+)$", text, re.MULTILINE):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
        slug = re.sub(r"[^\w\- ]", "", plain).strip().replace(" ", "-")
        found.add(slug if slug not in found else f"{slug}-1")
    return found


def test_navigation_has_every_page_once(tools: Any) -> None:
    nav = tomllib.loads((ROOT / "zensical.toml").read_text())["project"]["nav"]
    shown = list(pages_of(nav))
    written = {page.relative_to(DOCS).as_posix() for page in DOCS.rglob("*.md")}
    made = {f"api/{name}" for name in tools["api"].pages()}
    assert sorted(shown) == sorted(written | made | {"source/examples/README.md"})


def test_every_public_name_has_a_place(tools: Any) -> None:
    api = tools["api"]
    pages = api.pages()
    placed = {place for text in pages.values() for place in re.findall(r'<a id="([^"]+)"', text)}
    names = {name for name in api.FACE["face"]() if name.startswith("dg.") and "(" not in name}
    assert len(names) > 1000
    assert names - placed == set()


def test_docstrings_become_markdown(tools: Any) -> None:
    text = """Scales a <value>; see :func:`dg.f` and ``a * b``.

    Args:
        a, b: Factors, shape (N,),
            on two lines.
        *more: Others * others.

    Raises:
        InputError: Bad.

    Returns:
        The product.
    """
    assert tools["api"].parsed(text).markdown() == [
        "Scales a &lt;value>; see `dg.f` and `a * b`.",
        "**Parameters**",
        "- `a`: Factors, shape (N,), on two lines.\n- `b`: Factors, shape (N,), on two lines.\n"
        "- `*more`: Others \\* others.",
        "**Raises**",
        "- `InputError`: Bad.",
        "**Returns**\n\nThe product.",
    ]


def test_anchors_of_links_exist() -> None:
    texts = [ROOT / "README.md", *ROOT.glob("bench/records/*.md"), *DOCS.rglob("*.md")]
    known: dict[Path, set[str]] = {}
    broken = []
    for page in texts:
        for target, anchor in LINK.findall(without_code(page.read_text())):
            goal = (page.parent / target).resolve() if target else page
            if anchor and "://" not in target and goal.suffix == ".md":
                if goal not in known:
                    known[goal] = anchors(goal)
                if anchor[1:] not in known[goal]:
                    broken.append(f"{page.name}: {target}{anchor}")
    assert broken == []


def test_pipes_in_code_of_a_table_lose_their_backslashes(tools: Any) -> None:
    """A forge needs them there, and a site shows them."""
    text = r"| `--lens NAME\|<FILE>` | `a|b` |"
    assert tools["stage"].pipes(text) == ("| <code>--lens NAME&#124;&lt;FILE&gt;</code> | `a|b` |")


def test_links_out_of_docs_become_pages_of_the_site(tools: Any, tmp_path: Path) -> None:
    stage = tools["stage"]
    pages = stage.Pages(tmp_path)
    text = "[a](../SECURITY.md#x) [b](../scenes/motion.py) [c](cli.md) [d](gone.md)\n"
    text += "```\n[e](f.md)\n```"
    made = pages.relinked(text, DOCS / "page.md", "page.md")
    assert "[a](source/SECURITY.md#x) [b](source/scenes/motion.py.md) [c](cli.md)" in made
    assert "[e](f.md)" in made
    assert pages.missing == ["docs/page.md: no such file: gone.md"]
    pages.add_sources()
    assert (
        "# scenes/motion.py\n\n````python\n"
        in (tmp_path / "source/scenes/motion.py.md").read_text()
    )


@pytest.mark.parametrize(
    ("planted", "fault"),
    [
        ('<a href="#there">', ""),
        ('<a href="https://elsewhere.org/">', ""),
        ('<a href="other.html#gone">', "leads nowhere: other.html#gone"),
        ('<a href="gone.html">', "leads nowhere: gone.html"),
        ('<img src="gone.png">', "leads nowhere: gone.png"),
        ('<img src="//cdn.org/a.png">', "asks another host: //cdn.org/a.png"),
        ('<script src="https://cdn.org/a.js"></script>', "asks another host: https://cdn.org/a.js"),
        ('<link rel="stylesheet" href="http://cdn.org/a.css">', "asks another host: http://cdn.org/a.css"),
        ('<p id="there">', "two elements have the id there"),
        ("<h2>a</h2><h3>b</h3><h2>c</h2>", ""),
        ("<h3>b</h3>", "a heading of level 3 follows one of level 1"),
        ("<style>a{b:url(https://cdn.org/f.woff)}</style>", "asks another host: https://cdn.org/f.woff"),
    ],
)  # fmt: skip
def test_faults_of_a_site_are_found(tools: Any, tmp_path: Path, planted: str, fault: str) -> None:
    (tmp_path / "index.html").write_text(f'<h1 id="there">x</h1>{planted}')
    (tmp_path / "other.html").write_text("<h1>y</h1>")
    found = tools["check"].faults(tmp_path)
    assert found == ([f"index.html: {fault}"] if fault else [])


def test_units_page_has_every_suffix_and_size() -> None:
    text = (DOCS / "units.md").read_text()
    typed = text.split("## What can be typed")[1].split("## ")[0]
    for suffixes in (units.LENGTHS, units.TIMES, units.ANGLES):
        rows = [set(re.findall(r"`(\w+)`", row)) for row in typed.splitlines()]
        assert set(suffixes) in rows
    sizes = dict(re.findall(r"^\| `([\w-]+)` \| ([\d.]+ x [\d.]+) \|$", text, re.MULTILINE))
    assert sizes == {name: f"{w:g} x {h:g}" for name, (w, h) in units.SENSORS.items()}


@pytest.mark.parametrize("page", GUIDES, ids=lambda page: page.stem)
def test_commands_of_guides_parse(page: Path) -> None:
    """Each command has flags that exist, and scripts that are there."""
    top: Any = typer.main.get_command(cli.app)
    blocks = re.findall(r"^```(\w*)\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE)
    plain = [block.replace("\\\n", " ") for kind, block in blocks if not kind]
    lines = [line for block in plain for line in block.splitlines()]
    commands = [shlex.split(line) for line in lines if line.startswith(("daguerre ", "python "))]
    assert commands
    for program, name, *rest in commands:
        if program == "python":
            assert (ROOT / name).is_file()
        else:
            top.commands[name].make_context(name, rest)


def test_thumbnails_are_those_of_the_gallery(monkeypatch: pytest.MonkeyPatch) -> None:
    """Written by ``script/docs/gallery/make.py --page``; every picture of a page has one."""
    monkeypatch.syspath_prepend(str(ROOT / "script" / "docs" / "gallery"))
    import thumbnails

    text = (DOCS / "gallery.md").read_text()
    assert text == thumbnails.page(DOCS / "gallery")
    assert len(re.findall(r"<img ", text)) > 50


@pytest.mark.slow
def test_the_site_builds_without_warnings_and_asks_no_other_host(tmp_path: Path) -> None:
    """Where its packages are; ``script/manual`` itself follows links and looks for other hosts."""
    installed = ROOT / "build" / "manual" / "venv" / "installed"
    if not installed.is_file() or shutil.which("bash") is None:
        pytest.skip("script/manual has not been run here, and its packages come from the network")
    run = subprocess.run(
        [ROOT / "script" / "manual", tmp_path / "site"], capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "site" / "index.html").is_file()
    assert (tmp_path / "site" / "search.js").stat().st_size > 1e5
