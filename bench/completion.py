"""Time of an answer to a TAB: ``daguerre __complete`` as a whole process, for some command lines.

    python bench/completion.py [--runs 20] [--json]

Each row is the median of the runs, s: CPU time (user and system) and time on the clock. ``python``
is an empty program: the part that no answer can save. Run it on an idle machine.
"""

from __future__ import annotations

import argparse
import json
import resource
import shutil
import statistics
import subprocess
import sys
import time

BREAKS = " \t\n\"'@><=;|&(:"
LINES = ("daguerre ", "daguerre render --", "daguerre render --lens can", "daguerre render ")


def children_s() -> float:
    """CPU time of all processes that were started here and have ended, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def median_times(words: list[str], runs: int) -> tuple[float, float]:
    """Median CPU time and time on the clock of a process, s."""
    cpu, wall = [], []
    for _ in range(runs):
        before, begin = children_s(), time.perf_counter()
        subprocess.run(words, stdout=subprocess.DEVNULL, check=True)
        wall.append(time.perf_counter() - begin)
        cpu.append(children_s() - before)
    return statistics.median(cpu), statistics.median(wall)


def main() -> None:
    """Prints a row for each command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    program = shutil.which("daguerre") or sys.exit("wanted daguerre on the path, got none")
    asked = {"python": [sys.executable, "-c", ""]}
    asked |= {line: [program, "__complete", "bash", BREAKS, line] for line in LINES}
    for name, words in asked.items():
        cpu, wall = median_times(words, options.runs)
        if options.json:
            print(json.dumps({"line": name, "cpu_s": round(cpu, 4), "wall_s": round(wall, 4)}))
        else:
            print(f"{name:28} {cpu:.3f} s of CPU time, {wall:.3f} s")


if __name__ == "__main__":
    main()
