"""Commands in a process of their own, which finds the tests and says all that it said."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]


def run(
    words: Sequence[str],
    folder: Path = ROOT,
    *,
    timeout: float | None = None,
    check: bool = False,
    **environment: str,
) -> subprocess.CompletedProcess[str]:
    """Runs a command, its program first.

    Args:
        words: The command.
        folder: Where it runs.
        timeout: Seconds after which it is a fault; None: as long as it takes.
        check: Whether an exit code other than 0 is one, too.
        environment: Variables beside those of this process.
    """
    return subprocess.run(
        words,
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
        capture_output=True,
        text=True,
        timeout=timeout,
        check=check,
    )
