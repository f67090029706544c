"""Values that NumPy takes as one array: which array, when it is copied, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.analysis import Psf
from daguerre.development import Picture
from daguerre.files.array_value import ArrayValue
from daguerre.scene.parts import Plate, Texture
from daguerre.stocks import load
from daguerre.stocks.negative import Negative

NUMPY_2 = int(np.__version__.split(".")[0]) >= 2
RGB = np.linspace(0, 4, 5 * 7 * 3, dtype=np.float32).reshape(5, 7, 3)
DENSITY = RGB.copy()
SENSOR = dg.sensors.load("ideal")


def raw() -> dg.Raw:
    mosaic = np.arange(35, dtype=np.uint16).reshape(5, 7)
    return dg.Raw(mosaic, SENSOR, 100.0, 0, 4095, 1.0, np.ones(3), (0.3127, 0.329))


VALUES: dict[str, tuple[Any, str]] = {
    "Frame": (dg.Frame(RGB), "rgb"),
    "Raw": (raw(), "mosaic"),
    "Picture": (Picture(RGB / 4), "pixels"),
    "Negative": (Negative(DENSITY, load("generic-colour-negative-400")), "density"),
    "Psf": (Psf(np.ones((4, 4)), 0.1, np.zeros(2), diffraction=False), "image"),
    "Texture": (Texture(np.zeros((2, 3, 4), np.uint8)), "pixels"),
    "Plate": (Plate(RGB), "pixels"),
    "DensityGrid": (dg.DensityGrid(np.ones((2, 3, 4), np.float32)), "values"),
}


def kinds(base: type) -> set[str]:
    found = base.__subclasses__()
    return {kind.__name__ for kind in found}.union(*map(kinds, found))


def test_every_such_class_is_here() -> None:
    assert kinds(ArrayValue) == set(VALUES)


@pytest.fixture(params=VALUES)
def held(request: pytest.FixtureRequest) -> tuple[Any, np.ndarray]:
    value, name = VALUES[request.param]
    return value, getattr(value, name)


def test_numpy_takes_the_array_itself(held: tuple[Any, np.ndarray]) -> None:
    value, array = held
    assert np.asarray(value) is array
    assert value.__array__() is array
    assert value.__array__(array.dtype, copy=False) is array
    assert np.mean(value) == np.mean(array)


def test_numpy_copies_where_it_is_asked_to(held: tuple[Any, np.ndarray]) -> None:
    value, array = held
    for made in (np.array(value), value.__array__(copy=True), value.__array__(None, copy=True)):
        assert made.dtype == array.dtype
        assert np.array_equal(made, array)
        assert not np.shares_memory(made, array)


def test_another_type_is_a_copy(held: tuple[Any, np.ndarray]) -> None:
    value, array = held
    for made in (np.asarray(value, np.float64), value.__array__(np.float64), value.__array__("f8")):
        assert made.dtype == np.float64
        assert np.array_equal(made, array)


def test_a_copy_that_is_not_allowed_is_refused(held: tuple[Any, np.ndarray]) -> None:
    value, array = held
    with pytest.raises(ValueError, match=f"wanted {array.dtype} without a copy, got complex128"):
        value.__array__(np.complex128, copy=False)
    if NUMPY_2:
        assert np.asarray(value, copy=False) is array
        with pytest.raises(ValueError, match="without a copy"):
            np.asarray(value, np.complex128, copy=False)


def test_a_frame_is_linear_light() -> None:
    array = np.asarray(VALUES["Frame"][0])
    assert (array.dtype, array.shape, array.max()) == (np.float32, (5, 7, 3), 4)
