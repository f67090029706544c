"""Depth of field and motion blur of the darkroom: exact where they can be; bad input."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenEXR
import pytest

import daguerre as dg
from daguerre import _core, cli
from daguerre.errors import InputError, UsageError
from daguerre.post.iris import outline

# pupil 50 mm, film at 100 mm, 0.1 mm a pixel: radius = 25 * 100 * |1/s - 1/4| * 1e-3 / 0.1 px
LENS = {"focal_length": 100, "f_stop": 2, "focus": 4, "largest": 50}
FILM = {"sensor": (20.0, 12.0)}
SHAPE = (120, 200)


def spots() -> np.ndarray:
    rng = np.random.default_rng(3)
    image = rng.random((*SHAPE, 3)).astype(np.float32)
    image[50, 90] = 4000
    return image


def disc(radius: float) -> np.ndarray:
    """Areas of a disc on pixels, by many points on each."""
    reach, fine = int(radius) + 2, 24
    at = (np.arange((2 * reach + 1) * fine) + 0.5) / fine - reach - 0.5
    inside = (at[:, None] ** 2 + at**2 <= radius**2).astype(float)
    side = 2 * reach + 1
    return inside.reshape(side, fine, side, fine).sum(axis=(1, 3)) / inside.sum()


@pytest.mark.parametrize(("depth", "radius"), [(2.0, 6.25), (8.0, 3.125), (np.inf, 6.25)])
def test_a_plane_is_convolved_with_the_iris_of_the_thin_lens_formula(
    depth: float, radius: float
) -> None:
    image = np.zeros((*SHAPE, 3), np.float32)
    image[50, 90] = 1
    out = dg.post.depth_of_field(image, np.full(SHAPE, depth), **LENS, **FILM)
    kernel = disc(radius)
    reach = kernel.shape[0] // 2
    rows, columns = slice(50 - reach, 51 + reach), slice(90 - reach, 91 + reach)
    assert out[rows, columns, 1] == pytest.approx(kernel, abs=1.5e-4)
    assert out.sum() == pytest.approx(3, rel=1e-5)


def test_breathing_is_the_formula_of_the_catalogue() -> None:
    """Diameter |s - s_f| / s f^2 / (N (s_f - f)), mm."""
    image = np.zeros((*SHAPE, 3), np.float32)
    image[50, 90] = 1
    out = dg.post.depth_of_field(image, np.full(SHAPE, 2.0), **LENS, **FILM, focus_breathing=True)
    diameter = 2 / 2 * 0.1**2 / (2 * 3.9) * 1e3
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    spread = (out[:, :, 0] * ((y - 50) ** 2 + (x - 90) ** 2)).sum()
    assert spread == pytest.approx((diameter / 0.2) ** 2 / 2 + 1 / 6, rel=1e-2)


def test_what_is_in_focus_stays_and_no_argument_changes() -> None:
    image, depth = spots(), np.full(SHAPE, 4.0)
    before = image.copy()
    out = dg.post.depth_of_field(image, depth, **LENS, **FILM)
    assert out == pytest.approx(image, rel=1e-6)
    assert (image == before).all()


def test_distance_along_the_ray_is_depth_over_the_cosine() -> None:
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    slope = np.hypot(x + 0.5 - 100, y + 0.5 - 60) * 0.1 / 100
    ray = 2 * np.hypot(1, slope)
    image = spots()
    along = dg.post.depth_of_field(image, ray, **LENS, **FILM, depth_along="ray", blades=5)
    plain = dg.post.depth_of_field(image, np.full(SHAPE, 2.0), **LENS, **FILM, blades=5)
    assert along == pytest.approx(plain, rel=1e-3)


def test_a_blurred_triangle_points_up_behind_the_focus_and_down_before_it() -> None:
    image = np.zeros((*SHAPE, 3), np.float32)
    image[60, 100] = 1
    for depth, sign in ((np.inf, -1), (2.0, 1)):  # a corner at the top of the iris
        out = dg.post.depth_of_field(
            image, np.full(SHAPE, depth), **LENS, **FILM, blades=3, blade_rotation=90
        )
        rows = np.flatnonzero(out[:, :, 0].max(axis=1) > 1e-6) - 60
        assert np.sign(rows[0] + rows[-1]) == sign


@pytest.mark.parametrize(("blades", "curvature"), [(3, 0.0), (5, 0.4), (6, -0.5), (7, 1.0)])
def test_outlines_are_those_of_the_cameras(blades: int, curvature: float) -> None:
    iris = _core.Iris.polygon(blades, 20, curvature)
    corners = outline(blades, 20, curvature)
    x, y = corners.T
    corners *= np.sqrt(np.pi / (0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()))
    edges = np.array(iris.edges)
    if iris.bend == 0:
        beyond = (corners @ edges.T).max(axis=1) - iris.apothem
    else:
        from_arcs = np.linalg.norm(corners[:, None] - iris.arc_center * edges, axis=2)
        beyond = np.abs(from_arcs - iris.arc_radius).min(axis=1)
    assert beyond == pytest.approx(0, abs=1e-3)
    assert np.linalg.norm(corners, axis=1).max() == pytest.approx(iris.outer_radius, rel=1e-3)


def test_an_iris_by_picture(tmp_path: Path) -> None:
    from daguerre.frame.frame import Frame

    picture = np.zeros((64, 64, 3), np.float32)
    picture[16:48, 24:40] = 1
    Frame(picture).save(tmp_path / "iris.png")
    image = np.zeros((*SHAPE, 3), np.float32)
    image[60, 100] = 1
    out = dg.post.depth_of_field(
        image, np.full(SHAPE, 2.0), **LENS, **FILM, aperture_image=str(tmp_path / "iris.png")
    )
    lit = np.argwhere(out[:, :, 0] > 1e-5)
    height, width = lit.max(axis=0) - lit.min(axis=0) + 1
    assert 1.7 < height / width < 2.2
    assert out.sum() == pytest.approx(3, rel=1e-5)


def test_sky_and_large_blur_are_said_and_negative_depth_is_refused() -> None:
    image = spots()
    depth = np.full(SHAPE, 4.0, np.float32)
    depth[:20] = 0  # as our own channel has the sky
    depth[20:40] = np.inf
    depth[40] = np.nan
    out = dg.post.depth_of_field(image, depth, **LENS, **FILM)
    assert np.isfinite(out).all()
    depth[7, 5] = -3
    with pytest.raises(InputError, match=r"depth\.Z: wanted distances.*got -3 at pixel 5, 7"):
        dg.post.depth_of_field(image, depth, **LENS, **FILM)


def test_wrong_lenses_and_shapes_are_named() -> None:
    image, depth = spots(), np.full(SHAPE, 4.0)
    with pytest.raises(
        UsageError, match=r"focus: wanted a distance beyond the focal length of 100 mm"
    ):
        dg.post.depth_of_field(image, depth, **{**LENS, "focus": 0.1}, **FILM)
    with pytest.raises(UsageError, match="f_stop: the file has none; give the f-number"):
        dg.post.depth_of_field(image, depth, focal_length=100, focus=4, **FILM)
    with pytest.raises(UsageError, match="blades: wanted 0"):
        dg.post.depth_of_field(image, depth, **LENS, **FILM, blades=2)
    with pytest.raises(UsageError, match=r"depth\.Z: wanted numbers of shape \(120, 200\)"):
        dg.post.depth_of_field(image, depth[:9], **LENS, **FILM)


def moved(u: float, v: float) -> np.ndarray:
    return np.broadcast_to(np.array([u, v], np.float32), (*SHAPE, 2))


def test_uniform_motion_is_a_mean_along_a_line() -> None:
    image = spots()
    out = dg.post.motion_blur(image, moved(16, 0))  # 180 degrees: 4 px to either side
    line = np.array([0.125, *[1] * 7, 0.125]) / 7.25 * (7.25 / 8)
    line[[0, -1]] = 0.5 / 8
    line[1:-1] = 1 / 8
    wanted = sum(w * np.roll(image, k - 4, axis=1) for k, w in enumerate(line))
    assert out[:, 10:-10] == pytest.approx(wanted[:, 10:-10], rel=1e-5)


def test_the_shutter_decides_when_and_how_long() -> None:
    image = np.zeros((*SHAPE, 3), np.float32)
    image[60, 100] = 1
    columns = np.arange(SHAPE[1]) - 100

    def moments(**shutter: object) -> tuple[float, float]:
        line = dg.post.motion_blur(image, moved(40, 0), **shutter)[60, :, 0]
        middle = (line * columns).sum() / line.sum()
        return middle, (line * (columns - middle) ** 2).sum() / line.sum()

    middle, width = moments()
    assert middle == pytest.approx(0, abs=1e-6)
    assert width == pytest.approx(20**2 / 12, rel=2e-2)
    assert moments(shutter_offset=0)[0] == pytest.approx(10, rel=1e-2)
    assert moments(shutter_angle=360, scale=-1, shutter_offset=0)[0] == pytest.approx(-20, rel=1e-2)
    narrow = moments(shutter_curve="trapezoid", efficiency=0.5)[1]
    assert narrow == pytest.approx(20**2 / 24, rel=3e-2)  # a triangle
    assert moments(shutter_angle=0) == (0, 0)


def test_motion_before_and_after_may_differ_and_v_may_count_up() -> None:
    image = np.zeros((*SHAPE, 3), np.float32)
    image[60, 100] = 1
    both = np.concatenate([moved(0, 20), moved(20, 0)], axis=2)  # comes from the right, goes down
    out = dg.post.motion_blur(image, both)[:, :, 0]
    assert out[60, 101:106].sum() == pytest.approx(0.5, abs=0.06)
    assert out[61:66, 100].sum() == pytest.approx(0.5, abs=0.06)
    up = dg.post.motion_blur(image, moved(0, 20), v_up=True, shutter_offset=0)[:, :, 0]
    assert up[50:60, 100].sum() == pytest.approx(1, abs=0.06)


def test_depth_decides_what_hides_what() -> None:
    """A still square before a ground that moves, and behind it."""
    image = np.zeros((*SHAPE, 3), np.float32)
    image[40:80, 80:120] = 1
    flow = np.where(image[:, :, :1] == 1, 0, moved(40, 0)).astype(np.float32)
    near = np.where(image[:, :, 0] == 1, 2.0, 5.0)
    assert dg.post.motion_blur(image, flow, near) == pytest.approx(image, abs=1e-6)
    covered = dg.post.motion_blur(image, flow, 7 - near)
    assert covered[60, 82, 0] < 0.75
    assert dg.post.motion_blur(image, flow)[60, 82, 0] < 0.75  # the faster one is taken to be near


def test_unknown_motion_stands_still_and_wild_motion_is_refused() -> None:
    image = spots()
    flow = moved(0, 0).copy()
    flow[10, 10] = np.nan
    assert dg.post.motion_blur(image, flow) == pytest.approx(image)
    with pytest.raises(InputError, match="motion: wanted at most 10000 px"):
        dg.post.motion_blur(image, moved(1e9, 0))
    with pytest.raises(InputError, match="motion: wanted shape"):
        dg.post.motion_blur(image, np.zeros(SHAPE))


def write(path: Path, **planes: np.ndarray) -> Path:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    image = spots()
    colors = {name: np.ascontiguousarray(image[:, :, k]) for k, name in enumerate("RGB")}
    channels = {name.replace("_", "."): np.ascontiguousarray(p) for name, p in planes.items()}
    with OpenEXR.File(header, {**colors, **channels}) as file:
        file.write(str(path))
    return path


def test_files_in_bands_are_the_arrays_and_missing_channels_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    depth = np.linspace(2, 9, SHAPE[0] * SHAPE[1], dtype=np.float32).reshape(SHAPE)
    flow = np.ascontiguousarray(moved(9, 5))
    source = write(tmp_path / "in.exr", depth_Z=depth, motion_U=flow[..., 0], motion_V=flow[..., 1])
    words = "depth-of-field:focal_length=100,f_stop=2,focus=4,sensor=20x12,largest=50"
    target = str(tmp_path / "out.exr")
    assert cli.main(["post", str(source), "-o", target, "--effect", words]) == 0
    with OpenEXR.File(target, separate_channels=True) as file:
        made = np.stack([file.channels()[c].pixels for c in "RGB"], axis=2)
    image = spots()
    assert made == pytest.approx(dg.post.depth_of_field(image, depth, **LENS, **FILM), rel=1e-6)
    assert cli.main(["post", str(source), "-o", target, "--effect", "motion-blur"]) == 0
    with OpenEXR.File(target, separate_channels=True) as file:
        made = np.stack([file.channels()[c].pixels for c in "RGB"], axis=2)
    assert made == pytest.approx(dg.post.motion_blur(image, flow, depth), rel=1e-6)
    capsys.readouterr()
    bare = str(write(tmp_path / "bare.exr"))
    assert cli.main(["post", bare, "-o", target, "--effect", words]) == 3
    assert "channel for depth: wanted depth.Z" in capsys.readouterr().err
    assert cli.main(["post", bare, "-o", target, "--effect", "motion-blur"]) == 3
    assert "channel for motion.u: wanted motion.U" in capsys.readouterr().err
