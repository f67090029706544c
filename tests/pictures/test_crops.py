"""Crops that are joined have the bits of the picture that was drawn at once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.errors import MismatchError
from daguerre.pictures.exr import crops
from tests.support.scene import scenes

SIZE = (40, 150)  # more rows than a band
WHOLE = (0, 0, *SIZE)
PARTS = ((0, 0, 40, 70), (0, 70, 13, 150), (13, 70, 40, 150))


def drawn(folder: Path, crop: tuple[int, int, int, int], **options: object) -> Path:
    scene = scenes.furnace(dg.Material(dg.Diffuse((0.5,) * 3)))
    camera = dg.Camera(f_stop=2.0, focus_distance=3.0)
    settings = {"resolution": SIZE, "spp": 2, "light_paths": (300, 300), "aovs": True, **options}
    path = folder / f"{'-'.join(map(str, crop))}.exr"
    dg.render(scene, camera, crop=crop, **settings).save(path)  # type: ignore[arg-type]
    return path


@pytest.fixture(scope="module")
def parts(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    folder = tmp_path_factory.mktemp("crops")
    return [drawn(folder, crop) for crop in PARTS]


def test_joined_crops_are_the_picture(parts: list[Path], tmp_path: Path) -> None:
    whole = dg.load_frame(drawn(tmp_path, WHOLE))
    assert crops.join_crops([parts[2], parts[0], parts[1]], tmp_path / "joined.exr") == WHOLE
    joined = dg.load_frame(tmp_path / "joined.exr")
    assert set(joined.aovs) == set(whole.aovs)
    for name, plane in {"rgb": whole.rgb, "variance": whole.variance, **whole.aovs}.items():
        found = joined.aovs[name] if name in whole.aovs else getattr(joined, name)
        np.testing.assert_array_equal(found, plane, err_msg=name)
    same = {k: v for k, v in whole.metadata.items() if not isinstance(v, np.ndarray)}
    assert {k: v for k, v in joined.metadata.items() if k in same} == same


def test_some_of_the_crops_are_a_crop(parts: list[Path], tmp_path: Path) -> None:
    assert crops.join_crops(parts[1:], tmp_path / "low.exr") == (0, 70, 40, 150)
    low = dg.load_frame(tmp_path / "low.exr")
    assert low.metadata["crop"] == (0, 70, 40, 150)
    np.testing.assert_array_equal(low.rgb[:, :13], dg.load_frame(parts[1]).rgb)


def test_what_makes_up_no_picture_is_refused(parts: list[Path], tmp_path: Path) -> None:
    out = tmp_path / "out.exr"
    with pytest.raises(MismatchError, match=r"fill 40 x 150 px at \(0, 0\), got gaps of 2160 px"):
        crops.join_crops(parts[:2], out)
    with pytest.raises(MismatchError, match="overlaps"):
        crops.join_crops([parts[0], drawn(tmp_path, (0, 60, 40, 150))], out)
    other = drawn(tmp_path, PARTS[2], seed=3)
    with pytest.raises(MismatchError, match=r"daguerre:seed \(3, wanted 0\)"):
        crops.join_crops([*parts[:2], other], out)
    more = drawn(tmp_path, PARTS[2], spp=3)
    with pytest.raises(MismatchError, match=r"daguerre:samples \(3, wanted 2\)"):
        crops.join_crops([*parts[:2], more], out)
    assert not out.exists()


def test_the_command_joins(
    parts: list[Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = list(map(str, parts))
    assert main(["merge", *names, "-o", str(tmp_path / "a.exr")]) == 0
    assert "40 x 150 px of 3 crops" in capsys.readouterr().err
    assert main(["merge", *names, "-o", str(tmp_path / "a.png")]) == 2
    assert "crops are joined into one .exr output" in capsys.readouterr().err
