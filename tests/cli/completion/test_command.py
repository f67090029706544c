"""``daguerre completion`` prints a script that works in the start-up file of a shell."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from daguerre.cli import main
from daguerre.cli.completion.command import SHELLS
from tests.support.program.shell_line import SCRIPTS, Shell


def test_the_script_is_printed_whole(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for shell in SHELLS:
        monkeypatch.setenv("SHELL", f"/bin/{shell}")
        script = (SCRIPTS / f"daguerre.{shell}").read_text()
        for words in ([], [shell]):
            assert main(["completion", *words]) == 0
            assert capsys.readouterr().out == script


@pytest.mark.parametrize(
    ("shell", "words", "message"),
    [
        ("/bin/tcsh", [], "completion: $SHELL: wanted bash, zsh or fish, got 'tcsh'"),
        ("", [], "completion: $SHELL: wanted bash, zsh or fish, got nothing"),
        ("/bin/zsh", ["ksh"], "completion: wanted bash, zsh or fish, got 'ksh'"),
    ],
)
def test_wrong_shells_are_one_error(
    shell: str,
    words: list[str],
    message: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("SHELL", shell)
    assert main(["completion", *words]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(("name", "start"), [("bash", ".bashrc"), ("zsh", ".zshrc")])
def test_a_new_shell_completes_by_a_line_in_its_start_file(
    tmp_path: Path, name: str, start: str
) -> None:
    if not shutil.which(name):
        pytest.skip(f"there is no {name} here")
    (tmp_path / start).write_text(f". <(daguerre completion {name})\n")
    shell = Shell(name, tmp_path, tmp_path, start=True)
    assert shell.completed("daguerre vers") == "daguerre version "
    shell.close()
