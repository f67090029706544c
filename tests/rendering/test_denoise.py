"""Denoising: guides as the lens sees them, halves that share nothing, an error that is known."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.frame.frame import Frame
from daguerre.rendering import merging, passes, rounds
from daguerre.rendering.denoise import (
    BLOCK,
    Cleaner,
    check_available,
    denoise,
    error_left,
    noise_after,
)
from daguerre.rendering.session import Session
from tests.support.program import fake_denoiser
from tests.support.scene import scenes

SIZE = (40, 24)


@pytest.fixture
def library(monkeypatch: pytest.MonkeyPatch) -> fake_denoiser.Library:
    """A stand-in whose filter leaves pictures as they are."""

    def same(images: dict[str, np.ndarray]) -> np.ndarray:
        return images.get("color", next(iter(images.values())))

    return fake_denoiser.install(monkeypatch.setitem, monkeypatch.setattr, same)


def room(**options: object) -> Session:
    camera = dg.Camera(lens="thin", f_stop=2.0, focus_distance=5.0)
    kept = {"resolution": SIZE, "aovs": True, "halves": True}
    return Session(scenes.lamp_room(), camera, **{**kept, **options})  # type: ignore[arg-type]


# Guides -----------------------------------------------------------------------------------------


def card_before_a_wall(f_stop: float) -> np.ndarray:
    """The guide of albedo of a white card at 1 m, before a black wall in focus at 4 m."""
    scene = dg.Scene()
    for size, z, white in ((0.15, -1.0, 1.0), (9.0, -4.0, 0.0)):
        mesh = scene.add_mesh(*scenes.quad(size, z))
        scene.add_instance(mesh, dg.Material(dg.Diffuse((white,) * 3)))
    camera = dg.Camera(lens="thin", focal_length=80, f_stop=f_stop, focus_distance=4.0)
    options = {"resolution": (96, 64), "spp": 16, "aovs": True, "light_paths": "off"}
    frame = dg.render(scene, camera, **options)  # type: ignore[arg-type]
    return np.asarray(frame.aovs["denoise_albedo.R"])


def test_what_is_out_of_focus_has_no_sharp_guide() -> None:
    """Depth of field is in the guides: at f/64 an edge is a step, at f/1 it is not."""

    def between(guide: np.ndarray) -> float:
        return float(((guide > 0.1) & (guide < 0.9)).mean())

    sharp, blurred = card_before_a_wall(64.0), card_before_a_wall(1.0)
    assert sharp.max() > 0.99 > 0.01 > sharp.min()
    assert between(blurred) > 4 * between(sharp)
    # The lens takes no light from the guide: it spreads it.
    assert blurred.mean() == pytest.approx(sharp.mean(), rel=0.1)


def test_glass_before_a_wall_shows_the_wall() -> None:
    scene = scenes.furnace(dg.Material(dg.Dielectric(1.5)))
    wall = dg.Material(dg.Diffuse((0.3, 0.3, 0.3)))
    scene.add_instance(scene.add_mesh(*scenes.quad(99, -6)), wall)
    camera = dg.Camera(lens="pinhole", focal_length=40)
    frame = dg.render(scene, camera, resolution=SIZE, spp=64, aovs=True, light_paths="off")
    first, seen = (frame.aovs[f"{name}.R"] for name in ("albedo", "denoise_albedo"))
    assert seen[0, 0] == pytest.approx(0.3)
    assert first[12, 20] == pytest.approx(1)  # the ball has a colour of its own,
    assert seen[12, 20] == pytest.approx(0.3 * 0.92, abs=0.01)  # and shows what is behind it


# Halves -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("light_paths", ["off", (4000, 0)])
def test_halves_make_up_the_picture_and_share_no_sample(light_paths: object) -> None:
    session = room(light_paths=light_paths)
    session.draw(0, 16)
    frame = session.frame()
    halves = frame.halves.sum(3)
    np.testing.assert_allclose(halves.mean(2), frame.rgb, rtol=1e-4, atol=1e-5)
    even = room(light_paths=light_paths)
    for i in range(0, 16, 2):
        even.draw(i, i + 1)
    alone = even.frame()
    np.testing.assert_allclose(halves[:, :, 0], alone.rgb, rtol=1e-3, atol=1e-4)
    assert (halves[:, :, 0] != halves[:, :, 1]).any()
    if light_paths != "off":
        np.testing.assert_allclose(
            frame.halves[:, :, :, 1].mean(2), frame.splats, rtol=1e-4, atol=1e-6
        )


def test_halves_have_the_same_bits_for_any_split_and_any_threads(tmp_path: Path) -> None:
    whole, parts = room(light_paths=(4000, 0)), room(light_paths=(4000, 0), threads=1)
    whole.draw(0, 8)
    for a, b in ((5, 8), (0, 2), (2, 5)):
        parts.draw(a, b)
    for name, words in whole.state().items():
        assert np.array_equal(words, parts.state()[name]), name
    files = []
    for a, b in ((0, 3), (3, 8)):
        one = room(light_paths=(4000, 0))
        one.draw(a, b)
        files.append(tmp_path / f"{a}.exr")
        passes.write_pass(files[-1], one.frame(), passes.pass_of(one))
    merged, _ = merging.merge(files)
    assert np.array_equal(merged.halves, whole.frame().halves)


def test_halves_change_no_bit_of_the_picture() -> None:
    with_halves, without = room(), room(halves=False)
    for session in (with_halves, without):
        session.draw(0, 4)
    assert np.array_equal(with_halves.frame().rgb, without.frame().rgb)
    assert without.frame().halves is None


# Layers -----------------------------------------------------------------------------------------


def test_ghosts_are_kept_as_they_were_drawn(library: fake_denoiser.Library) -> None:
    rgb = np.full((16, 16, 3), 0.5, np.float32)
    ghost = np.zeros_like(rgb)
    ghost[3, 4] = 2
    frame = Frame(rgb + ghost, flare=ghost)
    library.filter = lambda images: images["color"] * 0
    np.testing.assert_array_equal(denoise(frame).rgb, ghost)
    assert library.runs[0]["color"].max() == pytest.approx(0.5)
    both = replace(frame, metadata={"flare": "1", "scatter": "1"})
    np.testing.assert_array_equal(denoise(both).rgb, ghost)
    alone = replace(frame, metadata={"scatter": "1"})  # smooth, and no ghost's edge to keep
    np.testing.assert_array_equal(denoise(alone).rgb, ghost * 0)
    np.testing.assert_array_equal(library.runs[-1]["color"], ghost)


def test_light_paths_are_cleaned_apart_from_the_scene(library: fake_denoiser.Library) -> None:
    rgb = np.full((16, 16, 3), 0.5, np.float32)
    disc = np.zeros_like(rgb)
    disc[4:8, 4:8] = 8
    guides = {f"denoise_albedo.{c}": rgb[..., 0] for c in "RGB"}
    guides |= {f"denoise_normal.{c}": rgb[..., 0] for c in "XYZ"}
    frame = denoise(Frame(rgb + disc, splats=disc, aovs=guides))
    scene, light = library.runs[2], library.runs[3]
    assert set(scene) == {"color", "albedo", "normal"}
    assert set(light) == {"color"}
    np.testing.assert_array_equal(light["color"], disc)
    np.testing.assert_array_equal(scene["color"], rgb)
    np.testing.assert_array_equal(frame.rgb, rgb + disc)


# The error that is left -------------------------------------------------------------------------


def test_noise_that_is_left_is_known_from_two_halves() -> None:
    """Two pictures of error s have a mean of error s / sqrt(2); here with value 1."""
    rng, shape, s = np.random.default_rng(1), (64, 64, 3), 0.1
    even, odd = (1 + s * rng.standard_normal(shape).astype(np.float32) for _ in range(2))
    still = np.zeros(shape, np.float32)
    wanted = s / np.sqrt(2) / np.sqrt(1.01)
    assert error_left(even, odd, still, still) == pytest.approx(wanted, rel=0.2)
    assert error_left(even, even, still, still) == 0


def test_light_that_was_moved_is_known_and_noise_that_was_taken_is_not_held_against_it() -> None:
    rng, shape, s = np.random.default_rng(2), (64, 64, 3), 0.3
    one = np.ones(shape, np.float32)
    taken = s * rng.standard_normal(shape).astype(np.float32)
    variance = np.full(shape, s * s, np.float32)
    assert error_left(one, one, taken, variance) < 0.2 * s / BLOCK**0.5
    moved = np.zeros(shape, np.float32)
    moved[:32] = 0.2
    assert error_left(one, one, moved + taken, variance) == pytest.approx(0.2 / 2**0.5, rel=0.1)


def test_a_spark_in_one_half_does_not_hide_its_own_error() -> None:
    even, odd = np.full((2, 64, 64, 3), 0.1, np.float32)
    even[10, 10] = 50
    still = np.zeros_like(even)
    assert error_left(even, odd, still, still) > 0.25 * 50 / np.sqrt(64 * 64) / 0.2


def test_what_cannot_be_known_is_not_said(library: fake_denoiser.Library) -> None:
    session = room()
    session.draw(0, 4)
    frame = session.frame()
    assert noise_after(frame) is not None
    assert denoise(frame).metadata["denoised_noise"] == noise_after(frame)
    assert "noise" not in denoise(frame).metadata
    wanted = denoise(replace(frame, metadata=frame.metadata | {"noise": 0.9})).metadata
    assert wanted["noise"] == wanted["denoised_noise"] < 0.9
    assert wanted["noise_of"] == "denoised"
    for unknown in (
        replace(frame, halves=None),
        replace(frame, flare=frame.rgb * 0),
        replace(frame, metadata=frame.metadata | {"diffraction": "yes"}),
    ):
        assert noise_after(unknown) is None
        assert "denoised_noise" not in denoise(unknown).metadata


def test_a_wanted_noise_counts_on_what_comes_after_it() -> None:
    drawn = []
    for judge in (None, lambda session: 0.03, lambda session: None):
        session = room(light_paths="off")
        count = 0
        while rounds.plan_round(session, 0.05, 4096, judge):
            session.draw_round(rounds.PARTS)
            count += 1
        assert session.round is not None
        assert session.round.noise <= 0.05
        drawn.append(session.round.samples())
    assert drawn[1] < drawn[0] == drawn[2]


def test_nobody_asks_what_denoising_brings_before_there_is_hope() -> None:
    asked = []
    session = room(light_paths="off")
    assert rounds.plan_round(session, 1e-3, 4096, lambda session: asked.append(session) or 1e-4)
    session.draw_round(rounds.PARTS)
    assert rounds.plan_round(session, 1e-3, 4096, lambda session: asked.append(session) or 1e-4)
    assert not asked
    reached = session.round.noise
    session.draw_round(rounds.PARTS)
    assert not rounds.plan_round(session, reached / 8, 4096, lambda session: reached / 9)


# The library ------------------------------------------------------------------------------------


def test_the_real_denoiser_lowers_the_error_and_knows_it() -> None:
    try:
        check_available()
    except dg.UsageError as error:  # as in a system without libatomic
        pytest.skip(str(error))
    session, long = room(seed=1), room(seed=2)
    session.draw(0, 32)
    long.draw(0, 1024)
    frame, truth = session.frame(), long.frame().rgb
    clean = denoise(frame)

    def error(picture: np.ndarray) -> float:
        return float(np.sqrt(((picture - truth) ** 2 / (truth**2 + 0.01)).mean()))

    assert error(clean.rgb) < 0.75 * error(frame.rgb)
    assert 0.3 < clean.metadata["denoised_noise"] / error(clean.rgb) < 3
    assert clean.metadata["denoised"].startswith("mitsuba-oidn ")
    assert np.array_equal(clean.rgb, denoise(frame).rgb)
    assert Cleaner.of(frame).guides is not None


def test_a_denoiser_that_cannot_be_loaded_is_one_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(name: str) -> None:
        raise RuntimeError("could not load the thread pool library")

    monkeypatch.setattr("daguerre.rendering.denoise.import_module", broken)
    monkeypatch.setattr("daguerre.files.extras.missing", lambda module: False)
    with pytest.raises(dg.UsageError, match=r"thread pool.*apt install libatomic1"):
        denoise(dg.Frame(np.ones((4, 6, 3), np.float32)))
