"""Values of light profiles: formulas, symmetry, products, and how they travel."""

from __future__ import annotations

import copy
import math
import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import DaguerreError, InputError
from daguerre.files import packing
from daguerre.scene.light_profile import ProfileTable
from daguerre.setup.content_hash import content_hash

THETA, PHI = np.arange(0, 181, 10.0), np.arange(0, 361, 30.0)
VALUES = np.random.default_rng(1).uniform(0.1, 2, (len(THETA), len(PHI)))
TABLE = dg.LightProfile.table(THETA, VALUES, PHI)
PRODUCT = TABLE * dg.LightProfile.cone(70, 0.2) * dg.LightProfile.focus(2, (0, 0.5, 1)) * 3.0


def way(theta_deg: float, phi_deg: float = 0.0) -> tuple[float, float, float]:
    theta, phi = math.radians(theta_deg), math.radians(phi_deg)
    return math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), -math.cos(theta)


def test_cone_and_focus_are_those_of_usd() -> None:
    cone, focus = dg.LightProfile.cone(60, 0.5), dg.LightProfile.focus(3, (0.25, 0.5, 1))
    steps = [way(t) for t in (0, 29.9, 45, 59.9, 60.1, 180)]
    assert cone.factors(steps)[:, 0] == pytest.approx([1, 1, 0.5, 0, 0, 0], abs=1e-4)
    factor = math.cos(math.radians(50)) ** 3
    tinted = [c + (1 - c) * factor for c in (0.25, 0.5, 1)]
    assert focus.factors([way(50), way(130)]) == pytest.approx(np.array([tinted, tinted]))
    both = (cone * focus).factors([way(45)])[0]
    assert both == pytest.approx(0.5 * focus.factors([way(45)])[0], rel=1e-4)


def test_products_multiply() -> None:
    ways = np.random.default_rng(3).normal(size=(200, 3))
    parts = (TABLE, dg.LightProfile.cone(70, 0.2), dg.LightProfile.focus(2, (0, 0.5, 1)))
    expected = 3 * np.prod([p.factors(ways) for p in parts], axis=0)
    assert PRODUCT.factors(ways) == pytest.approx(expected, rel=1e-5)
    assert (2 * TABLE).peak == pytest.approx(2 * TABLE.peak)
    assert dg.LightProfile().factors(ways) == pytest.approx(np.ones((200, 3)))


def test_power_and_means() -> None:
    assert dg.LightProfile().power == pytest.approx(4 * math.pi, rel=1e-5)
    assert dg.LightProfile.focus(1).power == pytest.approx(2 * math.pi, rel=1e-5)
    ways = np.random.default_rng(5).normal(size=(400_000, 3))
    assert PRODUCT.mean == pytest.approx(PRODUCT.factors(ways).mean(axis=0), rel=0.01)
    assert PRODUCT.relative().peak == pytest.approx(1)


def test_normalized_is_a_mean_of_one_over_sphere_or_hemisphere() -> None:
    whole = TABLE.normalized()
    assert whole.mean == pytest.approx((1, 1, 1), rel=1e-4)
    half = dg.LightProfile.table([0, 90], [4, 4]).normalized()
    assert half.factors([way(30)])[0] == pytest.approx((1, 1, 1), rel=1e-4)


def test_angle_scale_is_that_of_usd() -> None:
    spot = dg.LightProfile.table([0, 30, 60, 180], [9, 5, 1, 1])
    for theta in (0.0, 10.0, 29.0, 44.0, 80.0):
        narrow, wide = spot.stretched(0.5), spot.stretched(1.5)
        if theta * 2 <= 180:
            assert narrow.factors([way(theta)]) == pytest.approx(spot.factors([way(2 * theta)]))
        assert wide.factors([way(theta)]) == pytest.approx(spot.factors([way(theta / 1.5)]))
    up = dg.LightProfile.table([0, 120, 150, 180], [1, 1, 5, 9])
    for theta in (179.0, 160.0, 140.0, 100.0):
        narrow, wide = up.stretched(-0.5), up.stretched(-1.5)
        source = (theta - 180) / 0.5 + 180
        if source >= 0:
            assert narrow.factors([way(theta)]) == pytest.approx(up.factors([way(source)]))
        source = (theta - 180) / 1.5 + 180
        assert wide.factors([way(theta)]) == pytest.approx(up.factors([way(source)]))
    assert spot.stretched(0) is spot
    assert spot.stretched(0.5).factors([way(91)])[0, 0] == 0
    assert dg.LightProfile.table([100, 180], [1, 1]).stretched(3).peak == 0


