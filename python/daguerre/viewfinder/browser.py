"""Opens the viewfinder's page in a browser, without its token in the command of the browser.

Every user of a machine can read the commands of all processes. So the browser gets the name of a
file that this user alone can read, and the file leads to the page.
"""

from __future__ import annotations

import html
import subprocess
import tempfile
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import rmtree, which

_PAGE = """<!DOCTYPE html>
<meta charset="utf-8">
<meta name="referrer" content="no-referrer">
<meta http-equiv="refresh" content="0; url={url}">
<title>Daguerre</title>
<a href="{url}">The viewfinder</a>
"""
#: Folders of programs and of their descriptions that run in a sandbox, where files of temporary
#: and hidden folders cannot be read.
_SANDBOXES = ("/snap/", "/flatpak/")
#: Seconds for the desktop to name its browser.
_PATIENCE_S = 2.0


@contextmanager
def opened(url: str, say: Callable[[str], None]) -> Iterator[None]:
    """Opens a page in a browser; the file that leads there is removed in the end.

    Args:
        url: Address of the page, with the token.
        say: Prints a line.
    """
    if is_sandboxed():
        say("the browser here runs in a sandbox (snap, flatpak): open this address in it")
        yield
        return
    try:
        folder = Path(tempfile.mkdtemp(prefix="daguerre-view-"))  # 0700
    except OSError:  # no folder for temporary files
        say("no browser is opened, as there is no room for a temporary file: open this address")
        yield
        return
    try:
        page = folder / "open.html"
        page.touch(mode=0o600)
        page.write_text(_PAGE.format(url=html.escape(url)), encoding="utf-8")
        webbrowser.open(page.as_uri())
        yield
    finally:
        rmtree(folder, ignore_errors=True)


def is_sandboxed() -> bool:
    """Whether the browser that would open is known to run in a sandbox, as of snap or flatpak."""
    try:
        name = webbrowser.get().name
    except (webbrowser.Error, AttributeError):
        return False
    return _in_sandbox(_program(name)) or _in_sandbox(_of_desktop())


def _program(name: str) -> str:
    """Path of a program with its links followed, and the start of its text if it is a script."""
    path = which(name)
    if path is None:
        return ""
    try:
        with Path(path).open("rb") as file:
            start = file.read(2000)
    except OSError:
        start = b""
    text = start.decode("latin-1") if start.startswith(b"#!") else ""
    return f"{path} {Path(path).resolve()} {text}"


def _of_desktop() -> str:
    """Paths of the desktop entries of the desktop's default browser; empty: not found."""
    if which("xdg-settings") is None:
        return ""
    command = ["xdg-settings", "get", "default-web-browser"]
    try:
        said = subprocess.run(command, capture_output=True, timeout=_PATIENCE_S, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    name = said.stdout.decode(errors="replace").strip()
    files = [folder / name for folder in _applications()] if name.endswith(".desktop") else []
    return " ".join(str(file.resolve()) for file in files if file.is_file())


def _applications() -> list[Path]:
    """Folders of desktop entries, with sandboxed programs first."""
    return [
        Path("/var/lib/snapd/desktop/applications"),
        Path("/var/lib/flatpak/exports/share/applications"),
        Path.home() / ".local/share/flatpak/exports/share/applications",
    ]


def _in_sandbox(text: str) -> bool:
    return any(part in text for part in (*_SANDBOXES, "/snapd/"))
