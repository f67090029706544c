"""Help: commands in groups, and pages of at most 60 lines."""

from __future__ import annotations

import re
from typing import Any

import pytest
import typer.main

from daguerre import cli
from daguerre.cli.commands import GROUPS
from daguerre.cli.help import FIRST
from daguerre.files import formats

LINES = 60
TAKE_A_SCENE = ("render", "view", "info", "export-camera", "export-scene")


@pytest.fixture(autouse=True)
def _terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")


def shown(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    assert cli.main(words) == 0
    return capsys.readouterr().out


def flags_of(name: str) -> list[Any]:
    command = typer.main.get_command(cli.program(name))
    command = getattr(command, "commands", {}).get(name, command)
    return [one for one in command.params if one.param_type_name == "option"]


def names_in(text: str) -> set[str]:
    """Names of flags in a help, such as -o, --output."""
    return set(re.findall(r"(?<![\w-])--?\w[\w-]*", text))


@pytest.mark.parametrize("words", [(), *((name,) for name in cli.COMMANDS)])
def test_a_page_has_at_most_60_lines_of_80_columns(
    words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    lines = shown(capsys, *words, "--help").splitlines()
    assert len(lines) <= LINES
    assert max(map(len, lines)) <= 80


@pytest.mark.parametrize("name", FIRST)
def test_a_short_page_shows_common_flags_and_names_the_whole_page(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    text = shown(capsys, name, "--help")
    assert set(FIRST[name]) <= names_in(text)
    assert f"`daguerre {name} --help-all` lists all" in text
    assert len(flags_of(name)) > len(FIRST[name])


@pytest.mark.parametrize("name", cli.COMMANDS)
def test_the_whole_page_names_every_flag(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    flags = {flag for one in flags_of(name) for flag in (*one.opts, *one.secondary_opts)}
    assert flags <= names_in(shown(capsys, name, "--help-all"))


def test_the_whole_page_has_groups_and_units(capsys: pytest.CaptureFixture[str]) -> None:
    text = shown(capsys, "render", "--help-all")
    assert "mm" in text
    assert "degrees" in text.lower()
    for title in ("Common options", "Lens", "Focus", "Shutter", "Ground truth", "Files", "Other"):
        assert text.count(f"\n{title}:\n") == 1, title


def test_commands_are_in_groups(capsys: pytest.CaptureFixture[str]) -> None:
    text = shown(capsys, "--help")
    for heading, group in GROUPS.items():
        lines = text.partition(f"\n{heading}:\n")[2].partition("\n\n")[0].splitlines()
        assert [line.split()[0] for line in lines] == list(group)
    assert "\nCommands:" not in text
    assert "\nOther:" not in text


@pytest.mark.parametrize("name", TAKE_A_SCENE)
def test_helps_of_scenes_name_all_formats(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    text = shown(capsys, name, "--help")
    for suffix in (suffix for row in formats.formats("scene") for suffix in row.suffixes):
        assert suffix in text


def test_all_commands_that_take_a_scene_are_tested_here() -> None:
    whole = typer.main.get_command(cli.app)
    taking = {
        name
        for name, command in whole.commands.items()
        if any(one.metavar == "SCENE" for one in command.params)
    }
    assert taking == set(TAKE_A_SCENE)


@pytest.mark.parametrize("words", [["-h"], ["lenses", "-h"]])
def test_names_of_the_help_flag_have_an_order(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert "  -h, --help, --help-all  Show" in shown(capsys, *words)
