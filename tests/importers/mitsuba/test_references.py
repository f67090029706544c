"""Mitsuba's own reference pictures: a Z-test per pixel for its scenes.

The folder of the public collection mitsuba-data is named by ``DAGUERRE_MITSUBA_DATA``. The rule is
that of Mitsuba's render tests (src/render/tests/test_renders.py): two million samples per scene;
CIE XYZ; a family-wise error of 1 % by Sidak's correction; 99.75 % of all values must pass. Two
things differ. Wavelengths are sampled here, which adds noise that its variances lack: the larger of
both variances counts. And their paths end by counts of steps, ours by counts of surfaces.
"""

from __future__ import annotations

import math
import os
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.importers.mitsuba.reader import read_all
from daguerre.pictures.exr.reader import ExrReader

FOLDER = os.environ.get("DAGUERRE_MITSUBA_DATA", "")
BUDGET, BATCHES, ERROR, PASSING = 2_000_000, 16, 0.01, 0.9975
#: Least variance of a sample.
LEAST = 1e-4
_XYZ = np.array(
    [
        [0.412453, 0.357580, 0.180423],
        [0.212671, 0.715160, 0.072169],
        [0.019334, 0.119193, 0.950227],
    ]
)
Picture = NDArray[np.float64]
#: Scenes that pass. Where the noise of a reference is large, the rule does not see light that is
#: 5 % too bright.
SHARP, NOISY = True, False
PASSES: dict[str, bool] = {
    "floating_sphere/test_directional": SHARP,
    "instancing/test_instancing": SHARP,
    "projector/test_projector_constant": SHARP,
    "projector/test_projector_textured": SHARP,
    "spot_light/test_spot": SHARP,
    "bsdf_spheres/test_pointlight": SHARP,
    "bsdf_spheres/test_roughdielectric": SHARP,
    "participating_media/test_hetero_sigmat": NOISY,
    "participating_media/test_hetero_spectral_sigmat_no_scattering": NOISY,
    "participating_media/test_homo_area_light": NOISY,
    "participating_media/test_homo_dielectric_envmap": SHARP,
    "participating_media/test_homo_emitter_inside_medium": NOISY,
    "participating_media/test_homo_null_envmap": NOISY,
    "participating_media/test_homo_obj_inside_medium": NOISY,
    "participating_media/test_homo_roughdielectric_spot": NOISY,
    "participating_media/test_homo_spectral_sigmat": SHARP,
    "bsdf_spheres/test_constant": SHARP,
    "bsdf_spheres/test_envmap": SHARP,
    "bsdf_spheres/test_bumpmap": SHARP,
    "bsdf_spheres/test_normalmap": SHARP,
    "bsdf_spheres/test_normalmap_identity_roughconductor": SHARP,
    "bsdf_spheres/test_normalmap_roughconductor": SHARP,
    "bsdf_spheres/test_textured_diffuse": SHARP,
    "infinite_mirrors/scene": SHARP,
    "mesh_attributes/test_mesh_attributes_3_face": SHARP,
    "mesh_attributes/test_mesh_attributes_3_vertex": SHARP,
    "participating_media/test_surf_area_light": NOISY,
    "texture_interp/test_texture_interp": SHARP,
    "various_emitters/test_various_emitters": NOISY,
}
#: Scenes that do not pass, and why; bench/records/scenes.md has the same table.
_MASKING = "facets of roughness 1 hide and shade each other by the same heights here"
_PRINCIPLED = "principled materials"
LACKING: dict[str, str] = {
    "bsdf_spheres/test_arealight": "a spectrum on colours: three products in Mitsuba",
    "bsdf_spheres/test_roughplastic_linear": _MASKING,
    "bsdf_spheres/test_roughplastic_nonlinear": _MASKING,
    "bsdf_spheres/test_textured_roughconductor": "the metal's index has three colours in Mitsuba",
    "bsdf_spheres/test_texturedprincipled1": _PRINCIPLED,
    "bsdf_spheres/test_texturedprincipled2": _PRINCIPLED,
    "bsdf_spheres/test_texturedprincipledthin": _PRINCIPLED,
    "mesh_attributes/test_mesh_attributes_1_face": "attributes other than colours",
    "orthographic_sensor/test_orthographic": "an orthographic sensor",
    "participating_media/test_hetero_sigmat_albedo": "albedo from a grid",
    "participating_media/test_hetero_spectral_sigmat": "extinction from a grid of colours",
    "various_shapes/test_various_shapes": "sdfgrid",
}


