"""Shared parts of benches of one core: facts of the machine, a command line for one result."""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import daguerre as dg
from daguerre import _core


def processor() -> str:
    """Name of the processor."""
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def machine() -> dict[str, Any]:
    """On what the figures were taken."""
    return {
        "threads": 1,
        "clock": "CPU seconds of the thread",
        "simd_target": _core.simd_target(),
        "machine": processor(),
        "cores": os.cpu_count(),
        "version": dg.__version__,
    }


def command(doc: str | None) -> argparse.ArgumentParser:
    """A parser with the first line of a bench's docstring, and --json."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[0] if doc else None)
    parser.add_argument("--json", action="store_true", help="one JSON object on stdout")
    return parser


def report(
    options: argparse.Namespace,
    measured: Callable[[], dict[str, Any]],
    lines: Callable[[dict[str, Any]], Iterable[str]],
) -> int:
    """Measures and prints; the exit code: 2 for lenses and settings that cannot be."""
    try:
        result = measured()
    except ValueError as error:
        print(f"{Path(sys.argv[0]).stem}: {error}", file=sys.stderr)
        return 2
    if options.json:
        print(json.dumps(result))
        return 0
    print(f"{result['machine']}, {result['simd_target']}, one core")
    for line in lines(result):
        print(line)
    return 0
