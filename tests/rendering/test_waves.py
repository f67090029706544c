"""Diffraction in a render: bands of the film, colours, energy, passes, stars in the picture."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre import analysis, lenses
from daguerre.analysis.diffraction import PlainPupil
from daguerre.analysis.off_axis import off_axis
from daguerre.color import spectra as colour
from daguerre.errors import InputError, UsageError
from daguerre.rendering import diffraction as waves
from daguerre.rendering import pupil_files
from daguerre.rendering.diffraction import Diffraction
from daguerre.rendering.merging import merge
from daguerre.rendering.passes import pass_of, read_pass, write_pass
from daguerre.rendering.session import Session
from daguerre.setup.camera import set_up
from tests.rendering import test_flare

SIZE = (96, 64)


@pytest.fixture(autouse=True)
def few_wavelengths(monkeypatch: pytest.MonkeyPatch) -> None:
    """Kernels of one wavelength per band: a third of the time."""
    monkeypatch.setattr(waves, "LEAST_WAVELENGTHS", 8)


def lamps(colours: Any = ((900.0, 700.0, 400.0),)) -> dg.Scene:
    """Small lamps at 4 m, one beside the other, before a dim coloured sky."""
    scene = dg.Scene()
    for k, rgb in enumerate(colours):
        place = np.eye(4)
        place[:3, 3] = (0.4 * (k - 0.5 * (len(colours) - 1)), 0, -4)
        scene.add_light(dg.SphereLight(rgb, 0.01), place)
    scene.set_environment(np.full((2, 4, 3), (0.02, 0.05, 0.1), np.float32))
    return scene


def camera(**more: Any) -> dg.Camera:
    options: dict[str, Any] = {
        "focal_length": 50,
        "f_stop": 16.0,
        "focus_distance": 4.0,
        "sensor_size": (1.92, 1.28),
        "blades": 6,
    }
    return dg.Camera(**options | more)


def session(scene: dg.Scene, cam: dg.Camera, diffraction: Any = True, **more: Any) -> Session:
    return Session(scene, cam, resolution=SIZE, max_depth=2, diffraction=diffraction, **more)


def test_bands_without_kernels_have_the_colour_of_xyz(monkeypatch: pytest.MonkeyPatch) -> None:
    """White is exact; lamps of any RGB, too, but for the noise of their samples within bands."""
    scene = lamps(((9.0, 9, 9), (9, 2, 1), (1, 3, 9)))
    one = session(scene, camera(f_stop=4.0, sensor_size=(24, 16)), Diffraction(16))
    one.draw(0, 64)
    monkeypatch.setattr(waves, "DARK", np.inf)  # no band is spread
    plain, banded = one.frame(waves=False), one.frame()
    assert plain.xyz is not None
    assert banded.xyz is not None
    bright = plain.rgb.max(axis=2) > 0.01
    scale = plain.rgb[bright].max(axis=1, keepdims=True)
    assert np.abs((banded.rgb - plain.rgb)[bright] / scale).mean() < 0.02
    whole = banded.rgb.sum(axis=(0, 1)) / plain.rgb.sum(axis=(0, 1))
    np.testing.assert_allclose(whole, 1, atol=0.003)


def test_diffraction_keeps_the_light_and_makes_the_star_of_the_iris() -> None:
    one = session(lamps(), camera(), light_paths="off")
    one.draw(0, 64)
    sharp, wave = one.frame(waves=False), one.frame()
    inner = np.s_[24:-24, 40:-40]  # about the lamp
    assert wave.rgb[inner].sum() < 0.99 * sharp.rgb[inner].sum()
    dim = sharp.rgb.sum(axis=(0, 1)), wave.rgb.sum(axis=(0, 1))
    assert (np.abs(dim[1] / dim[0] - 1) < 0.02).all()
    y, x = np.unravel_index(sharp.rgb.sum(axis=2).argmax(), SIZE[::-1])
    light = (wave.rgb - sharp.rgb).sum(axis=2)
    rows, columns = np.mgrid[: SIZE[1], : SIZE[0]]
    angle = np.degrees(np.arctan2(y - rows, columns - x)) % 60
    ring = np.abs(np.hypot(rows - y, columns - x) - 17) < 9
    along, across = (light[ring & (np.abs(angle - a) < 8)].mean() for a in (30, 52))
    assert along > 1.3 * across  # spikes stand across edges, at 30 degrees and so on


def test_a_session_makes_its_kernels_once(monkeypatch: pytest.MonkeyPatch) -> None:
    made, make = [], waves._kernels
    monkeypatch.setattr(waves, "_kernels", lambda *given: made.append(given) or make(*given))
    one = session(lamps(), camera(), light_paths="off")
    one.draw(0, 1)
    first = one.frame()
    one.draw(1, 2)
    second = one.frame()
    assert len(made) == 1
    assert not np.array_equal(second.rgb, first.rgb)
    fresh = session(lamps(), camera(), light_paths="off")
    fresh.draw(0, 2)
    assert np.array_equal(fresh.frame().rgb, second.rgb)


@pytest.mark.parametrize("light_paths", ["off", (4.0, 0.0)])
def test_passes_with_bands_add_up_to_the_bits_of_one(tmp_path: Path, light_paths: Any) -> None:
    def draw(begin: int, end: int) -> Session:
        one = session(lamps(), camera(), Diffraction(8), light_paths=light_paths)
        one.draw(begin, end)
        return one

    whole = draw(0, 6)
    for k, (a, b) in enumerate(((4, 6), (0, 4))):
        part = draw(a, b)
        write_pass(tmp_path / f"{k}.exr", part.frame(), pass_of(part))
    frame, total = merge([tmp_path / "0.exr", tmp_path / "1.exr"])
    for name, words in whole.state().items():
        assert np.array_equal(words, total.state[name])
    assert np.array_equal(frame.rgb, whole.frame().rgb)
    assert frame.metadata["diffraction"] == "8 bands, 1 x 1 zones"
    other = draw(6, 7)
    other.set_state(read_pass(tmp_path / "0.exr").state, [(4, 6)])
    assert other.ranges == [(4, 6)]
    plain = session(lamps(), camera(), False, light_paths=light_paths)
    plain.draw(0, 4)
    write_pass(tmp_path / "2.exr", plain.frame(), pass_of(plain))
    with pytest.raises(dg.MismatchError, match="diffraction"):
        merge([tmp_path / "0.exr", tmp_path / "2.exr"])


def test_splats_of_light_paths_land_in_bands() -> None:
    frames = []
    for light_paths in ("off", (3000.0, 0.0)):
        one = session(
            lamps(), camera(), Diffraction(6), light_paths=light_paths,
            technique="both" if light_paths == "off" else "light",
        )  # fmt: skip
        one.draw(0, 128)
        frames.append(one.frame().rgb.sum(axis=(0, 1)))
    np.testing.assert_allclose(frames[1], frames[0], rtol=0.05)


def test_ghosts_are_diffracted_with_the_picture(tmp_path: Path) -> None:
    """Nothing else shines here, so ghosts are the whole picture; kernels keep their light."""
    eye = test_flare.camera(f_stop=11.0, sensor_size=(1.8, 1.2))
    options = {"seed": 3, "threads": 1}
    plain = test_flare.session(eye=eye, bands=8, **options)  # bands: ghosts by paths, as waves need
    waved = test_flare.session(eye=eye, diffraction=Diffraction(8), **options)
    for one in (plain, waved):
        one.draw(0, 2)
    wanted, frame = plain.frame(), waved.frame()
    assert wanted.rgb.max() > 0
    assert np.array_equal(waved.frame(waves=False).rgb, wanted.rgb)
    assert frame.flare is not None
    assert np.array_equal(frame.flare, wanted.rgb)
    assert frame.xyz is not None
    assert wanted.xyz is not None
    assert not np.array_equal(frame.xyz, wanted.xyz)
    light = [xyz.mean(axis=(0, 1)) for xyz in (frame.xyz, wanted.xyz)]
    np.testing.assert_allclose(*light, rtol=0.006)  # some leaves the frame
    write_pass(tmp_path / "a.exr", frame, pass_of(waved))
    again, _ = merge([tmp_path / "a.exr"])
    assert np.array_equal(again.rgb, frame.rgb)


def test_zones_of_a_lens_see_their_own_pupils() -> None:
    cam = dg.Camera(lens="double-gauss-50mm-f2", f_stop=2.0, focus_distance=4.0, blades=5)
    one = Session(
        lamps(), cam, resolution=(48, 32), max_depth=1, diffraction=Diffraction(4, 3),
        light_paths="off",
    )  # fmt: skip
    facts = one.metadata["pupils"]
    again = pupil_files.from_json(json.loads(json.dumps(facts)))
    assert [len(row) for row in again] == [3, 3, 3]
    spans = [[p.high[1] - p.low[1] for p in row] for row in again]
    assert spans[0][0] < 0.9 * spans[1][1]  # corners are cut
    kernels = waves._whole(waves._kernels(again, np.array([[500.0, 520.0]]), 0.002, 41, 0)[0])
    kernels = kernels[..., 0, 0]
    np.testing.assert_allclose(kernels.sum(axis=(2, 3)), 1, rtol=1e-5)
    widths = (kernels > 0.1 * kernels.max(axis=(2, 3), keepdims=True)).sum(axis=(2, 3))
    assert widths[0, 0] > widths[1, 1]  # narrow pupils spread more
    assert one.metadata["diffraction"] == "4 bands, 3 x 3 zones"


def middles(zones: int = 2, sensor: tuple[float, float] = (20.0, 16.0), **more: Any) -> Any:
    """Middles of the pupils' windows (direction cosines x, y), by zone, shape (Z, Z, 2)."""
    cam = dg.Camera(
        lens="double-gauss-50mm-f2", f_stop=4.0, focus_distance=3.0, sensor_size=sensor, **more
    )
    setup = set_up(dg.Scene(), cam, (40, 32), None)
    pupils = waves._pupils(Diffraction(4, zones), cam, setup)
    return np.array([[np.add(p.low, p.high) / 2 for p in row] for row in pupils])


