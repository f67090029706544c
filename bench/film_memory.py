"""Peak memory per pixel of ``daguerre render`` against what it is refused by.

    python bench/film_memory.py [--case NAME ...]

Each case is drawn at 1920 x 1080 and 3840 x 2160 px, each in a process of its own; the difference
of their peaks is that of their pixels. ``film_memory.pixel_bytes`` is what a picture is held
against before it is drawn: it should be a little more than what is measured. ``px_in_16_gb``: of
16 GB, one of which is for the scene and the program.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from memory import make_small

CHILD = """
import json, resource, sys
from daguerre.cli import main
from daguerre import _core
from daguerre.rendering import film_memory, light_plan
told = []
def check(layout, **options):
    told.append(pixel_bytes(layout, **options))
pixel_bytes, light_plan.check_film = film_memory.pixel_bytes, check
code = main(sys.argv[1:])
if "--denoise" in sys.argv:
    told = [_core.Film.pixel_bytes(_core.FilmLayout(aovs=True)) + film_memory.DENOISED]
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
print(json.dumps({"code": code or 0, "told": told[-1], "peak": peak}))
"""
LENS = ("--lens", "double-gauss-50mm-f2", "--f-stop", "2")
CASES: dict[str, tuple[str, ...]] = {
    "picture": ("--light-paths", "off"),
    "light paths": ("--light-paths", "1000,1000"),
    "exact lens, flare": (*LENS, "--light-paths", "1000,1000", "--flare", "2000"),
    "flare and scatter": (*LENS, "--light-paths", "1000,1000", "--flare", "2000", "--scatter", "9"),
    "channels of a sensor": ("--sensor", "sony-a7r-ii"),
    "--aov all": ("--aov", "all"),
    "--aov all, ground truth": ("--aov", "all", "--gt-time", "mid"),
    "--noise": ("--noise", "0.5", "--spp", "2"),
    "--denoise": ("--denoise",),
    "a pass": ("--samples", "0:1"),
    "16 bands": ("--bands", "16"),
}
WIDTHS = (1920, 3840)


def peak(scene: Path, width: int, arguments: tuple[str, ...]) -> dict[str, int]:
    """Bytes at the peak, and those per pixel that were foretold."""
    size = f"{width}x{width * 9 // 16}"
    command = [sys.executable, "-c", CHILD, "render", str(scene), "--res", size, "--spp", "1", "-q"]
    out = f"-o{scene.with_name('out.exr')}"
    done = subprocess.run([*command, *arguments, out], capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(done.stderr)
    found: dict[str, int] = json.loads(done.stdout.splitlines()[-1])
    if found["code"]:
        raise SystemExit(done.stderr)
    return found


def main() -> None:
    """Prints a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", action="append", choices=list(CASES), help="only these")
    chosen = parser.parse_args().case or list(CASES)
    print("| case | bytes per px | foretold | px in 16 GB |\n| --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.glb"
        make_small(scene)
        for name in chosen:
            small, large = (peak(scene, width, CASES[name]) for width in WIDTHS)
            pixels = [w * (w * 9 // 16) for w in WIDTHS]
            each = (large["peak"] - small["peak"]) / (pixels[1] - pixels[0])
            told = large["told"]
            print(f"| {name} | {each:.0f} | {told} | {15e3 / told:.0f} MP |", flush=True)


if __name__ == "__main__":
    main()
