"""Readers of files in Python under good files that were changed at random.

    python -m tests.fuzz.readers [--seconds 60] [--seed 1] [--keep FOLDER] [NAME...]

Each reader works in a process of its own. What it may do with a file: use it, or refuse it by one
``DaguerreError``, within 10 s of CPU time and 1 GB. All else is a fault: the file is kept, and the
exit code is 1. The same seed changes the same files in the same way.
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

LIMIT_S, LIMIT_MB = 10.0, 1000.0
HANGS_S = 120.0  # of the clock: the machine may have other work
ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Reader:
    """A kind of file.

    Attributes:
        seeds: Name in :mod:`tests.fuzz.seeds` of what gives good files.
        use: Name in :mod:`tests.fuzz.uses` of what reads one and uses it.
    """

    seeds: str
    use: str


READERS = {
    "gltf": Reader("scenes", "scene"),
    "packed": Reader("packed", "scene"),
    "exact": Reader("exact", "scene"),
    "lenses": Reader("lenses", "lens"),
    "exr": Reader("exrs", "exr"),
    "pass": Reader("passes", "samples"),
    "calibration": Reader("calibrations", "calibrated"),
    "json": Reader("recipes", "recipe"),
    "picture": Reader("pictures", "picture"),
    "profile": Reader("profiles", "profile"),
    "ply": Reader("plys", "mesh"),
    "mesh": Reader("meshes", "mesh"),
    "grid": Reader("grids", "grid"),
    "rare": Reader("rares", "texture"),
    "raw": Reader("raws", "raw"),
    "exif": Reader("tagged", "picture"),
    "pbrt": Reader("pbrts", "drawn"),
    "mitsuba": Reader("mitsubas", "drawn"),
    "usda": Reader("usdas", "drawn"),
    "usdc": Reader("usdcs", "drawn"),
    "usdz": Reader("usdzs", "drawn"),
    "cluster": Reader("answers", "answered"),
    "viewfinder": Reader("requests", "requested"),
}


def changed(rng: Random, name: str, data: bytes) -> bytes:
    """A file changed as its format allows, by its name."""
    from . import changes, container_changes

    suffix = Path(name).suffix
    if suffix in (".ply", ".serialized", ".vol", ".nvdb", ".dng") and rng.random() < 0.7:
        return changes.in_part(rng, data)
    if name.startswith(("tagged", "packet")) and rng.random() < 0.8:
        return container_changes.in_metadata(rng, data)
    if name.startswith("rare") and rng.random() < 0.7:
        return changes.in_part(rng, data)
    if suffix == ".usdc" and rng.random() < 0.8:
        return container_changes.in_crate(rng, data)
    if suffix == ".usdz" and rng.random() < 0.8:
        return container_changes.in_package(rng, data)
    if suffix == ".answer":
        return container_changes.in_answer(rng, data)
    if rng.random() < 0.1:
        return changes.in_bytes(rng, data)
    if name == "exact.glb":
        return changes.in_exact(rng, data)
    if suffix == ".glb":
        return changes.in_glb(rng, data, 0.8 if name == "packed.glb" else 0.2)
    if suffix == ".png":
        return changes.in_png(rng, data)
    try:
        text = data.decode()
    except UnicodeDecodeError:
        return changes.in_bytes(rng, data)
    if suffix == ".xml" and rng.random() < 0.5:
        return changes.in_attributes(rng, text).encode("utf-8", "surrogatepass")
    if suffix in (".json", ".gltf") and rng.random() < 0.8:
        try:
            return changes.dumped(rng, changes.in_tree(rng, json.loads(text)))
        except ValueError:  # a value in each line
            pass
    return changes.in_text(rng, text).encode("utf-8", "surrogatepass")


@dataclass
class Found:
    """Counts of one reader, the slowest file (s), the most memory beside the program's own (MB)."""

    tried: int = 0
    accepted: int = 0
    slowest: float = 0.0
    most: float = 0.0


