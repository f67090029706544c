"""A picture that cannot fit is refused in one line before anything is drawn."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import daguerre as dg
from daguerre import _core, memory
from daguerre.errors import InputError
from daguerre.rendering import film_memory
from daguerre.rendering.job import Job
from daguerre.rendering.output import Output
from daguerre.rendering.picture import Picture, View
from daguerre.rendering.reporter import PreviewPicture, Reporter
from daguerre.rendering.session import Session
from tests.support.scene import scenes


def layout(**keeps: object) -> _core.FilmLayout:
    return _core.FilmLayout(width=1000, height=500, **keeps)


def test_it_is_held_against_what_is_free() -> None:
    needed = 500_000 * film_memory.pixel_bytes(layout())
    film_memory.check_film(layout(), free=needed)
    with pytest.raises(
        InputError, match=r"memory: wanted at most the .* that are left, got"
    ) as got:
        film_memory.check_film(layout(), free=needed // 2)
    assert "1000 x 500 px" in str(got.value)
    assert "parts of at most 250,000 pixels (--crop)" in str(got.value)


@pytest.mark.parametrize(
    "keeps",
    ["aovs", "splats", "flare", "halves", "coverage", "catchers", "bands", "channels"],
)
def test_what_is_kept_counts(keeps: str) -> None:
    count = 4 if keeps in ("bands", "channels") else True
    more = layout(**{keeps: count})
    grown = film_memory.pixel_bytes(more) - film_memory.pixel_bytes(layout())
    assert grown >= _core.Film.pixel_bytes(more) - _core.Film.pixel_bytes(layout()) > 0


def test_a_session_refuses_before_there_is_a_film(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "left_bytes", lambda: 10_000_000)
    scene = scenes.furnace(dg.Material(dg.Diffuse((0.5,) * 3)))
    with pytest.raises(InputError, match="2000 x 1000 px of 180 bytes: 360 MB"):
        Session(scene, dg.Camera(), resolution=(2000, 1000), light_paths="off")
    # A part of it fits.
    crop = (0, 0, 200, 100)
    Session(scene, dg.Camera(), resolution=(2000, 1000), crop=crop, light_paths="off")


class Watching(Reporter):
    previews = True

    def preview(self, look: PreviewPicture) -> None:
        raise AssertionError("a look at a picture that does not fit")


def test_a_job_refuses_before_its_first_look(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(memory, "left_bytes", lambda: 10_000_000)
    scene = scenes.furnace(dg.Material(dg.Diffuse((0.5,) * 3)))
    settings = dg.RenderSettings.of(resolution=(2000, 1000), light_paths="off")
    output = Output((tmp_path / "a.exr",))
    picture = Picture(View.of(dg.Camera()), settings, output)
    with pytest.raises(InputError, match="2000 x 1000 px"):
        Job(scene, [picture], Watching()).run()


def test_denoising_counts() -> None:
    film_memory.check_denoised((1000, 1000), free=1_400_000_000)
    with pytest.raises(InputError, match="leave out --denoise"):
        film_memory.check_denoised((1000, 1000), free=1_399_000_000)


def test_memory_of_the_last_film_is_left_for_the_next(monkeypatch: pytest.MonkeyPatch) -> None:
    if "daguerre.cluster.task" in sys.modules:  # a worker of another test keeps films
        # Set without monkeypatch, which would keep the object; the worker makes another one.
        sys.modules["daguerre.cluster.task"]._kept = None  # type: ignore[attr-defined]
    layout = _core.FilmLayout(width=400, height=300)
    each = film_memory.pixel_bytes(layout)
    kept = 400 * 300 * _core.Film.pixel_bytes(layout)
    monkeypatch.setattr(memory, "left_bytes", lambda: 400 * 300 * each - kept)
    with film_memory.kept_films():
        _core.Film(layout)  # ends at once
        film_memory.check_film(layout)
    with pytest.raises(InputError, match="memory: wanted at most"):
        film_memory.check_film(layout)
