"""Records of the core: fields by name, sums, pickling; lists of channels that the core owns."""

from __future__ import annotations

import copy
import math
import pickle

import numpy as np
import pytest

from daguerre import _core
from daguerre.frame.aovs import FILM_CHANNELS, MEANS_CHANNELS, TRUTH_CHANNELS


def test_counters_add_up_field_by_field() -> None:
    one = _core.RenderCounters(camera_rays=1, rays=20, scatter_hits=3)
    two = _core.RenderCounters(rays=1 << 40, flare_rays=4)
    both = one + two
    assert (both.camera_rays, both.rays, both.flare_rays) == (1, 20 + (1 << 40), 4)
    assert (both.scatter_hits, both.light_paths) == (3, 0)
    assert both == two + one
    assert both != one
    assert repr(one).startswith("RenderCounters(camera_rays=1, stopped_rays=0, rays=20, ")


def test_counters_are_copied_and_go_to_another_process() -> None:
    names = [name for name in dir(_core.RenderCounters) if not name.startswith("_")]
    counters = _core.RenderCounters(**{name: 7 + i for i, name in enumerate(names)})
    for again in (pickle.loads(pickle.dumps(counters)), copy.deepcopy(counters)):
        assert again == counters
        assert [getattr(again, name) for name in names] == list(range(7, 7 + len(names)))


@pytest.mark.parametrize(
    "record",
    [_core.RenderCounters, _core.FilmLayout, _core.ExactLensSettings, _core.LensFitRequest],
)
def test_a_record_knows_its_fields(record: type) -> None:
    with pytest.raises(AttributeError, match="colour"):
        record(colour=1)


def test_settings_of_a_lens_keep_what_they_are_given() -> None:
    settings = _core.ExactLensSettings(f_stop=2.8, film_z_mm=60.5, fit_degree=7, tilt_deg=(1, -2))
    assert (settings.f_stop, settings.film_z_mm, settings.fit_degree) == (2.8, 60.5, 7)
    assert settings.tilt_deg == (1.0, -2.0)
    assert math.isinf(settings.focus_distance_m)
    settings.film_z_mm = settings.fit_degree = None
    assert (settings.film_z_mm, settings.fit_degree) == (None, None)


def test_a_film_has_the_channels_that_the_core_lists() -> None:
    film = _core.Film(_core.FilmLayout(width=3, height=2, aovs=True))
    assert set(FILM_CHANNELS) == {*_core.FILM_AOVS, "object_id"}
    for name in _core.FILM_AOVS:
        assert film.aov(name).shape == (2, 3)
    with pytest.raises(_core.Error, match=r"depth\.Z, P\.X, .*denoise_normal.Z, got velocity"):
        film.aov("velocity")
    # Sums of each channel, and 16 bytes of counts and the object.
    assert film.state("aovs").shape == (2, 3, 4 * (len(_core.FILM_AOVS) + 1))


def test_truth_has_the_planes_that_the_core_lists() -> None:
    builder = _core.SceneBuilder()
    scene = builder.build()
    camera = _core.Camera.pinhole(_core.Motion.still(np.eye(4)), 50.0)
    settings = _core.RenderSettings()
    settings.resolution, settings.sensor_size_mm = (3, 2), (36.0, 24.0)
    seen = _core.see(scene, camera, settings, (0, 0, 3, 2))
    mean = _core.see_mean(scene, camera, settings, (0, 0, 3, 2), 4)
    assert set(TRUTH_CHANNELS) == set(_core.TRUTH_PLANES)
    assert set(MEANS_CHANNELS) - set(TRUTH_CHANNELS) == {_core.COVERAGE_PLANE}
    for name in TRUTH_CHANNELS:
        assert seen.plane(name).shape == mean.plane(name).shape == (2, 3)
        assert seen.plane(name).dtype == (np.uint32 if name.endswith("_id") else np.float32)
    assert mean.plane(_core.COVERAGE_PLANE).shape == (2, 3)
    with pytest.raises(_core.Error, match=r"one of depth\.Z, .*, material_id, got coverage"):
        seen.plane(_core.COVERAGE_PLANE)
