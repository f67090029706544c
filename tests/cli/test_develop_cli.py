"""``daguerre develop``: frames and raw files into photographs, and what it refuses."""

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.development.camera_raw import read_shot
from daguerre.development.dng import size_note
from daguerre.sensors import load
from tests.support.pictures.colour_chart import (
    delta_e,
    greys,
    lab,
    patch_means,
    raw_of,
    reflectances,
    saved_large,
    truth,
)

exifread = pytest.importorskip("exifread")
Image = pytest.importorskip("PIL.Image")

FACTS = {"expTime": 1 / 125, "aperture": 2.8, "luminance_exposure": 10 / 0.18 / 200}
FACTS |= {"isoSpeed": 200, "version": "x", "lensModel": "Biotar"}


@pytest.fixture
def frame_file(tmp_path):
    rgb = np.full((64, 96, 3), 0.18, np.float32)
    rgb[:, 48:] = (0.6, 0.3, 0.1)
    dg.Frame(rgb=rgb, metadata=dict(FACTS)).save(tmp_path / "in.exr")
    return tmp_path / "in.exr"


def run(*words):
    return main(["develop", *map(str, words)])


def pixels(path):
    with Image.open(path) as image:
        return np.asarray(image).astype(int)


def test_a_frame_becomes_jpeg_png_and_exr(frame_file, tmp_path):
    names = ("a.jpg", "a.png", "a.exr", "a.tif")
    assert run(frame_file, *(w for name in names for w in ("-o", tmp_path / name))) == 0
    assert np.abs(pixels(tmp_path / "a.png")[:, :48] - 118).max() <= 1
    assert np.abs(pixels(tmp_path / "a.jpg")[:, :40] - 118).max() <= 1
    with (tmp_path / "a.jpg").open("rb") as file:
        tags = exifread.process_file(file, details=False)
    assert str(tags["EXIF ExposureTime"]) == "1/125"
    assert str(tags["EXIF LensModel"]) == "Biotar"


def test_iso_and_ev_double_the_light(frame_file, tmp_path):
    run(frame_file, "-o", tmp_path / "a.png", "--ev", "-1")
    run(frame_file, "-o", tmp_path / "b.png", "--iso", "100")
    dark = pixels(tmp_path / "a.png")
    assert (dark == pixels(tmp_path / "b.png")).all()
    assert abs(dark[0, 0, 0] - 85) <= 1  # 0.09 in sRGB


def test_a_sensor_takes_the_picture_and_its_dng_is_the_same_picture(frame_file, tmp_path):
    flags = ("--sensor", "ideal", "--iso", "200", "--seed", "3")
    assert run(frame_file, "-o", tmp_path / "a.dng", "-o", tmp_path / "a.png", *flags) == 0
    assert run(tmp_path / "a.dng", "-o", tmp_path / "b.png") == 0
    one, other = pixels(tmp_path / "a.png"), pixels(tmp_path / "b.png")
    assert np.abs(one - other).mean() < 0.02
    assert one[:, :44].std() > 0.3  # photons
    assert np.abs(one[:, :44].mean() - 118) < 1
    run(frame_file, "-o", tmp_path / "c.png", *flags[:-1], "4")
    assert (pixels(tmp_path / "c.png") != one).any()


@pytest.mark.parametrize("white", [None, 2856])
@pytest.mark.parametrize("pattern", ["bayer-rggb", "xtrans"])
def test_files_of_cameras_have_their_colours(tmp_path, white, pattern):
    raw = raw_of(load("nikon-d5100").with_(pattern=pattern), reflectances(), white=white)
    height, width = raw.mosaic.shape
    saved_large(raw, tmp_path / "x.dng")
    shot = read_shot(tmp_path / "x.dng")
    assert shot.as_shot == pytest.approx(raw.white_balance, abs=1e-3)
    assert shot.metadata["expTime"] == pytest.approx(1 / 125)
    got = patch_means(dg.development.develop(shot).linear()[:height, :width])
    assert delta_e(lab(got), lab(truth(reflectances(), white).clip(0, 1))).mean() < 1.5


def test_a_small_file_of_x_trans(tmp_path):
    raw_of("fujifilm-x-t4", greys(0.18, 0.18)).save(tmp_path / "x.dng")
    got = dg.development.develop(read_shot(tmp_path / "x.dng")).bytes8()
    assert np.abs(got[2:-2, 2:-2].astype(int) - 118).max() <= 1


@pytest.mark.parametrize(
    ("sensor", "size", "opens"),
    [
        ("ideal", 22, True),
        ("ideal", 21, False),
        ("fujifilm-x-t4", 516, True),
        ("fujifilm-x-t4", 510, False),
    ],
)
def test_files_that_libraw_refuses_are_told(tmp_path, sensor, size, opens):
    import rawpy

    rgb = np.full((size, size, 3), 0.1, np.float32)
    raw = dg.Frame(rgb=rgb, metadata=dict(FACTS)).expose(sensor)
    raw.save(tmp_path / "x.dng")
    try:
        with rawpy.imread(str(tmp_path / "x.dng")) as shot:
            shot.postprocess()
            opened = True
    except rawpy.LibRawError:
        opened = False
    assert opened == opens
    assert (size_note(raw) is None) == opens