def test_a_shifted_frame_sees_the_pupils_of_its_own_place() -> None:
    """A frame moved right and up is the upper right of a larger one."""
    large, moved = middles(3), middles(1, shift=(10.0, 8.0))
    np.testing.assert_allclose(moved[0, 0], large[0, 2], atol=1e-6)
    assert moved[0, 0, 0] > 0.05
    assert moved[0, 0, 1] > 0.05


@pytest.mark.parametrize(
    "more", [{"tilt": (5.0, 0.0)}, {"decenter": (((9, 10), (0.0, 1.0), (0.0, 0.0)),)}]
)
def test_what_is_off_the_axis_has_pupils_off_the_axis(more: dict[str, Any]) -> None:
    """Up and down differ; left and right do not, for both move along y alone."""
    straight, skew = middles(), middles(**more)
    up, down = skew[0, :, 1], -skew[1, :, 1]
    assert np.abs(up - down).min() > 3e-3
    np.testing.assert_allclose(skew[:, 0] * (-1, 1), skew[:, 1], atol=1e-6)
    mirrored = straight[::-1] * (1, -1)
    np.testing.assert_allclose(mirrored, straight, atol=1e-6)
    # A turn the other way mirrors it.
    other = {
        "tilt": (-5.0, 0.0), "decenter": (((9, 10), (0.0, -1.0), (0.0, 0.0)),)
    }  # fmt: skip
    back = middles(**{name: other[name] for name in more})
    np.testing.assert_allclose(back[::-1] * (1, -1), skew, atol=1e-5)


