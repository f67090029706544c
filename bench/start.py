"""CPU time of whole processes that do little: importing, helping, loading, drawing a small picture.

    python bench/start.py --json [--runs 15] [--scene night_table.glb]

The scene is that of ``scenes/night_table.py`` unless --scene names another; pictures have 96 x 64
pixels of one sample, and those of coats show a square alone. CPU seconds are user and system time
of a process with all its threads, from its start to its end, at their least over runs that take
turns. Modules are those in ``sys.modules`` at the end.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

MAIN = "import sys; from daguerre.cli import main; main()"
COUNT = "\nprint(len(sys.modules), file=sys.stderr)"
#: A square under a white sky, with a coat of a roughness over a base, of facets of a distribution.
COATED = """
import sys
import daguerre as dg
corners = [(-1, -1, -2), (1, -1, -2), (1, 1, -2), (-1, 1, -2)]
facets = {"alpha": float(sys.argv[1]), "distribution": sys.argv[2]}
base = dg.Conductor(**facets) if sys.argv[3] == "metal" else dg.Diffuse()
scene = dg.Scene()
square = scene.add_mesh(corners, [(0, 1, 2), (0, 2, 3)])
scene.add_instance(square, dg.Coated(base, **facets))
scene.set_environment(color=(1, 1, 1))
dg.render(scene, dg.Camera(focal_length=35), resolution=(96, 64), spp=1)
"""
SCENES = Path(__file__).resolve().parent.parent / "scenes"
#: Python may keep what it compiles, as it does for a user.
SURROUNDINGS = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}


def programs(scene: str) -> dict[str, list[str]]:
    """Program text and arguments of each process, by name."""
    small = ["render", scene, "--res", "96x64", "--spp", "1", "-q", "-o"]
    lens = ["--lens", "double-gauss-50mm-f2"]
    return {
        "Python alone": ["import sys"],
        "import daguerre": ["import sys; import daguerre"],
        "daguerre --help": [MAIN, "--help"],
        "daguerre render --help": [MAIN, "render", "--help"],
        "dg.load": ["import sys; import daguerre as dg; dg.load(sys.argv[1])", scene],
        "a small .png": [MAIN, *small, "a.png"],
        "a small .exr": [MAIN, *small, "a.exr"],
        "a small .png, double Gauss": [MAIN, *small, "b.png", *lens],
        "a small .exr, double Gauss": [MAIN, *small, "b.exr", *lens],
        "smooth coat": [COATED, "0", "ggx", "matte"],
        "rough coat, GGX": [COATED, "0.2", "ggx", "matte"],
        "rough coat, Beckmann": [COATED, "0.2", "beckmann", "matte"],
        "rough coat on metal, GGX": [COATED, "0.2", "ggx", "metal"],
        "rough coat on metal, Beckmann": [COATED, "0.2", "beckmann", "metal"],
    }


def cpu_seconds(code: str, arguments: list[str], folder: str) -> float:
    """User and system time of one process."""
    command = [sys.executable, "-c", code, *arguments]
    with subprocess.Popen(
        command, cwd=folder, env=SURROUNDINGS, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    ) as process:
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode and process.stderr is not None:
            sys.exit(f"start: {' '.join(arguments)}: {process.stderr.read().decode()}")
    return used.ru_utime + used.ru_stime


def modules(code: str, arguments: list[str], folder: str) -> int:
    """Number of modules that a process has loaded at its end."""
    done = subprocess.run(
        [sys.executable, "-c", code + COUNT, *arguments],
        cwd=folder, env=SURROUNDINGS, capture_output=True, text=True, check=True,
    )  # fmt: skip
    return int(done.stderr.splitlines()[-1])


def measured(runs: int, scene: Path | None, folder: str) -> dict[str, dict[str, float]]:
    """CPU seconds and modules of each process."""
    if scene is None:
        scene = Path(folder) / "night_table.glb"
        made = [sys.executable, str(SCENES / "night_table.py"), str(scene)]
        subprocess.run(made, check=True, capture_output=True)
    them = {name: (code, rest) for name, (code, *rest) in programs(str(scene.resolve())).items()}
    counts = {name: modules(*one, folder) for name, one in them.items()}  # compiles, too
    least = dict.fromkeys(them, float("inf"))
    for _ in range(runs):
        for name, one in them.items():
            least[name] = min(least[name], cpu_seconds(*one, folder))
    return {name: {"cpu_s": round(least[name], 3), "modules": counts[name]} for name in them}


def main() -> None:
    """Prints a table, or JSON."""
    parser = argparse.ArgumentParser(description="CPU time of whole processes that do little")
    parser.add_argument("--runs", type=int, default=15)
    parser.add_argument("--scene", type=Path)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found = measured(options.runs, options.scene, folder)
    if options.json:
        print(json.dumps(found))
        return
    for name, one in found.items():
        print(f"{name:30} {one['cpu_s']:6.3f} CPU s {one['modules']:5} modules")


if __name__ == "__main__":
    main()