def work(name: str, seed: int, begin: int, seconds: float, most: int, folder: Path) -> None:
    """Reads files until time is up; a line of JSON for each tells how far it came."""
    from daguerre.errors import DaguerreError

    from . import seeds, uses

    reader = READERS[name]
    goods = list(getattr(seeds, reader.seeds)(folder))
    use: Callable[[Path], Any] = getattr(uses, reader.use)
    end = time.monotonic() + seconds
    for number in range(begin, begin + most):
        if time.monotonic() > end:
            break
        rng = Random(f"{name} {seed} {number}")
        file, data = rng.choice(goods)
        path = folder / f"case-{file}"
        tried = changed(rng, file, data) if number >= len(goods) else goods[number][1]
        path.write_bytes(tried)
        before, started = _peak_mb(reset=True), time.process_time()
        faulthandler.dump_traceback_later(HANGS_S, exit=True)
        accepted = True
        print(json.dumps({"number": number, "file": path.name}), flush=True)
        try:
            use(path)
        except DaguerreError as error:
            accepted = False
            if "\n" in str(error).strip() or len(str(error)) > 4000:
                raise RuntimeError(f"not one line: {str(error)[:200]!r}") from error
        faulthandler.cancel_dump_traceback_later()
        took, memory = time.process_time() - started, _peak_mb() - before
        path.unlink(missing_ok=True)
        print(json.dumps({"accepted": accepted, "s": took, "mb": memory}), flush=True)
        if took > LIMIT_S or memory > LIMIT_MB:
            path.write_bytes(tried)
            raise RuntimeError(f"it took {took:.1f} s and {memory:.0f} MB")


def _peak_mb(*, reset: bool = False) -> float:
    """The most memory since it was reset, MB."""
    if reset:
        try:
            Path("/proc/self/clear_refs").write_text("5")
        except OSError:
            return 0.0
    status = Path("/proc/self/status").read_text()
    return float(status.split("VmHWM:")[1].split()[0]) / 1024


def run(
    name: str, seconds: float, seed: int = 1, keep: Path | None = None, most: int = 1 << 40
) -> tuple[Found, list[str]]:
    """Runs one reader, anew after each fault.

    Args:
        name: One of :data:`READERS`.
        seconds: Time for it.
        seed: Chooses files and changes.
        keep: Folder for files at which it was at fault.
        most: Files that are tried at most.

    Returns:
        Counts, and a text for each fault.
    """
    found, faults, next_ = Found(), [], 0
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0 and next_ < most and len(faults) < 20:
        with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
            words = [name, seed, next_, left, most - next_, folder]
            run_ = subprocess.run(
                [sys.executable, "-m", "tests.fuzz.readers", "--work", json.dumps(words)],
                cwd=ROOT,
                capture_output=True,
                text=True,
                errors="replace",
                check=False,
            )
            last = None
            for line in _lines(run_.stdout):
                if "number" in line:
                    last, next_ = line, line["number"] + 1
                    found.tried += 1
                else:
                    found.accepted += line["accepted"]
                    found.slowest = max(found.slowest, line["s"])
                    found.most = max(found.most, line["mb"])
            if run_.returncode == 0:
                break
            if last is None:
                raise RuntimeError(f"{name}: no file was read:\n{run_.stderr}")
            said = run_.stderr.strip().splitlines() or ["nothing was said"]
            faults.append(f"{name} {seed} {last['number']} {last['file']}: {said[-1][:300]}")
            if keep is not None and (file := Path(folder, last["file"])).exists():
                keep.mkdir(parents=True, exist_ok=True)
                (keep / f"{name}-{seed}-{last['number']}-{last['file']}").write_bytes(
                    file.read_bytes()
                )
                (keep / f"{name}-{seed}-{last['number']}.txt").write_text(run_.stderr)
    return found, faults


def _lines(text: str) -> Iterator[dict[str, Any]]:
    for line in text.splitlines():
        if line.startswith("{"):
            yield json.loads(line)


def main() -> int:
    """Prints a line for each reader, and one for each fault."""
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, default=ROOT / "build" / "fuzz" / "found")
    parser.add_argument("--work", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.work:
        *words, folder = json.loads(given.work)
        work(*words, Path(folder))
        return 0
    failed = 0
    for name in given.names or READERS:
        found, faults = run(name, given.seconds, given.seed, given.keep)
        print(
            f"fuzz: {name}: {found.tried} files, {found.accepted} accepted, "
            f"{found.tried - found.accepted - len(faults)} refused, {len(faults)} faults; slowest "
            f"{found.slowest:.2f} s, most {found.most:.0f} MB"
        )
        for fault in faults:
            print(f"  {fault}")
        failed |= bool(faults)
    return failed


if __name__ == "__main__":
    sys.exit(main())