def test_a_turned_lens_sees_as_the_camera_does() -> None:
    """Directions of chief rays across the film, against the camera's own, but for the middle."""
    lens, f_stop, away = "double-gauss-50mm-f2", 4.0, 3.0
    film = np.array([[0.0, 0], [9, 0], [0, 9], [0, -9], [-6, -7]])
    for tilt in ((5.0, 0.0), (0.0, 5.0), (4.0, -3.0)):
        cam = dg.Camera(lens=lens, f_stop=f_stop, focus_distance=away, tilt=tilt)
        core = set_up(dg.Scene(), cam, (36, 24), None).core.chief_rays()
        wanted = np.asarray(core.rays(film)[1])
        bench = analysis.set_up(lenses.load(lens), f_stop=f_stop, focus_m=away, by="paraxial")
        found = -analysis.chief_rays(off_axis(bench, (), tilt), -film).directions
        slopes = [d[:, :2] / -d[:, 2:] for d in (wanted, found)]
        off = slopes[1] - slopes[0]
        np.testing.assert_allclose(off, np.broadcast_to(off[0], off.shape), atol=4e-4)
        assert np.abs(off[0]).max() < 5e-3  # the camera keeps the middle of its picture


class Film:
    """Stands in for a film in ``developed``."""

    def __init__(self, bands: Any, xyz: Any) -> None:
        self._bands, self._xyz = np.asarray(bands, np.float32), np.asarray(xyz, np.float32)

    def mean_bands(self) -> NDArray[np.float32]:
        return self._bands

    def mean_xyz(self) -> NDArray[np.float32]:
        return self._xyz.copy()


