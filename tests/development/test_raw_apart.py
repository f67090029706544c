"""Raw files are read in a helper process: what ends LibRaw there is one error here."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from daguerre.apart.limits import Limits
from daguerre.development import libraw
from daguerre.development.camera_raw import read_shot
from daguerre.errors import InputError
from daguerre.plates import files as plates
from tests.fuzz.shot_seeds import raws

rawpy = pytest.importorskip("rawpy", reason="needs the extra raw")
Reader = Callable[[Path], object]
READERS: tuple[Reader, ...] = (plates.read, read_shot)


@pytest.fixture
def shot(tmp_path: Path) -> Iterator[Path]:
    path = tmp_path / "shot.dng"
    path.write_bytes(next(raws(tmp_path))[1])
    yield path
    libraw._helper.end()


def test_values_are_those_of_the_library_in_this_process(shot: Path) -> None:
    file = libraw.read(shot, "mosaic")
    with rawpy.imread(str(shot)) as opened:
        assert np.array_equal(file.mosaic, opened.raw_image_visible)
        assert np.array_equal(file.cells, opened.raw_colors_visible[:12, :12])
        assert (file.colors, file.pattern, file.flip) == (3, 2, opened.sizes.flip)
        assert file.black == tuple(opened.black_level_per_channel)
        assert file.white == opened.white_level
        assert np.array_equal(file.xyz_matrix, opened.rgb_xyz_matrix[:3])
        balance = libraw.balance_of(file, shot)
        pixels = libraw.USUAL.run(opened, balance, xtrans=False, turn=True)
    assert np.array_equal(libraw.read(shot, "picture").pixels, pixels)
    assert libraw.read(shot).mosaic is None


@pytest.mark.parametrize(
    ("task", "said"),
    [
        ("tests.apart.tasks:crash", "the helper process ended by SIGSEGV"),
        ("tests.apart.tasks:abort", "the helper process ended by SIGABRT"),
        ("tests.apart.tasks:divide", "ZeroDivisionError"),
        ("tests.apart.tasks:echo", "the helper process sent no raw file"),
    ],
)
@pytest.mark.parametrize("reader", READERS)
def test_whatever_ends_the_helper_is_one_error(
    shot: Path, task: str, said: str, reader: Reader, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(libraw, "_TASK", task)
    with pytest.raises(InputError, match=rf"shot\.dng: cannot read: .*{said}"):
        reader(shot)
    monkeypatch.undo()
    reader(shot)


@pytest.mark.parametrize(
    "answer",
    [
        {"mosaic": np.zeros((2, 2), np.float64)},
        {"pixels": np.zeros((2, 2), np.uint16)},
        {"cells": np.zeros((0, 0), np.uint8)},
        {"black": ("x",)},
        {"more": 1},
    ],
)
def test_answers_are_checked(shot: Path, answer: dict[str, object]) -> None:
    good = libraw.read(shot, "mosaic").__dict__
    libraw._checked(dict(good), "a")
    with pytest.raises(InputError, match="a: cannot read: the helper process sent no raw file"):
        libraw._checked(good | answer, "a")


def test_limits_follow_the_number_of_photosites() -> None:
    small, large = libraw._limits("1000"), libraw._limits("61000000")
    assert small.seconds < large.seconds < 300
    assert small.memory < large.memory < 6e9
    assert libraw._limits("9" * 30) == libraw._limits(str(libraw.MAX_PIXELS))
    assert libraw._limits("-1\n") == Limits(small.seconds - 0.004, libraw._MEMORY)


def test_a_huge_claim_is_refused_before_memory_is_taken(shot: Path) -> None:
    """Its tags state 60000 x 60000 photosites."""
    data = bytearray(shot.read_bytes())
    at = struct.unpack_from("<I", data, 4)[0]
    places = [at]
    while places:
        at = places.pop()
        for entry in range(at + 2, at + 2 + 12 * struct.unpack_from("<H", data, at)[0], 12):
            tag, _, count, value = struct.unpack_from("<HHII", data, entry)
            if tag == 330 and count == 1:
                places.append(value)
            if tag in (256, 257):
                struct.pack_into("<HHII", data, entry, tag, 4, 1, 60000)
    shot.write_bytes(data)
    for reader in READERS:
        with pytest.raises(InputError, match=r"shot\.dng: wanted (at most|a camera raw)"):
            reader(shot)
