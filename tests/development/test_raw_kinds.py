"""Raw files without a mosaic, such as DNGs of linear colours, are refused by one error."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

from daguerre.development.camera_raw import read_shot
from daguerre.errors import InputError
from daguerre.plates import files as plates
from tests.fuzz.shot_seeds import raws

pytest.importorskip("rawpy", reason="needs the extra raw")


@pytest.mark.parametrize(
    "name", ["sony-a7r-ii.dng", "fujifilm-x-t4.dng", "ideal-mono.dng", "linear.dng"]
)
def test_kinds_of_raw_files(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(dict(raws(tmp_path))[name])
    if name == "linear.dng":
        for reader in (plates.read, read_shot):
            with pytest.raises(
                InputError,
                match=r"linear\.dng: .*wanted a mosaic .*; got 3 colours without a mosaic",
            ):
                reader(path)
    else:
        assert plates.read(path).raw.mosaic.shape == (64, 96)
        assert read_shot(path).pixels.shape == (64, 96, 3)


def test_an_impossible_baseline_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "shot.dng"
    data = bytearray(next(raws(tmp_path))[1])
    entry = data.index(struct.pack("<HHI", 50730, 10, 1))
    struct.pack_into("<ii", data, struct.unpack_from("<I", data, entry + 8)[0], 9999, 1)
    path.write_bytes(data)
    with pytest.raises(InputError, match=r"BaselineExposure: wanted -32 to 32, got 9999\.0"):
        read_shot(path)
