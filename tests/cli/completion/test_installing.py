"""Completion is installed with one command, and removed without a trace."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from daguerre.cli import main
from daguerre.cli.completion import installing
from daguerre.cli.completion.installing import SHELLS, install, remove, script
from tests.support.shell_line import Shell

START = {"bash": ".bashrc", "zsh": ".zshrc"}


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    made = tmp_path / "home of user"
    made.mkdir()
    for name in ("XDG_DATA_HOME", "XDG_CONFIG_HOME", "ZDOTDIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(made))
    monkeypatch.setattr(installing, "_BASH_COMPLETION", ())
    return made


def tree(folder: Path) -> dict[str, tuple[bytes | None, int]]:
    """Everything below a folder: bytes of files, and permissions."""
    return {
        str(path.relative_to(folder)): (
            path.read_bytes() if path.is_file() else None,
            path.stat().st_mode,
        )
        for path in sorted(folder.rglob("*"))
    }


@pytest.mark.parametrize("shell", SHELLS)
@pytest.mark.parametrize("start", [None, b"", b"echo hi\n", b"echo hi", b"# \xff\n\n"])
@pytest.mark.parametrize("folder", ["", ".local/share", ".config/fish/completions"])
def test_removing_leaves_everything_as_it_was(
    home: Path, shell: str, start: bytes | None, folder: str
) -> None:
    (home / folder).mkdir(parents=True, exist_ok=True)
    if start is not None:
        for name in START.values():
            (home / name).write_bytes(start)
            (home / name).chmod(0o600)
    before = tree(home)
    install(shell)
    installed = tree(home)
    install(shell)
    assert tree(home) == installed != before
    assert remove(shell)
    assert tree(home) == before
    assert remove(shell) == []


@pytest.mark.parametrize("shell", ["bash", "zsh"])
@pytest.mark.parametrize("start", [None, b"echo hi\n", b"echo hi"])
def test_lines_that_were_added_later_stay(home: Path, shell: str, start: bytes | None) -> None:
    file = home / START[shell]
    if start is not None:
        file.write_bytes(start)
    install(shell)
    with file.open("ab") as stream:
        stream.write(b"later\n")
    remove(shell)
    assert file.read_bytes().split() == [*(start or b"").split(), b"later"]
    assert b"daguerre" not in file.read_bytes()


def test_links_to_start_files_stay(home: Path) -> None:
    (home / "dotfiles").mkdir()
    (home / "dotfiles" / "zshrc").write_text("echo hi\n")
    (home / ".zshrc").symlink_to("dotfiles/zshrc")
    install("zsh")
    assert (home / ".zshrc").is_symlink()
    assert "daguerre" in (home / "dotfiles" / "zshrc").read_text()
    remove("zsh")
    assert (home / "dotfiles" / "zshrc").read_text() == "echo hi\n"


def test_bash_completion_needs_no_line(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "bash_completion"
    monkeypatch.setattr(installing, "_BASH_COMPLETION", (str(package),))
    monkeypatch.setattr(installing, "_STARTS_OF_BASH", ())
    start = home / ".bashrc"
    start.write_text(f"# . {package}\n")
    package.touch()
    assert len(install("bash")) == 2  # the line that would load it is a comment
    remove("bash")
    start.write_text(f". {package}\n")
    assert len(install("bash")) == 1
    package.unlink()
    assert len(install("bash")) == 2  # it is not there


def test_folders_of_the_user_are_used(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(home / "data"))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(home / "config"))
    monkeypatch.setenv("ZDOTDIR", str(home))
    for shell in SHELLS:
        install(shell)
    assert (home / "data/bash-completion/completions/daguerre").exists()
    assert (home / "data/zsh/site-functions/_daguerre").exists()
    assert (home / "config/fish/completions/daguerre.fish").exists()


def test_a_file_of_somebody_else_stays(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = home / ".config/fish/completions/daguerre.fish"
    file.parent.mkdir(parents=True)
    file.write_text("# mine\n")
    assert main(["completion", "fish", "--install"]) == 5
    assert f"{file}: cannot write: a file that is not daguerre's" in capsys.readouterr().err
    assert main(["completion", "fish", "--remove"]) == 0
    assert file.read_text() == "# mine\n"


def test_the_script_is_printed_whole(capsys: pytest.CaptureFixture[str]) -> None:
    for shell in SHELLS:
        assert main(["completion", shell]) == 0
        assert capsys.readouterr().out == script(shell)


@pytest.mark.parametrize(
    ("shell", "words", "message"),
    [
        ("/bin/tcsh", [], "completion: $SHELL: wanted bash, zsh or fish, got 'tcsh'"),
        ("", [], "completion: $SHELL: wanted bash, zsh or fish, got nothing"),
        ("/bin/zsh", ["ksh"], "completion: wanted bash, zsh or fish, got 'ksh'"),
        ("/bin/zsh", ["--install", "--remove"], "--install and --remove: wanted one of them"),
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


def test_a_user_without_a_home_is_one_error(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def none() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(Path, "home", none)
    assert main(["completion", "bash", "--install"]) == 2
    assert "$HOME: wanted a folder, got nothing" in capsys.readouterr().err


def test_a_home_that_cannot_be_written_is_one_error(
    home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (home / ".local").touch()
    assert main(["completion", "bash", "--install"]) == 5
    assert "completions: cannot make it: Not a directory" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["bash", "zsh"])
def test_a_new_shell_completes_after_installing(home: Path, name: str) -> None:
    if not shutil.which(name):
        pytest.skip(f"there is no {name} here")
    before = tree(home)
    install(name)
    shell = Shell(name, home, home, start=True)
    assert shell.completed("daguerre vers") == "daguerre version "
    shell.close()
    remove(name)
    shutil.rmtree(home / ".bin")
    assert tree(home) == before
