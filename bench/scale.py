"""How time and memory grow with a scene, a lens, a picture, and the work that is asked for.

    python bench/scale.py [--only lamps ...] [--most 1e6] [--json] [--keep FILE] [--plot scale.svg]
    python bench/scale.py --kept FILE --plot scale.svg

Each point is a process of its own: its memory is the peak above the imported package, with the
arrays of which a scene is made. Time is CPU time of one thread, but for ``threads``, where it is
wall-clock time. A law is the exponent of the growth from the first point to the last: 0 does not
grow, 1 grows in proportion; "each" is what one more takes between them, of set-up (us) and memory
(bytes). Pictures are 320 x 180 of 16 samples but for ``pixels`` and
``samples``.
"""

from __future__ import annotations

import argparse
import json
import math
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from many_lights import look, place
from peers import relative_mse

import daguerre as dg
from daguerre.rendering.session import Session

SIZE, SPP = (320, 180), 16
Facts = dict[str, float]


def peak_mb() -> float:
    """Peak memory of this process, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


IMPORTED_MB = peak_mb()


def camera() -> dg.Camera:
    """Looks down at the ground from 2.2 m, through a thin lens."""
    view = look((0, 2.2, 1.8), (0, 0, 0.3), 28)
    return replace(view, lens="thin", f_stop=4, focus_distance=2.8)


def relief(triangles: int) -> tuple[np.ndarray, np.ndarray]:
    """Hills on 4 x 4 m, as so many triangles."""
    side = max(1, round(math.sqrt(triangles / 2)))
    line = np.linspace(-2, 2, side + 1, dtype=np.float32)
    x, z = np.meshgrid(line, line)
    y = 0.1 * np.sin(5 * x) * np.cos(7 * z) + 0.01 * np.sin(91 * x + 57 * z)
    at = np.arange((side + 1) ** 2, dtype=np.uint32).reshape(side + 1, side + 1)
    a, b, c, d = (q.ravel() for q in (at[:-1, :-1], at[1:, :-1], at[:-1, 1:], at[1:, 1:]))
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([c, b, d], 1)])
    return np.stack([x, y, z], 2).reshape(-1, 3).astype(np.float32), faces


def ground(scene: dg.Scene) -> None:
    """Adds a plane."""
    positions, faces = relief(2)
    scene.add_instance(scene.add_mesh(positions, faces), dg.Material(dg.Diffuse((0.5,) * 3)))


def lit(scene: dg.Scene) -> dg.Scene:
    """Adds one lamp."""
    scene.add_light(dg.SphereLight((900.0,) * 3, 0.1), place((1, 2.5, 0)))
    return scene


def of_triangles(count: int) -> dg.Scene:
    """One mesh."""
    scene = dg.Scene()
    positions, faces = relief(count)
    scene.add_instance(scene.add_mesh(positions, faces), dg.Material(dg.Diffuse((0.5,) * 3)))
    return lit(scene)


def of_instances(count: int) -> dg.Scene:
    """One mesh of 200 triangles, many times, side by side."""
    scene = dg.Scene()
    ground(scene)
    mesh = scene.add_mesh(*relief(200))
    side = math.ceil(math.sqrt(count))
    at = np.arange(count)
    matrices = np.tile(np.eye(4), (count, 1, 1))
    matrices[:, :3, :3] *= 0.9 / side
    matrices[:, 0, 3] = (at % side + 0.5) * 4 / side - 2
    matrices[:, 2, 3] = (at // side + 0.5) * 4 / side - 2
    matrices[:, 1, 3] = 0.15
    scene.add_instances(mesh, scene.add_material(dg.Diffuse((0.4, 0.5, 0.6))), matrices)
    return lit(scene)


def of_lamps(count: int, dark: bool = False) -> dg.Scene:
    """Small emissive triangles, of the same power together, over a ground; or dark, and a lamp."""
    scene = dg.Scene()
    ground(scene)
    rng = np.random.default_rng(5)
    middle = rng.uniform((-2, 0.4, -2), (2, 1.4, 2), (count, 3))
    size = 0.3 / math.sqrt(count)
    corners = middle[:, None] + rng.uniform(-size, size, (count, 3, 3))
    faces = np.arange(3 * count).reshape(-1, 3)
    glow = dg.Gltf(base_color=(0, 0, 0), emissive=(0.0 if dark else 60.0,) * 3)
    mesh = scene.add_mesh(corners.reshape(-1, 3).astype(np.float32), faces)
    scene.add_instance(mesh, dg.Material(glow))
    return lit(scene) if dark else scene


def drawn(
    scene: dg.Scene,
    view: dg.Camera | None = None,
    size: tuple[int, int] = SIZE,
    spp: int = SPP,
    **options: Any,
) -> Facts:
    """Set-up and drawing of a picture: CPU seconds, and what it took in memory."""
    start = time.process_time()
    session = Session(scene, view or camera(), resolution=size, threads=1, **options)
    ready, wall = time.process_time(), time.perf_counter()
    session.draw(0, spp)
    cpu, samples = time.process_time() - ready, size[0] * size[1] * spp
    return {
        "us_per_sample": 1e6 * cpu / samples,
        "us_per_ray": 1e6 * cpu / max(1, session.counters.rays),
        "set_up_s": ready - start,
        "wall_s": time.perf_counter() - wall,
        "memory_mb": peak_mb() - IMPORTED_MB,
    }


def of_textures(count: int) -> dg.Scene:
    """So many textures of 4096 x 4096 RGB in 8 bits, each on a square of its own."""
    scene = dg.Scene()
    side = math.ceil(math.sqrt(count))
    points, faces = relief(2)
    points[:, 1] = 0
    mesh = scene.add_mesh(points, faces, uv=points[:, [0, 2]] / 4 + 0.5)
    rng = np.random.default_rng(5)
    for i in range(count):
        pixels = rng.integers(0, 256, (4096, 4096, 3), np.uint8)
        slot = dg.TextureSlot(scene.add_texture(pixels, srgb=True))
        material = scene.add_material(dg.Gltf(base_color_texture=slot))
        matrix = np.diag([0.9 / side, 1, 0.9 / side, 1])
        matrix[[0, 2], 3] = (np.array([i % side, i // side]) + 0.5) * 4 / side - 2
        scene.add_instance(mesh, material, matrix)
    return lit(scene)


LENSES = {
    10: "double-gauss-50mm-f2",
    20: "canon-ts-e-90mm-f2.8-macro",
    28: "sigma-17-40mm-f1.8",
    40: "nikon-af-s-70-200mm-f2.8",
}


def surfaces(count: int) -> Facts:
    """Rays through a lens of so many surfaces, to an even sky."""
    scene = dg.Scene()
    scene.set_environment(color=(1.0, 1.0, 1.0))
    return drawn(scene, dg.Camera(lens=LENSES[count], f_stop=5.6), spp=64)


def lamps(count: int) -> Facts:
    """Samples among so many lamps; the same with light paths, and with the same triangles dark.

    Where lamps are too small to be met, light paths buy more for their time than samples do, so a
    sample with them is another thing than one without.
    """
    found = drawn(of_lamps(count), light_paths="off")
    found["with_light_paths"] = drawn(of_lamps(count))["us_per_sample"]
    found["dark"] = drawn(of_lamps(count, dark=True), light_paths="off")["us_per_sample"]
    return found


def samples(count: int) -> Facts:
    """Error of so many samples, of two seeds."""
    scene = of_triangles(10_000)
    pictures = []
    for seed in (1, 2):
        session = Session(scene, camera(), resolution=SIZE, threads=1, seed=seed)
        session.draw(0, count)
        pictures.append(session.frame().rgb.astype(np.float64))
    error = relative_mse(*pictures)
    return {**drawn(scene, spp=count), "relmse": error}


def threads(count: int) -> Facts:
    """Wall-clock time on so many threads."""
    session = Session(of_triangles(100_000), camera(), resolution=(640, 360), threads=count)
    wall = time.perf_counter()
    session.draw(0, SPP)
    seconds = time.perf_counter() - wall
    return {"wall_s": seconds, "us_per_sample": 1e6 * seconds / (640 * 360 * SPP)}


def frames(count: int) -> Facts:
    """A sequence of so many pictures of one scene, the camera on its way."""
    scene, start = of_triangles(10_000), time.process_time()
    for i in range(count):
        view = camera()
        moved = replace(view, transform=place((0.01 * i, 0, 0)) @ view.transform)
        session = Session(scene, moved, resolution=SIZE, threads=1)
        session.draw(0, 4)
    seconds = time.process_time() - start
    return {
        "us_per_sample": 1e6 * seconds / (count * SIZE[0] * SIZE[1] * 4),
        "s_per_frame": seconds / count,
        "memory_mb": peak_mb() - IMPORTED_MB,
    }


def pixels(count: int) -> Facts:
    """A picture of about so many pixels, one sample of each."""
    width = 16 * round(math.sqrt(count * 16 / 9) / 16)
    size = (width, width * 9 // 16)
    return drawn(of_triangles(10_000), size=size, spp=1)


#: By name: what measures a point, and the counts that are measured.
KINDS: dict[str, tuple[Callable[[int], Facts], tuple[int, ...]]] = {
    "triangles": (
        lambda n: drawn(of_triangles(n)),
        (10_000, 100_000, 1_000_000, 5_000_000, 20_000_000),
    ),
    "textures": (lambda n: drawn(of_textures(n)), (1, 10, 100)),
    "instances": (lambda n: drawn(of_instances(n)), (100, 1_000, 10_000, 100_000, 1_000_000)),
    "lamps": (lamps, (1, 10, 1_000, 10_000, 100_000, 1_000_000)),
    "surfaces": (surfaces, tuple(LENSES)),
    "pixels": (pixels, (250_000, 1_000_000, 4_000_000, 16_000_000, 64_000_000)),
    "samples": (samples, (1, 4, 16, 64, 256)),
    "threads": (threads, (1, 2, 4)),
    "frames": (frames, (1, 4, 16, 64)),
}


def measure(kind: str, count: int) -> Facts | None:
    """Measures one point in a process of its own; None if that failed."""
    command = [sys.executable, __file__, "--point", kind, str(count)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        print(f"{kind} {count}: {done.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
        return None
    found: Facts = json.loads(done.stdout)
    return found


def law(points: list[tuple[int, Facts]], name: str) -> float:
    """Exponent of a fact's growth from the first point to the last."""
    (n0, first), (n1, last) = points[0], points[-1]
    if n1 == n0 or not (first.get(name, 0) > 0 and last.get(name, 0) > 0):
        return math.nan
    return math.log(last[name] / first[name]) / math.log(n1 / n0)


