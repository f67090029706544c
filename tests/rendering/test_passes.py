"""Passes on the real film: any split, added in any order, gives the bits of the whole."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.errors import InputError, MismatchError
from daguerre.rendering import merging, passes, ranges
from daguerre.rendering.session import Session
from tests.support.scene import scenes

SIZE = (24, 16)


def session(**options: object) -> Session:
    scene = scenes.furnace(dg.Material(dg.Conductor((0.9, 0.5, 0.3), 0.3)))
    camera = dg.Camera(f_stop=2.0, focus_distance=3.0)
    return Session(scene, camera, **{"resolution": SIZE, "aovs": True, **options})  # type: ignore[arg-type]


def drawn(*spans: tuple[int, int], **options: object) -> passes.Pass:
    one = session(**options)
    for begin, end in spans:
        one.draw(begin, end)
    return passes.pass_of(one)


def write(path: Path, *spans: tuple[int, int], **options: object) -> Path:
    one = session(**options)
    for begin, end in spans:
        one.draw(begin, end)
    passes.write_pass(path, one.frame(), passes.pass_of(one))
    return path


def planes(frame: dg.Frame) -> dict[str, np.ndarray]:
    named = {k: getattr(frame, k) for k in ("rgb", "xyz", "alpha", "variance", "samples")}
    return named | frame.aovs


def assert_same(a: dg.Frame, b: dg.Frame) -> None:
    one, two = planes(a), planes(b)
    assert set(one) == set(two)
    for name, plane in one.items():
        assert plane.dtype == two[name].dtype, name
        np.testing.assert_array_equal(plane, two[name], err_msg=name)


@pytest.fixture(scope="module")
def whole() -> dg.Frame:
    one = session()
    one.draw(0, 16)
    return one.frame()


def test_merged_in_any_order_equals_the_whole(tmp_path: Path, whole: dg.Frame) -> None:
    splits = [(0, 3), (3, 8), (8, 16)]
    files = [write(tmp_path / f"{a}.exr", (a, b)) for a, b in splits]
    for order in itertools.permutations(files):
        frame, total = merging.merge(order)
        assert_same(frame, whole)
        assert total.ranges == [(0, 16)]
        assert frame.metadata["samples"] == 16


def test_merged_in_steps_equals_the_whole(tmp_path: Path, whole: dg.Frame) -> None:
    a, b, c = (write(tmp_path / f"{r[0]}.exr", r) for r in ((0, 4), (4, 8), (8, 16)))
    frame, total = merging.merge([c, a])
    assert ranges.missing_ranges(total.ranges) == [(4, 8)]
    passes.write_pass(tmp_path / "ac.exr", frame, total)
    assert_same(merging.merge([tmp_path / "ac.exr", b])[0], whole)


def test_a_planted_fault_is_seen(whole: dg.Frame) -> None:
    """The comparison above would notice one unit in the last word of one pixel."""
    one = drawn((0, 16))
    state = {name: words.copy() for name, words in one.state.items()}
    state["sums"][3, 5, 1] += np.uint32(1 << 20)  # the second word of X
    frame, _ = merging.merge([replace(one, state=state)])
    with pytest.raises(AssertionError):
        assert_same(frame, whole)


def test_state_survives_the_file(tmp_path: Path) -> None:
    one = drawn((0, 2), (5, 6))
    write(tmp_path / "a.exr", (0, 2), (5, 6))
    back = passes.read_pass(tmp_path / "a.exr")
    assert set(back.state) == set(one.state)
    for name, words in one.state.items():
        np.testing.assert_array_equal(back.state[name], words, err_msg=name)
    assert back.ranges == [(0, 2), (5, 6)]
    assert back.key == one.key


def test_a_session_goes_on_from_a_pass(tmp_path: Path, whole: dg.Frame) -> None:
    saved = passes.read_pass(write(tmp_path / "a.exr", (0, 7)))
    one = session()
    one.set_state(saved.state, saved.ranges)
    one.draw(7, 16)
    assert_same(one.frame(), whole)


def test_a_pass_can_be_looked_at(tmp_path: Path) -> None:
    path = write(tmp_path / "a.exr", (0, 2))
    with OpenEXR.File(str(path), separate_channels=True) as file:
        assert [part.name() for part in file.parts] == ["beauty", "sums", "aovs", "coverage"]
        assert {"R", "G", "B", "A", "depth.Z", "object_id"} <= set(file.parts[0].channels)
        assert {c.pixels.dtype for c in file.parts[1].channels.values()} == {np.dtype(np.uint32)}


def test_overlap_is_refused() -> None:
    with pytest.raises(MismatchError, match="samples 4:8 are also in"):
        merging.merge([drawn((0, 8)), drawn((4, 12))])


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"seed": 1}, r"seed 1 \(wanted 0\)$"),
        ({"filter": "box"}, r"filter box \(wanted blackman_harris\)$"),
        ({"resolution": (24, 18)}, r"resolution 24,18 \(wanted 24,16\), crop 0,0,24,18"),
        ({"crop": (0, 0, 8, 8)}, r"crop 0,0,8,8 \(wanted 0,0,24,16\)$"),
        ({"light_paths": 30}, r"light paths 30,0 \(wanted off\)$"),
        ({"max_depth": 3}, "resolution, crop, seed, filter, depth, AOVs, light paths"),
    ],
)
def test_passes_of_other_settings_are_refused(options: dict[str, object], says: str) -> None:
    with pytest.raises(MismatchError, match=rf"they differ in .*{says}"):
        merging.merge([drawn((0, 4)), drawn((4, 8), **options)])


def test_passes_of_another_camera_or_scene_are_refused() -> None:
    scene = scenes.furnace()
    other = Session(scene, dg.Camera(f_stop=2.0, focus_distance=3.0), resolution=SIZE, aovs=True)
    other.draw(4, 8)
    with pytest.raises(MismatchError, match="the scene"):
        merging.merge([drawn((0, 4)), passes.pass_of(other)])
    stopped = Session(
        scenes.furnace(dg.Material(dg.Conductor((0.9, 0.5, 0.3), 0.3))),
        dg.Camera(f_stop=2.1, focus_distance=3.0),
        resolution=SIZE,
        aovs=True,
    )
    stopped.draw(4, 8)
    with pytest.raises(MismatchError, match="they differ in the camera"):
        merging.merge([drawn((0, 4)), passes.pass_of(stopped)])


def test_a_picture_is_no_pass(tmp_path: Path) -> None:
    one = session()
    one.draw(0, 1)
    one.frame().save(tmp_path / "a.exr")
    with pytest.raises(InputError, match="holds no sums"):
        passes.read_pass(tmp_path / "a.exr")
    (tmp_path / "b.exr").write_text("hello")
    with pytest.raises(InputError, match="wanted an OpenEXR file"):
        passes.read_pass(tmp_path / "b.exr")
    with pytest.raises(InputError, match="no such file"):
        passes.read_pass(tmp_path / "c.exr")


def test_merge_command(tmp_path: Path, whole: dg.Frame, capsys: pytest.CaptureFixture[str]) -> None:
    a, b = write(tmp_path / "a.exr", (0, 4)), write(tmp_path / "b.exr", (8, 16))
    c = write(tmp_path / "c.exr", (4, 8))
    out = tmp_path / "out.exr"
    assert main(["merge", str(b), str(a), "-o", str(out)]) == 0
    assert "samples 4:8 are missing" in capsys.readouterr().err
    out.unlink()
    assert main(["merge", str(b), str(a), "-o", str(out), "--strict"]) == 4
    assert main(["merge", str(b), str(b), "-o", str(out)]) == 4
    assert not out.exists()
    assert main(["merge", str(b), str(a), str(c), "-o", str(out)]) == 0
    whole.save(tmp_path / "whole.exr")
    with (
        OpenEXR.File(str(out), separate_channels=True) as one,
        OpenEXR.File(str(tmp_path / "whole.exr"), separate_channels=True) as two,
    ):
        assert set(one.channels()) == set(two.channels())
        for name, channel in one.channels().items():
            np.testing.assert_array_equal(channel.pixels, two.channels()[name].pixels)


def test_ranges() -> None:
    assert ranges.join_ranges([(4, 8), (0, 4), (10, 12)]) == [(0, 8), (10, 12)]
    assert ranges.missing_ranges([(4, 8), (10, 12)]) == [(0, 4), (8, 10)]
    assert ranges.missing_ranges([(4, 8)], (2, 12)) == [(2, 4), (8, 12)]
    assert ranges.missing_ranges([(0, 12)], (2, 12)) == []
    assert ranges.missing_ranges([], (2, 3)) == [(2, 3)]
    assert ranges.show_ranges([(0, 1), (4, 8)]) == "0:1, 4:8"