def planned(pupils: Any, bands: int, pitch_mm: float = 0.006) -> dict[str, Any]:
    return {"bands": bands, "pitch_mm": pitch_mm, **pupil_files.to_json(pupils)}


@pytest.mark.parametrize("nm", [412.0, 470.0, 641.0])
def test_a_spectrum_steep_within_its_band_keeps_light_and_colour(nm: float) -> None:
    """A line of one wavelength, as coatings leave violet: its band has another colour."""
    bands = 16
    b = int((nm - 380) / 25)
    spectra = np.zeros((41, 61, bands))
    spectra[20, 30, b] = 5.0
    xyz = np.zeros((41, 61, 3))
    xyz[20, 30] = 5.0 * 25 * colour._tables([nm])[0][0]
    assert np.abs(5 * colour.band_colors(bands)[b] - xyz[20, 30]).max() > 0.02 * xyz.max()
    facts = planned([[PlainPupil(8)]], bands)
    out = waves.developed(Film(spectra, xyz), facts).xyz
    light, wanted = out.sum(axis=(0, 1)), xyz.sum(axis=(0, 1))
    kept = light[1] / wanted[1]
    assert kept == pytest.approx(1, abs=0.02)  # but for what leaves the small frame
    np.testing.assert_allclose(light, kept * wanted, atol=0.004 * wanted.max())
    assert 0 < out[20, 30, 1] < 0.9 * xyz[20, 30, 1]  # and all of it is spread
    assert out.min() > -1e-3 * out.max()


def test_each_corner_of_the_frame_has_its_own_kernel() -> None:
    """A narrow pupil in one corner of 2 x 2: there alone a lamp is wide; rows go down."""
    for y, x in ((0, 1), (1, 0)):
        pupils = [[PlainPupil(4) for _ in range(2)] for _ in range(2)]
        pupils[y][x] = PlainPupil(40)
        spectra = np.zeros((60, 80, 4))
        corners = [(r, c) for r in (0, 1) for c in (0, 1)]
        for r, c in corners:
            spectra[6 + 47 * r, 6 + 67 * c] = 1
        xyz = spectra @ colour.band_colors(4)
        out = waves.developed(Film(spectra, xyz), planned(pupils, 4)).xyz[:, :, 1]
        peaks = {(r, c): out[6 + 47 * r, 6 + 67 * c] for r, c in corners}
        assert min(peaks, key=lambda corner: peaks[corner]) == (y, x)
        assert peaks[y, x] < 0.5 * min(v for corner, v in peaks.items() if corner != (y, x))


@pytest.mark.parametrize(
    "change",
    [
        {"pitch_mm": 0},
        {"bands": 5},
        {"iris": {"blades": 1000, "rotation": 0, "curvature": 0, "mask_half": None}},
        {"pupils": [[{"f_number": float("nan")}]]},
        {"pupils": [[{}]]},
        {"pupils": []},
        {"pupils": 7},
    ],
)
def test_damaged_pupils_of_a_pass_are_refused(change: dict[str, Any]) -> None:
    one = session(lamps(), camera(), Diffraction(4), light_paths="off")
    one.draw(0, 1)
    facts = json.loads(json.dumps(one.metadata["pupils"])) | change
    with pytest.raises(InputError, match="damaged pupil data"):
        waves.developed(one._film, facts)


def test_what_cannot_be_diffracted_is_said() -> None:
    with pytest.raises(UsageError, match="wanted a lens with an iris, got a pinhole"):
        session(lamps(), dg.Camera(lens="pinhole"))
    with pytest.raises(UsageError, match=r"bands: wanted .*3 \.\. 64"):
        Diffraction(2)
    with pytest.raises(UsageError, match="diffraction: wanted True, False"):
        session(lamps(), camera(), "yes")
