"""Raw files without a mosaic, such as DNGs of linear colours, are refused by one error."""

from __future__ import annotations

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
