"""Motion reaches the core over the interval of the shutter: boxes of what is built, hashes."""

from __future__ import annotations

import math

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import InputError
from daguerre.importers.gltf import reader as gltf
from daguerre.setup.built_scene import BuiltScene
from daguerre.setup.content_hash import content_hash
from daguerre.setup.scene import build
from daguerre.setup.scene_motion import MovingParts
from tests.support.formats.make_gltf import triangle
from tests.support.scene import scenes

SQUARE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
FACES = [[0, 1, 2], [0, 2, 3]]


class Over:
    """A value over time that is neither keys nor a spin."""

    def __init__(self, value, breaks):
        self._value, self._breaks = value, breaks

    def at(self, time_s):
        return self._value(time_s)

    def breaks(self, begin, end):
        return self._breaks(begin, end)


def slide(*xs: float) -> dg.Keys:
    return dg.keys([(float(i), scenes.at(x, 0, 0)) for i, x in enumerate(xs)])


def width(scene: dg.Scene, interval) -> tuple[float, float]:
    low, high = build(scene, interval).bounds
    return low[0], high[0]


def seen_along(core, x: float) -> bool:
    """Whether there is anything behind (x, 0) at the middle of the interval."""
    return core.first_hit((x, 0.0, 9.0), (0.0, 0.0, -1.0)) is not None


@pytest.mark.parametrize("how", ["keys", "function", "vertices"])
def test_boxes_hold_the_way_of_the_shutter_only(how):
    scene = dg.Scene()
    path = slide(0, 8, 0)
    if how == "vertices":
        places = [(0, 0), (1, 8), (2, 0)]
        steps = dg.keys([(t, SQUARE + np.float32([x, 0, 0])) for t, x in places])
        scene.add_instance(scene.add_mesh(SQUARE, FACES, steps=steps))
    else:
        moving = path
        if how == "function":
            moving = Over(path.at, path.breaks)
        scene.add_instance(scene.add_mesh(SQUARE, FACES), transform=moving)
    assert width(scene, None) == pytest.approx((-1, 1), abs=1e-3)
    assert width(scene, (0.5, 0.5)) == pytest.approx((3, 5), abs=1e-3)
    assert width(scene, (0.25, 0.5)) == pytest.approx((1, 5), abs=1e-2)
    assert width(scene, (0.75, 1.25)) == pytest.approx((5, 9), abs=1e-2)
    core = build(scene, (0.25, 0.5))  # its middle is 0.375 s, where the square is at 3
    assert [seen_along(core, x) for x in (1.5, 2.5, 3.5, 4.5)] == [False, True, True, False]


def test_presence_reaches_the_core():
    scene = dg.Scene()
    there = dg.keys([(0, True), (1, False), (2, True)])
    scene.add_instance(scene.add_mesh(SQUARE, FACES), shown=there)
    for interval, wanted in (((0, 0.5), True), ((1.2, 1.4), False), ((2, 3), True)):
        assert seen_along(build(scene, interval), 0) is wanted
    assert seen_along(build(scene), 0)
    assert not seen_along(build(scene.at(1.5)), 0)


def test_spins_and_keys_go_to_the_core_as_they_are():
    scene = dg.Scene()
    mesh = scene.add_mesh(SQUARE, FACES)
    wheel = dg.spin((0, 0, 1), 1000)
    scene.add_instance(mesh, transform=wheel)
    moving = MovingParts(scene, (0, 1), [])
    assert moving.transform(0) is wheel.motion
    core = build(scene, (0, 1))
    assert core.bounds[1][0] == pytest.approx(math.sqrt(2), rel=0.05)


def test_a_mesh_that_jumps_is_told():
    scene = dg.Scene()
    steps = dg.keys([(0, SQUARE), (0.3, SQUARE + 5)], "step")
    scene.add_instance(scene.add_mesh(SQUARE, FACES, steps=steps, name="frog"))
    notes: list[str] = []
    build(scene, (0, 1), notes)
    assert notes == ["mesh 'frog' moves too unevenly for 129 steps: 129 steps approximate it"]
    build(scene, (0.5, 1), notes)
    assert len(notes) == 1


