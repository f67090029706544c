"""STMaps in and out: the convention, the same picture by map and by model, bad files."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre.distortion import BrownConrady
from daguerre.errors import UsageError
from daguerre.post import run, tiles
from tests.post.test_post import planes, post, read, write
from tests.post.test_warp import soft

MODEL = BrownConrady(-0.2, 0.03, 0.002)


def test_the_map_that_changes_nothing():
    st = dg.post.stmap(BrownConrady(), (40, 20), focal_px=30)
    columns, rows = np.meshgrid((np.arange(40) + 0.5) / 40, 1 - (np.arange(20) + 0.5) / 20)
    assert st == pytest.approx(np.stack([columns, rows], 2), abs=1e-7)
    image = soft(40, 20)
    assert dg.post.apply_stmap(image, st) == pytest.approx(image, abs=1e-5)


def test_t_points_up():
    st = np.full((20, 40, 2), 0.5, np.float32)
    st[:, :, 1] = 0.975  # the middle of the first row
    image = np.repeat(np.arange(20, dtype=np.float32)[:, None, None], 40, 1)
    assert dg.post.apply_stmap(image, st) == pytest.approx(np.zeros((20, 40, 1)), abs=1e-5)


@pytest.mark.parametrize("inverse", [False, True])
def test_a_map_does_what_its_model_does(inverse):
    image = soft(320, 200)
    how = {"focal_px": 250.0, "centre": (150.0, 110.0), "inverse": inverse}
    by_model = dg.post.distort(image, MODEL, **how)
    by_map = dg.post.apply_stmap(image, dg.post.stmap(MODEL, (320, 200), **how))
    edge = (by_model == 0) | (by_map == 0)
    assert np.abs(by_map - by_model)[~edge].max() < 1e-4
    assert edge.mean() < 0.2


@pytest.mark.parametrize("block", [7, 64])
def test_files_there_and_back(tmp_path, monkeypatch, block):
    window = {
        "dataWindow": (np.array([3, -5], np.int32), np.array([132, 224], np.int32)),
        "displayWindow": (np.array([0, 0], np.int32), np.array([139, 219], np.int32)),
    }
    source = write(tmp_path / "in.exr", planes(230, 130), **window)
    word = f"distortion:k1=-0.3,fx=120,stmap={tmp_path / 'st.exr'}"
    assert post(source, "-o", tmp_path / "model.exr", "--effect", word) == 0
    monkeypatch.setattr(tiles, "BLOCK", block)
    monkeypatch.setattr(run, "BLOCK", block)
    word = f"stmap:file={tmp_path / 'st.exr'}"
    assert post(source, "-o", tmp_path / "map.exr", "--effect", word) == 0
    model, found = read(tmp_path / "model.exr")[0], read(tmp_path / "map.exr")[0]
    edge = (model["R"] == 0) | (found["R"] == 0)
    assert ((model["R"] == 0) ^ (found["R"] == 0)).mean() < 0.01
    assert np.abs(model["R"] - found["R"])[~edge].max() < 2e-3
    st, header = read(tmp_path / "st.exr")
    assert st["R"].shape == (230, 130)
    assert np.array_equal(header["displayWindow"][1], [139, 219])


def test_a_map_of_a_part_leaves_the_rest_black(tmp_path, capsys):
    source = write(tmp_path / "in.exr", planes(64, 64))
    st = {"R": np.full((10, 64), 0.5, np.float32), "G": np.full((10, 64), 0.5, np.float32)}
    window = {
        "dataWindow": (np.array([0, 20], np.int32), np.array([63, 29], np.int32)),
        "displayWindow": (np.array([0, 0], np.int32), np.array([63, 63], np.int32)),
    }
    file = write(tmp_path / "st.exr", st, **window)
    words = ["post", str(source), "-o", str(source), "--effect", f"stmap:file={file}"]
    assert dg.cli.main(words) == 0
    alpha = read(source)[0]["A"]
    assert np.array_equal(np.flatnonzero(alpha.any(axis=1)), np.arange(20, 30))
    assert f"{54 * 64} pixels where the distortion model is not defined" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("channels", "message"),
    [
        ({"R": np.ones((9, 9), np.float32)}, "wanted R and G (s and t), got R"),
        ({n: np.ones((9, 9), np.float32) for n in "RG"}, "wanted 40 x 70 pixels, got 9 x 9"),
        (None, "st.exr: no such file"),
    ],
)
def test_bad_maps(tmp_path, capsys, channels, message):
    source = write(tmp_path / "in.exr", planes())
    if channels is not None:
        write(tmp_path / "st.exr", channels)
    word = f"stmap:file={tmp_path / 'st.exr'}"
    assert post(source, "-o", source, "--effect", word) == 3
    assert message in capsys.readouterr().err
    with pytest.raises(UsageError, match="stmap: wanted shape"):
        dg.post.apply_stmap(soft(9, 9), np.ones((8, 9, 2)))
