"""Files of another version either work or are refused: by file, what was wanted and what was got.

Each test makes a good file and changes the version that it carries, byte by byte or in its text.
docs/stability.md has the table of these files.
"""

from __future__ import annotations

import copy
import json
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.errors import InputError, MismatchError, UsageError
from daguerre.files import value
from daguerre.post import recipe
from daguerre.rendering import merging, passes

NOW = dg.__version__
OTHER = re.sub(r"\d", "9", NOW)  # as long, so that a file keeps its layout
SIZE = {"resolution": (8, 6)}


def session(**settings: Any) -> dg.Session:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    return dg.Session(scene, dg.Camera(lens_model="pinhole"), **SIZE, **settings)


def written(path: Path, begin: int, end: int) -> Path:
    """A pass of some samples."""
    one = session()
    one.draw(begin, end)
    passes.write_pass(path, one.frame(), passes.pass_of(one))
    return path


def by_another_version(path: Path) -> Path:
    """Puts another version in every place of a file that names this one."""
    data = path.read_bytes()
    assert NOW.encode() in data
    path.write_bytes(data.replace(NOW.encode(), OTHER.encode()))
    return path


def test_a_checkpoint_is_refused_and_kept(tmp_path: Path) -> None:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    camera, kept = dg.Camera(lens_model="pinhole"), tmp_path / "kept.exr"
    settings: dict[str, Any] = {**SIZE, "spp": 64, "checkpoint": kept}
    dg.render(scene, camera, **settings, progress=lambda s: s.samples < 1)
    before = by_another_version(kept).read_bytes()
    with pytest.raises(MismatchError) as refused:
        dg.render(scene, camera, **settings)
    said = str(refused.value)
    assert said.startswith(f"{kept}: does not belong to this render")
    assert re.search(rf"the build of daguerre \({OTHER} .*, wanted {NOW} ", said)
    assert kept.read_bytes() == before