def test_what_a_dynamic_value_gives_wrong_is_named():
    scene = dg.Scene()
    odd = Over(lambda t: np.eye(4) if t == 0 else np.eye(3), lambda begin, end: ())
    scene.add_instance(scene.add_mesh(SQUARE, FACES), transform=odd, name="odd")
    with pytest.raises(InputError, match="instance 'odd': transform"):
        build(scene, (0, 1))


def test_the_hash_knows_the_motion():
    def hashed(moving, interval=(0.0, 1.0)) -> str:
        scene = dg.Scene()
        scene.add_instance(scene.add_mesh(SQUARE, FACES), transform=moving)
        return content_hash(scene, interval)

    assert hashed(slide(0, 8, 0)) == hashed(slide(0, 8, 0))
    assert hashed(slide(0, 8, 0)) != hashed(slide(0, 8.1, 0))
    assert hashed(slide(0, 8, 0)) != hashed(slide(0, 8, 0), (0.0, 0.9))
    ends = [(0.0, np.eye(4)), (1.0, scenes.at(1, 0, 0) @ np.diag([-1.0, -1, 1, 1]))]
    ways = [hashed(dg.keys(ends, way)) for way in ("decomposed", "linear", "twist")]
    assert ways[0] != ways[1]


def test_the_hash_of_another_interval_begins_with_what_does_not_move():
    scene, other = dg.Scene(), dg.Scene()
    for one, far in ((scene, 8), (other, 9)):
        one.add_instance(one.add_mesh(SQUARE, FACES), transform=slide(0, far, 0))
    first = BuiltScene(scene, (0.0, 1.0))
    later = BuiltScene(scene, (0.0, 0.5), first)
    assert first.hash == content_hash(scene, (0.0, 1.0))
    assert later.hash == content_hash(scene, (0.0, 0.5)) != first.hash
    assert BuiltScene(other, (0.0, 0.5), first).hash == content_hash(other, (0.0, 0.5))


def test_a_file_that_moves_is_blurred(tmp_path):
    """A shining band, 2 m wide, goes 4 m while the shutter is open: each point of the film sees it
    for as long as it takes to pass."""
    b = triangle()
    corners = b.accessor(SQUARE * (1, 9, 1))
    b.mesh({"POSITION": corners}, indices=b.accessor(np.ravel(FACES), "u2"), material=0)
    b.add("materials", {"emissiveFactor": [1, 1, 1]})
    b.json["nodes"][0]["mesh"] = 1
    keys, values = b.accessor([0, 1]), b.accessor([[-2, 0, 0], [2, 0, 0]])
    channel = {"sampler": 0, "target": {"node": 0, "path": "translation"}}
    b.add("animations", {"samplers": [{"input": keys, "output": values}], "channels": [channel]})
    scene = gltf.read(b.glb(tmp_path / "a.glb"), time=0.5)
    scene.add_camera("eye", dg.Camera(scenes.at(0, 0, 10), lens="pinhole", focal_length=50))
    x = (np.arange(72) - 35.5) * 0.1  # of pixels: 36 mm at 50 mm are 7.2 m at 10 m
    passed = np.minimum(x + 3, 3 - x) / 4  # of a second, while less than all of the band passes
    for shutter, wanted in ((0.0, np.abs(x) < 1), (1.0, np.clip(passed, 0, 0.5))):
        camera = scene.camera().with_(shutter_time=shutter)
        frame = dg.render(scene, camera, resolution=(72, 12), spp=64, filter="box")
        seen = frame.rgb[:, :, 1].mean(axis=0)
        assert seen == pytest.approx(wanted.astype(float), abs=0.06)
