"""Aims that are kept between runs: the same rays, and no harm from what is broken."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre import _core
from daguerre.setup import aim_cache


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of its own for the cache."""
    monkeypatch.setenv("DAGUERRE_CACHE", str(tmp_path))
    return tmp_path / "aims"


def lens(f_stop: float = 4.0, **settings: object) -> _core.ExactLens:
    prescription = dg.lenses.load("double-gauss-50mm-f2").prescription
    known = {"f_stop": f_stop, "focus_distance_m": 3.0, "half_diagonal_mm": 20.0}
    return aim_cache.exact_lens(prescription, _core.ExactLensSettings(**known, **settings))


def rays(exact: _core.ExactLens) -> list[np.ndarray]:
    random = np.random.default_rng(1)
    film = (10 * random.random((500, 2)) - 5).astype(np.float32)
    u_lens = random.random((500, 2)).astype(np.float32)
    nm = np.full(500, 550, np.float32)
    return list(exact.generate(film, u_lens, nm))


def test_the_second_time_it_comes_from_the_cache_with_the_same_bits(place: Path) -> None:
    first = lens(tilt_deg=(3.0, 0.0))
    files = list(place.glob("*.aim"))
    assert len(files) == 1
    written = files[0].stat()
    second = lens(tilt_deg=(3.0, 0.0))
    assert files[0].stat().st_ino == written.st_ino  # not written again
    assert second.h0 == first.h0
    for a, b in zip(rays(first), rays(second), strict=True):
        np.testing.assert_array_equal(a, b)
    lens(5.6)
    assert len(list(place.glob("*.aim"))) == 2


def test_damaged_entries_are_replaced(place: Path) -> None:
    good = lens()
    (file,) = place.glob("*.aim")
    whole = file.read_bytes()
    for broken in (b"", whole[:1000], whole[:-8] + b"12345678"):
        file.write_bytes(broken)
        again = lens()
        assert again.aim_state == good.aim_state
        assert file.read_bytes() == whole


def test_another_build_does_not_read_what_this_one_keeps(
    place: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    aim_cache.store("key", b"state")
    assert aim_cache.load("key") == b"state"
    core = tmp_path / "_core.so"
    builds = set()
    for size, changed in ((10, 1), (11, 1), (11, 2)):
        core.write_bytes(bytes(size))
        os.utime(core, ns=(changed, changed))
        builds.add(aim_cache.identity(core))
        monkeypatch.setattr(aim_cache, "BUILD", aim_cache.identity(core))
        assert aim_cache.load("key") is None
    assert len(builds) == 3


def test_tests_do_not_use_the_cache_of_the_user(tmp_path_factory: pytest.TempPathFactory) -> None:
    kept = aim_cache.folder()
    assert kept is not None
    assert kept.is_relative_to(tmp_path_factory.getbasetemp())


def test_off_and_folders_that_cannot_be_written(
    place: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DAGUERRE_CACHE", "off")
    assert aim_cache.folder() is None
    lens()
    assert not place.exists()
    in_the_way = tmp_path / "file"
    in_the_way.write_text("no folder")
    monkeypatch.setenv("DAGUERRE_CACHE", str(in_the_way))
    lens()
    assert in_the_way.read_text() == "no folder"


def test_where_it_lies_by_the_convention(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv("DAGUERRE_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert aim_cache.folder() == tmp_path / "daguerre" / "aims"
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    assert aim_cache.folder() == tmp_path / "home" / ".cache" / "daguerre" / "aims"


def test_what_was_not_used_for_longest_goes(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(aim_cache, "MAX_BYTES", 2500)
    for age, key in enumerate("abcd"):
        aim_cache.store(key, bytes(1000))
        if (place / aim_cache.file_name(key)).exists():
            os.utime(place / aim_cache.file_name(key), (1e9 + age, 1e9 + age))
    assert {p.name for p in place.iterdir()} == {aim_cache.file_name(k) for k in "cd"}
    assert aim_cache.load("c") == bytes(1000)  # used now
    aim_cache.store("e", bytes(1000))
    assert {p.name for p in place.iterdir()} == {aim_cache.file_name(k) for k in "ce"}
    assert aim_cache.load("a") is None
