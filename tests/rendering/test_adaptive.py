"""Adaptive sampling: the noise asked for is reached, at less cost, with the right mean and bits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import MismatchError, UsageError
from daguerre.rendering import adaptive, merging, passes, rounds
from daguerre.rendering.session import Session
from tests.support.pictures.statistical import differences
from tests.support.scene import scenes

SIZE = (40, 24)
LENS = "petzval-100mm-f2.2"


def session(lens: str = "thin", **options: object) -> Session:
    camera = dg.Camera(lens=lens, f_stop=4.0, focus_distance=5.0)
    return Session(scenes.lamp_room(), camera, **{"resolution": SIZE, **options})  # type: ignore[arg-type]


def same(a: Session, b: Session) -> bool:
    one, two = a.state(), b.state()
    return all(np.array_equal(words, two[name]) for name, words in one.items())


def relative_mse(a: dg.Frame, b: dg.Frame) -> float:
    """Relative squared error of one of two independent pictures."""
    mean = (a.rgb.astype(float) + b.rgb) / 2
    return float(np.mean((a.rgb.astype(float) - b.rgb) ** 2 / 2 / (mean**2 + 0.01)))


# The picture ----------------------------------------------------------------------------------


def test_the_noise_that_was_asked_for_is_there() -> None:
    wanted = 0.08
    frames = [
        dg.render(scenes.lamp_room(), dg.Camera(), resolution=SIZE, noise=wanted, seed=seed)
        for seed in (1, 2)
    ]
    for frame in frames:
        assert frame.metadata["noise"] <= wanted
        assert frame.samples is not None
        assert frame.metadata["samples"] == pytest.approx(frame.samples.mean())
        assert frame.metadata["samples_min"] == frame.samples.min() >= adaptive.START
        assert frame.metadata["samples_max"] == frame.samples.max() > frame.samples.min()
    # The estimate takes samples as independent, and stratified ones scatter less.
    assert 0.3 < np.sqrt(relative_mse(*frames)) / wanted < 1.2


def test_it_costs_less_than_even_sampling() -> None:
    scene, camera = scenes.lamp_room(), dg.Camera(focal_length=30)
    options = {"resolution": (48, 32), "filter": "box"}
    found = [dg.render(scene, camera, noise=0.03, seed=s, **options) for s in (1, 2)]
    spp = round(np.mean([f.metadata["samples"] for f in found]))
    even = [dg.render(scene, camera, spp=spp, seed=s, **options) for s in (1, 2)]
    assert relative_mse(*found) < 0.8 * relative_mse(*even)


def test_a_ceiling_ends_it() -> None:
    frame = dg.render(scenes.lamp_room(), dg.Camera(), resolution=(16, 8), noise=0.001, spp=40)
    assert frame.samples is not None
    assert frame.samples.max() == 40
    assert frame.metadata["noise"] > 0.001


def test_what_is_drawn_already_counts() -> None:
    """Samples of another plan: too few to estimate from, or more than may be drawn now."""
    one = session()
    one.draw(0, 1)
    assert next(rounds.rounds(one, 0.5)).begin.max() == 1
    assert one.sample_counts().min() == one.sample_counts().max() == adaptive.START
    for _ in rounds.rounds(one, 0.04, 200):
        pass
    before = one.sample_counts()
    for _ in rounds.rounds(one, 0.01, 100):
        pass
    after = one.sample_counts()
    assert before.max() > 100
    assert after[after > before].max() == 100


def test_a_black_world_needs_no_more() -> None:
    frame = dg.render(dg.Scene(), dg.Camera(), resolution=(16, 8), noise=0.001)
    assert frame.metadata["samples"] == adaptive.START
    assert frame.metadata["noise"] == 0
    one = dg.render(scenes.lamp_room(), dg.Camera(), resolution=(1, 1), noise=0.2)
    assert one.metadata["noise"] <= 0.2


@pytest.mark.parametrize(
    "options", [{"noise": 0}, {"noise": 2}, {"noise": "much"}, {"noise": 0.1, "spp": 1}]
)
def test_what_cannot_be_is_refused(options: dict[str, object]) -> None:
    with pytest.raises(UsageError, match=r"noise|spp"):
        dg.render(scenes.furnace(), dg.Camera(), **options)  # type: ignore[arg-type]


# Bits -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("lens", ["thin", LENS])
def test_neither_threads_nor_parts_change_a_bit(lens: str) -> None:
    whole = session(lens, threads=1)
    for _ in rounds.rounds(whole, 0.07):
        pass
    assert whole.round is not None
    assert whole.sample_counts().max() > whole.sample_counts().min()
    parts = session(lens, threads=3)
    while rounds.plan_round(parts, 0.07, adaptive.MAX_SPP):
        for until in (7, 30000, adaptive.PARTS):
            parts.draw_round(until)
    assert same(whole, parts)


def test_the_first_round_is_a_plain_render() -> None:
    plain, first = session(LENS), session(LENS)
    plain.draw(0, adaptive.START)
    rounds.plan_round(first, 0.1, 1000)
    first.draw_round(adaptive.PARTS)
    assert same(plain, first)


def test_a_checkpoint_within_a_round_goes_on_to_the_same_bits(tmp_path: Path) -> None:
    noise = 0.12
    whole, begun = session(), session()
    for _ in rounds.rounds(whole, noise):
        pass
    for _ in range(1):
        rounds.plan_round(begun, noise, adaptive.MAX_SPP)
        begun.draw_round(adaptive.PARTS)
    rounds.plan_round(begun, noise, adaptive.MAX_SPP)
    begun.draw_round(20000)
    path = tmp_path / "a.exr"
    passes.write_pass(path, begun.frame(), passes.pass_of(begun))
    saved = passes.read_pass(path)
    assert saved.round is not None
    assert saved.round.drawn == 20000
    resumed = session()
    resumed.set_state(saved.state, saved.ranges, saved.round)
    for _ in rounds.rounds(resumed, noise):
        pass
    assert same(whole, resumed)
    for _ in rounds.rounds(resumed, noise / 2):  # and further
        pass
    assert resumed.metadata["noise"] <= noise / 2


def test_a_stopped_part_is_not_taken_for_drawn() -> None:
    one = session()
    rounds.plan_round(one, 0.1, 1000)
    assert not one.draw_round(adaptive.PARTS, lambda _: False)
    assert one.round is not None
    assert one.round.drawn == 0
    with pytest.raises(UsageError, match="stopped midway"):
        one.draw_round(adaptive.PARTS)


def test_rounds_are_no_passes() -> None:
    one = session()
    next(rounds.rounds(one, 0.2))
    with pytest.raises(MismatchError, match="drawn with --noise"):
        merging.merge([passes.pass_of(one)])
    with pytest.raises(MismatchError, match="another round"):
        one.draw(64, 128)
    later = session()
    later.draw(8, 16)
    with pytest.raises(MismatchError, match="from 0 on"):
        next(rounds.rounds(later, 0.2))


# The mean -------------------------------------------------------------------------------------


def test_uneven_rounds_keep_the_mean_through_glass() -> None:
    """Wavelengths that glass sends to pixels of other counts are weighed by those counts."""
    tiles = np.random.default_rng(3).choice([0, 2, 16], (SIZE[1] // 4, SIZE[0] // 4))
    counts = np.repeat(np.repeat(tiles, 4, 0), 4, 1).astype(np.uint32)
    uneven, even = [], []
    for seed in range(12):
        one = session(LENS, seed=seed)
        one.round = adaptive.Round(np.zeros_like(counts), counts)
        one.draw_round(adaptive.PARTS)
        uneven.append(one.frame().rgb)
        other = session(LENS, seed=100 + seed)
        other.draw(0, 8)
        even.append(np.where(counts[..., None] > 0, other.frame().rgb, 0))
    assert np.all(np.array(uneven)[:, counts == 0] == 0)
    assert differences(np.array(uneven, float), np.array(even, float)) == []


def spiky_means(around: Callable[[adaptive.Plane], adaptive.Plane], pictures: int) -> np.ndarray:
    """Means of pictures whose samples are 0.1, and rarely 20 in the right half, drawn by rounds.

    Samples are independent of each other; ``around`` is how variances are smoothed.
    """
    random = np.random.default_rng(5)
    chance = np.where(np.arange(32) < 16, 0.0, 1 / 400) * np.ones((32, 1))
    means = []
    for _ in range(pictures):
        counts = np.full((32, 32), adaptive.START, np.uint32)
        spikes = random.binomial(counts.astype(int), chance)
        while counts.mean() < 60:
            n, k = counts.astype(np.float32), spikes.astype(np.float32)
            mean = (0.1 * (n - k) + 20 * k) / n
            squares = (0.01 * (n - k) + 400 * k) / n
            variance = np.maximum(squares - mean**2, 0) / (n - 1) * n
            relative = variance / (mean**2 + adaptive.DARK)
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr(adaptive, "around", around)
                more, _ = adaptive.next_counts(relative, counts, 0.01, 1000)
            spikes = spikes + random.binomial(more.astype(int), chance)
            counts = counts + more
        means.append(((0.1 * (counts - spikes) + 20 * spikes) / counts).mean())
    return np.array(means)


def own_too(values: adaptive.Plane) -> adaptive.Plane:
    """Mean of a pixel and its neighbours, around the borders."""
    reach = range(-2, 3)
    return np.mean([np.roll(values, (y, x), (0, 1)) for y in reach for x in reach], axis=0)


def test_rare_light_keeps_its_mean() -> None:
    expected = 0.1 + 19.9 / 400 / 2

    def z(means: np.ndarray) -> float:
        return float((means.mean() - expected) / (means.std(ddof=1) / np.sqrt(len(means))))

    assert abs(z(spiky_means(adaptive.around, 100))) < 4
    # Where a pixel's own samples have a say, it is left too dark.
    assert z(spiky_means(own_too, 100)) < -8


def test_a_round_needs_its_facts(tmp_path: Path) -> None:
    one = session()
    next(rounds.rounds(one, 0.2))
    drawn = passes.pass_of(one)
    assert drawn.round is not None
    broken = replace(drawn, round=replace(drawn.round, drawn=None))  # type: ignore[arg-type]
    passes.write_pass(tmp_path / "a.exr", one.frame(), broken)
    with pytest.raises(dg.InputError, match="daguerre:round"):
        passes.read_pass(tmp_path / "a.exr")
