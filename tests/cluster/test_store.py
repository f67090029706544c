"""The store of a worker: values by hash, of limited size."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from daguerre.cluster.store import FOLDER, Store
from daguerre.errors import InputError, OutputError
from daguerre.files.packing import hash_of, pack
from daguerre.files.value import same


def test_values_are_kept_by_their_hash(tmp_path: Path) -> None:
    value = {"array": np.arange(1 << 15), "text": "x"}
    store, packed = Store(tmp_path / "new"), pack(value)
    name, (large,) = hash_of(packed.data), packed.large
    assert store.lacks([name, "other"]) == [name, "other"]
    store.put(name, packed.data)
    assert store.lacks([name]) == [large]
    store.put(large, packed.large[large].tobytes())
    assert store.lacks([name]) == []
    assert same(store.value(name), value)


def test_another_value_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="wanted a value of hash"):
        Store(tmp_path).put(hash_of(b"a"), b"b")
    assert list(tmp_path.iterdir()) == []


def test_a_value_that_is_not_here(tmp_path: Path) -> None:
    (tmp_path / "empty.packed").write_bytes(b"")
    for name in ("missing", "empty"):
        with pytest.raises(InputError, match="cannot read"):
            Store(tmp_path).get(name)


def test_the_oldest_go_first(tmp_path: Path) -> None:
    store, names = Store(tmp_path, limit=250), []
    for i in range(4):
        data = bytes([i]) * 100
        names.append(hash_of(data))
        store.put(names[-1], data)
        os.utime(tmp_path / f"{names[-1]}.packed", (i, i))
        if i == 1:
            store.get(names[0])  # used again: now the newest
    assert {path.stem for path in tmp_path.iterdir()} == {names[0], names[3]}


def test_a_folder_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot write"):
        Store(tmp_path / "file" / "cache").put(hash_of(b"a"), b"a")


def test_a_value_that_another_worker_removes_meanwhile_is_no_error(tmp_path: Path) -> None:
    (tmp_path / "gone.packed").symlink_to(tmp_path / "nowhere")
    store = Store(tmp_path, limit=1)
    store.put(hash_of(b"value"), b"value")
    assert store.get(hash_of(b"value"))[:] == b"value"


def test_the_folder_of_strangers_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(FOLDER, raising=False)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    folder = Store().folder
    assert folder.parent == tmp_path
    assert folder.stat().st_mode & 0o777 == 0o700
    folder.chmod(0o777)
    with pytest.raises(OutputError, match="wanted a folder to which only this user can write"):
        Store()


def test_a_named_folder_of_strangers_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    named = tmp_path / "named"
    monkeypatch.setenv(FOLDER, str(named))
    assert Store().folder == named
    assert named.stat().st_mode & 0o777 == 0o700
    (tmp_path / "link").symlink_to(named)
    monkeypatch.setenv(FOLDER, str(tmp_path / "link"))
    Store()
    for mode in (0o770, 0o707):
        named.chmod(mode)
        with pytest.raises(OutputError, match="wanted a folder to which only this user can write"):
            Store()
    named.chmod(0o700)
    monkeypatch.setattr("os.getuid", lambda: 12345)
    with pytest.raises(OutputError, match="wanted a folder to which only this user can write"):
        Store()
