"""Installs the script of a shell for one user, and removes it.

bash-completion and fish find scripts in folders of the user. For zsh, and for bash without
bash-completion, a line at the end of the start-up file reads the script. The files themselves list
the folders and files made for them, so that ``remove`` restores the earlier state.
"""

from __future__ import annotations

import os
import re
import shlex
from pathlib import Path

from daguerre.errors import InputError, OutputError, UsageError, suggest
from daguerre.files import atomic

SHELLS = ("bash", "zsh", "fish")
_SCRIPTS = Path(__file__).parent / "scripts"
#: Last line of an installed script: how many folders were made for it.
_MADE = re.compile(r"# installed by daguerre; folders made: (\d+)\n\Z")
#: Line in a start-up file, and whether file or line end were made for it.
_LINE = re.compile(rb"(?m)^[^\n]*# completion of daguerre( \(new file\)| \(new line\))?(?:\n|\Z)")
#: Files that switch on the package bash-completion, if a start-up file names them.
_BASH_COMPLETION = (
    "/usr/share/bash-completion/bash_completion",
    "/usr/local/share/bash-completion/bash_completion",
    "/etc/bash_completion",
)
_STARTS_OF_BASH = ("/etc/bash.bashrc", "/etc/bashrc")


def of_user(shell: str | None) -> str:
    """The shell that was named, else the user's shell.

    Raises:
        UsageError: There is no completion for it.
    """
    found = shell if shell is not None else Path(os.environ.get("SHELL", "")).name
    if found not in SHELLS:
        where = "completion" if shell is not None else "completion: $SHELL"
        got = repr(found) if found else "nothing"
        raise UsageError(f"{where}: wanted bash, zsh or fish, got {got}{suggest(found, SHELLS)}")
    return found


def script(shell: str) -> str:
    """The script of a shell."""
    return (_SCRIPTS / f"daguerre.{shell}").read_text("utf-8")


def install(shell: str) -> list[str]:
    """Installs the script of a shell; returns a sentence for each change.

    Raises:
        OutputError: It cannot be written, or another file has its place.
    """
    path = _place(shell)
    if path.exists():
        made = _folders_made(path)
        if made is None:
            raise OutputError(f"{path}: cannot write: a file that is not daguerre's is there")
    else:
        made = _make_folders(path.parent)
    text = f"{script(shell)}# installed by daguerre; folders made: {made}\n"
    atomic.write_bytes(path, text.encode())
    return [f"wrote {path}", *_add_line(shell, path)]


def remove(shell: str) -> list[str]:
    """Removes the script of a shell; returns a sentence for each change.

    Raises:
        OutputError: It cannot be removed.
    """
    done = _drop_line(shell)
    path = _place(shell)
    made = _folders_made(path) if path.exists() else None
    if made is not None:
        atomic.remove(path)
        for folder in list(path.parents)[:made]:
            if any(folder.iterdir()):
                break
            folder.rmdir()
        done.append(f"removed {path}")
    return done


def _place(shell: str) -> Path:
    """File of the script."""
    data = _folder("XDG_DATA_HOME", ".local/share")
    if shell == "bash":
        return data / "bash-completion/completions/daguerre"
    if shell == "zsh":
        return data / "zsh/site-functions/_daguerre"
    return _folder("XDG_CONFIG_HOME", ".config") / "fish/completions/daguerre.fish"


def _start(shell: str) -> Path:
    """Start-up file of bash or zsh."""
    return _home() / ".bashrc" if shell == "bash" else _folder("ZDOTDIR", "") / ".zshrc"


def _folder(variable: str, usual: str) -> Path:
    named = os.environ.get(variable, "")
    return Path(named) if Path(named).is_absolute() else _home() / usual


def _home() -> Path:
    try:
        return Path.home()
    except RuntimeError:
        raise UsageError("completion: $HOME: wanted a folder, got nothing") from None


def _folders_made(path: Path) -> int | None:
    """Number of folders that were made for an installed script; None: it is another file."""
    found = _MADE.search(_read(path).decode("utf-8", "replace"))
    return int(found[1]) if found else None


def _make_folders(folder: Path) -> int:
    """Makes a folder and those above it; returns how many."""
    missing = [one for one in (folder, *folder.parents) if not one.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot make it: {error.strerror or error}") from error
    return len(missing)


def _add_line(shell: str, path: Path) -> list[str]:
    """Adds a line that reads the script to a start-up file, if the shell needs the line."""
    start = _start(shell)
    if shell == "fish" or (shell == "bash" and _loads_bash_completion(start)):
        return []
    text = _read(start) if start.exists() else b""
    if _LINE.search(text):
        return []
    how = " (new file)" if not start.exists() else ""
    if text and not text.endswith(b"\n"):
        text, how = text + b"\n", " (new line)"
    name = shlex.quote(str(path))
    line = f"[ -r {name} ] && . {name} # completion of daguerre{how}\n"
    _rewrite(start, text + os.fsencode(line))
    return [f"added a line to {start}"]


def _drop_line(shell: str) -> list[str]:
    start = _start(shell)
    if shell == "fish" or not start.exists():
        return []
    text = _read(start)
    found = _LINE.search(text)
    if not found:
        return []
    before, after = text[: found.start()], text[found.end() :]
    if found[1] == b" (new line)" and not after:
        before = before.removesuffix(b"\n")
    if found[1] == b" (new file)" and not before + after:
        atomic.remove(start)
        return [f"removed {start}"]
    _rewrite(start, before + after)
    return [f"removed a line from {start}"]


def _loads_bash_completion(start: Path) -> bool:
    """Whether bash-completion, which finds the script by itself, is there and switched on."""
    there = [name for name in _BASH_COMPLETION if Path(name).exists()]
    lines = [
        line.split(b"#")[0]
        for file in (start, *map(Path, _STARTS_OF_BASH))
        if file.exists()
        for line in _read(file).splitlines()
    ]
    return any(os.fsencode(name) in line for name in there for line in lines)


def _rewrite(path: Path, data: bytes) -> None:
    """Writes a file of the user: at once, through links, with its permissions."""
    mode = path.stat().st_mode if path.exists() else None
    with atomic.atomic_path(path) as temp:
        temp.write_bytes(data)
        if mode is not None:
            temp.chmod(mode & 0o7777)


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot read: {error.strerror or error}") from error