def test_a_small_dng_is_told(frame_file, tmp_path, capsys):
    assert run(frame_file, "-o", tmp_path / "x.dng", "--sensor", "fujifilm-x-t4") == 0
    assert "LibRaw develops X-Trans from 516 x 516 px" in capsys.readouterr().err


def test_mono_files(tmp_path):
    raw = raw_of("ideal-mono", greys(0.18, 0.5))
    raw.save(tmp_path / "x.dng")
    got = dg.development.develop(read_shot(tmp_path / "x.dng")).bytes8()
    assert np.abs(got[:, :20].astype(int) - 118).max() <= 1


@pytest.mark.parametrize(
    ("words", "code", "named"),
    [
        (["-o", "x.dng"], 2, "no raw data; add --sensor NAME"),
        (["-o", "x.gif"], 2, "wanted a name ending in"),
        (["-o", "in.exr"], 2, "this command reads this file"),
        (["-o", "x.jpg", "--sensor", "ideel"], 3, "ideal"),
        (["-o", "x.jpg", "--sensor", "ideal", "--iso", "1e9"], 2, "iso: wanted"),
        (["-o", "x.jpg", "--iso", "-5"], 2, "--iso"),
        (["-o", "x.jpg", "--wb", "warm"], 2, "wb"),
        (["-o", "x.jpg", "--ev", "nan"], 2, "--ev"),
        (["-o", "x.jpg", "--look", "flim"], 2, "did you mean 'film'"),
        (["-o", "x.jpg", "--quality", "0"], 2, "--quality: wanted 1 to 100"),
        (["-o", "x.jpg", "--bits", "16"], 2, "bits"),
        (["-o", "x.jpg", "--grain", "2"], 2, "sensorOverallDimensions"),
    ],
)
def test_what_it_refuses(frame_file, tmp_path, monkeypatch, capsys, words, code, named):
    monkeypatch.chdir(tmp_path)
    assert run("in.exr", *words) == code
    said = capsys.readouterr().err
    assert named in said
    assert said.count("\n") == 1
    assert sorted(p.name for p in tmp_path.iterdir()) == ["in.exr"]


@pytest.mark.parametrize(
    ("facts", "named"),
    [
        ({"expTime": None}, "expTime"),
        ({"expTime": -0.01}, "expTime"),
        ({"luminance_exposure": float("nan")}, "luminance_exposure"),
        ({"aperture": None, "luminance_exposure": None}, "aperture"),
        ({"isoSpeed": float("nan")}, "isoSpeed"),
        ({"isoSpeed": -100.0}, "isoSpeed"),
    ],
)
def test_frames_of_unknown_exposure(tmp_path, capsys, facts, named):
    metadata = {**FACTS, **facts}
    if facts == {"expTime": None}:
        metadata["luminance_exposure"] = None
    rgb = np.ones((4, 4, 3), np.float32)
    dg.Frame(rgb=rgb, metadata=metadata).save(tmp_path / "in.exr")
    assert run(tmp_path / "in.exr", "-o", tmp_path / "x.jpg") == 3
    assert f"in.exr: {named}: wanted" in capsys.readouterr().err


def test_files_that_are_no_raw_files(tmp_path, capsys):
    (tmp_path / "x.dng").write_bytes(b"II*\0 no picture at all")
    assert run(tmp_path / "x.dng", "-o", tmp_path / "x.jpg") == 3
    assert "wanted a camera raw file; LibRaw cannot read this one" in capsys.readouterr().err
    assert run(tmp_path / "none.dng", "-o", tmp_path / "x.jpg") == 3
    assert "no such file" in capsys.readouterr().err
    assert run(tmp_path / "x.dng", "-o", tmp_path / "x.jpg", "--iso", "200") == 2
    assert "--iso" in capsys.readouterr().err
    assert run(tmp_path / "x.dng", "-o", tmp_path / "y.dng") == 2
    assert "raw file already" in capsys.readouterr().err


def test_broken_files_are_refused_or_read(tmp_path):
    """Nothing but our own errors, whatever bytes of the directories are changed."""
    raw_of("nikon-d5100", greys(0.18, 0.5)).save(tmp_path / "x.dng")
    whole, rng = (tmp_path / "x.dng").read_bytes(), np.random.default_rng(1)
    files = [whole[:length] for length in (0, 8, 100, 700, len(whole) - 900)]
    for _ in range(30):
        broken = bytearray(whole)
        for place in rng.integers(0, 900, 4):
            broken[place if rng.random() < 0.7 else -place - 1] = rng.integers(256)
        files.append(bytes(broken))
    said = []
    for data in files:
        (tmp_path / "y.dng").write_bytes(data)
        try:
            dg.development.develop(read_shot(tmp_path / "y.dng"))
        except dg.DaguerreError as error:
            said.append(str(error))
    assert len(said) >= 4
    assert all("y.dng" in words for words in said)
