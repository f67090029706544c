"""Real shells complete command lines of daguerre."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from daguerre.cli import main
from daguerre.cli.completion.shells import complete
from tests.support.program.shell_line import SCRIPTS, Shell, environment

LENS = "canon-35mm-f1.8"
#: Lines, and what a TAB makes of them.
ALIKE = [
    ("daguerre vers", "daguerre version "),
    ("daguerre lens canon-35", f"daguerre lens {LENS} "),
    ("daguerre render --lens=canon-35", f"daguerre render --lens={LENS} "),
    ("daguerre render --deno", "daguerre render --denoise "),
    ("daguerre render x.glb --tone so", "daguerre render x.glb --tone soft "),
    ("daguerre render x.glb --aov depth,alb", "daguerre render x.glb --aov depth,albedo "),
    ("daguerre render x.glb --exposure m", "daguerre render x.glb --exposure manual "),
    ("daguerre render x.glb --meter c", "daguerre render x.glb --meter centre "),
    ("daguerre render x.glb --look oc", "daguerre render x.glb --look ocio:"),
    ("daguerre post x.exr --effect bloom:sh", "daguerre post x.exr --effect bloom:share="),
    ("daguerre render my", "daguerre render my\\ scene.glb "),
    ('daguerre render "my', 'daguerre render "my scene.glb" '),
    ("daguerre render sub", "daguerre render sub\\ dir/"),
    ("daguerre render sub\\ dir/", "daguerre render sub\\ dir/in.glb "),
    ("daguerre render 'sub dir/i", "daguerre render 'sub dir/in.glb' "),
    ("daguerre render $", "daguerre render $"),
    ("daguerre render dol", "daguerre render dol\\$lar.glb "),
    ("daguerre render col:", "daguerre render col:on.glb "),
    ("daguerre render x.glb --env=pic", "daguerre render x.glb --env=pic.exr "),
    ("daguerre render x.glb > pic", "daguerre render x.glb > pic.exr "),
    ("daguerre frob x", "daguerre frob x"),
    ("daguerre render nowhere/", "daguerre render nowhere/"),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("work")
    (made / "sub dir").mkdir()
    for name in ("my scene.glb", "col:on.glb", "dol$lar.glb", "pic.exr", "sub dir/in.glb"):
        (made / name).touch()
    return made


@pytest.fixture(scope="module", params=["bash", "zsh"])
def shell(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, folder: Path
) -> Iterator[Shell]:
    if not shutil.which(request.param):
        pytest.skip(f"there is no {request.param} here")
    made = Shell(request.param, tmp_path_factory.mktemp("home"), folder)
    yield made
    made.close()


@pytest.mark.parametrize(("line", "wanted"), ALIKE)
def test_a_tab_completes_the_line(shell: Shell, line: str, wanted: str) -> None:
    assert shell.completed(line) == wanted


@pytest.mark.parametrize(("line", "wanted"), ALIKE)
def test_fish_completes_the_word(folder: Path, tmp_path: Path, line: str, wanted: str) -> None:
    if not shutil.which("fish"):
        pytest.skip("there is no fish here")
    if ">" in line or "$" in line:
        pytest.skip("fish completes these itself")
    ask = f"source '{SCRIPTS / 'daguerre.fish'}'; complete -C $line"
    done = subprocess.run(
        ["fish", "--no-config", "-c", ask],
        env={**environment(tmp_path), "line": line},
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
    )
    words = [one.partition("\t")[0] for one in done.stdout.splitlines()]
    quoted = wanted.removeprefix("daguerre ").strip().replace("\\", "")
    last = [word for word in words if quoted.replace("'", "").replace('"', "").endswith(word)]
    assert last or wanted == line
    assert (words, done.stderr) == (last, "")


@pytest.mark.parametrize("shell_name", ["bash", "fish", "zsh"])
@pytest.mark.parametrize("words", [[], ["\0"], ["a", "b", "c"], ["", "daguerre render '\\"]])
def test_nothing_goes_into_the_line_of_the_user(
    shell_name: str, words: list[str], capfd: pytest.CaptureFixture[str]
) -> None:
    main(["__complete", shell_name, *words])
    assert "Traceback" not in (shown := capfd.readouterr()).out
    assert shown.err == ""


def test_a_lost_table_is_silent(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("daguerre.cli.completion.answer.TABLE", Path("nowhere.json"))
    assert complete(["bash", ":", "daguerre ren"]) == 1
    assert capfd.readouterr() == ("", "")


def test_an_answer_loads_neither_typer_nor_numpy() -> None:
    ask = "from daguerre.cli import main; main(['__complete', 'bash', ':', 'daguerre lens can'])"
    done = subprocess.run(
        [sys.executable, "-c", f"import sys; {ask}; print(*sys.modules, file=sys.stderr)"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert LENS in done.stdout
    assert not {"typer", "numpy", "dataclasses"} & set(done.stderr.split())
