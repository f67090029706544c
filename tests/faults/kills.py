"""Kills renders at random instants and resumes them: ``python -m tests.faults.kills --kills 300``.

Each render is a process of its own: a fork of this one, which has loaded the program and drawn
nothing. Half of the kills come at any instant, half while a file is being written. After each, all
files that are there under their final names must open, and a checkpoint must hold all but one
interval of what was drawn. When the picture is complete, it must have the bits of one that nobody
disturbed, and nothing may lie beside it.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

from .scene import write_scene

ONE = ["--camera", "left", "--res", "48x32", "--sky", "1,0.9,0.8"]
SHOT = ["--sensor", "ideal", "--exposure-f-stop", "4", "--exposure-time", "1/50", "--iso", "100"]

#: Words of the command line by kind of render.
KINDS: dict[str, list[str]] = {
    "plain": [*ONE, "--spp", "48", "-o", "a.exr", "-o", "a.png", "--shutter", "0"],
    "adaptive": [*ONE, "--noise", "0.03", "--spp", "256", "-o", "a.exr", "--shutter", "0"],
    "motion": [*ONE, "--spp", "40", "-o", "a.exr", "--shutter-angle", "180", "--aov", "depth"],
    "rig": [*ONE[2:], "--camera", "left,right", "--spp", "20", "-o", "a.exr", "-o", "a.jpg"],
    "sequence": [*ONE, "--frames", "0-2", "--spp", "14", "-o", "a.##.exr", "-o", "a.##.png"],
    "flare": [
        *ONE, "--lens", "double-gauss-50mm-f2", "--flare", "20000", "--spp", "24", "-o", "a.exr",
    ],
    "sensor": [*ONE, *SHOT, "--spp", "40", "-o", "a.exr", "-o", "a.dng", "--shutter", "0"],
}  # fmt: skip

#: Length of a pass while kills are tried, s: passes of one sample, so many checkpoints.
PASS_S = 0.002


@dataclass
class Count:
    """Numbers of what happened with renders of a kind."""

    kills: int = 0
    within_saves: int = 0
    complete: int = 0
    resumed: int = 0
    left: int = 0
    most_left: int = 0
    lost: Counter[int] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)


def main(words: list[str] | None = None) -> int:
    """Runs the kills, prints a table; 1 if anything was broken."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", default=",".join(KINDS))
    given = parser.parse_args(words)
    kinds = given.kinds.split(",")
    chance = random.Random(given.seed)
    os.environ["SOURCE_DATE_EPOCH"] = "0"  # the date of a file is no part of its picture
    _load()
    faults = 0
    for i, kind in enumerate(kinds):
        kills = given.kills // len(kinds) + (i < given.kills % len(kinds))
        with TemporaryDirectory() as folder:
            count = Trial(Path(folder), KINDS[kind], chance).run(kills)
        faults += len(count.faults)
        print(
            f"{kind}: {count.kills} kills, {count.within_saves} within a save, "
            f"{count.resumed} resumed, {count.complete} pictures complete with the same bits, "
            f"passes lost {dict(sorted(count.lost.items()))}, temporary files at most "
            f"{count.most_left}, at the end {count.left}, faults {len(count.faults)}",
            flush=True,
        )
        for fault in count.faults:
            print(f"  {fault}", flush=True)
    return int(faults > 0)


def _load() -> None:
    """Loads what a render needs, so that forks begin at once; starts no thread."""
    import numpy as np  # noqa: F401
    import OpenEXR  # noqa: F401
    import OpenImageIO  # noqa: F401
    import tifffile  # noqa: F401

    import daguerre.rendering.session
    import daguerre.setup.camera  # noqa: F401
    from daguerre.cli import _command

    _command("render")


