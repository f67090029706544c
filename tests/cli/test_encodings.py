"""Names with accents reach terminals of any encoding."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest


@pytest.mark.parametrize(
    ("settings", "name"),
    [
        ({"PYTHONIOENCODING": "ascii"}, r"Mert\xe9"),
        ({"PYTHONIOENCODING": "latin-1"}, "Merté"),
        ({"PYTHONIOENCODING": "utf-8"}, "Merté"),
        ({"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}, r"Mert\xe9"),
    ],
)
def test_letters_that_an_encoding_lacks(settings: dict[str, str], name: str) -> None:
    keep = {k: v for k, v in os.environ.items() if k not in ("PYTHONIOENCODING", "LC_ALL")}
    done = subprocess.run(
        [sys.executable, "-m", "daguerre", "lenses"],
        capture_output=True,
        check=True,
        env=keep | settings,
    )
    encoding = settings.get("PYTHONIOENCODING", "ascii")
    assert name in done.stdout.decode(encoding)
    assert not done.stderr
