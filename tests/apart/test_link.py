"""Messages between two processes: large blocks cross as sealed files, others are refused."""

from __future__ import annotations

import fcntl
import gc
import os
import socket
import struct
import sys
import tempfile
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from daguerre.apart import shared
from daguerre.apart.link import ANSWER, DamagedError, Link
from daguerre.checks import as_readonly

SIZE = 3 << 20
LINUX = pytest.mark.skipif(not shared.HAS_FILES, reason="files in memory are Linux's")


@pytest.fixture
def ends() -> Iterator[tuple[socket.socket, socket.socket]]:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        yield ours, theirs


def open_files() -> int:
    return sum(1 for _ in Path("/proc/self/fd").iterdir())


def crossed(ends: tuple[socket.socket, socket.socket], blocks: list[object]) -> list[object]:
    """Blocks after their way."""
    sender = threading.Thread(target=Link(ends[0]).send, args=(ANSWER, blocks))
    sender.start()
    kind, found = Link(ends[1]).receive(lambda: 1e9)
    sender.join()
    assert kind == ANSWER
    return list(found)


@pytest.mark.parametrize("files", [True, False])
def test_blocks_of_all_sizes_cross(
    ends: tuple[socket.socket, socket.socket], files: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shared, "HAS_FILES", files and shared.HAS_FILES)
    random = np.random.default_rng(1)
    sizes = (0, 1, 1000, SIZE, (1 << 20) - 1, 1 << 20, SIZE + 1, *(1 << 18,) * 9, 5, 0)
    given = [random.integers(0, 256, size, np.uint8) for size in sizes]
    for one, found in zip(given, crossed(ends, [*given]), strict=True):
        assert isinstance(found, np.ndarray)
        assert np.array_equal(one, found)
        assert not found.flags.writeable


@LINUX
def test_mapped_blocks_are_not_copied_and_keep_no_file_open(
    ends: tuple[socket.socket, socket.socket],
) -> None:
    before = open_files()
    (found,) = crossed(ends, [np.zeros(SIZE, np.uint8)])
    assert isinstance(found, np.ndarray)
    assert open_files() == before
    numbers = np.frombuffer(found, np.float32, 100, 400).reshape(10, 10)
    assert as_readonly(numbers) is numbers
    with pytest.raises(ValueError, match="WRITEABLE"):
        found.flags.writeable = True


@LINUX
def test_many_small_blocks_share_few_mappings_and_stay_aligned(
    ends: tuple[socket.socket, socket.socket],
) -> None:
    given = [np.arange(number, number + 10_001, dtype=np.float64) for number in range(200)]
    found = crossed(ends, [*given])
    for one, block in zip(given, found, strict=True):
        numbers = np.frombuffer(block, np.float64)  # type: ignore[call-overload]
        assert np.array_equal(numbers, one)
        assert as_readonly(numbers) is numbers
    maps = Path("/proc/self/maps").read_text().count("memfd:daguerre")
    assert 1 <= maps <= 16


@LINUX
def test_memory_of_a_block_lasts_as_long_as_its_arrays(
    ends: tuple[socket.socket, socket.socket],
) -> None:
    def mappings() -> int:
        return Path("/proc/self/maps").read_text().count("memfd:daguerre")

    gc.collect()
    before = mappings()
    (found,) = crossed(ends, [np.full(SIZE, 7, np.uint8)])
    assert isinstance(found, np.ndarray)
    part = np.frombuffer(found, np.uint8)[5:9]
    del found
    assert part.tolist() == [7, 7, 7, 7]
    assert mappings() == before + 1
    del part
    gc.collect()
    assert mappings() == before


def sealed(size: int) -> int:
    found = shared.copied([memoryview(bytes(size))])
    assert found is not None
    return found


def unsealed(seals: int) -> int:
    file = os.memfd_create("x", os.MFD_ALLOW_SEALING)
    os.truncate(file, SIZE)
    fcntl.fcntl(file, fcntl.F_ADD_SEALS, seals)
    return file


def plain() -> int:
    with tempfile.TemporaryFile() as file:
        file.truncate(SIZE)
        return os.dup(file.fileno())


LIES = {
    "no file": list,
    "a smaller file": lambda: [sealed(SIZE - 16)],
    "a larger file": lambda: [sealed(SIZE + 16)],
    "a file that can shrink": lambda: [unsealed(fcntl.F_SEAL_WRITE | fcntl.F_SEAL_GROW)],
    "a file that can change": lambda: [unsealed(fcntl.F_SEAL_SHRINK | fcntl.F_SEAL_GROW)],
    "a file on a disk": lambda: [plain()],
    "a pipe": lambda: [os.pipe()[0]],
    "a folder": lambda: [os.open("/", os.O_RDONLY)],
}


@LINUX
@pytest.mark.parametrize("lie", LIES)
def test_files_of_other_kinds_are_refused(
    ends: tuple[socket.socket, socket.socket], lie: str
) -> None:
    files = LIES[lie]()
    ends[0].sendall(struct.pack("<cIQ", ANSWER, 1, SIZE))
    if files:
        socket.send_fds(ends[0], [b"f"], files)
    else:
        ends[0].sendall(b"f")
    for file in files:
        os.close(file)
    before = open_files()
    with pytest.raises(DamagedError):
        Link(ends[1]).receive(lambda: 1e9)
    assert open_files() == before


@LINUX
def test_further_files_do_not_stay_open(ends: tuple[socket.socket, socket.socket]) -> None:
    files = [sealed(SIZE), sealed(SIZE), sealed(SIZE)]
    ends[0].sendall(struct.pack("<cIQ", ANSWER, 1, SIZE))
    socket.send_fds(ends[0], [b"f"], files)
    for file in files:
        os.close(file)
    before = open_files()
    Link(ends[1]).receive(lambda: 1e9)
    assert open_files() == before


def test_an_end_before_a_block_is_an_end(ends: tuple[socket.socket, socket.socket]) -> None:
    ends[0].sendall(struct.pack("<cIQ", ANSWER, 1, SIZE))
    ends[0].close()
    with pytest.raises(EOFError):
        Link(ends[1]).receive(lambda: sys.maxsize)
