"""Answers to a TAB: words and files that can stand at the cursor."""

from __future__ import annotations

from pathlib import Path

import pytest

from daguerre import lenses, sensors, stocks
from daguerre.charts import KINDS as CHARTS
from daguerre.cli.commands import COMMANDS
from daguerre.cli.completion.answer import Answer, answer
from daguerre.cli.completion.files import files
from daguerre.files import formats


def words(*before: str, current: str = "") -> list[str]:
    return [word for word, _ in answer(list(before), current).words]


def test_commands_then_flags_of_the_program() -> None:
    assert words() == list(COMMANDS)
    assert words(current="len") == ["lenses", "lens"]
    assert words(current="--") == ["--help", "--help-all", "--version"]
    assert dict(answer([], "vers").words) == {"version": COMMANDS["version"].line.rstrip(".")}


def test_names_of_each_library() -> None:
    assert words("lens") == lenses.names()
    assert words("render", "--lens") == [*lenses.names(), "thin", "pinhole"]
    assert words("sensor") == sensors.names()
    assert words("develop", "--sensor") == sensors.names()
    assert words("develop", "x.exr", "--stock") == stocks.names()
    assert words("chart") == list(CHARTS)


def test_flags_are_those_of_the_command_and_given_once() -> None:
    assert "--blades" in words("render", current="--")
    assert "--blades" not in words("merge", current="--")
    assert words("render", current="--deno") == ["--denoise"]
    assert words("render", "--denoise", current="--deno") == []
    assert words("render", "--fstop", "2", current="--f-s") == []
    assert words("render", "-o", "a.exr", current="--outp") == ["--output"]
    assert words("render", current="-o") == ["-o"]
    assert words("lens", "x", current="") == words("lens", "x", current="--")


@pytest.mark.parametrize(
    ("before", "current", "kept", "typed"),
    [
        (["render", "--tone"], "so", "", "so"),
        (["render"], "--tone=so", "--tone=", "so"),
        (["render", "--aov"], "depth,al", "depth,", "al"),
        (["render"], "--aov=depth,al", "--aov=depth,", "al"),
        (["post", "--effect"], "bloom:radius=2,sh", "bloom:radius=2,", "sh"),
        (["render"], "-oout.e", "-o", "out.e"),
    ],
)
def test_the_beginning_of_a_word_stays(
    before: list[str], current: str, kept: str, typed: str
) -> None:
    found = answer(before, current)
    assert (found.kept, found.typed) == (kept, typed)
    assert found.words or found.suffixes is not None


def test_values_in_lists_are_given_once() -> None:
    assert "depth" in words("render", "--aov", current="N,")
    assert "depth" not in words("render", "--aov", current="depth,")
    assert words("post", "--effect", current="bloom:share=1,") == ["radius="]


def test_values_are_no_arguments_and_nothing_follows_them() -> None:
    scene = answer(["render", "--focus", "2"], "").suffixes
    assert scene == tuple(s for row in formats.formats("scene") for s in row.suffixes)
    assert answer(["render", "s.glb"], "x").suffixes is None
    assert answer(["render", "--", "-odd.glb"], "--to") == Answer("", "--to")
    assert answer(["merge", "a.exr", "b.exr"], "").suffixes == (".exr",)


@pytest.mark.parametrize("before", [["frob"], ["frob", "--lens"], ["version", "x", "y"]])
def test_nothing_completes_what_does_not_exist(before: list[str]) -> None:
    assert words(*before, current="x") == []


def test_files_have_the_suffix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    for name in ("a b.GLB", "c:d.glb", "c.png", ".h.glb", "new\nline.glb"):
        (tmp_path / name).touch()
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "e.glb").touch()
    scene = Answer(suffixes=(".glb",))
    assert files(scene) == ["a b.GLB", "c:d.glb", "sub/"]
    assert files(scene._replace(typed=".")) == [".h.glb"]
    assert files(scene._replace(typed="~/c")) == ["~/c:d.glb"]
    assert files(scene._replace(typed="sub/")) == ["sub/e.glb"]
    assert files(scene._replace(typed=f"{tmp_path}/a")) == [f"{tmp_path}/a b.GLB"]
    assert files(scene._replace(suffixes=(".tif",), typed="c.")) == ["c.png"]  # better than nothing
    assert files(Answer(folders=True)) == ["sub/"]
    assert files(Answer()) == []
    assert files(scene._replace(typed="nowhere/")) == []