def _exr(path: Path) -> Picture:
    with ExrReader(path) as reader:
        planes = reader.rows(0, reader.height, ["R", "G", "B"])
    rgb = np.stack([planes[name] for name in "RGB"], axis=2).astype(np.float64)
    return np.asarray(rgb @ _XYZ.T)


def _scene(name: str) -> Path:
    if not FOLDER:
        pytest.skip("DAGUERRE_MITSUBA_DATA names no folder with mitsuba-data")
    stem = name.rsplit("/", 1)[1]  # some names begin as others do
    found = sorted((Path(FOLDER) / "tests/scenes").glob(f"{name}_*.xml"))
    (one,) = (path for path in found if path.stem.rsplit("_", 1)[0] == stem or len(found) == 1)
    return one


def _drawn(path: Path, spp: int) -> tuple[Picture, Picture]:
    """Picture, and variance of a sample, by independent batches."""
    scene, settings, _ = read_all(path, allow_dirs=(FOLDER,))
    chosen = next(iter(settings.values()))
    pictures = np.array(
        [
            dg.render(
                scene,
                scene.camera(),
                resolution=chosen.resolution,
                filter=chosen.filter,
                max_depth=chosen.max_depth or 64,
                spp=max(spp // BATCHES, 1),
                seed=100 + i,
            ).rgb
            for i in range(BATCHES)
        ],
        np.float64,
    )
    pictures = pictures @ _XYZ.T
    return pictures.mean(axis=0), pictures.var(axis=0, ddof=1) * max(spp // BATCHES, 1)


def share_that_passes(mean: Picture, own: Picture, path: Path, spp: int) -> float:
    """Share of values whose difference from the reference chance explains."""
    stem = path.parent / "refs" / path.stem.rsplit("_", 1)[0]
    wanted, variance = _exr(Path(f"{stem}_ref_rgb.exr")), _exr(Path(f"{stem}_ref_rgb_var.exr"))
    z = np.abs(mean - wanted) * np.sqrt(spp / np.maximum(np.maximum(variance, own), LEAST))
    chance = np.vectorize(math.erfc)(z / math.sqrt(2))
    pixels = wanted.shape[0] * wanted.shape[1]
    return float((chance > 1 - (1 - ERROR) ** (1 / pixels)).mean())


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.parametrize("name", PASSES)
def test_pictures_are_those_of_mitsuba(name: str) -> None:
    path = _scene(name)
    spp = _samples(path)
    mean, own = _drawn(path, spp)
    assert share_that_passes(mean, own, path, spp) >= PASSING
    if PASSES[name]:  # light that is 5 % too bright is seen
        assert share_that_passes(1.05 * mean, own, path, spp) < PASSING


def _samples(path: Path) -> int:
    stem = path.parent / "refs" / path.stem.rsplit("_", 1)[0]
    height, width = _exr(Path(f"{stem}_ref_rgb.exr")).shape[:2]
    return int(BUDGET // (height * width))


@pytest.mark.slow
def test_every_reference_is_in_the_table() -> None:
    if not FOLDER:
        pytest.skip("DAGUERRE_MITSUBA_DATA names no folder with mitsuba-data")
    root = Path(FOLDER) / "tests/scenes"
    found = {
        f"{path.parent.parent.name}/{path.name.removesuffix('_ref_rgb.exr')}"
        for path in root.glob("*/refs/*_ref_rgb.exr")
    }
    assert found == {*PASSES, *LACKING}
    assert not {*PASSES} & {*LACKING}


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(LACKING))
def test_scenes_that_lack_something_load(name: str) -> None:
    path = _scene(name)
    _, _, ledger = read_all(path, allow_dirs=(FOLDER,))
    assert ledger.counts()[2] == 0
