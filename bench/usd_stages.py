"""Renders every stage of USD below a folder, and prints how many load, end in an error, or fail.

A stage passes if it is rendered at 64 x 36, 1 spp, or ends in one error with exit code 3, within
10 s of CPU time and 2 GB. The result is JSON.

    python bench/usd_stages.py FOLDER [--allow-dir DIR]
"""

from __future__ import annotations

import argparse
import json
import re
import resource
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

_SUFFIXES = (".usd", ".usda", ".usdc", ".usdz")
_LIMIT_S, _LIMIT_MB, _PATIENCE_S = 10.0, 2048.0, 120


def drawn(path: Path, allowed: Path, folder: str) -> dict[str, Any]:
    """Renders a stage in a process of its own."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [
        *(sys.executable, "-c", _CHILD, "render", str(path), "--allow-dir", str(allowed)),
        *("--res", "64x36", "--spp", "1", "-o", f"{folder}/out.exr", "--quiet"),
    ]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=_PATIENCE_S, check=False
        )
        code, said = done.returncode, done.stderr
    except subprocess.TimeoutExpired:
        code, said = -1, "no end"
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    lines = [line for line in said.splitlines() if line.strip()]
    megabytes = next((float(x.split()[1]) for x in lines if x.startswith("peak_mb ")), 0.0)
    return {
        "stage": path.name,
        "code": code,
        "cpu_s": round(cpu, 2),
        "peak_mb": round(megabytes),
        "said": [line for line in lines if not line.startswith("peak_mb ")],
    }


_CHILD = """
import resource, sys
from daguerre.cli import main
try:
    code = main()
except SystemExit as end:
    code = end.code
print("peak_mb", resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, file=sys.stderr)
sys.exit(code)
"""


def fate(row: dict[str, Any]) -> str:
    """The class of a result."""
    if row["code"] not in (0, 3) or any("Traceback" in line for line in row["said"]):
        return "failed"
    if row["cpu_s"] > _LIMIT_S:
        return "slow"
    if row["peak_mb"] > _LIMIT_MB:
        return "large"
    return "rendered" if row["code"] == 0 else "refused"


def reason(row: dict[str, Any]) -> str:
    """Error of a refused stage without places and numbers, so that like ones count as one."""
    told = row["said"][-1] if row["said"] else ""
    at = told.find("wanted")
    words = told[at:] if at >= 0 else told.rpartition(": ")[2]
    return re.sub(r"/[^\s,)']+", "...", re.sub(r"\d+", "N", words))


def main() -> None:
    """Renders the stages of a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--allow-dir", type=Path)
    parser.add_argument("--only", help="stages whose path contains this")
    given = parser.parse_args()
    stages = [p for p in sorted(given.folder.rglob("*")) if p.suffix in _SUFFIXES and p.is_file()]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for path in stages:
            if given.only and given.only not in str(path):
                continue
            row = drawn(path, given.allow_dir or given.folder, folder)
            row |= {"stage": str(path.relative_to(given.folder)), "fate": fate(row)}
            rows.append(row)
            print(row["fate"], row["cpu_s"], row["peak_mb"], row["stage"], file=sys.stderr)
    notes = Counter(line for row in rows for line in row["said"] if row["code"] == 0)
    print(
        json.dumps(
            {
                "stages": len(rows),
                "fates": Counter(row["fate"] for row in rows),
                "slowest_s": max((row["cpu_s"] for row in rows), default=0),
                "largest_mb": max((row["peak_mb"] for row in rows), default=0),
                "reasons": Counter(reason(row) for row in rows if row["fate"] == "refused"),
                "not_rendered": [row for row in rows if row["fate"] != "rendered"],
                "notes": len(notes),
            },
            indent=1,
        )
    )


if __name__ == "__main__":
    main()
