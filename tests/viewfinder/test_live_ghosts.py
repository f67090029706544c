"""Live ghosts: those of pictures on the way against those at rest, and when there are none."""

from __future__ import annotations

import itertools
import math
import time
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.color.spectra import luminance_of_rgb
from daguerre.rendering import Cancelled
from daguerre.rendering.light_plan import FilmPlan
from daguerre.rendering.live_ghosts import LiveGhosts
from daguerre.rendering.session import Session
from daguerre.viewfinder import ghosts
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.drawn import Drawn, PictureRequest
from daguerre.viewfinder.ghosts import Layers, resized
from daguerre.viewfinder.stage import Stage
from daguerre.viewfinder.work import Work

from .test_painter import scene

image = pytest.importorskip("daguerre.viewfinder.image", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")
LENS = "double-gauss-50mm-f2"
SIZE = (240, 160)
#: Relative difference of blocks that counts as the same: both pictures have noise.
RMS = 0.1
ASIDE = {"place.position": "0,0,0", "place.look_at": "0.06,0.03,-1"}


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Layers that are never too slow: other tests may run beside."""
    monkeypatch.setattr(ghosts, "MOST_S", math.inf)


def sunny(*degrees: tuple[float, float]) -> dg.Scene:
    """Small far lamps at angles from the axis, before a black world."""
    found = dg.Scene()
    for right, up in degrees or ((9, 5),):
        toward = np.array([math.tan(math.radians(right)), math.tan(math.radians(up)), -1])
        place = np.eye(4)
        place[:3, 3] = 1000 * toward / np.linalg.norm(toward)
        radius = 1000 * math.tan(math.radians(0.265))
        found.add_light(dg.SphereLight((1.6e4,) * 3, radius), place)
    found.add_camera("main", dg.Camera(lens=LENS, f_stop=5.6, focus_distance=math.inf))
    return found


def stage_of(
    made: dg.Scene, size: tuple[int, int] = SIZE, *, lit: bool = True, **more: Any
) -> Stage:
    """Stage of a scene, with ghosts if it is lit so."""
    flare = {"flare": 4e5, "flare_highlights": "off"} if lit else {}
    settings = dg.RenderSettings.of(resolution=size, spp=1, light_paths="off", **flare, **more)
    return Stage(made, made.camera(), settings)


def drawn_of(stage: Stage, number: int = 0, **turns: str) -> list[Drawn]:
    """Pictures of a request until it rests."""
    dials = Dials().turned(turns)
    return list(
        Work(PictureRequest(number, stage, dials, stage.shot(dials))).pictures(lambda step: step())
    )


def first_of(stage: Stage, beside: dict[str, str] | None = None, **turns: str) -> Drawn:
    """First picture of a request."""
    dials = Dials().turned(turns)
    request = PictureRequest(0, stage, dials, stage.shot(dials), beside=beside)
    return next(Work(request).pictures(lambda step: step()))


def test_a_layer_takes_no_memory_for_a_film(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its session draws no samples; making a film takes as long as a small picture."""
    films: list[FilmPlan] = []
    make = FilmPlan.film

    def counted(plan: FilmPlan) -> Any:
        films.append(plan)
        return make(plan)

    monkeypatch.setattr(FilmPlan, "film", counted)
    drawn = first_of(stage_of(sunny()))
    assert drawn.sharp is not None
    assert [plan.layout.width for plan in films] == [drawn.frame.width]


def blocks(light: NDArray[np.float32], size: int = 8) -> NDArray[np.float32]:
    """Mean luminance of squares."""
    rows, columns = light.shape[0] // size, light.shape[1] // size
    cut = light[: rows * size, : columns * size] @ luminance_of_rgb()
    return np.asarray(cut.reshape(rows, size, columns, size).mean(axis=(1, 3)))


def rms(one: NDArray[np.float32], other: NDArray[np.float32]) -> float:
    """Relative difference of blocks that have 2 % of the brightest one or more."""
    a, b = blocks(one), blocks(other)
    lit = b > 0.02 * b.max()
    assert lit.sum() > 20
    return float(np.sqrt(np.mean((a[lit] / b[lit] - 1) ** 2)))


@pytest.mark.parametrize(
    ("size", "more", "turns"),
    [
        (SIZE, {}, {}),
        ((160, 240), {}, {}),
        (SIZE, {"crop": (60, 20, 220, 150)}, {}),
        (SIZE, {}, {"f_stop": "4", "iso": "400", "exposure": "manual"}),
        (SIZE, {}, {"t_stop": "6"}),
        (SIZE, {}, {"sensor": "sony-a7r-ii"}),
        (SIZE, {}, {"lens_model": "polynomial"}),
        ((300, 120), {}, {}),
    ],
    ids=["plain", "portrait", "crop", "exposed", "t-stop", "sensor", "polynomial", "wide"],
)
def test_ghosts_on_the_way_are_those_at_rest(size: Any, more: Any, turns: dict[str, str]) -> None:
    pictures = drawn_of(stage_of(sunny(), size, **more), **turns)
    rest = pictures[-1]
    assert rest.rests
    assert rest.sharp is None
    on_the_way = [one for one in pictures if not one.whole]
    assert on_the_way
    for one in on_the_way:
        assert one.sharp is not None
        assert one.sharp.flare is not None
        assert one.sharp.rgb.shape == rest.frame.rgb.shape
        assert rms(one.sharp.flare, rest.frame.flare) < RMS
        assert one.frame.flare.mean() == pytest.approx(rest.frame.flare.mean(), rel=0.05)
        if rest.frame.channels is not None:
            both = (one.sharp, rest.frame)
            black = np.all([frame.rgb == frame.flare for frame in both], axis=(0, 3))  # no lamp
            sums = [frame.channels[black].sum(axis=0) for frame in both]
            np.testing.assert_allclose(*sums, rtol=0.1)
        for name in ("isoSpeed", "f_stop", "t_stop", "resolution", "crop"):
            assert one.sharp.metadata.get(name) == rest.frame.metadata.get(name)


def test_several_lamps_have_ghosts() -> None:
    stage = stage_of(sunny((9, 5), (-11, 3)))
    one, *_, rest = drawn_of(stage)
    assert one.sharp is not None
    assert rms(one.sharp.flare, rest.frame.flare) < RMS


def test_the_layer_is_of_the_camera_of_its_picture() -> None:
    stage = stage_of(sunny())
    before, *_, old = drawn_of(stage)
    after, *_, new = drawn_of(stage, 1, **ASIDE)
    assert before.sharp is not None
    assert after.sharp is not None
    assert rms(after.sharp.flare, new.frame.flare) < RMS
    assert rms(after.sharp.flare, old.frame.flare) > 3 * RMS


def test_a_preview_is_the_one_without_ghosts_and_the_layer() -> None:
    made, place = scene(), np.eye(4)
    place[:3, 3] = (80, 300, -1000)
    made.add_light(dg.SphereLight((1e7,) * 3, 5), place)
    dark, one = (first_of(stage_of(made, lit=lit), lens=LENS) for lit in (False, True))
    assert dark.frame.flare is None
    assert one.frame.flare is not None
    np.testing.assert_allclose(one.frame.rgb, dark.frame.rgb + one.frame.flare, rtol=1e-5)
    assert one.frame.flare.mean() > 1e-3 * one.frame.rgb.mean()
    assert one.sharp is not None
    assert one.sharp.rgb.mean() == pytest.approx(one.frame.rgb.mean(), rel=0.02)


def test_the_picture_at_rest_is_the_render() -> None:
    stage = stage_of(sunny())
    drawn_of(stage)
    rest = drawn_of(stage, 1, **ASIDE)[-1]
    camera = Dials().turned(ASIDE).camera(stage.camera)
    alone = dg.render(stage.scene, camera, settings=stage.settings)
    np.testing.assert_array_equal(rest.frame.rgb, alone.rgb)


@pytest.fixture
def draws(monkeypatch: pytest.MonkeyPatch) -> list[Session]:
    """Sessions whose ghosts were drawn."""
    found: list[Session] = []

    draw = LiveGhosts.draw

    def noted(self: LiveGhosts, session: Session) -> Any:
        found.append(session)
        return draw(self, session)

    monkeypatch.setattr(LiveGhosts, "draw", noted)
    return found


def test_pictures_of_a_wish_share_a_layer_and_brightness_keeps_it(draws: list[Session]) -> None:
    stage = stage_of(sunny(), (480, 270))
    dials = Dials().turned({"exposure": "manual", "iso": "100"})
    work = Work(PictureRequest(0, stage, dials, stage.shot(dials)))
    pictures = work.pictures(lambda step: step())
    one = next(pictures)
    assert one.sharp is not None
    brighter = dials.turned({"iso": "200"})
    assert work.expose(PictureRequest(1, stage, brighter, stage.shot(brighter)))
    anew = work.drawn
    assert anew is not None
    assert anew.sharp is not None
    assert anew.sharp.rgb is one.sharp.rgb
    assert (one.sharp.metadata["isoSpeed"], anew.sharp.metadata["isoSpeed"]) == (100, 200)
    two = next(pictures)
    assert two.frame.width > one.frame.width
    assert two.sharp is not None
    assert two.sharp.metadata["isoSpeed"] == 200
    np.testing.assert_array_equal(two.sharp.flare, one.sharp.flare)
    assert len(draws) == 1


@pytest.mark.parametrize("size", [SIZE, (60, 40)])  # small pictures have fewer rungs without
def test_turning_ghosts_on_and_off_draws_anew(size: tuple[int, int]) -> None:
    stage = stage_of(sunny(), size, lit=False)
    on, off = Dials().turned({"flare": "auto"}), Dials()
    for old, new in itertools.permutations((on, off)):
        work = Work(PictureRequest(0, stage, old, stage.shot(old)))
        for _ in work.pictures(lambda step: step()):
            assert not work.expose(PictureRequest(1, stage, new, stage.shot(new)))


def test_without_ghosts_no_layer_is_drawn(draws: list[Session]) -> None:
    assert first_of(stage_of(sunny(), lit=False)).sharp is None
    assert draws == []


@pytest.mark.parametrize("cause", ["no lamp", "no surfaces"])
def test_where_nothing_makes_ghosts_pictures_stay_as_they_are(cause: str) -> None:
    made = scene() if cause == "no lamp" else sunny()
    turns = {"lens": LENS} if cause == "no lamp" else {"lens_model": "thick"}
    stage, dark = stage_of(made), stage_of(made, lit=False)
    one = first_of(stage, **turns)
    assert one.sharp is None
    np.testing.assert_array_equal(one.frame.rgb, first_of(dark, **turns).frame.rgb)


def test_a_small_picture_comes_before_its_exact_ghosts() -> None:
    pictures = drawn_of(stage_of(sunny(), (60, 40)))
    assert [one.whole for one in pictures] == [False, True]
    assert pictures[0].frame.flare is not None


@pytest.mark.parametrize(
    ("change", "ghostly"),
    [({"lens": "tessar-50mm-f2.8"}, [True, True]), ({"lens_model": "thin"}, [True, False])],
)
def test_each_picture_beside_has_the_ghosts_of_its_own_lens(
    change: dict[str, str], ghostly: list[bool]
) -> None:
    one = first_of(stage_of(sunny()), change)
    assert [panel.frame.flare is not None for panel in one.panels] == ghostly
    shown = image.image_of(one)
    assert shown.size[1] == (SIZE[1] if all(ghostly) else one.frame.height)
    if all(ghostly):
        a, b = (panel.frame.flare for panel in one.panels)
        assert rms(resized(a, *SIZE), resized(b, *SIZE)) > 3 * RMS


@pytest.mark.parametrize("tint", ["none", "false-colour", "depth"])
def test_a_tint_has_the_size_of_its_picture(tint: str) -> None:
    one = first_of(stage_of(sunny()))
    shown = image.image_of(one, tint=tint)
    assert shown.size == (SIZE if tint == "none" else (one.frame.width, one.frame.height))


# Slow lenses


@pytest.fixture
def session() -> Session:
    made = sunny()
    return Session(made, resolution=(60, 40), light_paths="off")


def test_a_lens_that_is_too_slow_is_left_alone_for_a_while(
    session: Session, draws: list[Session], monkeypatch: pytest.MonkeyPatch
) -> None:
    layers = Layers()
    assert layers.draw(session) is not None
    monkeypatch.setattr(ghosts, "MOST_S", 0.0)
    assert layers.draw(session) is None  # it came too late
    assert layers.draw(session) is None
    assert len(draws) == 2
    monkeypatch.setattr(ghosts, "MOST_S", math.inf)
    assert layers.draw(session) is None
    other = Session(
        session.scene, session.camera.with_(lens="tessar-50mm-f2.8"), settings=session.settings
    )
    assert layers.draw(other) is not None
    later = time.monotonic() + 2 * ghosts.PAUSE_S
    monkeypatch.setattr(time, "monotonic", lambda: later)
    assert layers.draw(session) is not None


def test_a_lens_whose_layer_was_cancelled_late_is_too_slow(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    layers, draw = Layers(), LiveGhosts.draw

    def cancelled(*_: object) -> None:
        raise Cancelled

    monkeypatch.setattr(LiveGhosts, "draw", cancelled)
    with pytest.raises(Cancelled):  # at once: that says nothing
        layers.draw(session)
    monkeypatch.setattr(LiveGhosts, "draw", draw)
    assert layers.draw(session) is not None
    monkeypatch.setattr(LiveGhosts, "draw", cancelled)
    monkeypatch.setattr(ghosts, "MOST_S", 0.0)
    with pytest.raises(Cancelled):
        layers.draw(session)
    monkeypatch.setattr(LiveGhosts, "draw", draw)
    assert layers.draw(session) is None


# Sizes


@pytest.mark.parametrize("size", [(80, 45), (53, 31), (480, 270), (481, 269)])
def test_resizing_keeps_constants_places_and_light(size: tuple[int, int]) -> None:
    even = np.full((90, 160, 2), 0.7, np.float32)
    np.testing.assert_allclose(resized(even, *size), 0.7, rtol=1e-5)
    spot = np.zeros((90, 160, 1), np.float32)
    spot[30:34, 100:106] = 1
    made = resized(spot, *size)[..., 0]
    assert made.shape == size[::-1]
    assert made.mean() == pytest.approx(spot.mean(), rel=0.02)
    rows, columns = np.indices(made.shape) + 0.5
    middle = [(made * at).sum() / made.sum() / n for at, n in ((columns, size[0]), (rows, size[1]))]
    np.testing.assert_allclose(middle, (103 / 160, 32 / 90), atol=1e-3)


def test_a_layer_smaller_than_the_picture_only_adds(session: Session) -> None:
    layer = Layers().draw(session)
    assert layer is not None
    large = dg.Frame(np.full((80, 120, 3), 0.1, np.float32), metadata=session.metadata)
    assert layer.sharp(large) is None
    added = layer.added(replace(large, xyz=large.rgb))
    assert added.rgb.mean() == pytest.approx(0.1 + layer.light.rgb.mean(), rel=1e-3)
    assert added.xyz is None  # not that without ghosts
