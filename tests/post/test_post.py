"""The darkroom's frame: files in bands, chains of effects, the command line."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from daguerre import cli
from daguerre.convolution.rows import Rows
from daguerre.errors import InputError, UsageError
from daguerre.post import recipe, run, tiles
from daguerre.post.effect import Effect, Step
from daguerre.post.effects import catalogue as effects
from daguerre.post.parameter import REQUIRED, Parameter
from daguerre.post.picture import Band, Canvas

NOTHING = "vignetting:model=polynomial"  # light times 1


def planes(height: int = 70, width: int = 40) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(7)
    return {
        "R": rng.exponential(1, (height, width)).astype(np.float32),
        "G": rng.exponential(1, (height, width)).astype(np.float16),
        "B": rng.exponential(9, (height, width)).astype(np.float32),
        "A": np.ones((height, width), np.float32),  # the file can be packed
        "depth.Z": np.full((height, width), 5.5, np.float32),
        "object_id": rng.integers(0, 2**32, (height, width), dtype=np.uint32),
    }


def write(path: Path, channels: dict[str, np.ndarray], **header: object) -> Path:
    kind = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File({**kind, **header}, dict(channels)) as file:
        file.write(str(path))
    return path


def read(path: Path) -> tuple[dict[str, np.ndarray], dict[str, object]]:
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {name: c.pixels for name, c in file.channels().items()}, dict(file.header())


class Spread(Step):
    """The mean of the rows around: wants rows of its neighbours."""

    reach = 21

    def apply(self, band: Band, rows: Rows) -> Band:
        first = band.rows.begin
        image = np.stack(
            [
                band.image[max(y - self.reach - first, 0) : y + self.reach + 1 - first].mean(axis=0)
                for y in range(rows.begin, rows.end)
            ]
        )
        return band.cut(rows).with_image(image)


class Brightest(Step):
    """Divides by the brightest value of the whole picture."""

    def prepare(self, source) -> None:
        whole = (source.rows(Rows(y, y + 1)).image.max() for y in range(source.canvas.height))
        self.peak = max(whole)

    def apply(self, band: Band, rows: Rows) -> Band:
        return band.with_image(band.image / self.peak)


class Upside(Step):
    """The whole picture upside down, all at once."""

    block = 0

    def __init__(self, canvas: Canvas) -> None:
        self.height = canvas.height

    def reads(self, rows: Rows) -> Rows:
        return Rows(self.height - rows.end, self.height - rows.begin)

    def apply(self, band: Band, rows: Rows) -> Band:
        return Band(rows, band.image[::-1], band.planes)


@pytest.fixture
def toys(monkeypatch):
    gain = Parameter("gain", "of light", "stops", REQUIRED, low=-10)
    made = {
        "spread": Effect("spread", "", (), lambda canvas, values: Spread()),
        "brightest": Effect("brightest", "", (), lambda canvas, values: Brightest()),
        "upside": Effect("upside", "", (), lambda canvas, values: Upside(canvas)),
        "deep": Effect("deep", "", (), lambda canvas, values: Step(), needs=("depth", "motion")),
        "film": Effect("film", "", (gain,), lambda canvas, values: Spread(), last=True),
    }
    for name, effect in made.items():
        monkeypatch.setitem(effects.EFFECTS, name, effect)


def post(*words: object) -> int:
    return cli.main(["post", *map(str, words), "--quiet"])


@pytest.mark.parametrize(
    "header",
    [
        {},
        {"compression": OpenEXR.NO_COMPRESSION},
        {"compression": OpenEXR.PIZ_COMPRESSION},
        {"type": OpenEXR.tiledimage, "tiles": OpenEXR.TileDescription()},
    ],
)
def test_what_no_effect_changes_is_kept(tmp_path, header):
    window = {
        "dataWindow": (np.array([3, -5], np.int32), np.array([42, 64], np.int32)),
        "displayWindow": (np.array([0, 0], np.int32), np.array([99, 79], np.int32)),
    }
    own = {"worldToCamera": np.arange(16, dtype=np.float32).reshape(4, 4), "daguerre:h0": 1.5}
    given = planes()
    source = write(tmp_path / "in.exr", given, **window, **own, **header)
    assert post(source, "-o", tmp_path / "out.exr", "--effect", NOTHING) == 0
    found, attributes = read(tmp_path / "out.exr")
    assert found.keys() == given.keys()
    for name, plane in given.items():
        assert found[name].dtype == plane.dtype
        assert np.array_equal(found[name], plane), name
    for name, value in {**window, **own}.items():
        assert np.array_equal(attributes[name], value), name
    assert json.loads(attributes["daguerre:post"]) == [
        {"effect": "vignetting", "model": "polynomial"}
    ]


def test_the_history_grows(tmp_path):
    source = write(tmp_path / "in.exr", planes())
    for _ in range(2):
        assert post(source, "-o", source, "--effect", NOTHING) == 0
    assert len(read(source)[1]["daguerre:post"].splitlines()) == 2


@pytest.mark.parametrize("block", [1, 7, 16, 64])
def test_bands_are_the_whole_picture_bit_for_bit(tmp_path, monkeypatch, toys, block):
    source = write(tmp_path / "in.exr", planes())
    words = ["spread", "brightest", "upside", "spread", "vignetting:model=polynomial,k1=-0.5"]
    chain = [word for name in words for word in ("--effect", name)]
    assert post(source, "-o", tmp_path / "whole.exr", *chain) == 0
    monkeypatch.setattr(tiles, "BLOCK", block)
    monkeypatch.setattr(run, "BLOCK", block)
    assert post(source, "-o", tmp_path / "bands.exr", *chain) == 0
    whole, bands = read(tmp_path / "whole.exr")[0], read(tmp_path / "bands.exr")[0]
    assert all(np.array_equal(whole[name], bands[name]) for name in whole)
    assert not np.array_equal(whole["R"], planes()["R"])


def test_rows_that_two_bands_share_are_made_once(monkeypatch):
    made = []

    class Counting(Spread):
        def apply(self, band, rows):
            made.append(rows)
            return super().apply(band, rows)

    canvas = Canvas(3, 100)
    whole = tiles.WholeImage(canvas, Band(Rows(0, 100), np.ones((100, 3, 3), np.float32)))
    monkeypatch.setattr(tiles, "BLOCK", 10)
    top = tiles.chained([Counting(), Spread()], whole)
    for y in range(0, 100, 10):
        top.rows(Rows(y, y + 10))
    assert len(made) == len(set(made)) == 10


def test_nan_is_counted_and_kept(tmp_path, capsys):
    given = planes()
    given["R"][5, 6] = np.nan
    given["B"][5, 6] = np.inf
    given["G"][60, 1] = np.inf
    source = write(tmp_path / "in.exr", given)
    assert cli.main(["post", str(source), "-o", str(source), "--effect", NOTHING]) == 0
    assert "2 pixels are NaN" in capsys.readouterr().err
    found, _ = read(source)
    assert np.array_equal(found["R"], given["R"], equal_nan=True)
    assert np.isinf(found["G"][60, 1])


def test_half_stays_finite(tmp_path):
    given = {name: np.full((4, 4), 4e4, np.float16) for name in "RGB"}
    source = write(tmp_path / "in.exr", given)
    assert post(source, "-o", source, "--effect", NOTHING + ",k1=5") == 0
    assert read(source)[0]["R"].max() == 65504


def test_the_first_part_is_used_and_that_is_said(tmp_path, capsys):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    parts = [OpenEXR.Part(dict(header), planes(), name) for name in ("beauty", "other")]
    with OpenEXR.File(parts) as file:
        file.write(str(tmp_path / "in.exr"))
    out = tmp_path / "out.exr"
    assert cli.main(["post", str(tmp_path / "in.exr"), "-o", str(out), "--effect", NOTHING]) == 0
    assert "first of its 2 parts" in capsys.readouterr().err
    assert np.array_equal(read(out)[0]["R"], planes()["R"])


def test_grain_and_its_like_come_last(toys):
    planned = recipe.from_words(["film:gain=1", "spread", "upside"])
    order, moved = recipe.in_order(planned)
    assert [p.effect.name for p in order] == ["spread", "upside", "film"]
    assert moved == ["film"]
    assert recipe.in_order(order) == (order, [])


def test_a_recipe_says_the_same_as_words(tmp_path, toys):
    file = tmp_path / "recipe.json"
    file.write_text('[{"effect": "film", "gain": -2}, {"effect": "vignetting", "k1": -0.5}]')
    words = recipe.from_words(["film:gain=-2", "vignetting:k1=-1/2"])
    read = recipe.from_file(file)
    assert [(p.effect, p.values) for p in read] == [(p.effect, p.values) for p in words]


def test_a_recipe_of_many_megabytes_is_refused_before_it_is_parsed(tmp_path):
    file = tmp_path / "recipe.json"
    file.write_text("[" + "[]," * 400_000 + "[]]")
    with pytest.raises(InputError, match="wanted at most 1000000 bytes, got 1200004"):
        recipe.from_file(file)


def test_units_of_parameters():
    distance = Parameter("focus", "", "m")
    assert distance.read("250cm", "", UsageError) == 2.5
    assert distance.read("inf", "", UsageError) == np.inf
    assert Parameter("f", "", "mm").read("2in", "", UsageError) == 50.8
    assert Parameter("s", "", "mm", kind="size").read("ff", "", UsageError) == (36, 24)
    assert Parameter("s", "", "mm", kind="size").read([3, 2], "", UsageError) == (3, 2)


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["vignetting:modl=natural"], 2, "did you mean 'model'"),
        (["vigneting"], 2, "did you mean 'vignetting'"),
        (["vignetting:k1"], 2, "wanted key=value, got 'k1'"),
        (["vignetting:k1=1,k1=2"], 2, "got twice"),
        (["vignetting:model=natral"], 2, "did you mean 'natural'"),
        (["vignetting:k1=much"], 2, "k1: wanted a number, got 'much'"),
        (
            ["vignetting:focal_length=-3"],
            2,
            "focal_length: wanted a number of mm of at least",
        ),
        (["vignetting"], 2, "the file has none; give its size in mm, such as sensor=36x24"),
        (["vignetting:sensor=36x24"], 2, "focal_length: the file has none"),
        (["vignetting:model=lens,sensor=36x24"], 2, "vignetting: model=lens needs a lens"),
        (["vignetting:model=lens,lens=nothing,sensor=36x24"], 3, "no lens of the library"),
        (["film"], 2, "gain: wanted a number of stops of at least -10, got no value"),
        (
            ["diffraction"],
            2,
            "f_number: wanted an f-stop such as 2.8, f/2.8 or f2.8, at least 0.3, got no value",
        ),
        (["deep"], 3, "channel for motion.u: wanted motion.U or"),
    ],
)
def test_bad_effects(tmp_path, capsys, toys, words, code, message):
    source = write(tmp_path / "in.exr", planes())
    chain = [word for name in words for word in ("--effect", name)]
    assert post(source, "-o", tmp_path / "out.exr", *chain) == code
    assert message in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["in.exr"]


def test_channels_by_other_names(tmp_path, capsys, toys):
    source = write(tmp_path / "in.exr", planes())
    roles = ["--channel", "motion.u=depth.Z", "--channel", "motion.v=object_id"]
    out = tmp_path / "out.exr"
    with pytest.raises(NotImplementedError):  # it has all that it needs
        run.process(source, out, recipe.from_words(["deep"]),
                    roles={"motion.u": "depth.Z", "motion.v": "object_id"})  # fmt: skip
    assert post(source, "-o", out, "--effect", "deep", *roles[:2]) == 3
    assert "motion.v" in capsys.readouterr().err
    assert post(source, "-o", out, "--effect", "deep", "--channel", "motion=x") == 2
    assert post(source, "-o", out, "--effect", "deep", "--channel", "depth=fog") == 3
    assert "wanted fog, got depth.Z, object_id" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{}", "wanted a list of objects"),
        ("[1]", "wanted a list of objects"),
        ("[", "line 1"),
        ('[{"effect": "film"}]', "[0]: gain: wanted"),
        ('[{"effect": "vignetting"}, {"gain": 1}]', "[1]: effect: wanted a name"),
        ('[{"effect": "vignetting", "k1": true}]', "k1: wanted a number, got True"),
        ('[{"effect": "vignetting", "k1": NaN}]', "wanted a finite number"),
        ('[{"effect": "vignetting", "model": ["a"]}]', "model: wanted one of natural"),
        (f'[{{"effect": "vignetting", "{"x" * 5000}": 1}}]', "xx...: wanted one of"),
    ],
)
def test_bad_recipes(tmp_path, toys, text, message):
    file = tmp_path / "recipe.json"
    file.write_text(text)
    with pytest.raises(InputError) as caught:
        recipe.from_file(file)
    assert message in str(caught.value)


def bad_files(tmp_path: Path) -> dict[str, tuple[bytes, str]]:
    whole = write(tmp_path / "whole.exr", planes()).read_bytes()
    lacking = write(tmp_path / "whole.exr", {"U": np.ones((4, 4), np.float32)}).read_bytes()
    window = whole.index(b"dataWindow\0box2i\0") + len(b"dataWindow\0box2i\0") + 4
    huge = whole[:window] + struct.pack("<4i", 0, 0, 2**31 - 2, 5) + whole[window + 16 :]
    return {
        "empty": (b"", "wanted an OpenEXR file"),
        "text": (b"#?RADIANCE\n\n", "wanted an OpenEXR file"),
        "header cut off": (whole[:60], "header: truncated or too long"),
        "rows cut off": (whole[: len(whole) // 2], ""),
        "deep": (
            whole[:4] + struct.pack("<i", 2 | 0x800) + whole[8:],
            "deep pixels are not supported",
        ),
        "huge": (huge, "dataWindow: wanted corners in order"),
        "no colour": (lacking, "wanted R, G, B or Y, got U"),
    }


@pytest.mark.parametrize(
    "name", ["empty", "text", "header cut off", "rows cut off", "deep", "huge", "no colour"]
)
def test_bad_pictures(tmp_path, capsys, name):
    data, message = bad_files(tmp_path)[name]
    file, out = tmp_path / "bad.exr", tmp_path / "out.exr"
    file.write_bytes(data)
    assert post(file, "-o", out, "--effect", NOTHING) == 3
    error = capsys.readouterr().err
    assert str(file) in error
    assert message in error
    assert not out.exists()


def test_pictures_for_screens_are_refused(tmp_path, capsys):
    assert post(tmp_path / "in.png", "-o", tmp_path / "out.exr", "--effect", NOTHING) == 2
    assert "scene-linear .exr" in capsys.readouterr().err
    source = write(tmp_path / "in.exr", planes())
    assert post(source, "-o", tmp_path / "out.jpg", "--effect", NOTHING) == 2
    assert "wanted .exr, or .png" in capsys.readouterr().err
    assert post(source, "-o", tmp_path / "nowhere" / "out.exr", "--effect", NOTHING) == 5
    assert post(tmp_path / "no.exr", "-o", tmp_path / "out.exr", "--effect", NOTHING) == 3
    assert post(source, "-o", tmp_path / "out.exr") == 2


def test_a_png_is_the_picture_for_the_eye(tmp_path):
    import OpenImageIO as oiio

    source = write(tmp_path / "in.exr", {**planes(), "R": np.full((70, 40), 0.214, np.float32)})
    assert post(source, "-o", tmp_path / "out.png", "--effect", NOTHING) == 0
    shown = oiio.ImageInput.open(str(tmp_path / "out.png")).read_image(oiio.UINT8)
    assert shown.shape == (70, 40, 3)
    assert np.unique(shown[:, :, 0]).tolist() == [127]  # half of white, by eye
    grey = write(tmp_path / "grey.exr", {"Y": np.full((70, 40), 0.214, np.float32)})
    assert post(grey, "-o", tmp_path / "out.png", "--effect", NOTHING) == 0
    shown = oiio.ImageInput.open(str(tmp_path / "out.png")).read_image(oiio.UINT8)
    assert (shown == 127).all()


def test_files_may_have_commas_in_their_names(tmp_path):
    kernel = write(tmp_path / "a,b, c.exr", {c: np.ones((1, 1), np.float32) for c in "RGB"})
    source = write(tmp_path / "in,1.exr", planes())
    word = f"psf:file={kernel},normalise=1"
    assert post(source, "-o", tmp_path / "out,1.exr", "--effect", word) == 0
    assert read(tmp_path / "out,1.exr")[0]["R"] == pytest.approx(planes()["R"], abs=1e-5)


def test_the_list_names_parameters_with_units(capsys):
    assert cli.main(["post", "--list"]) == 0
    text = capsys.readouterr().out
    for name, effect in effects.EFFECTS.items():
        assert f"{name}: " in text
        for parameter in effect.parameters:
            unit = f" [{parameter.unit}]" if parameter.unit else ""
            assert f"    {parameter.name}{unit}" in text


def test_progress_as_json(tmp_path, capsys):
    source = write(tmp_path / "in.exr", planes())
    words = [str(source), "-o", str(tmp_path / "out.exr"), "--effect", NOTHING, "--json-progress"]
    assert cli.main(["post", *words]) == 0
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert events[0]["event"] == "progress"
    assert events[0]["fraction"] == 1
    assert "done" in [event["event"] for event in events]
