"""Light followed from the emitters to the film: bits, splits, bad input, and one equality per kind.

The catalogue of pictures that camera and light must agree on is in ``test_light_pass_proof.py``.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import MismatchError, UsageError
from daguerre.rendering.merging import merge
from daguerre.rendering.passes import pass_of, read_pass, write_pass
from daguerre.rendering.session import Session
from tests.support.pictures.statistical import batch_means, differences
from tests.support.scene import scenes

SIZE = (32, 20)
PLAN = (4000.0, 0.0)


def lamps() -> dg.Scene:
    """Balls of light before, in and behind the plane of focus, and a glowing pane."""
    scene = dg.Scene()
    for x, y, z, color in (
        (-0.05, 0.02, -0.7, (60, 30, 10)),
        (0.03, 0.01, -1.2, (30, 40, 60)),
        (-0.1, -0.1, -3.2, (60, 60, 100)),
    ):
        scene.add_light(dg.SphereLight(color, 0.02), scenes.at(x, y, z))
    points, faces = scenes.quad(0.05)
    glow = dg.Material(dg.Diffuse((0, 0, 0)), emission=(20, 90, 60))
    scene.add_instance(scene.add_mesh(points, faces), glow, scenes.at(0.06, 0.0, -1.0))
    return scene


def camera(**changes: Any) -> dg.Camera:
    facts = {"focal_length": 50, "f_stop": 2.0, "focus_distance": 1.2, "sensor_size": (9, 5.4)}
    return dg.Camera(**{**facts, **changes})


def session(**options: Any) -> Session:
    options = {"resolution": SIZE, "light_paths": PLAN, **options}
    return Session(lamps(), camera(), **options)


def same_bits(a: Session, b: Session) -> bool:
    first, second = a.state(), b.state()
    return first.keys() == second.keys() and all(
        np.array_equal(first[part], second[part]) for part in first
    )


CAMERAS = {
    "thin": {},
    "pinhole": {"f_stop": None},
    "exact": {"lens": "double-gauss-50mm-f2", "focal_length": None},
    "polynomial": {
        "lens": "double-gauss-50mm-f2",
        "focal_length": None,
        "lens_model": "polynomial",
    },
}


@pytest.mark.parametrize("kind", CAMERAS)
def test_camera_light_and_both_are_one_picture(kind: str) -> None:
    scene, one = lamps(), camera(**CAMERAS[kind])

    def draw(technique: str, spp: int, plan: Any, seed: int) -> np.ndarray:
        options = {"technique": technique, "light_paths": plan, "seed": seed}
        # The tails of other filters bring pixels beside a lamp light that few of their samples see:
        # pictures from the lens do not know their own variance there.
        return batch_means(scene, one, 8, spp, resolution=SIZE, filter="box", **options)

    by_camera = draw("camera", 96, "off", 1000)
    by_light, by_both = draw("light", 24, PLAN, 2000), draw("both", 24, PLAN, 3000)
    assert differences(by_camera, by_light) == []
    assert differences(by_camera, by_both) == []
    assert differences(by_camera, 1.03 * by_both) != []


def test_a_split_of_samples_and_threads_change_no_bit() -> None:
    whole, parts = session(threads=1), session(threads=2)
    whole.draw(0, 7)
    parts.draw(3, 7)
    parts.draw(0, 3)
    assert "splats" in whole.state()
    assert same_bits(whole, parts)
    assert whole.counters.light_paths == parts.counters.light_paths


def test_passes_add_up_and_refuse_another_plan(tmp_path: Path) -> None:
    whole = session()
    whole.draw(0, 6)
    files = []
    for a, b in ((0, 2), (2, 6)):
        one = session()
        one.draw(a, b)
        files.append(tmp_path / f"{a}.exr")
        write_pass(files[-1], one.frame(), pass_of(one))
    frame, total = merge(files)
    assert np.array_equal(frame.rgb, whole.frame().rgb)
    assert all(np.array_equal(total.state[k], v) for k, v in whole.state().items())
    assert frame.metadata["light_paths"] == "4000,0"
    for plan in ("off", (4001, 0)):
        other = session(light_paths=plan)
        other.draw(6, 7)
        with pytest.raises(MismatchError, match="light paths"):
            merge([read_pass(files[0]), pass_of(other)])


def test_a_saved_state_goes_on(tmp_path: Path) -> None:
    whole, first = session(), session()
    whole.draw(0, 5)
    first.draw(0, 2)
    write_pass(tmp_path / "a.exr", first.frame(), pass_of(first))
    saved = read_pass(tmp_path / "a.exr")
    again = session()
    again.set_state(saved.state, saved.ranges)
    again.draw(2, 5)
    assert same_bits(whole, again)
    with pytest.raises(MismatchError, match="splats"):
        session(light_paths="off").set_state(saved.state, saved.ranges)


def test_light_that_lands_beside_the_frame_is_counted() -> None:
    one = session(resolution=SIZE)
    one.draw(0, 4)
    assert one.counters.light_paths == 4 * PLAN[0]
    assert 0 < one.counters.splats_off_film < one.counters.light_paths
    off = session(light_paths="off")
    off.draw(0, 1)
    assert off.counters.light_paths == 0
    assert list(off.state()) == ["sums", "coverage"]
    assert "light_paths" not in off.metadata


@pytest.mark.parametrize(
    "value", ["some", "1,2,3", "nan", (-1, 0), (0, float("inf")), True, None, (1e10, 0), b"1", ""]
)
def test_bad_plans_are_one_error(value: Any) -> None:
    with pytest.raises(UsageError, match="light_paths: wanted auto, off, or"):
        session(light_paths=value)


def test_an_unknown_technique_is_one_error() -> None:
    with pytest.raises(UsageError, match="technique: wanted both, camera, light, got 'lamp'"):
        session(technique="lamp")
