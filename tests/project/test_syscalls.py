"""Renders ask the system for their own files alone: no other open, no connection, no program.

Measured by strace over the catalogue of bad files and good scenes (docs/threat-model.md).
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from tests.bad_files import CASES
from tests.bad_files.bases import full, moving, seen
from tests.support.formats.make_gltf import png

STRACE = shutil.which("strace")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(STRACE is None, reason="needs strace (apt-get install strace)"),
]
ROOT = Path(__file__).resolve().parents[2]
CALLS = "open,openat,openat2,creat,connect,sendto,bind,listen,execve,execveat"
#: Programs that Daguerre starts: decoders of rare pictures and EXRs, and the helper process.
OURS = ("pictures/decoder_program.py", "apart/child.py")
CALL = re.compile(r"^\d+\s+(?P<name>\w+)\((?P<arguments>.*)\)\s+=\s+(?P<result>-?\d+)")
#: Runs many command lines in one process, after everything that they import.
PROGRAM = """
import json, sys
from daguerre.cli import main
codes = [main(words) for words in json.load(open(sys.argv[1]))]
json.dump(codes, open(sys.argv[1] + ".codes", "w"))
"""


def system_folders() -> list[str]:
    """The package, the interpreter, packages and libraries, and what the kernel tells."""
    own = [
        sys.prefix,
        sys.base_prefix,
        *sysconfig.get_paths().values(),
        Path(dg.__file__).parents[1],
    ]
    packages = [Path(np.__file__).parents[1]]
    fixed = ["/proc", "/sys", "/dev/shm", "/lib", "/lib64", "/usr/lib", "/usr/share", "/usr/local"]
    small = [
        "/etc/ld.so.cache",
        "/etc/localtime",
        "/etc/ssl/openssl.cnf",
        "/etc/locale.alias",
        "/dev/null",
        "/dev/urandom",
        "/usr/bin/pyvenv.cfg",
    ]
    return [os.path.realpath(p) for p in (*own, *packages)] + [str(p) for p in own] + fixed + small


def traced(jobs: list[list[str]], folder: Path, program: str = PROGRAM) -> list[str]:
    """Lines of strace of a process that runs command lines."""
    (folder / "jobs.json").write_text(json.dumps(jobs))
    log = folder / "calls.txt"
    environment = {
        **os.environ,
        "TMPDIR": str(folder / "tmp"),
        "HOME": str(folder / "home"),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    (folder / "tmp").mkdir(exist_ok=True)
    command = [str(STRACE), "-f", "-qq", "-s", "4096", "-o", str(log), "-e", f"trace={CALLS}"]
    run = [*command, sys.executable, "-c", program, str(folder / "jobs.json")]
    subprocess.run(run, env=environment, cwd=ROOT, capture_output=True, timeout=900, check=False)
    return log.read_text(errors="replace").splitlines()


def refused(lines: list[str], declared: list[Path]) -> list[str]:
    """Calls that are not of a render: opens that succeed elsewhere, connections, programs."""
    allowed = [*system_folders(), *(os.path.realpath(p) for p in declared)]
    found, started = [], False
    for line in lines:
        call = CALL.match(line)
        if call is None:
            continue
        name, arguments = call["name"], call["arguments"]
        if name.startswith("exec"):
            # The first is the process itself.
            if started and not any(f"daguerre/{one}" in arguments for one in OURS):
                found.append(line)
            started = True
        elif name == "sendto" and arguments.endswith("NULL, 0"):
            pass  # along a pair of sockets to a helper; others need a connect, which is found
        elif not name.startswith(("open", "creat")):
            found.append(line)
        elif int(call["result"]) >= 0:
            said = re.search(r'"((?:[^"\\]|\\.)*)"', arguments)
            text = said[1].encode().decode("unicode_escape") if said else "?"
            if text.startswith("/proc/self/fd/"):
                continue  # a file that it holds open, such as a pipe to itself
            path = os.path.realpath(ROOT / text)
            if path != str(ROOT) and not any(
                path == a or path.startswith(a + "/") for a in allowed
            ):
                found.append(line)
    assert started, "strace saw no process"
    return found


def exit_codes(folder: Path) -> list[int]:
    """Exit codes of the command lines of ``traced``."""
    codes: list[int] = json.loads((folder / "jobs.json.codes").read_text())
    return codes


def good_jobs(folder: Path) -> list[list[str]]:
    """Scenes with textures, an environment, lenses, calibrations, passes, raw files and plates."""
    (folder / "t.png").write_bytes(png(np.full((8, 8, 3), 90, np.uint8)))
    textured = seen()
    textured.json["images"] = [{"uri": "t.png"}]
    wall = str(textured.gltf(folder / "wall.gltf"))
    full_, moving_ = (str(make().glb(folder / f"{make.__name__}.glb")) for make in (full, moving))
    camera = str(folder / "camera.yaml")
    small = ("--spp", "1", "--res", "16x9", "--threads", "2")
    lens = ("--lens", "tessar-50mm-f2.8", "--sky", "1,1,1")
    shot = (
        "--sensor",
        "ideal",
        "--exposure-f-stop",
        "4",
        "--exposure-time",
        "1/50",
        "--iso",
        "100",
    )
    made: list[list[str]] = [["calibrate", "tessar-50mm-f2.8", "--res", "64x48", "-o", camera]]

    def draw(scene: str, *words: str, ending: str = "exr") -> str:
        out = str(folder / f"o{len(made)}.{ending}")
        made.append(["render", scene, *small, *words, "-o", out])
        return out

    picture = draw(wall)
    draw(full_, "--sky", "1,1,1")
    draw(moving_, "--sky", "1,1,1", "--time", "0.5")
    draw(wall, "--env", str(folder / "t.png"))
    draw(wall, *lens, "--flare", "auto", "--scatter", "auto")
    draw(wall, "--calibration", camera, "--sky", "1,1,1", "--res", "16x12")
    draw(wall, "--sky", "1,1,1", "--aov", "all", "--cryptomatte", "object", "--checkpoint", "1us")
    draw(wall, "--sky", "1,1,1", ending="png")
    draw(wall, *lens, *shot, "--res", "96x64", ending="dng")
    passes = [
        draw(wall, "--sky", "1,1,1", "--spp", "2", "--samples", part) for part in ("0:1", "1:2")
    ]
    stage = folder / "stage.usda"
    (folder / "ball.usda").write_text('#usda 1.0\ndef Sphere "A"\n{\n}\n')
    stage.write_text("#usda 1.0\n(\n subLayers = [@ball.usda@]\n metersPerUnit = 1\n)\n")
    draw(str(stage), "--sky", "1,1,1")
    raw = next(words[-1] for words in made if words[-1].endswith(".dng"))
    return [
        *made,
        ["merge", *passes, "-o", str(folder / "merged.exr")],
        ["post", picture, "-o", str(folder / "glow.exr"), "--effect", "vignetting:model=natural"],
        ["develop", raw, "-o", str(folder / "raw.jpg")],
        ["info", wall],
        ["lens", "tessar-50mm-f2.8", "--drawing", str(folder / "x.svg")],
        ["composite", picture, passes[0], "-o", str(folder / "composite.exr")],
    ]


def test_good_scenes_stay_in_their_folders(tmp_path: Path) -> None:
    jobs = good_jobs(tmp_path)
    assert refused(traced(jobs, tmp_path), [tmp_path]) == []
    failed = [job for job, code in zip(jobs, exit_codes(tmp_path), strict=True) if code]
    assert failed == []


def test_bad_files_stay_in_their_folders(tmp_path: Path) -> None:
    jobs = []
    for i, case in enumerate(CASES):
        folder = tmp_path / str(i)
        folder.mkdir()
        if "device" in case.name:  # it is refused by its kind, which needs no open
            continue
        bad = case.make(folder)
        jobs.append(case.words(bad, folder / "out"))
    assert refused(traced(jobs, tmp_path), [tmp_path]) == []
    codes = exit_codes(tmp_path)
    assert len(codes) == len(jobs)
    assert {0, 3} <= set(codes) <= {0, 2, 3, 4, 5}


FAULTS = {
    "connect": "import socket; socket.socket().connect_ex(('127.0.0.1', 9))",
    "execve": "import subprocess; subprocess.run(['true'])",
    "open": "open('/etc/passwd').close()",
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_seen(tmp_path: Path, name: str) -> None:
    assert any(name in line for line in refused(traced([], tmp_path, FAULTS[name]), [tmp_path]))


def test_a_link_to_another_file_is_not_followed(tmp_path: Path) -> None:
    """A texture that is a link out of the folder is refused before it is opened."""
    b = seen()
    b.json["images"] = [{"uri": "t.png"}]
    (tmp_path / "t.png").symlink_to("/etc/passwd")
    scene = str(b.glb(tmp_path / "s.glb"))
    job = ["render", scene, "-o", str(tmp_path / "o.exr"), "--spp", "1", "--res", "8x8"]
    assert refused(traced([job], tmp_path), [tmp_path]) == []
    wall = "from daguerre.files import uris; uris.Folder.find = lambda self, uri: self._path(uri)\n"
    without = traced([job], tmp_path, wall + PROGRAM)
    assert any("passwd" in line or "t.png" in line for line in refused(without, [tmp_path]))
