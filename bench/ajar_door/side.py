"""Arguments and the answer of one renderer's program; ``ajar.py`` and ``rooms.py`` run them."""

from __future__ import annotations

import argparse
import json
import resource
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

DEPTH = 12  # surfaces of a path


def arguments(**more: Callable[[str], object]) -> argparse.Namespace:
    """The same for each renderer, and ``more`` by their types."""
    parser = argparse.ArgumentParser()
    for name in ("w", "h", "spp", "seed", "threads"):
        parser.add_argument(f"--{name}", type=int, required=True)
    parser.add_argument("--out", type=Path, required=True)
    for name, kind in more.items():
        parser.add_argument(f"--{name}", type=kind, required=True)
    return parser.parse_args()


def cpu_seconds() -> float:
    """User and system time of this process."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def answer(out: Path, picture: np.ndarray, renderer: str, cpu: float, **more: Any) -> None:
    """Keeps the picture, (H, W, 3), and prints the line that the bench reads."""
    np.save(out.with_suffix(".npy"), picture.astype(np.float32))
    result = {"renderer": renderer, "cpu_s": round(cpu, 2), **more}
    print("RESULT " + json.dumps(result), flush=True)