def test_a_pass_is_not_added_to_those_of_another_version(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one = written(tmp_path / "a.exr", 0, 2)
    two = by_another_version(written(tmp_path / "b.exr", 2, 4))
    assert main(["merge", str(one), str(two), "-o", str(tmp_path / "out.exr")]) == 4
    said = " ".join(capsys.readouterr().err.split())
    assert f"{two}: does not belong to {one}" in said
    assert f"the build of daguerre ({OTHER} " in said
    assert f", wanted {NOW} " in said
    assert not (tmp_path / "out.exr").exists()


def test_passes_of_one_other_version_are_added_to_the_same_bits(tmp_path: Path) -> None:
    files = [written(tmp_path / f"{i}.exr", 2 * i, 2 * i + 2) for i in range(2)]
    whole, _ = merging.merge(files)
    other, total = merging.merge([by_another_version(file) for file in files])
    np.testing.assert_array_equal(other.rgb, whole.rgb)
    assert total.key["build"].startswith(OTHER)
    assert other.metadata["version"] == OTHER


def test_a_pass_of_another_form_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(passes, "FORM", passes.FORM + 1)
    path = written(tmp_path / "a.exr", 0, 1)
    monkeypatch.undo()
    with pytest.raises(InputError) as refused:
        passes.read_pass(path)
    wanted = f"{path}: format of the pass: wanted 1, got 2; another version wrote it"
    assert str(refused.value) == f"{wanted}, this is daguerre {NOW}"
    assert main(["merge", str(path), "-o", str(tmp_path / "out.exr")]) == 3
    assert "format of the pass: wanted 1, got 2" in " ".join(capsys.readouterr().err.split())


def test_a_pass_without_a_form_is_of_the_first(tmp_path: Path) -> None:
    path = written(tmp_path / "a.exr", 0, 1)
    path.write_bytes(path.read_bytes().replace(b"daguerre:pass\0", b"daguerre:past\0"))
    assert passes.read_pass(path).ranges == [(0, 1)]


def test_a_build_is_named_whole_and_a_hash_by_its_start() -> None:
    build = "10.11.12rc13 aarch64 NEON_WITHOUT_AES Embree 4.13.15"
    assert passes._short(build) == build
    assert passes._short(64 * "a") == 12 * "a"
    assert "\x1b" not in passes._short("\x1b[31m")


def test_a_crop_is_not_joined_to_those_of_another_version(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = []
    for name, crop in (("a", (0, 0, 8, 3)), ("b", (0, 3, 8, 6))):
        one = session(crop=crop)
        one.draw(0, 1)
        files.append(tmp_path / f"{name}.exr")
        one.frame().save(files[-1])
    by_another_version(files[1])
    assert main(["merge", *map(str, files), "-o", str(tmp_path / "out.exr")]) == 4
    said = " ".join(capsys.readouterr().err.split())
    assert f"{files[1]}: not a crop of the same picture as {files[0]}" in said
    assert OTHER in said
    assert NOW in said


def test_a_picture_of_another_version_is_read(tmp_path: Path) -> None:
    one = session()
    one.draw(0, 1)
    one.frame().save(tmp_path / "a.exr")
    frame = dg.load_frame(by_another_version(tmp_path / "a.exr"))
    np.testing.assert_array_equal(frame.rgb, one.frame().rgb)
    assert frame.metadata["version"] == OTHER


def test_a_lens_fit_is_refused() -> None:
    data = dg.polynomial.fit("double-gauss-50mm-f2", degree=3).to_dict()
    dg.polynomial.LensFit.from_dict(data)
    wanted = "lens fit: format: wanted 'daguerre-lens-fit/0.1', got 'daguerre-lens-fit/9.9'"
    with pytest.raises(InputError, match=re.escape(wanted)):
        dg.polynomial.LensFit.from_dict(data | {"format": "daguerre-lens-fit/9.9"})


@pytest.mark.parametrize(
    ("room", "name"),
    [
        (dg.lenses, "double-gauss-50mm-f2"),
        (dg.sensors, "sony-a7r-ii"),
        (dg.stocks, "generic-panchromatic-400"),
    ],
)
def test_a_schema_that_is_not_known_is_refused(tmp_path: Path, room: Any, name: str) -> None:
    path = tmp_path / "file.json"
    path.write_text((Path(room.__file__).parent / "library" / f"{name}.json").read_text())
    room.load(path)
    data = json.loads(path.read_text())
    path.write_text(json.dumps(data | {"schema": "daguerre-other/9.9"}))
    said = f"{path}: schema: wanted '{data['schema']}', got 'daguerre-other/9.9'"
    with pytest.raises(InputError, match=re.escape(said)):
        room.load(path)


def test_settings_with_a_parameter_of_another_version_are_refused() -> None:
    data = dg.RenderSettings.of(spp=4).to_json()
    data["light"]["photons"] = 1
    with pytest.raises(UsageError, match="settings: light: no parameter 'photons'"):
        dg.RenderSettings.from_json(data)


def test_a_recipe_with_an_effect_of_another_version_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "recipe.json"
    path.write_text('[{"effect": "vignetting"}, {"effect": "hologram"}]')
    with pytest.raises(InputError, match=re.escape(str(path)) + ".*hologram"):
        recipe.from_file(path)


def things() -> list[Any]:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    lens = dg.lenses.load("double-gauss-50mm-f2")
    return [
        scene,
        dg.Camera(lens=lens),
        lens,
        dg.keys([(0, 1), (1, 2)]),
        dg.RenderSettings.of(spp=4),
    ]


@pytest.mark.parametrize("thing", things(), ids=lambda thing: type(thing).__name__)
def test_a_pickle_is_refused(thing: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    assert pickle.loads(pickle.dumps(thing)) == copy.deepcopy(thing) == thing
    assert value.MADE_BY not in vars(pickle.loads(pickle.dumps(thing)))
    monkeypatch.setattr(value, "__version__", "9.9.9")
    other = pickle.dumps(thing)
    monkeypatch.undo()
    said = rf"pickle of a \w+: made by daguerre 9\.9\.9, but this is daguerre {NOW}"
    with pytest.raises(InputError, match=said):
        pickle.loads(other)


def test_a_pickle_without_a_version_is_refused() -> None:
    camera = dg.Camera()
    state = {name: part for name, part in camera.__getstate__().items() if name != value.MADE_BY}
    with pytest.raises(
        InputError, match=r"pickle of a Camera: made by daguerre of an older version"
    ):
        dg.Camera.__new__(dg.Camera).__setstate__(state)