#: Growth by one: the fact, how many of its units are one of the shown unit, and that.
EACH = {"set_up_s": (1e6, "us"), "memory_mb": (2**20, "B")}


def each(points: list[tuple[int, Facts]], name: str) -> str:
    """Set-up and memory of one more, from the first point to the last; empty: of other facts."""
    (n0, first), (n1, last) = points[0], points[-1]
    if name not in EACH or n0 == n1 or name not in last:
        return ""
    scale, unit = EACH[name]
    return f"{scale * (last[name] - first[name]) / (n1 - n0):.3g} {unit}"


def table(kind: str, points: list[tuple[int, Facts]]) -> str:
    """Rows of Markdown, the laws last."""
    names = list(points[0][1])
    rows = [[kind, *names], ["---"] * (len(names) + 1)]
    rows += [[f"{n:,}", *(f"{facts[k]:.3g}" for k in names)] for n, facts in points]
    rows.append(["each", *(each(points, k) for k in names)])
    rows.append(["exponent", *(f"{law(points, k):.2f}" for k in names)])
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def plot(path: Path, found: dict[str, list[tuple[int, Facts]]]) -> None:
    """Draws time per sample, and memory, over each count."""
    import matplotlib as mpl
    import matplotlib.pyplot as plt

    mpl.rcParams.update({"svg.hashsalt": "scale", "svg.fonttype": "none", "font.size": 8})
    figure, axes = plt.subplots(2, 5, figsize=(13, 5), layout="constrained")
    for axis in axes.flat[len(found) :]:
        axis.remove()
    for axis, (kind, points) in zip(axes.flat, found.items(), strict=False):
        counts = [n for n, _ in points]
        axis.loglog(counts, [facts["us_per_sample"] for _, facts in points], "o-", ms=3)
        axis.set(title=kind, ylabel="us per sample")
        if counts[-1] < 20 * counts[0]:
            axis.set_xticks(counts, [str(n) for n in counts])
            axis.set_xticks([], minor=True)
        axis.set_ylim(0.1, max(20, *axis.get_ylim()))
        axis.grid(alpha=0.3)
        if not all("memory_mb" in facts for _, facts in points):
            continue
        other = axis.twinx()
        other.loglog(counts, [facts["memory_mb"] for _, facts in points], "s--", color="C1", ms=3)
        other.set_ylim(1, 16_000)
        other.set_ylabel("MB", color="C1")
    figure.savefig(path, metadata={"Date": None})


