"""The reader of EXR has the bits of OpenEXR's own, and outlives decoders that crash or hang."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

import daguerre as dg
from daguerre.errors import InputError
from daguerre.pictures import decoder_program
from daguerre.pictures.exr import apart, parts
from daguerre.pictures.exr.layout import COMPRESSIONS
from daguerre.pictures.exr.reader import ExrReader
from tests.bad_files.exr_files import READ

SIZE = (75, 43)  # no multiple of any chunk
KINDS = [name for name, _ in COMPRESSIONS]


def write(path: Path, compression: str, dtype: str, tile: int = 0) -> dict[str, np.ndarray]:
    """Writes smooth light with some noise; returns what OpenEXR itself reads."""
    rng = np.random.default_rng(5)
    smooth = np.sin(np.arange(SIZE[1]) / 9)[None] + np.cos(np.arange(SIZE[0]) / 5)[:, None] + 2.5
    planes = {c: (smooth + 0.1 * rng.random(SIZE)).astype(dtype) for c in "ABGR"}
    name = "NO" if compression == "NONE" else compression
    header = {
        "compression": getattr(OpenEXR, f"{name}_COMPRESSION"),
        "type": OpenEXR.tiledimage if tile else OpenEXR.scanlineimage,
    }
    if tile:
        header["tiles"] = OpenEXR.TileDescription()
        header["tiles"].xSize = header["tiles"].ySize = tile
    with OpenEXR.File(header, planes) as file:
        file.write(str(path))
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {name: c.pixels.copy() for name, c in file.channels().items()}


@pytest.mark.parametrize("dtype", ["float16", "float32"])
@pytest.mark.parametrize("tile", [0, 32])
@pytest.mark.parametrize("kind", KINDS)
def test_bits_are_those_of_openexr(tmp_path: Path, kind: str, tile: int, dtype: str) -> None:
    wanted = write(tmp_path / "a.exr", kind, dtype, tile)
    with ExrReader(tmp_path / "a.exr") as reader:
        found = reader.rows(0, SIZE[0])
    assert set(found) == set(wanted)
    for name, plane in wanted.items():
        assert found[name].dtype == dtype
        assert found[name].tobytes() == plane.tobytes(), name


def test_sums_of_differences_go_on_through_a_large_block(tmp_path: Path) -> None:
    noise = np.random.default_rng(2).random((19, 9001)).astype("f4")
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"Y": np.sqrt(noise).round(2)}) as file:
        file.write(str(tmp_path / "a.exr"))
    with ExrReader(tmp_path / "a.exr") as reader:
        np.testing.assert_array_equal(reader.rows(0, 19)["Y"], np.sqrt(noise).round(2))


def test_facts_of_other_types_are_none(tmp_path: Path) -> None:
    (tmp_path / "a.exr").write_bytes(READ["facts of other types"].data())
    frame = dg.load_frame(tmp_path / "a.exr")
    assert set(frame.metadata) == {"resolution", "crop", "pixelAspectRatio", "notes"}
    assert "wanted 8 numbers" in frame.metadata["notes"][0]
    assert frame.bad_samples == (0, [])
    assert (frame.rgb == 1).all()


@pytest.mark.parametrize("kind", ["NONE", "ZIP", "PIZ"])
@pytest.mark.parametrize("tile", [0, 32])
def test_bands_of_any_size_make_up_the_picture(tmp_path: Path, kind: str, tile: int) -> None:
    wanted = write(tmp_path / "a.exr", kind, "float32", tile)["G"]
    with ExrReader(tmp_path / "a.exr") as reader:
        for size in (1, 7, 16, 50):
            cuts = [(a, min(a + size, SIZE[0])) for a in range(0, SIZE[0], size)]
            bands = [reader.rows(*cut, ["G"])["G"] for cut in cuts]
            np.testing.assert_array_equal(np.concatenate(bands), wanted)
        np.testing.assert_array_equal(reader.rows(20, 30)["G"], wanted[20:30])


def test_threads_share_no_state(tmp_path: Path) -> None:
    wanted = write(tmp_path / "a.exr", "PIZ", "float16")["R"]
    found: list[np.ndarray] = []

    def read() -> None:
        with ExrReader(tmp_path / "a.exr") as reader:
            found.append(reader.rows(0, SIZE[0])["R"])

    threads = [threading.Thread(target=read) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [plane.tobytes() for plane in found] == [wanted.tobytes()] * 4


def other_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str) -> Path:
    """A file for the decoder, and another program in the decoder's place."""
    write(tmp_path / "a.exr", "PIZ", "float16")
    (tmp_path / "program.py").write_text(text)
    monkeypatch.setattr(decoder_program, "__file__", str(tmp_path / "program.py"))
    return tmp_path / "a.exr"


@pytest.mark.parametrize("ending", [signal.SIGSEGV, signal.SIGABRT])
def test_a_crash_of_the_decoder_is_one_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ending: signal.Signals
) -> None:
    crash = f"import os\nos.kill(os.getpid(), {int(ending)})"
    path = other_program(tmp_path, monkeypatch, crash)
    with ExrReader(path) as reader, pytest.raises(InputError, match=f"PIZ pixels.*{ending.name}"):
        reader.rows(0, 4)


def test_a_decoder_without_an_end_is_stopped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(apart, "PATIENCE", 0.2)
    path = other_program(tmp_path, monkeypatch, "while True:\n    pass")
    with ExrReader(path) as reader, pytest.raises(InputError, match="took longer than"):
        reader.rows(0, 4)


def test_a_decoder_that_lies_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    other = tmp_path / "other.exr"
    OpenEXR.File({"compression": OpenEXR.NO_COMPRESSION}, {"R": np.ones((4, 4), "f4")}).write(
        str(other)
    )
    lie = f"import shutil, sys\nshutil.copy({str(other)!r}, sys.argv[3])"
    path = other_program(tmp_path, monkeypatch, lie)
    with (
        ExrReader(path) as reader,
        pytest.raises(InputError, match="the decoded copy differs from the file"),
    ):
        reader.rows(0, 4)


def test_more_than_the_free_memory_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(tmp_path / "a.exr", "ZIP", "float32")
    monkeypatch.setattr(parts, "_SMALL", 0)
    monkeypatch.setattr(parts, "free_bytes", lambda: 4000)
    with ExrReader(tmp_path / "a.exr") as reader:
        with pytest.raises(InputError, match="wanted at most the free memory, 4 kB"):
            reader.rows(0, SIZE[0])
        reader.rows(0, 1)


def test_the_libraries_stay_out_of_this_process(tmp_path: Path) -> None:
    """Neither OpenEXR nor OpenImageIO is imported to read, whatever the compression."""
    for kind in ("ZIP", "PIZ"):
        path = tmp_path / f"{kind}.exr"
        write(path, kind, "float16")
        words = (
            "import sys, daguerre; daguerre.load_frame(sys.argv[1]); "
            "sys.exit('OpenEXR' in sys.modules or 'OpenImageIO' in sys.modules)"
        )
        assert subprocess.run([sys.executable, "-c", words, str(path)], check=False).returncode == 0
