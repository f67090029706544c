"""Real processes on networks of their own: whatever dies, the bits are those of one machine."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre import cli
from tests.faults.scene import write_scene

from .farm import PYTHON, Farm, certificates, has_namespaces, listening, on_networks

pytest.importorskip("distributed", reason="needs the extra cluster")
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("cluster")]
NAMES = ["w1", "w2", "w3"]
WITH_ALL = [
    *("--lens", "double-gauss-50mm-f2", "--light-paths", "1", "--shutter", "1/25"),
    *("--shutter-type", "electronic", "--time", "0.5", "--res", "240x160"),
]
RENDERS = {
    "everything": [*WITH_ALL, "--spp", "768"],
    "noise": [*WITH_ALL, "--noise", "0.00002", "--spp", "8192"],
}


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_scene(tmp_path_factory.mktemp("scene") / "scene.glb")


@pytest.fixture(scope="module")
def keys(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, Path]:
    if shutil.which("openssl") is None:
        pytest.skip("needs openssl")
    return certificates(tmp_path_factory.mktemp("keys"))


def flags(keys: tuple[Path, Path, Path]) -> list[str]:
    """Flags of certificates."""
    return [
        str(one) for pair in zip(("--ca", "--cert", "--key"), keys, strict=True) for one in pair
    ]


def farm_file(farm: Farm, keys: tuple[Path, Path, Path]) -> Path:
    """File that tells a render how to reach a cluster."""
    path = farm.folder / "farm.yaml"
    ca, cert, key = keys
    path.write_text(f"address: {farm.address}\nca: {ca}\ncert: {cert}\nkey: {key}\n")
    return path


@pytest.fixture
def networks(tmp_path: Path, keys: tuple[Path, Path, Path]) -> Iterator[Farm]:
    if not has_namespaces():
        pytest.skip("needs root and ip, to make network namespaces")
    farm = Farm(tmp_path, f"dg{os.getpid()}-", flags(keys))
    with on_networks(farm, NAMES):
        farm.scheduler()
        for name in NAMES:
            farm.worker(name)
        try:
            yield farm
        finally:
            farm.close()


@pytest.fixture
def farm(tmp_path: Path) -> Iterator[Farm]:
    made = Farm(tmp_path)
    made.scheduler()
    for name in ("w1", "w2"):
        made.worker(name)
    try:
        yield made
    finally:
        made.close()


def serial(file: Path, words: list[str], folder: Path) -> dg.Frame:
    """Picture of one machine."""
    assert cli.main(["render", str(file), *words, "-q", "-o", str(folder / "alone.exr")]) == 0
    return dg.load_frame(folder / "alone.exr")


@pytest.mark.parametrize("what", RENDERS)
def test_one_is_killed_one_is_cut_off_one_is_slow(
    networks: Farm, keys: tuple[Path, Path, Path], file: Path, tmp_path: Path, what: str
) -> None:
    words, out = RENDERS[what], tmp_path / "many.exr"
    cluster = ["--cluster", str(farm_file(networks, keys))]
    log = tmp_path / "render.log"
    command = networks.command("hub", ["render", file, *words, "-o", out, *cluster])
    with log.open("wb") as to:
        render = subprocess.Popen(command, stderr=to)
    over = threading.Event()
    slow = threading.Thread(target=networks.slow, args=("w3", over))
    try:
        time.sleep(12)
        slow.start()
        networks.kill("w1")
        networks.cut("w2", 20)
        assert render.wait(600) == 0, log.read_text()
    finally:
        render.kill()
        over.set()
        slow.join()
    assert "is gone; its tasks are drawn again elsewhere" in log.read_text()
    found, alone = dg.load_frame(out), serial(file, words, tmp_path)
    assert np.array_equal(found.rgb, alone.rgb)
    assert np.array_equal(found.variance, alone.variance, equal_nan=True)


def test_strangers_are_refused(networks: Farm, file: Path, tmp_path: Path) -> None:
    others = certificates(tmp_path / "others", "other")
    bare = networks.address.replace("tls://", "tcp://")
    wrong = farm_file(networks, others)
    for cluster in ([bare, "--insecure-cluster"], [str(wrong)]):
        words = ["render", file, "-o", tmp_path / "a.exr", "--cluster", *cluster]
        began = time.monotonic()
        done = subprocess.run(
            networks.command("hub", words), capture_output=True, text=True, check=False
        )
        assert done.returncode == 3, done.stderr
        assert time.monotonic() - began < 20
        assert "cluster: cannot reach" in done.stderr
        assert "Traceback" not in done.stderr


def test_all_listen_on_this_machine_alone(farm: Farm, file: Path, tmp_path: Path) -> None:
    out = tmp_path / "a.exr"
    words = ["render", str(file), "--res", "24x16", "--spp", "4", "-q", "-o", str(out)]
    assert cli.main([*words, "--cluster", farm.address]) == 0
    for name, process in farm.running.items():
        assert listening(process.pid) == {"127.0.0.1"}, name


@pytest.mark.parametrize(
    ("away", "said"), [(3, "its tasks are drawn again elsewhere"), (15, "lost the scheduler")]
)
def test_the_scheduler_is_started_again(
    farm: Farm, file: Path, tmp_path: Path, away: float, said: str
) -> None:
    words = ["--res", "240x160", "--spp", "1500", "--light-paths", "1"]
    out = tmp_path / "many.exr"
    with (tmp_path / "render.log").open("wb") as log:
        render = subprocess.Popen(
            [*PYTHON, "render", file, *words, "-o", out, "--cluster", farm.address], stderr=log
        )
    time.sleep(10)
    assert render.poll() is None, (tmp_path / "render.log").read_text()
    farm.kill("hub")
    time.sleep(away)
    farm.scheduler()
    assert render.wait(600) == 0, (tmp_path / "render.log").read_text()
    assert said in (tmp_path / "render.log").read_text()
    assert np.array_equal(dg.load_frame(out).rgb, serial(file, words, tmp_path).rgb)


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_a_client_that_ends_is_resumed_with_or_without_a_cluster(
    farm: Farm, file: Path, tmp_path: Path, how: int
) -> None:
    words = ["--res", "240x160", "--spp", "1500", "--light-paths", "1", "--checkpoint", "3"]
    out = tmp_path / "many.exr"
    first = [*PYTHON, "render", str(file), *words, "-o", str(out), "--cluster", farm.address]
    render = subprocess.Popen(first, stderr=subprocess.PIPE)
    kept = out.with_suffix(".checkpoint.exr")
    end = time.monotonic() + 200
    while not kept.exists():
        assert time.monotonic() < end
        time.sleep(0.2)
    render.send_signal(how)
    _, said = render.communicate()
    if how == signal.SIGINT:
        assert render.returncode == 75
        assert b"--resume" in said
        assert b"--cluster" in said
    assert kept.exists()
    assert not out.exists()
    assert cli.main(["render", str(file), *words, "-q", "-o", str(out), "--resume"]) == 0
    assert np.array_equal(dg.load_frame(out).rgb, serial(file, words, tmp_path).rgb)