class Trial:
    """Renders of one kind in a folder, killed and resumed."""

    def __init__(self, folder: Path, words: list[str], chance: random.Random) -> None:
        self.scene = write_scene(folder / "s.glb")
        self.words = ["render", str(self.scene), *words, "--checkpoint", "1us", "--json-progress"]
        self.whole, self.out, self.log = (folder / name for name in ("whole", "out", "log"))
        self.whole.mkdir()
        self.out.mkdir()
        self.chance, self.count = chance, Count()
        # Twice: the first one fills the cache of lenses, the second one tells how long it takes.
        for _ in range(2):
            began = time.monotonic()
            if self._wait(self._start(self.whole, resume=False)) != 0:
                raise SystemExit(self.log.read_text())
        self.seconds = time.monotonic() - began
        self.wanted = {path.name: path.read_bytes() for path in self.whole.iterdir()}

    def run(self, kills: int) -> Count:
        """Kills that often, and completes the last picture."""
        resume = False
        while self.count.kills < kills:
            process = self._start(self.out, resume=resume)
            self.count.resumed += resume
            within = self._strike(process)
            resume = self._wait(process) == -signal.SIGKILL
            if resume:
                self.count.kills += 1
                self.count.within_saves += within
                self._after_a_kill()
            else:
                self._complete()
        if resume:
            self.count.resumed += 1
            self._wait(self._start(self.out, resume=True))
            self._complete()
        return self.count

    def _start(self, folder: Path, *, resume: bool) -> int:
        return _forked(lambda: self._render(folder, resume=resume), self.log)

    def _render(self, folder: Path, *, resume: bool) -> int:
        from daguerre.cli import main as program
        from daguerre.cli import progress
        from daguerre.rendering import loop

        loop.PASS_S = PASS_S
        progress.JsonLines.period_s = 0.0
        os.chdir(folder)
        return program([*self.words, *(["--resume"] if resume else [])])

    def _wait(self, process: int) -> int:
        return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])

    def _strike(self, process: int) -> bool:
        """Kills it at some instant; whether a file was being written then."""
        end = time.monotonic() + self.chance.uniform(0, self.seconds)
        if self.chance.random() < 0.5:
            time.sleep(max(end - time.monotonic(), 0))
        else:  # the first save after that instant, and some way into it
            while (time.monotonic() < end or not self._temporary()) and _lives(process):
                time.sleep(0.0001)
            time.sleep(self.chance.choice((0.0, 0.0005, 0.001, 0.002, 0.004)))
        # A process that has ended but was not waited for keeps its number.
        os.kill(process, signal.SIGKILL)
        return bool(self._temporary())

    def _temporary(self) -> list[str]:
        with os.scandir(self.out) as entries:
            return [entry.name for entry in entries if ".tmp" in entry.name]

    def _after_a_kill(self) -> None:
        left = len(self._temporary())
        self.count.most_left = max(self.count.most_left, left)
        if left > 3:
            self.count.faults.append(f"{left} temporary files piled up")
        events = _events(self.log)
        report = self.log.with_name("report")
        if _code(lambda: _check(self.out, events), report) != 0:
            self.count.faults.append(report.read_text()[-2000:])
            return
        self.count.lost[int(report.read_text().split()[-1])] += 1

    def _complete(self) -> None:
        there = {path.name: path.read_bytes() for path in self.out.iterdir()}
        if there.keys() != self.wanted.keys():
            names = sorted(there), sorted(self.wanted)
            self.count.faults.append(f"files {names[0]}, wanted {names[1]}: {self.log.read_text()}")
        else:
            different = [name for name in there if not self._same(name, there[name])]
            self.count.faults += [f"{name} has other bits" for name in different]
            self.count.complete += not different
        self.count.left += len(self._temporary())
        for path in self.out.iterdir():
            path.unlink()

    def _same(self, name: str, data: bytes) -> bool:
        return data == self.wanted[name]


def _forked(work: Callable[[], int], said: Path) -> int:
    """Starts a process that does some work; what it says goes to a file."""
    sys.stdout.flush()
    process = os.fork()
    if process:
        return process
    try:
        file = os.open(said, os.O_CREAT | os.O_TRUNC | os.O_WRONLY, 0o666)
        os.dup2(file, 1)
        os.dup2(file, 2)
        code = work()
    except BaseException as error:
        print(f"{type(error).__name__}: {error}")
        code = 99
    sys.stdout.flush()
    os._exit(code)


def _code(work: Callable[[], int], said: Path) -> int:
    return os.waitstatus_to_exitcode(os.waitpid(_forked(work, said), 0)[1])


def _lives(process: int) -> bool:
    return os.waitid(os.P_PID, process, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None


def _events(log: Path) -> list[dict[str, object]]:
    """Progress that a killed render told; its last line may be cut."""
    events = []
    for line in log.read_text().splitlines():
        try:
            events.append(json.loads(line))
        except ValueError:
            break
    return events


def _check(folder: Path, events: list[dict[str, object]]) -> int:
    """Opens all that is there, and prints how many complete passes the checkpoint lacks."""
    import OpenEXR
    import OpenImageIO as oiio
    import tifffile

    from daguerre.rendering.passes import read_pass

    kept: dict[Path, float] = {}
    for path in folder.iterdir():
        if ".tmp" in path.name:
            continue
        if path.name.endswith(".checkpoint.exr"):
            found = read_pass(path)
            kept[path] = found.round.samples() if found.round else float(found.ranges[0][1])
        elif path.suffix == ".exr":
            with OpenEXR.File(str(path)) as file:
                assert file.channels()
        elif path.suffix == ".dng":
            with tifffile.TiffFile(path) as tiff:
                for page in tiff.pages:
                    assert page.asarray().size  # type: ignore[union-attr]
        else:
            picture = oiio.ImageInput.open(str(path))
            assert picture is not None, f"{path.name} does not open"
            assert picture.read_image(oiio.UINT8) is not None, f"{path.name}: {picture.geterror()}"
    saves = [(i, e) for i, e in enumerate(events) if e["event"] == "checkpoint"]
    done = [i for i, e in enumerate(events) if e["event"] == "done"]
    last_done = done[-1] if done else -1
    lost = 0
    for i, event in saves[-1:]:
        if i < last_done:
            continue
        assert kept, f"{event['path']} was saved and is gone"
        samples = max(kept.values())
        told = float(event["samples"])  # type: ignore[arg-type]
        assert samples >= told - 1e-6, f"the checkpoint holds {samples} samples of {told}"
        drawn = {e["samples"] for e in events[i:] if e["event"] == "progress"}
        lost = sum(float(n) > samples + 1e-6 for n in drawn)  # type: ignore[arg-type]
        assert lost <= 1, f"{lost} passes lost"
    print(lost)
    return 0


if __name__ == "__main__":
    sys.exit(main())
