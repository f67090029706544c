"""Examples that stand for front ends: one that watches a file, one of two processes."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from tests.support.formats.make_gltf import Builder

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"


def write_scene(path: Path, red: float) -> None:
    """A glowing square that fills the view of a camera."""
    made = Builder()
    corners = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], np.float32)
    ends = {"min": [-9, -9, 0], "max": [9, 9, 0]}
    attributes = {"POSITION": made.accessor(corners, **ends)}
    glow = made.add("materials", {"emissiveFactor": [red, 0.5, 0.5]})
    indices = made.accessor([0, 1, 2, 0, 2, 3], "u2")
    made.node(mesh=made.mesh(attributes, indices=indices, material=glow), translation=[0, 0, -2])
    made.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01}})
    made.node(camera=0, name="A")
    made.glb(path)


@pytest.mark.parametrize("name", ["watch", "worker"])
def test_they_are_short_and_use_public_names(name: str) -> None:
    text = (EXAMPLES / f"{name}.py").read_text()
    assert len(text.splitlines()) <= 60
    assert all(word in dg.__all__ for word in ("RenderSettings", "merge", "render", "rendering"))
    assert "daguerre.cli" not in text
    assert "_core" not in text


def test_a_watched_file_is_rendered_again(tmp_path: Path) -> None:
    scene, picture = tmp_path / "s.glb", tmp_path / "out" / "s.exr"
    write_scene(scene, 0.25)
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); import watch; "
        "watch.main(sys.argv[2], sys.argv[3], 16, 2, count=2)"
    )
    command = [sys.executable, "-c", code, str(EXAMPLES), str(scene), str(picture)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        guard = threading.Timer(120, process.kill)
        guard.start()
        assert process.stdout is not None
        assert "2 of 2 samples" in process.stdout.readline()
        before = dg.load_frame(picture).rgb
        time.sleep(0.05)  # clocks of some disks are coarse
        write_scene(tmp_path / "new.glb", 1.0)
        (tmp_path / "new.glb").replace(scene)
        assert "2 of 2 samples" in process.stdout.readline()
        assert process.wait() == 0
        guard.cancel()
    after = dg.load_frame(picture).rgb
    assert after[..., 0].mean() == pytest.approx(4 * before[..., 0].mean(), rel=0.02)


def test_two_processes_draw_the_bits_of_one(tmp_path: Path) -> None:
    scene = tmp_path / "s.glb"
    write_scene(scene, 0.25)
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); import worker\n"
        "if __name__ == '__main__': worker.main(sys.argv[2], sys.argv[3], 16, 40)"
    )
    command = [sys.executable, "-c", code, str(EXAMPLES), str(scene), str(tmp_path)]
    paths = os.pathsep.join(filter(None, [str(EXAMPLES), os.environ.get("PYTHONPATH", "")]))
    subprocess.run(command, check=True, timeout=240, env={**os.environ, "PYTHONPATH": paths})
    passes = sorted(tmp_path.glob("pass_*.exr"))
    assert [p.name for p in passes] == ["pass_000000.exr", "pass_000016.exr", "pass_000032.exr"]
    whole = dg.render(dg.load(scene), spp=40, resolution=(16, 9))
    np.testing.assert_array_equal(dg.load_frame(tmp_path / "worker.exr").rgb, whole.rgb)
    with pytest.raises(dg.MismatchError, match="16:32 are missing"):
        dg.merge([passes[0], passes[2]], strict=True)