def test_copies_compare_pickle_and_travel() -> None:
    for made in (PRODUCT, dg.LightProfile()):
        for other in (pickle.loads(pickle.dumps(made)), copy.deepcopy(made)):
            assert other == made
            assert hash(other) == hash(made)
            assert other.factors([way(20, 40)]) == pytest.approx(made.factors([way(20, 40)]))
    assert PRODUCT != TABLE
    changed = VALUES.copy()
    changed[3, 4] += 1e-3
    assert dg.LightProfile.table(THETA, changed, PHI) != TABLE
    lamp = dg.PointLight(profile=PRODUCT)
    assert lamp == dg.PointLight(profile=pickle.loads(pickle.dumps(PRODUCT)))
    assert lamp != dg.PointLight()
    packed = packing.pack(lamp)
    there = packing.unpack(packed.data, lambda name: packed.large[name].tobytes())
    assert there == lamp
    assert there.profile.power == pytest.approx(PRODUCT.power)


def test_arrays_of_a_table_cannot_be_changed() -> None:
    (table,) = pickle.loads(pickle.dumps(TABLE)).parts
    assert isinstance(table, ProfileTable)
    with pytest.raises(ValueError, match="read-only"):
        table.values[0, 0] = 1


def test_a_scene_hash_knows_profiles() -> None:
    def hashed(profile: dg.LightProfile | None) -> str:
        scene = dg.Scene()
        scene.add_light(dg.PointLight(profile=profile))
        return content_hash(scene)

    changed = VALUES.copy()
    changed[3, 4] += 1e-3
    names = [None, TABLE, TABLE * 2, PRODUCT, dg.LightProfile.table(THETA, changed, PHI)]
    assert len({hashed(p) for p in names}) == len(names)


WRONG: dict[str, Any] = {
    "cone of 0": lambda: dg.LightProfile.cone(0),
    "cone of 200": lambda: dg.LightProfile.cone(200),
    "softness": lambda: dg.LightProfile.cone(20, 2),
    "focus": lambda: dg.LightProfile.focus(-1),
    "tint": lambda: dg.LightProfile.focus(1, (-1, 0, 0)),
    "falling": lambda: dg.LightProfile.table([0, 90, 45], [1, 1, 1]),
    "beyond": lambda: dg.LightProfile.table([0, 190], [1, 1]),
    "below": lambda: dg.LightProfile.table([-10, 90], [1, 1]),
    "too close": lambda: dg.LightProfile.table([89.9999999999, 90], [1, 1]),
    "negative": lambda: dg.LightProfile.table([0, 90], [1, -1]),
    "nan": lambda: dg.LightProfile.table([0, 90], [1, math.nan]),
    "too large": lambda: dg.LightProfile.table([0, 90], [1, 1e200]),
    "shape": lambda: dg.LightProfile.table([0, 90], [1, 1, 1]),
    "circle": lambda: dg.LightProfile.table([0, 90], [[1, 1], [1, 1]], [0, 100]),
    "size": lambda: dg.LightProfile.table(
        np.linspace(0, 180, 2000), np.ones((2000, 600)), np.linspace(0, 360, 600)
    ),
    "empty": lambda: dg.LightProfile.table([], []),
    "text": lambda: dg.LightProfile.table("abc", [1]),
    "scale": lambda: dg.LightProfile((), -1.0),
    "parts": lambda: dg.LightProfile((3,)),  # type: ignore[arg-type]
    "direction": lambda: TABLE.factors([(0, 0, 0)]),
    "product": lambda: TABLE * 1e300,
    "a number": lambda: TABLE * -1.0,
    "light": lambda: dg.Scene().add_light(dg.PointLight(profile=3)),  # type: ignore[arg-type]
    "ball": lambda: dg.Scene().add_light(dg.SphereLight(profile="a")),  # type: ignore[arg-type]
    "material": lambda: dg.Scene().add_material(profile=3),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_wrong_values_are_one_error(name: str) -> None:
    with pytest.raises(DaguerreError, match="wanted"):
        WRONG[name]()


def test_a_profile_that_changes_over_time_is_an_error() -> None:
    class Other:
        """A lamp whose profile changes."""

        def at(self, time_s: float) -> Any:
            return dg.PointLight(profile=TABLE if time_s < 0 else PRODUCT), np.eye(4)

        def breaks(self, begin: float, end: float) -> list[float]:
            return [0.0]

    scene = dg.Scene()
    scene.add_light(dg.PointLight(profile=TABLE), motion=Other())
    scene.set_environment(color=(1, 1, 1))
    camera = dg.Camera(shutter_time=0.1)
    with pytest.raises(InputError, match="profile: must be the profile of the first key"):
        dg.render(scene, camera, resolution=(4, 3), spp=1)


def test_equal_profiles_are_one() -> None:
    """Many lamps of one file share its table in the core."""
    scene = dg.Scene()
    for _ in range(3):
        scene.add_light(dg.PointLight(profile=pickle.loads(pickle.dumps(TABLE))))
        scene.add_light(replace(dg.SphereLight(), profile=TABLE))
    from daguerre.setup.shading import Profiles

    class Count:
        count = 0

        def add_profile(self, core: object) -> int:
            self.count += 1
            return self.count - 1

    counter = Count()
    profiles = Profiles(counter)  # type: ignore[arg-type]
    assert {profiles.index(light.profile) for light, _ in scene.lights} == {0}
    assert profiles.index(None) == -1
    assert counter.count == 1