def main() -> None:
    """Prints a table for each kind, or JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--most", type=float, default=math.inf, help="largest count that is tried")
    parser.add_argument("--point", nargs=2, metavar=("KIND", "COUNT"), help="measure one, here")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--keep", type=Path, help="JSON file for what is found")
    parser.add_argument("--kept", type=Path, help="such a file, instead of measuring")
    parser.add_argument("--plot", type=Path, help="picture of the laws")
    arguments = parser.parse_args()
    if arguments.point:
        kind, count = arguments.point
        print(json.dumps(KINDS[kind][0](int(count))))
        return
    found: dict[str, list[tuple[int, Facts]]] = {}
    if arguments.kept:
        found = json.loads(arguments.kept.read_text())
    for kind in arguments.only if not found else ():
        counts = [n for n in KINDS[kind][1] if n <= arguments.most]
        points = [(n, facts) for n in counts if (facts := measure(kind, n)) is not None]
        if not points:
            continue
        found[kind] = points
        if not arguments.json:
            print(table(kind, points), flush=True)
            print()
    if arguments.json:
        print(json.dumps(found, indent=2))
    if arguments.keep:
        arguments.keep.write_text(json.dumps(found, indent=1) + "\n")
    if arguments.plot:
        plot(arguments.plot, found)


if __name__ == "__main__":
    main()
