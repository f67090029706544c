"""Interactive shells on a pseudo-terminal: what a TAB makes of a line."""

from __future__ import annotations

import os
import pty
import re
import select
import shutil
import signal
import sys
import time
from pathlib import Path

import daguerre
from tests.support.program.pseudo_terminal import need_terminal

PACKAGES = Path(daguerre.__file__).parents[1]
SCRIPTS = PACKAGES / "daguerre/cli/completion/scripts"
#: Commands that let Ctrl-T print the line between marks.
_SHOW = {
    "bash": """bind 'set bell-style none'; bind -x '"\\C-t": printf "<<%s>>" "$READLINE_LINE"'""",
    "zsh": "_show() { print -rn -- \"<<$BUFFER>>\" }; zle -N _show; bindkey '^T' _show",
}
_PLAIN = {"bash": ["bash", "--norc", "--noprofile"], "zsh": ["zsh", "-f"]}
SECONDS = 60


def environment(home: Path) -> dict[str, str]:
    """Environment of a shell in which ``daguerre`` is this one."""
    bin_ = home / ".bin"
    bin_.mkdir(exist_ok=True)
    program = bin_ / "daguerre"
    program.write_text(
        f"#!{sys.executable}\nimport sys\nsys.path.insert(0, {str(PACKAGES)!r})\n"
        "from daguerre.cli import main\nsys.exit(main())\n"
    )
    program.chmod(0o755)
    known = {"TERM": "dumb", "LANG": "C.UTF-8", "INPUTRC": "/dev/null"}
    return {**known, "PATH": f"{bin_}:/usr/bin:/bin", "HOME": str(home)}


class Shell:
    """A shell with completion of daguerre."""

    def __init__(self, name: str, home: Path, folder: Path, *, start: bool = False) -> None:
        """Starts it.

        Args:
            name: bash or zsh.
            home: Home of its user.
            folder: Its folder.
            start: Whether it reads its start-up files; else it reads the script alone.
        """
        need_terminal()
        self._pid, self._terminal = pty.fork()
        if self._pid == 0:
            os.chdir(folder)
            words = [name, "-i"] if start else _PLAIN[name]
            os.execve(shutil.which(name) or name, words, environment(home))
        script = "" if start else f". '{SCRIPTS / f'daguerre.{name}'}'; "
        self._type(f"{script}{_SHOW[name]}; PS1='$ '; echo rea''dy\n")
        self._until(r"\nready")

    def completed(self, line: str) -> str:
        """The line after a TAB at its end; nothing else may be on the screen."""
        self._type(f"{line}\t\x14")
        shown = self._until(r"<<(.*?)>>")
        self._type("\x15")
        return shown

    def close(self) -> None:
        """Ends it."""
        os.kill(self._pid, signal.SIGKILL)
        os.waitpid(self._pid, 0)
        os.close(self._terminal)

    def _type(self, text: str) -> None:
        os.write(self._terminal, text.encode())

    def _until(self, pattern: str) -> str:
        """Reads until a pattern, and returns its group."""
        text, end = "", time.monotonic() + SECONDS
        while not (found := re.search(pattern, text)):
            assert time.monotonic() < end, text
            if select.select([self._terminal], [], [], 1)[0]:
                text += os.read(self._terminal, 1 << 16).decode("utf-8", "replace")
        return found[found.re.groups]
