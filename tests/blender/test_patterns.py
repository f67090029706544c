"""Pattern textures of Blender against Cycles' pictures, texel by texel. Needs bpy."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("bpy")

from daguerre.blender.patterns import gradient_noise, hashes

from .node_scenes import Read, Tree, cycles, emptied, random_picture, stage

#: Factor on a value before it is added to 1, so that no colour is negative.
SMALL = 0.05
#: Largest difference of a value.
CLOSE = 1e-4


@pytest.fixture(autouse=True)
def empty():
    emptied()


def random_numbers(tree, seed, low=-2.0, high=2.0):
    """Random numbers at each texel, as a colour."""
    return tree.texture(random_picture(f"p{seed}", seed, low, high)).outputs["Color"]


def random_number(tree, seed, low=-2.0, high=2.0):
    return tree.node("SeparateColor", {0: random_numbers(tree, seed, low, high)}).outputs[0]


def compared(node_of, output, folder, tolerance=CLOSE):
    """Asserts that an output of a node is that of Cycles at each texel."""
    tree = Tree()
    node = node_of(tree)
    socket = next(one for one in node.outputs if one.identifier == output)
    small = tree.node(
        "VectorMath", {0: socket, 1: (SMALL,) * 3, 2: (1.0,) * 3}, operation="MULTIPLY_ADD"
    )
    tree.shine(small.outputs["Vector"])
    stage(tree.material)
    read = Read(tree.material)
    ours, theirs = (read.shines() - 1) / SMALL, (cycles(folder) - 1) / SMALL
    assert np.ptp(theirs) > 0.05
    np.testing.assert_allclose(ours, theirs, atol=tolerance + 3e-6 * np.abs(theirs).max())
    assert not read.sentences


TYPES = ["FBM", "MULTIFRACTAL", "HETERO_TERRAIN", "HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL"]


def noise(tree, **options):
    inputs = {
        "Vector": random_numbers(tree, 1),
        "W": random_number(tree, 2),
        "Scale": 3.7,
        "Detail": 2.4,
        "Roughness": 0.6,
        "Lacunarity": 2.3,
        "Offset": 0.7,
        "Gain": 1.3,
    }
    inputs |= options.pop("inputs", {})
    return tree.node("TexNoise", inputs, **options)


@pytest.mark.parametrize("kind", TYPES)
@pytest.mark.parametrize("dimensions", ["1D", "2D", "3D", "4D"])
def test_noise(kind, dimensions, tmp_path):
    options = {"noise_dimensions": dimensions, "noise_type": kind}
    compared(lambda tree: noise(tree, **options), "Fac", tmp_path)


@pytest.mark.parametrize("dimensions", ["1D", "2D", "3D", "4D"])
def test_color_of_distorted_noise(dimensions, tmp_path):
    options = {"noise_dimensions": dimensions, "inputs": {"Distortion": 0.8, "Detail": 1.0}}
    compared(lambda tree: noise(tree, **options), "Color", tmp_path)


@pytest.mark.parametrize("detail", [0.0, 3.0, 20.0])
@pytest.mark.parametrize("normalize", [False, True])
def test_octaves_of_noise(detail, normalize, tmp_path):
    options = {"normalize": normalize, "inputs": {"Detail": detail, "Scale": 0.3}}
    compared(lambda tree: noise(tree, **options), "Fac", tmp_path, 5e-4 if detail > 10 else CLOSE)


def test_parameters_of_noise_from_pictures(tmp_path):
    def build(tree):
        inputs = {
            "Scale": random_number(tree, 3, 1, 3),
            "Roughness": random_number(tree, 4, 0, 1),
            "Lacunarity": random_number(tree, 5, 1.5, 2.5),
            "Distortion": random_number(tree, 6, 0, 1),
        }
        return noise(tree, inputs=inputs)

    compared(build, "Color", tmp_path)


@pytest.mark.parametrize("output", ["Value", "Color"])
@pytest.mark.parametrize("dimensions", ["1D", "2D", "3D", "4D"])
def test_white_noise(dimensions, output, tmp_path):
    def build(tree):
        inputs = {"Vector": random_numbers(tree, 1), "W": random_number(tree, 2)}
        return tree.node("TexWhiteNoise", inputs, noise_dimensions=dimensions)

    compared(build, output, tmp_path)


def voronoi(tree, **options):
    inputs = {
        "Vector": random_numbers(tree, 1),
        "W": random_number(tree, 2),
        "Scale": 1.7,
        "Roughness": 0.6,
        "Lacunarity": 2.3,
        "Smoothness": 0.7,
        "Exponent": 1.6,
        "Randomness": 0.9,
    }
    inputs |= options.pop("inputs", {})
    return tree.node("TexVoronoi", inputs, **options)


@pytest.mark.parametrize("feature", ["F1", "F2", "SMOOTH_F1"])
@pytest.mark.parametrize("dimensions", ["1D", "2D", "3D", "4D"])
def test_voronoi(feature, dimensions, tmp_path):
    options = {"feature": feature, "voronoi_dimensions": dimensions}
    outputs = ["Distance", "Color"] + ["Position"] * (dimensions != "1D")
    for output in outputs + ["W"] * (dimensions in ("1D", "4D")):
        emptied()
        compared(lambda tree: voronoi(tree, **options), output, tmp_path)


@pytest.mark.parametrize("dimensions", ["1D", "2D", "3D", "4D"])
def test_edges_and_radii_of_voronoi(dimensions, tmp_path):
    options = {"feature": "DISTANCE_TO_EDGE", "voronoi_dimensions": dimensions}
    compared(lambda tree: voronoi(tree, **options), "Distance", tmp_path)
    emptied()
    options["feature"] = "N_SPHERE_RADIUS"
    compared(lambda tree: voronoi(tree, **options), "Radius", tmp_path)


@pytest.mark.parametrize("metric", ["EUCLIDEAN", "MANHATTAN", "CHEBYCHEV", "MINKOWSKI"])
@pytest.mark.parametrize("feature", ["F1", "F2", "SMOOTH_F1"])
def test_metrics_of_voronoi(feature, metric, tmp_path):
    options = {"feature": feature, "distance": metric, "normalize": True}
    compared(lambda tree: voronoi(tree, **options), "Distance", tmp_path)


@pytest.mark.parametrize("feature", ["F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE"])
@pytest.mark.parametrize("normalize", [False, True])
def test_octaves_of_voronoi(feature, normalize, tmp_path):
    options = {"feature": feature, "normalize": normalize, "inputs": {"Detail": 2.4}}
    compared(lambda tree: voronoi(tree, **options), "Distance", tmp_path)
    if feature != "DISTANCE_TO_EDGE":
        emptied()
        compared(lambda tree: voronoi(tree, **options), "Color", tmp_path)
        emptied()
        compared(lambda tree: voronoi(tree, **options), "Position", tmp_path)


def test_smooth_voronoi_without_smoothness(tmp_path):
    options = {"feature": "SMOOTH_F1", "inputs": {"Smoothness": 0.0}}
    compared(lambda tree: voronoi(tree, **options), "Distance", tmp_path)


@pytest.mark.parametrize("profile", ["SIN", "SAW", "TRI"])
@pytest.mark.parametrize(
    ("kind", "direction"),
    [
        *(("BANDS", one) for one in ("X", "Y", "Z", "DIAGONAL")),
        *(("RINGS", one) for one in ("X", "Y", "Z", "SPHERICAL")),
    ],
)
def test_wave(kind, direction, profile, tmp_path):
    options = {"wave_type": kind, f"{kind.lower()}_direction": direction, "wave_profile": profile}
    inputs = {"Scale": 0.4, "Distortion": 0.7, "Detail": 1.5, "Detail Scale": 1.3}
    inputs |= {"Detail Roughness": 0.6, "Phase Offset": 0.3}

    def build(tree):
        return tree.node("TexWave", {"Vector": random_numbers(tree, 1), **inputs}, **options)

    compared(build, "Fac", tmp_path)


KINDS = ["LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL", "QUADRATIC_SPHERE", "RADIAL"]


@pytest.mark.parametrize("kind", KINDS)
def test_gradient(kind, tmp_path):
    def build(tree):
        vector = random_numbers(tree, 1, -0.7, 1.2)
        return tree.node("TexGradient", {"Vector": vector}, gradient_type=kind)

    compared(build, "Color", tmp_path)


@pytest.mark.parametrize("depth", range(11))
def test_magic(depth, tmp_path):
    def build(tree):
        inputs = {"Vector": random_numbers(tree, 1, -9, 9), "Scale": 0.7, "Distortion": 1.4}
        return tree.node("TexMagic", inputs, turbulence_depth=depth)

    compared(build, "Color" if depth % 2 else "Fac", tmp_path, 2e-4)


@pytest.mark.parametrize("output", ["Color", "Fac"])
@pytest.mark.parametrize("smooth", [0.0, 0.8])
def test_brick(smooth, output, tmp_path):
    def build(tree):
        inputs = {"Vector": random_numbers(tree, 1), "Scale": 2.3, "Mortar Size": 0.07}
        inputs |= {"Mortar Smooth": smooth, "Bias": 0.1, "Brick Width": 0.4, "Row Height": 0.3}
        inputs |= {"Color1": (0.9, 0.1, 0.2), "Color2": (0.2, 0.7, 0.3), "Mortar": (0, 0, 1)}
        options = {"offset": 0.3, "squash": 0.7, "offset_frequency": 3, "squash_frequency": 2}
        return tree.node("TexBrick", inputs, **options)

    compared(build, output, tmp_path)


@pytest.mark.parametrize("output", ["Color", "Fac"])
def test_checker(output, tmp_path):
    def build(tree):
        inputs = {"Vector": random_numbers(tree, 1), "Scale": 1.3}
        inputs |= {"Color1": (0.9, 0.1, 0.2), "Color2": (0.2, 0.7, 0.3)}
        return tree.node("TexChecker", inputs)

    compared(build, output, tmp_path)


def test_hash_of_words_is_that_of_its_author():
    """Words of zeros, and the value that follows from Jenkins' mixers by hand."""
    zero = np.zeros(1, np.uint32)

    def rotated(word, count):
        return (word << count | word >> (32 - count)) & 0xFFFFFFFF

    a = b = c = (0xDEADBEEF + 8 + 13) & 0xFFFFFFFF
    for count in (14, 11, 25, 16, 4, 14, 24):  # each word takes its turn: c, a, b, c, a, b, c
        c, a, b = (c ^ b), a, b
        c = (c - rotated(b, count)) & 0xFFFFFFFF
        a, b, c = b, c, a  # the word that changed is the next one's source
    assert int(hashes.lookup3(zero, zero)[0]) == b


def test_noise_is_zero_at_the_corners_of_its_grid():
    corners = [np.arange(-4, 4, dtype=np.float32)] * 3
    np.testing.assert_array_equal(gradient_noise.signed_noise(corners), 0)


def test_noise_far_from_the_origin_is_finite():
    far = np.array([1e9, -1e30, np.inf, np.nan, 1e38], np.float32)
    found = gradient_noise.signed_noise([far, far, far])
    assert np.isfinite(found).all()
