"""The browser is opened without the token in its command."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit
from urllib.request import url2pathname

import pytest

from daguerre.viewfinder import browser

URL = "http://127.0.0.1:8321/#secret&<token>"


class _Named:
    def __init__(self, name: str) -> None:
        self.name = name


@pytest.fixture
def programs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of all programs; ``browse`` is the browser."""
    folder = tmp_path / "bin"
    folder.mkdir()
    monkeypatch.setenv("PATH", str(folder))
    monkeypatch.setattr("webbrowser.get", lambda *_: _Named("browse"))
    monkeypatch.setattr(browser, "_applications", lambda: [tmp_path / "snapd" / "applications"])
    return folder


def _program(path: Path, text: str) -> None:
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)


def _opened(monkeypatch: pytest.MonkeyPatch) -> tuple[list[str], list[str], list[Any]]:
    """Addresses given to the browser, lines said, and facts of the page while it is open."""
    given: list[str] = []
    said: list[str] = []
    facts: list[Any] = []
    monkeypatch.setattr("webbrowser.open", lambda url: given.append(url) or True)
    with browser.opened(URL, said.append):
        for one in given:
            page = Path(url2pathname(urlsplit(one).path))
            modes = [stat.S_IMODE(path.stat().st_mode) for path in (page.parent, page)]
            facts.append((page, modes, page.read_text()))
    return given, said, facts


def test_the_command_has_a_file_of_this_user_alone(
    programs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _program(programs / "browse", "exec true")
    before = os.umask(0)
    try:
        (given,), said, ((page, modes, text),) = _opened(monkeypatch)
    finally:
        os.umask(before)
    assert given.startswith("file://")
    assert "secret" not in given
    assert modes == [0o700, 0o600]
    assert 'url=http://127.0.0.1:8321/#secret&amp;&lt;token&gt;"' in text
    assert "no-referrer" in text
    assert not page.parent.exists()
    assert not said


@pytest.mark.parametrize("how", ["link", "script", "desktop"])
def test_a_browser_in_a_sandbox_gets_the_printed_address(
    how: str, programs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sandbox = tmp_path / "snap" / "bin"
    sandbox.mkdir(parents=True)
    _program(sandbox / "browse", "exec true")
    if how == "link":
        (programs / "browse").symlink_to(sandbox / "browse")
    elif how == "script":
        _program(programs / "browse", 'exec /snap/bin/browse "$@"')
    else:
        _program(programs / "browse", "exec true")
        _program(programs / "xdg-settings", "echo browse_browse.desktop")
        (tmp_path / "snapd" / "applications").mkdir(parents=True)
        (tmp_path / "snapd" / "applications" / "browse_browse.desktop").touch()
    given, said, _ = _opened(monkeypatch)
    assert not given
    assert len(said) == 1
    assert "open this address" in said[0]


def test_no_browser_and_no_room_end_nothing(
    programs: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "nowhere"))
    given, said, _ = _opened(monkeypatch)
    assert not given
    assert "open this address" in said[0]
