"""``daguerre view``: the address that it prints, ports in use, wrong flags, and its end."""

from __future__ import annotations

import re
import signal
import socket
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from daguerre import cli
from daguerre.viewfinder import run
from tests.faults.scene import write_scene

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
COMMAND = (sys.executable, "-m", "daguerre", "view")
QUICK = ("--no-browser", "--res", "60x40", "--spp", "2")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return write_scene(tmp_path / "scene.glb")


@contextmanager
def viewed(*words: str) -> Iterator[subprocess.Popen[str]]:
    """The command while it runs; it hears Ctrl-C also where the tests run in the background."""
    process = subprocess.Popen(
        [*COMMAND, *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def lines_until_address(process: subprocess.Popen[str]) -> list[str]:
    """Lines that it prints, the last one with the page's address."""
    assert process.stdout is not None
    found = []
    for line in process.stdout:
        found.append(line.strip())
        if found[-1].startswith("http://"):
            return found
    raise AssertionError((found, process.communicate()))


def test_it_prints_an_address_serves_the_page_and_ends(file: Path) -> None:
    with viewed(str(file), *QUICK, "--port", "0") as process:
        address = lines_until_address(process)[-1]
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/#([\w-]{43})", address)
        assert found
        with urllib.request.urlopen(address.partition("#")[0], timeout=20) as answer:
            assert b"viewfinder" in answer.read()
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=30)
        assert process.returncode == 0
        assert "Traceback" not in err


def test_a_port_in_use_is_said_and_the_next_one_serves(file: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with viewed(str(file), *QUICK, "--port", str(port)) as process:
            lines = lines_until_address(process)
            assert any(line.startswith(f"port {port} is in use; using ") for line in lines), lines
            assert f":{port}/" not in lines[-1]


def test_the_command_has_the_flags_given(file: Path) -> None:
    from websockets.sync.client import connect

    words = (str(file), *QUICK, "--port", "0", "--lens", "double-gauss-50mm-f2", "--f-stop", "4")
    with viewed(*words) as process:
        address, _, token = lines_until_address(process)[-1].partition("#")
        with connect(address.replace("http", "ws") + "live") as line:
            line.send(token)
            text = ""
            while "command" not in text:
                text = str(line.recv(60))
        assert "--lens=double-gauss-50mm-f2 --f-stop=4" in text
        assert "-o scene.png" in text
        assert "--port" not in text
        assert "--no-browser" not in text


@pytest.mark.parametrize(
    ("words", "wanted", "code"),
    [
        (["--host", "0.0.0.0"], "needs --token", 2),
        (["--host", "192.0.2.1", "--token", "x" * 20], "--host 192.0.2.1", 2),
        (["--lens", "no-such-lens"], "no-such-lens", 3),
        (["--f-stop", "-1"], "--f-stop", 2),
        (["--proxy", "hub.example/x"], "--proxy", 2),
        (["--port", "99999"], "--port", 2),
        (["--lens", "thin", "--flare", "auto"], "flare (--flare)", 2),
        (["--lens", "thin", "--scatter", "auto"], "scatter (--scatter)", 2),
        (["--lens", "pinhole", "--diffraction"], "diffraction (--diffraction)", 2),
    ],
)
def test_wrong_flags_are_one_error(
    file: Path,
    words: list[str],
    wanted: str,
    code: int,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(run, "asyncio", None)  # no server starts
    assert cli.main(["view", str(file), *QUICK, *words]) == code
    said = capsys.readouterr().err
    assert said.count("daguerre: error:") == 1
    assert wanted in said


def test_a_scene_that_is_not_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["view", str(tmp_path / "none.glb"), *QUICK]) == 3
    assert "none.glb" in capsys.readouterr().err


def test_a_missing_package_is_named(
    file: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from daguerre.files import extras

    monkeypatch.setattr(extras, "missing", lambda module: module == "simplejpeg")
    assert cli.main(["view", str(file), *QUICK]) == 2
    assert extras.hint("simplejpeg") in capsys.readouterr().err
