"""Signals and limits of the system outside of a render: one line, and the exit code of an end."""

from __future__ import annotations

import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.faults.scene import write_scene

#: A reader that never ends, in place of that of scenes.
_SLOW = """
import sys, time
from daguerre.files import formats
from daguerre.cli import main
def read(*words, **options):
    print("reading", flush=True)
    time.sleep(100)
formats.read = read
sys.argv = ["daguerre", *sys.argv[1:]]
sys.exit(main())
"""


def _hear() -> None:
    """Hears signals that the tests' own parent may ignore."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


@pytest.mark.parametrize("command", ["info", "render"])
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT"])
def test_a_signal_before_the_first_sample_ends_with_a_word(
    name: str, command: str, tmp_path: Path
) -> None:
    file = write_scene(tmp_path / "scene.glb")
    words = [command, str(file), *(["-o", str(tmp_path / "o.png")] if command == "render" else [])]
    process = subprocess.Popen(
        [sys.executable, "-c", _SLOW, *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=_hear,
    )
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == "reading\n"
        begun = time.monotonic()
        process.send_signal(getattr(signal, name))
        _, error = process.communicate(timeout=30)
    finally:
        process.kill()
    assert time.monotonic() - begun < 20
    assert process.returncode == 75
    by = "" if name == "SIGINT" else f" by {name}"
    assert error.strip() == (
        "daguerre: interrupted before the first sample; nothing was written"
        if command == "render"
        else f"daguerre: error: interrupted{by}"
    )


def test_hangups_that_nohup_ignores_stay_ignored() -> None:
    code = (
        "import signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)\n"
        "from daguerre.cli import ended; ended.by_signals()\n"
        "print(signal.getsignal(signal.SIGHUP) == signal.SIG_IGN)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"


@pytest.mark.parametrize("kilobytes", [150_000, 400_000, 900_000, 1_200_000])
def test_few_addresses_are_one_error_or_enough(kilobytes: int, tmp_path: Path) -> None:
    file = tmp_path / "stage.usda"
    file.write_text('#usda 1.0\n( defaultPrim = "W" )\ndef Sphere "W" {\n}\n')
    limit = kilobytes << 10
    done = subprocess.run(
        [sys.executable, "-m", "daguerre", "info", str(file)],
        capture_output=True,
        text=True,
        timeout=100,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)),
    )
    assert done.returncode == 3, done.stderr
    assert done.stderr.count("daguerre: error: ") == 1
    assert "too little address space: wanted at least 1.64 GB, got " in done.stderr
