"""Media as values: what they hold, what they refuse."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import daguerre as dg

GRID = dg.DensityGrid(np.ones((2, 3, 4)))
FOG = dg.Medium(
    (0.1, 0.2, 0.3), dg.Spectrum((400, 700), (1, 2)), ((0.5, 2), (-0.2, 1)), (1, 1, 1), GRID
)


def test_media_compare_pickle_and_hash_by_content() -> None:
    again = pickle.loads(pickle.dumps(FOG))
    assert again == FOG
    assert hash(again) == hash(FOG)
    assert again != dg.Medium((0.1, 0.2, 0.3))
    assert not again.density.values.flags.writeable
    assert repr(again.density) == "<DensityGrid 4x3x2>"


def test_a_grid_keeps_its_numbers_whatever_becomes_of_the_array() -> None:
    values = np.ones((2, 2, 2), np.float32)
    grid = dg.DensityGrid(values)
    values[:] = 5
    assert grid.values.max() == 1
    assert grid.values.dtype == np.float32


def _spike(density: float) -> dg.DensityGrid:
    """Empty but for one cell: rays would take a step for each free path in its whole block."""
    values = np.zeros((8, 8, 8))
    values[4, 4, 4] = density
    return dg.DensityGrid(values)


@pytest.mark.parametrize(
    ("made", "says"),
    [
        (lambda: dg.Medium((1, 2)), "absorption: wanted three numbers"),
        (lambda: dg.Medium(scattering=(1, -1, 0)), "scattering: wanted three finite numbers"),
        (lambda: dg.Medium(emission="red"), "emission: wanted three numbers"),
        (lambda: dg.Medium(lobes=()), r"lobes: wanted 1 to 8 pairs \(g, weight\), got 0"),
        (lambda: dg.Medium(lobes=((0, 1),) * 9), "got more"),
        (lambda: dg.Medium(lobes=((1, 1),)), r"lobes\[0\]: g: wanted"),
        (lambda: dg.Medium(lobes=((0, -1),)), r"lobes\[0\]: weight: wanted"),
        (lambda: dg.Medium(lobes=((0, 0),)), "all weights are 0"),
        (lambda: dg.Medium(density=np.ones((2, 2, 2))), "wanted a DensityGrid or None"),
        (lambda: dg.Medium((1, 2, 1), density=_spike(600_000.0)), "1e\\+06 mean free paths.*1.2e"),
        (lambda: dg.DensityGrid(np.ones((2, 2))), r"wanted shape \(Z, Y, X\)"),
        (lambda: dg.DensityGrid(np.zeros((0, 2, 2))), r"wanted shape \(Z, Y, X\)"),
        (lambda: dg.DensityGrid([[[-1.0]]]), "numbers must be finite and at least 0"),
        (lambda: dg.DensityGrid([[[np.nan]]]), "numbers must be finite and at least 0"),
        (lambda: dg.DensityGrid([[[1e300]]]), "numbers must be finite and at least 0"),
        (lambda: dg.DensityGrid([[[1.0]]], np.zeros((4, 4))), "wanted an invertible affine matrix"),
        (lambda: dg.DensityGrid([[[1.0]]], np.eye(3)), r"wanted shape \(4, 4\)"),
    ],
)
def test_values_that_are_none_are_refused(made: Callable[[], Any], says: str) -> None:
    with pytest.raises(dg.InputError, match=says):
        made()


def test_scenes_and_materials_take_media_alone() -> None:
    scene = dg.Scene()
    with pytest.raises(dg.InputError, match="interior: wanted a Medium or None"):
        scene.add_material(dg.Material(interior=3))  # type: ignore[arg-type]
    with pytest.raises(dg.InputError, match="emission: a boundary cannot emit"):
        scene.add_material(dg.Material(dg.Boundary(), emission=(1, 1, 1)))
    with pytest.raises(dg.InputError, match="a medium without bounds that emits"):
        scene.set_fog(dg.Medium(emission=(1, 1, 1)))
    assert not scene.has_media
    scene.set_fog(FOG)
    assert scene.has_media
    assert scene.at(2.0).fog is FOG
    scene.set_fog(None)
    scene.add_material(dg.Material(exterior=FOG))
    assert scene.has_media
