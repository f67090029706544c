"""Objects in the electrons of a raw plate: the statistics of one shot of the whole scene."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.frame.over import AUTO
from daguerre.plates.composite.in_raw import composite_raw, kept_and_added, mixed
from tests.plates.test_truth import CASES, SIZE

SENSOR = "nikon-d5100"


def ks_distance(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Largest distance of two empirical distributions (Kolmogorov-Smirnov)."""
    a, b = np.sort(np.ravel(a)), np.sort(np.ravel(b))
    at = np.concatenate([a, b])
    return float(np.abs(_below(a, at) - _below(b, at)).max())


def _below(values: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.searchsorted(values, at, side="right") / values.size


def ks_limit(n: int, m: int, alpha: float = 1e-3) -> float:
    """Distance that equal distributions exceed with chance ``alpha`` (Smirnov's asymptotic law)."""
    return float(np.sqrt(-0.5 * np.log(alpha / 2) * (n + m) / (n * m)))


@pytest.mark.parametrize(
    ("light", "kept", "added"),
    [
        (400.0, 0.5, 0.0),
        (60.0, 0.2, 30.0),
        (5000.0, 0.9, 100.0),
        (300.0, 0.0, 80.0),
        (40.0, 1.0, 9.0),
    ],
)
def test_what_is_left_and_added_has_the_noise_of_one_shot(
    light: float, kept: float, added: float
) -> None:
    rng, shape, read = np.random.default_rng(4), (200, 200), 4.0

    def shot(mean: float) -> NDArray[np.float64]:
        return rng.poisson(mean, shape) + read * rng.standard_normal(shape)

    plate = shot(light).astype(np.float32)
    full = np.full(shape, 1, np.float32)
    made = mixed(plate, kept * full, added * full, read, rng)
    wanted = shot(kept * light + added)
    limit = ks_limit(made.size, wanted.size)
    # A normal number in the place of a binomial one has no skewness of its own.
    assert ks_distance(made, wanted) < limit + 0.004
    assert made.mean() == pytest.approx(wanted.mean(), abs=5 * wanted.std() / 200)
    assert made.var() == pytest.approx(wanted.var(), rel=0.04)
    # The noise of multiplying alone would be seen.
    if 0.1 < kept < 0.6:
        assert (kept * plate + added).var() < 0.8 * wanted.var()


def frames(sensor: str, iso: float = 800.0, name: str = "matte ground") -> dict[str, dg.Frame]:
    """The whole scene, the set, and the objects with what catchers caught, nearly without noise."""
    case = CASES[name]
    camera = case.camera.with_(sensor=sensor, iso=iso, shutter_time=1 / 30, exposure="manual")
    return {
        kind: dg.render(
            case.scene(kind), camera, resolution=SIZE, spp=256, seed=i, light_paths="off"
        )
        for i, kind in enumerate(("full", "empty", "caught"))
    }


def bright(frame: dg.Frame, ev: float = 3.0) -> dg.Frame:
    """Lamps as bright as those of a room."""
    return replace(frame, metadata=frame.metadata | {"exposure_compensation": ev})


def test_a_shot_of_the_whole_scene_and_the_composite_are_alike() -> None:
    made = {kind: bright(frame) for kind, frame in frames(SENSOR).items()}
    whole = np.array([made["full"].expose(seed=i).electrons() for i in range(24)])
    mixed_shots = []
    for i in range(24):
        plate = made["empty"].expose(seed=100 + i)
        mixed_shots.append(composite_raw(plate, made["caught"], seed=200 + i).electrons())
    composites = np.array(mixed_shots)
    error = np.sqrt((whole.var(axis=0) + composites.var(axis=0)) / 24)
    z = (composites.mean(axis=0) - whole.mean(axis=0)) / np.maximum(error, 1e-3)
    assert abs(z.mean()) < 0.1
    assert 0.8 < z.std() < 1.25  # the renders have some noise, too
    ratio = composites.var(axis=0).mean() / whole.var(axis=0).mean()
    assert ratio == pytest.approx(1, abs=0.02)
    covered = made["caught"].alpha > 0.99
    shaded = (made["caught"].catcher_ratio[..., 1] < 0.8) & (made["caught"].alpha < 0.01)
    for region in (covered, shaded):
        assert region.sum() > 40
        spread = composites[:, region].var(axis=0).mean() / whole[:, region].var(axis=0).mean()
        assert spread == pytest.approx(1, abs=0.05)


def test_photosites_without_a_change_keep_their_numbers() -> None:
    made = {kind: bright(frame) for kind, frame in frames(SENSOR).items()}
    plate = made["empty"].expose(seed=1)
    raw = composite_raw(plate, made["caught"], seed=2)
    caught = made["caught"]
    far = (caught.alpha == 0) & (caught.catcher == 0).all(axis=2)
    assert far.sum() > 200  # the sky, and ground that does not see the ball
    assert np.array_equal(raw.mosaic[far], plate.mosaic[far])
    assert np.array_equal(raw.mosaic, composite_raw(plate, made["caught"], seed=2).mosaic)
    assert not np.array_equal(raw.mosaic, plate.mosaic)


def test_clean_objects_bring_what_their_catchers_caught() -> None:
    """Denoising leaves no channels of the beauty; those of the catchers count as before."""
    made = {kind: bright(frame) for kind, frame in frames(SENSOR, name="lamp").items()}
    caught = made["caught"]
    plate = made["empty"].expose(seed=1)
    drawn = kept_and_added(plate, caught, AUTO)
    clean = kept_and_added(plate, replace(caught, channels=None), AUTO)
    assert np.array_equal(clean[0], drawn[0])
    beside = maximum_of_neighbours(caught.alpha) == 0  # crosstalk brings light of the next one
    bleeds = beside & (drawn[1] > 1)  # electron
    assert bleeds.sum() > 40
    assert clean[1][bleeds] == pytest.approx(drawn[1][bleeds], rel=1e-4)
    covered = caught.alpha > 0.99
    assert clean[1][covered].mean() == pytest.approx(drawn[1][covered].mean(), rel=0.05)


def maximum_of_neighbours(plane: NDArray[np.float32]) -> NDArray[np.float32]:
    """The largest number of 5 x 5 pixels."""
    padded = np.pad(plane, 2, mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, (5, 5))
    return np.asarray(windows.max(axis=(2, 3)))


def test_bad_plates_are_refused() -> None:
    made = frames(SENSOR)
    small = dg.render(
        CASES["matte ground"].scene("empty"),
        CASES["matte ground"].camera.with_(sensor=SENSOR, iso=800, shutter_time=1 / 30),
        resolution=(36, 24),
        spp=4,
    )
    with pytest.raises(dg.InputError, match="wanted the plate's 36 x 24 px, got 72 x 48 px"):
        composite_raw(small.expose(), made["caught"])
    with pytest.raises(dg.UsageError, match="wanted auto or ratio for a raw plate"):
        composite_raw(made["empty"].expose(), made["caught"], form="difference")
    alone = replace(made["caught"], channels=None, catcher_channels=None)
    with pytest.raises(dg.InputError, match="render with --sensor"):
        composite_raw(made["empty"].expose(), alone)
