"""Records of the core: fields by name, sums, pickling; lists of channels that the core owns."""

from __future__ import annotations

import copy
import math
import pickle
import subprocess
import sys

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


def test_a_film_has_a_keyword_for_each_layer() -> None:
    assert list(_core.FILM_LAYERS) == [
        *("aovs", "splats", "flare", "halves", "coverage"),
        *("catchers", "bands", "channels", "objects"),
    ]
    for name, (most, words) in _core.FILM_LAYERS.items():
        needed = {"coverage": True} if name == "objects" else {}
        asked = most if most > 1 else True
        layout = _core.FilmLayout(width=3, height=2, **{name: asked}, **needed)
        assert getattr(layout, name) == most
        film = _core.Film(layout)
        assert film.state_parts() == ["sums", *needed, name]
        if name != "objects":
            records = {"catchers": 2}.get(name, most)
            assert film.state(name).shape == (2, 3, records * words)
    with pytest.raises(TypeError):
        _core.FilmLayout(splats=2)
    with pytest.raises(AttributeError):
        _core.FilmLayout(sums=True)


def test_means_of_a_layer_are_read_by_its_name() -> None:
    film = _core.Film(_core.FilmLayout(width=3, height=2, catchers=True, bands=5, coverage=True))
    assert [film.means(name).shape[2] for name in ("sums", "catchers", "bands")] == [3, 6, 5]
    with pytest.raises(_core.Error, match="wanted a layer of plain sums, got coverage"):
        film.means("coverage")
    with pytest.raises(_core.Error, match="wanted sums or coverage or catchers or bands, got 'x'"):
        film.means("x")


def test_words_of_a_state_have_its_shape() -> None:
    layout = _core.FilmLayout(width=3, height=2, coverage=True, objects=True)
    film = _core.Film(layout)
    for part in film.state_parts():
        words = np.array(film.state(part))
        film.set_state(part, words)
        for wrong in (words[:1], words[..., :-1], words.transpose(1, 0, 2)):
            with pytest.raises(_core.Error, match=f"film state: {part}: wanted 2 rows of entries"):
                film.set_state(part, np.ascontiguousarray(wrong))


def test_a_film_is_refused_before_it_takes_memory() -> None:
    program = """
import resource
from daguerre import _core
for wrong in ({"objects": True}, {"bands": 65}, {"channels": 5}):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    try:
        _core.Film(_core.FilmLayout(width=1500, height=1000, **wrong))
    except _core.Error as error:
        print(error)
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""
    found = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    ).stdout.splitlines()
    assert found[::2] == [
        "film: objects: wanted coverage, got none",
        "film: bands: wanted 0 to 64, got 65",
        "film: channels: wanted 0 to 4, got 5",
    ]
    assert max(int(kilobytes) for kilobytes in found[1::2]) < 5000  # the film would take 168 MB


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
