"""Rooms lit through windows, by Daguerre and, where installed, by Mitsuba with two samplers.

    python bench/rooms.py --json [--rooms living-room classroom dining-room staircase ajar]
                          [--folder FOLDER] [--w 240] [--h 135] [--spp 64] [--seeds 5]
                          [--reference-spp 2048] [--references build/rooms] [--only daguerre]
                          [--mitsuba-python PYTHON] [--pictures OUT]

``bench/sky_rooms/made.py`` makes the rooms, with textures and skies of 4096 x 2048: an overcast sky
through windows, the sun and a sky, the sun through blinds, 13 area lamps, and a door ajar. Mitsuba
reads the file that ``daguerre export`` writes. ``--folder`` adds public rooms, each as
``NAME/scene.xml`` for Mitsuba 3 (those of Bitterli), which both read: choose them by ``--rooms``,
else all are drawn.

Each renderer's error is relative to its own converged picture R, so that other filters of textures
do not count: (A - R)^2 / (R^2 + 0.01 mean(R)^2), over the colours of a pixel, less the noise that R
itself has. ``mean`` is over the frame, ``typical`` without its worst hundredth, ``median`` the
middle pixel. Figures are medians over the seeds. A score is CPU seconds x error; ``ratio`` is
Daguerre's score over the better of Mitsuba's two samplers, and below 1 Daguerre is faster.
``us_per_sample`` and ``error_of_one_sample`` are the price and the error apart. Set-up and
compilation do not count; their CPU seconds stand beside. Renderers take turns, seed by seed, each
in a process of its own. Converged pictures are kept in ``--references``; each room's answer also
goes to the error stream as soon as it is there.

Pictures of two scenes compare nothing: where Mitsuba's picture is not Daguerre's, within 3 % in
its mean and within 5 % in nine of ten of its blocks, beside their noise, the bench ends with an
error; ``same_picture`` has the differences. Needs mitsuba 3.9.1 in this interpreter or in that of
``--mitsuba-python``; without it, ``skipped`` says so.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import platform
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from peers import can_import, run

HERE = Path(__file__).resolve().parent
SIDES = HERE / "sky_rooms"
sys.path.insert(0, str(HERE / "ajar_door"))

from sky_rooms.figures import OWN, SAMPLERS, Facts, Picture, differences, ratios, row  # noqa: E402
from sky_rooms.made import ROOMS  # noqa: E402

import daguerre as dg  # noqa: E402
from daguerre.frame.picture import Picture as SavedPicture  # noqa: E402

REFERENCE_SEED = 1000
DEPTH = 12  # surfaces of a path


@dataclass
class Room:
    """A room to draw.

    Attributes:
        name: Name in the answer.
        scene: Scene that Daguerre draws: a name of `ROOMS`, or a file.
        file: File that Mitsuba draws.
        key: Tells kept pictures of another version of the room apart.
    """

    name: str
    scene: str
    file: Path
    key: str


class Renderers:
    """Draws pictures in processes.

    Args:
        options: Options of this bench.
        folder: Folder for their files.
    """

    def __init__(self, options: argparse.Namespace, folder: Path) -> None:
        self._options, self._folder = options, folder
        paths = [str(HERE), str(HERE / "ajar_door"), os.environ.get("PYTHONPATH", "")]
        resolved = [str(Path(p).resolve()) for p in os.pathsep.join(paths).split(os.pathsep) if p]
        self._environment = dict(os.environ, PYTHONPATH=os.pathsep.join(resolved))

    def draw(self, name: str, room: Room, spp: int, seed: int) -> tuple[Picture, Facts]:
        """One picture, (H, W, 3), and what its renderer said."""
        options = self._options
        out = self._folder / f"{name}-{seed}"
        values: dict[str, object] = {key: getattr(options, key) for key in ("w", "h", "threads")}
        values |= {"spp": spp, "seed": seed, "out": out, "depth": options.depth}
        if name == OWN:
            command = [sys.executable, str(SIDES / "draw_daguerre.py")]
            values |= {"room": room.scene, "sky": options.sky_width}
        else:
            command = [options.mitsuba_python, str(SIDES / "draw_mitsuba.py")]
            values |= {"room": room.file, "sampler": name.removeprefix("mitsuba_")}
        words = [word for key, value in values.items() for word in (f"--{key}", str(value))]
        said = run([*command, *words], self._environment, str(self._folder))
        return np.load(out.with_suffix(".npy")).astype(np.float64), said

    def reference(self, name: str, room: Room) -> Picture:
        """The converged picture of a renderer, kept in the folder for them."""
        options = self._options
        spp = options.reference_spp
        size = f"{options.w}x{options.h}-{options.depth}-{options.sky_width}"
        kept = options.references / f"{room.name}-{name}-{size}-{spp}-{room.key}.npy"
        if not kept.is_file():
            made, _ = self.draw(name, room, spp, REFERENCE_SEED)
            kept.parent.mkdir(parents=True, exist_ok=True)
            np.save(kept, made)
        found: Picture = np.load(kept)
        return found


def measure(
    room: Room, names: list[str], renderers: Renderers, options: argparse.Namespace
) -> Facts:
    """The rows of a room."""
    drawn: dict[str, tuple[list[Picture], list[Facts]]] = {name: ([], []) for name in names}
    for seed in range(1, options.seeds + 1):
        for name in names if seed % 2 else names[::-1]:
            picture, said = renderers.draw(name, room, options.spp, seed)
            drawn[name][0].append(picture)
            drawn[name][1].append(said)
    _keep_pictures(room, drawn, options.pictures)
    same = {}
    for name in names[1:]:
        same[name] = differences(drawn[OWN][0], drawn[name][0])
        if not same[name]["same"]:
            sys.exit(f"rooms: {room.name}: {name} draws another picture: {json.dumps(same[name])}")
    noise = options.spp / options.reference_spp
    made: Facts = {}
    for name in names:
        # Both samplers of Mitsuba converge to one picture.
        true = renderers.reference(name if name == OWN else f"mitsuba_{SAMPLERS[0]}", room)
        made[name] = row(*drawn[name], true, options.spp, noise)
    if len(names) > 1:
        made["ratio"] = ratios(made)
        made["same_picture"] = same
    return made


def _keep_pictures(room: Room, drawn: dict[str, Any], folder: Path | None) -> None:
    """Means of the seeds as EXR files."""
    if folder is None:
        return
    folder.mkdir(parents=True, exist_ok=True)
    for name, (pictures, _) in drawn.items():
        mean = np.mean(pictures, axis=0).astype(np.float32)
        SavedPicture(mean, "lin_rec709").save(folder / f"{room.name}-{name}.exr")


def made_room(name: str, options: argparse.Namespace, folder: Path, export: bool) -> Room:
    """A room by script, written for Mitsuba."""
    file = folder / name / "scene.xml"
    if export:
        file.parent.mkdir(parents=True, exist_ok=True)
        size = (options.w, options.h)
        dg.export_scene(ROOMS[name](options.sky_width), file, resolution=size, spp=options.spp)
    sources = sorted([*SIDES.glob("*.py"), *(HERE / "ajar_door").glob("*.py")])
    content = b"".join(path.read_bytes() for path in sources if "draw_" not in path.name)
    return Room(name, name, file, hashlib.sha256(content).hexdigest()[:12])


def public_rooms(folder: Path | None) -> dict[str, Room]:
    """Rooms in a folder, by name."""
    if folder is None:
        return {}
    files = sorted(folder.glob("*/scene.xml"))
    if not files:
        sys.exit(f"rooms: --folder: wanted rooms as NAME/scene.xml, got none in {folder}")
    return {
        f"public/{file.parent.name}": Room(
            f"public-{file.parent.name}",
            str(file.resolve()),
            file.resolve(),
            hashlib.sha256(file.read_bytes()).hexdigest()[:12],
        )
        for file in files
    }


def renderers_there(options: argparse.Namespace) -> tuple[list[str], str]:
    """Names of the renderers, and why some are left out."""
    if options.only:
        return [OWN], ""
    if not can_import(options.mitsuba_python, "mitsuba"):
        return [OWN], f"mitsuba: {options.mitsuba_python} cannot import it"
    return [OWN, *(f"mitsuba_{sampler}" for sampler in SAMPLERS)], ""


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--rooms", nargs="+", help="names; those of --folder are public/NAME")
    parser.add_argument("--folder", type=Path, help="public rooms for Mitsuba, NAME/scene.xml each")
    parser.add_argument("--only", choices=(OWN,), help="no peers")
    parser.add_argument("--w", type=int, default=240, help="px")
    parser.add_argument("--h", type=int, default=135, help="px")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--depth", type=int, default=DEPTH, help="surfaces of a path")
    parser.add_argument("--sky-width", type=int, default=4096, help="texels of a made sky")
    parser.add_argument("--reference-spp", type=int, default=2048)
    parser.add_argument("--references", type=Path, default=HERE.parent / "build" / "rooms")
    parser.add_argument("--pictures", type=Path, help="folder for EXR files")
    parser.add_argument("--mitsuba-python", default=sys.executable)
    options = parser.parse_args()
    if options.seeds < 2:
        parser.error(f"--seeds: wanted 2 or more, got {options.seeds}")
    options.references = options.references.resolve()
    return options


def main() -> None:
    """Measures and prints one JSON object."""
    options = arguments()
    public = public_rooms(options.folder)
    chosen = options.rooms or [*ROOMS, *public]
    unknown = [name for name in chosen if name not in ROOMS and name not in public]
    if unknown:
        sys.exit(f"rooms: --rooms: wanted some of {[*ROOMS, *public]}, got {unknown[0]!r}")
    out: Facts = {
        "benchmark": "rooms",
        "resolution": [options.w, options.h],
        "spp": options.spp,
        "reference_spp": options.reference_spp,
        "sky": [options.sky_width, options.sky_width // 2],
        "threads": options.threads,
        "machine": f"{platform.machine()}, {os.cpu_count()} cores",
    }
    names, skipped = renderers_there(options)
    if skipped:
        out["skipped"] = skipped
    with tempfile.TemporaryDirectory() as folder:
        renderers = Renderers(options, Path(folder))
        for name in chosen:
            room = public.get(name) or made_room(name, options, Path(folder), len(names) > 1)
            out[name] = measure(room, names, renderers, options)
            print(f"rooms: {json.dumps({name: out[name]})}", file=sys.stderr, flush=True)
    print(json.dumps(out, indent=1))


if __name__ == "__main__":
    main()
