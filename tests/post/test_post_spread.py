"""Spread light in files: bands of rows are the whole picture, NaN is counted and kept."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from daguerre.convolution import overlap
from daguerre.convolution.convolve import convolve, spreader_of
from daguerre.convolution.rows import Rows
from daguerre.post import run, spreading
from daguerre.post.effects import lens_psf
from daguerre.post.exr_picture import ExrPicture
from daguerre.post.picture import Band
from tests.post.test_post import post, read, write

WORDS = {
    "bloom": "bloom:radius=3,share=0.4",
    "halo": "halo:sensor=3x5,share=0.5,thickness=0.08",
    "glare": "glare:sensor=3x5,share=0.3",
    "diffraction": "diffraction:f_number=16,blades=5,rotation=9,sensor=0.6x1,size=61,wavelengths=6",
    "star": "star:f_number=16,blades=5,rotation=9,sensor=0.6x1,size=61,wavelengths=6,share=0.5",
    "psf": "psf:file={kernel}",
    "lens-psf": "lens-psf:lens=double-gauss-50mm-f2,f_stop=4,defocus=0.3,zones=3,"
    "sensor=3x5,wavelengths=3",
}


def picture(height: int = 290, width: int = 90) -> dict[str, np.ndarray]:
    """Lamps in the dark, some of them next to edges, some no number."""
    rng = np.random.default_rng(5)
    out = {name: rng.random((height, width), np.float32) * 0.1 for name in "RGB"}
    for y, x in ((0, 3), (63, 80), (64, 10), (150, 45), (289, 89)):
        for name in "RGB":
            out[name][y, x] = 300 + y
    out["R"][70, 20], out["G"][200, 60] = np.nan, np.inf
    out["A"] = rng.random((height, width), np.float32)
    out["depth.Z"] = np.full((height, width), 5.5, np.float32)
    return out


def lopsided(path: Path) -> Path:
    """A kernel of even height that is nowhere symmetric."""
    rng = np.random.default_rng(8)
    return write(path, {name: rng.random((20, 11), np.float32) ** 4 for name in "RGB"})


@pytest.mark.parametrize("name", WORDS)
def test_files_in_bands_are_the_whole_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """Whole: all rows at once. In bands: some rows at a time, and read as they are needed."""
    monkeypatch.setattr(lens_psf, "WAVES", 1)  # rays are quick
    word = WORDS[name].format(kernel=lopsided(tmp_path / "kernel.exr"))
    source = write(tmp_path / "in.exr", picture())
    assert post(source, "-o", tmp_path / "whole.exr", "--effect", word) == 0
    monkeypatch.setattr(overlap, "ROWS", 100)
    monkeypatch.setattr(overlap, "SPECTRA_BYTES", 1 << 20)
    monkeypatch.setattr(run, "BLOCK", 48)
    monkeypatch.setattr(spreading, "SCAN", 16)
    most = 0
    rows = ExrPicture.rows

    def counted(self: ExrPicture, wanted: Rows) -> Band:
        nonlocal most
        most = max(most, wanted.end - wanted.begin)
        return rows(self, wanted)

    monkeypatch.setattr(ExrPicture, "rows", counted)
    assert post(source, "-o", tmp_path / "bands.exr", "--effect", word) == 0
    assert most < 260  # of 290
    whole, found = read(tmp_path / "whole.exr")[0], read(tmp_path / "bands.exr")[0]
    given = picture()
    for channel, values in found.items():
        np.testing.assert_allclose(values, whole[channel], atol=1e-4, err_msg=channel)
        bad = ~np.isfinite(given[channel])
        assert np.array_equal(values[bad], given[channel][bad], equal_nan=True)
        assert np.isfinite(values[~bad]).all()
    assert np.array_equal(found["A"], given["A"])
    assert not np.allclose(found["G"][100:150], given["G"][100:150], atol=1e-3)


def test_bad_pixels_are_counted_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from daguerre import cli

    source = write(tmp_path / "in.exr", picture())
    words = ["post", str(source), "-o", str(tmp_path / "out.exr"), "--effect", WORDS["bloom"]]
    assert cli.main(words) == 0
    assert "2 pixels are NaN or infinite; they are kept" in capsys.readouterr().err


@pytest.mark.parametrize("size", [(20, 11), (31, 31), (280, 301)])
def test_rows_are_those_of_the_whole_convolution(
    size: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever rows are asked for, and wherever blocks begin; even kernels, and large ones too."""
    rng = np.random.default_rng(4)
    image = rng.random((330, 120, 2), np.float32)
    kernel = rng.random(size).astype(np.float32)
    kernel /= kernel.sum()
    whole = convolve(image, kernel)
    monkeypatch.setattr(overlap, "ROWS", 64)
    spread = spreader_of(kernel, image.shape)
    assert spread.block < 330
    for begin in range(0, 330, spread.block):
        wanted = Rows(begin, min(begin + spread.block, 330))
        read = wanted.grown(spread.reach).within(330)
        found = spread.rows(image[read.begin : read.end], read.begin, wanted)
        np.testing.assert_allclose(found, whole[wanted.begin : wanted.end], atol=2e-6)


def test_the_bar_moves_with_the_bands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from daguerre.post.recipe import from_words

    source = write(tmp_path / "in.exr", picture(), compression=OpenEXR.NO_COMPRESSION)
    monkeypatch.setattr(run, "BLOCK", 32)
    seen = []
    run.process(
        source, tmp_path / "out.exr", from_words([WORDS["bloom"]]),
        progress=lambda done, height, width: seen.append((done, height, width)),
    )  # fmt: skip
    assert seen == [(min(32 * k, 290), 290, 90) for k in range(1, 11)]
