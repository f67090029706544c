"""Cryptomatte: names, hashes and shares of pixels, as compositing programs read them."""

from __future__ import annotations

import copy
import json
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.cli import main
from daguerre.frame.cryptomatte import Cryptomatte, hash_of
from daguerre.rendering import merging, passes
from daguerre.rendering.session import Session
from tests.plates.test_truth import DISTORTED, GLASS, POSE, RED, real, shifted, thin
from tests.support.scene import scenes

SIZE = (48, 32)
ALL = "object,material,asset"
#: Sum of coverages against alpha.
EXACT = 1e-6
BLUE = dg.Material(dg.Diffuse((0.1, 0.2, 0.8)), name='blau: \u00fc, "quoted"')
PASSING = dg.keys([(-0.02, shifted(-0.9, 0.5, -1)), (0.02, shifted(0.2, 0.5, -1))])
CAMERAS = {
    "exact": real(f_stop=2.0, focus_distance=1.2),
    "thin, moving": thin(f_stop=1.4, focus_distance=7.0, shutter_time=0.02),
    "distorted": dg.Camera(POSE, projection=dg.Projection("opencv", SIZE, (46.0, 46.0),
                           parameters=DISTORTED.parameters)),
}  # fmt: skip


def murmur3(data: bytes) -> int:
    """MurmurHash3 x86 32, seed 0, by its published definition (Appleby, public domain)."""
    mask, h = 0xFFFFFFFF, 0

    def mixed(k: int) -> int:
        k = k * 0xCC9E2D51 & mask
        return ((k << 15 | k >> 17) & mask) * 0x1B873593 & mask

    whole = len(data) // 4 * 4
    for (k,) in struct.iter_unpack("<I", data[:whole]):
        h ^= mixed(k)
        h = ((h << 13 | h >> 19) & mask) * 5 + 0xE6546B64 & mask
    if data[whole:]:
        h ^= mixed(int.from_bytes(data[whole:], "little"))
    h ^= len(data)
    for shift, times in ((16, 0x85EBCA6B), (13, 0xC2B2AE35), (16, 1)):
        h = (h ^ h >> shift) * times & mask
    return h


def scene(*, names: tuple[str, ...] = ("front", "back")) -> dg.Scene:
    """A ball before another one, a third that moves, and a lamp, over nothing."""
    made = dg.Scene()
    points, triangles, normals = scenes.sphere(16, 0.5)
    ball = made.add_mesh(points, triangles, normals, name="ball")
    red = made.add_material(dg.Material(RED, name="red"))
    blue = made.add_material(BLUE)
    places = {
        "front": (red, shifted(0, 0.5, -0.5)),
        "back": (blue, shifted(0.4, 0.6, -2)),
        "passing": (red, PASSING),
        "": (blue, shifted(1.4, 0.5, -1)),
    }
    for name in names:
        material, place = places[name]
        made.add_instance(ball, material, place, name=name)
    made.set_environment(color=(0.4, 0.5, 0.7))
    return made


def drawn(made: dg.Scene, camera: dg.Camera, **options: Any) -> dg.Frame:
    return dg.render(
        made, camera,
        **{"resolution": SIZE, "spp": 32, "light_paths": "off", "cryptomatte": ALL, **options},
    )  # fmt: skip


def total(matte: Cryptomatte) -> NDArray[np.float64]:
    return matte.coverage.astype(np.float64).sum(axis=2)


@pytest.mark.parametrize("name", CAMERAS)
def test_coverages_sum_to_alpha(name: str) -> None:
    frame = drawn(scene(names=("front", "back", "passing", "")), CAMERAS[name])
    partly = (frame.alpha > 0.01) & (frame.alpha < 0.99)
    assert partly.sum() > 100
    for matte in frame.cryptomatte.values():
        np.testing.assert_allclose(total(matte), frame.alpha, atol=EXACT)
        assert (np.diff(matte.coverage, axis=2) <= 0).all()
        assert ((matte.ids == 0) == (matte.coverage == 0)).all()
    both = frame.cryptomatte["object"].coverage[:, :, 1] > 0.01
    assert both.sum() > 20  # blur mixes them


@pytest.mark.parametrize("name", CAMERAS)
def test_a_matte_is_the_alpha_of_its_object(name: str) -> None:
    """Samples of the camera are the same whatever the scene holds, where one wavelength leads."""
    camera = CAMERAS[name]
    both, front = (
        drawn(scene(names=names), camera, dispersion="end_secondary")
        for names in (("front", "back"), ("front",))
    )
    mattes = both.cryptomatte["object"]
    np.testing.assert_allclose(mattes.mask("front"), front.alpha, atol=EXACT)
    np.testing.assert_allclose(mattes.mask("back"), both.alpha - front.alpha, atol=2 * EXACT)
    np.testing.assert_allclose(mattes.mask("front", "back"), both.alpha, atol=EXACT)
    with pytest.raises(dg.UsageError, match=r"no object named 'frnt' \(did you mean 'front'\?\)"):
        mattes.mask("frnt")


def test_hashes_are_those_of_the_definition() -> None:
    names = ["", "a", "front", "bunny", "default", "blau: \u00fc", "x" * 99, *map(str, range(3000))]
    changed = 0
    for name in names:
        plain, used = murmur3(name.encode()), hash_of(name)
        exponent = plain >> 23 & 255
        assert used == (plain ^ 1 << 23 if exponent in (0, 255) else plain)
        assert np.isfinite(np.uint32(used).view(np.float32))
        changed += used != plain
    assert changed > 5


def test_hashes_as_floats_are_those_that_are_published() -> None:
    """Psyop, Cryptomatte 1.4.0, tests of the Nuke plugin."""
    published = {
        "hello": 6.0705627102400005616e-17,
        "cube": -4.08461912519e15,
        "sphere": 2.79018604383e15,
        "plane": 3.66557617593e-11,
        "\u0440\u0430\u0432\u043d\u0438\u043d\u0430": -1.3192631212399999468e-25,
        "m\u00e4dchen": 6.2361298211599995797e25,
    }
    for name, value in published.items():
        assert np.uint32(hash_of(name)).view(np.float32) == np.float32(value), name


def read_by_the_specification(path: Path) -> dict[str, dict[str, NDArray[np.float32]]]:
    """Mattes of a file, read by OpenImageIO and the specification, and nothing of ours."""
    source = oiio.ImageInput.open(str(path))
    spec = source.spec()
    pixels = source.read_image(0, 0, 0, spec.nchannels, oiio.FLOAT)
    plane = {name: pixels[:, :, i] for i, name in enumerate(spec.channelnames)}
    told = {a.name: a.value for a in spec.extra_attribs if a.name.startswith("cryptomatte/")}
    found: dict[str, dict[str, NDArray[np.float32]]] = {}
    for key in {name.split("/")[1] for name in told}:
        layer = told[f"cryptomatte/{key}/name"]
        assert key == f"{murmur3(layer.encode()):08x}"[:7]
        assert told[f"cryptomatte/{key}/hash"] == "MurmurHash3_32"
        assert told[f"cryptomatte/{key}/conversion"] == "uint32_to_float32"
        masks = {}
        for name, text in json.loads(told[f"cryptomatte/{key}/manifest"]).items():
            value = np.uint32(int(text, 16)).view(np.float32)
            layers = sorted({c[:-2] for c in plane if c.startswith(layer)})
            masks[name] = sum(
                np.where(plane[f"{one}.{i}"] == value, plane[f"{one}.{c}"], 0)
                for one in layers
                for i, c in ("RG", "BA")
            )
        found[layer] = masks
    source.close()
    return found


def test_another_reader_finds_the_mattes(tmp_path: Path) -> None:
    frame = drawn(scene(names=("front", "back", "passing", "")), CAMERAS["exact"])
    frame.save(tmp_path / "a.exr")
    found = read_by_the_specification(tmp_path / "a.exr")
    assert set(found) == {"CryptoObject", "CryptoMaterial", "CryptoAsset"}
    assert set(found["CryptoObject"]) == {"front", "back", "passing", "ball"}
    assert set(found["CryptoMaterial"]) == {"red", BLUE.name}
    for layer, kind in (("CryptoObject", "object"), ("CryptoMaterial", "material")):
        for name, mask in found[layer].items():
            np.testing.assert_array_equal(mask, frame.cryptomatte[kind].mask(name))
        np.testing.assert_allclose(sum(found[layer].values()), frame.alpha, atol=EXACT)
    again = dg.load_frame(tmp_path / "a.exr")
    assert again.cryptomatte == frame.cryptomatte
    assert not any("Crypto" in name for name in again.aovs)


def test_assets_are_the_topmost_nodes() -> None:
    made = scene(names=("front", "back", "passing"))
    made.group_instances("left", [0, 2])
    made.group_instances("everything", [0, 2])
    frame = drawn(made, CAMERAS["exact"])
    assets, objects = frame.cryptomatte["asset"], frame.cryptomatte["object"]
    assert set(assets.manifest) == {"left", "back"}
    np.testing.assert_allclose(assets.mask("left"), objects.mask("front", "passing"), atol=EXACT)


def test_lamps_that_the_lens_sees_and_glass_that_shows_others() -> None:
    made = scene(names=("back",))
    points, triangles, normals = scenes.sphere(16, 0.4)
    glass = made.add_mesh(points, triangles, normals)
    made.add_instance(glass, GLASS, shifted(0.2, 0.6, -0.4), name="glass")
    made.add_light(dg.SphereLight(radius=0.2, name="lamp"), shifted(-0.9, 1.0, -1))
    made.add_light(dg.PointLight(), shifted(0, 3, 0))
    camera = CAMERAS["exact"]
    frame = drawn(made, camera)
    mattes = frame.cryptomatte["object"]
    assert mattes.mask("lamp").max() > 0.9
    covering = mattes.mask("glass") > 0.999
    assert covering.sum() > 20
    assert (mattes.mask("back")[covering] < 1e-3).all()  # its picture in the glass is the glass's
    np.testing.assert_allclose(total(mattes), frame.alpha, atol=EXACT)
    holes = drawn(made, camera, see_through=True)
    seen = holes.cryptomatte["object"]
    assert seen.mask("back")[covering].max() > 0.5
    np.testing.assert_allclose(total(seen), holes.alpha, atol=EXACT)


def test_catchers_have_no_matte_and_hide_what_is_behind() -> None:
    made = scene(names=("front", "back"))
    made.set_catcher("front")
    frame = drawn(made, CAMERAS["exact"])
    mattes = frame.cryptomatte["object"]
    assert mattes.mask("front").max() == 0
    np.testing.assert_allclose(mattes.mask("back"), frame.alpha, atol=EXACT)


def test_bits_are_those_of_any_threads_ranges_and_merges(tmp_path: Path) -> None:
    made, camera = scene(names=("front", "back", "passing", "")), real(focus_distance=1.2)
    options = {"resolution": SIZE, "cryptomatte": ALL, "light_paths": "off"}
    whole = dg.render(made, camera, spp=12, threads=1, **options)
    files = []
    for begin, end in ((7, 12), (0, 7)):
        session = Session(made, camera, threads=2, **options)
        session.draw(begin, end)
        files.append(tmp_path / f"{begin}.exr")
        passes.write_pass(files[-1], session.frame(), passes.pass_of(session))
    merged, total_pass = merging.merge(files)
    assert merged.cryptomatte == whole.cryptomatte
    passes.write_pass(tmp_path / "sum.exr", merged, total_pass)
    assert merging.merge([tmp_path / "sum.exr"])[0].cryptomatte == whole.cryptomatte
    plain = dg.render(made, camera, spp=12, **{**options, "cryptomatte": ()})
    assert np.array_equal(plain.rgb, whole.rgb)
    assert np.array_equal(plain.alpha, whole.alpha)


def test_a_damaged_list_is_refused(tmp_path: Path) -> None:
    made, camera = scene(), thin()
    session = Session(made, camera, resolution=SIZE, cryptomatte="object", light_paths="off")
    session.draw(0, 2)
    state = {name: words.copy() for name, words in session.state().items()}
    state["objects"][3, 0, 0] = SIZE[0]
    with pytest.raises(dg.DaguerreError, match="objects: wanted columns and objects that increase"):
        session.set_state(state, [(0, 2)])
    one, frame = passes.pass_of(session), session.frame()
    one = replace(one, metadata=copy.deepcopy(one.metadata))
    one.metadata["mattes"]["layers"]["object"]["of"] = [5]
    passes.write_pass(tmp_path / "a.exr", frame, one)
    with pytest.raises(dg.InputError, match="damaged pass file: daguerre:metadata: mattes is"):
        merging.merge([tmp_path / "a.exr"])


def test_too_many_names_for_the_ranks_are_told(tmp_path: Path) -> None:
    made = dg.Scene()
    points, triangles = scenes.quad(1.0, -2.0)
    mesh = made.add_mesh(points * (0.02, 0.02, 1), triangles)
    for i in range(24):
        x, y = i % 6, i // 6
        made.add_instance(mesh, RED, shifted(0.05 * x - 0.12, 0.05 * y - 0.08), name=f"tile {i}")
    camera = dg.Camera(f_stop=1.4, focal_length=50, focus_distance=0.5)
    frame = drawn(made, camera, resolution=(24, 16), cryptomatte="object")
    matte, cut = frame.cryptomatte["object"], frame.metadata["mattes_cut"]
    lacks = frame.alpha - total(matte)
    assert cut["pixels"] > 4
    assert cut["share"] == pytest.approx(lacks.max(), abs=EXACT)
    assert lacks.max() > 0.01
    more = drawn(made, camera, resolution=(24, 16), cryptomatte="object", cryptomatte_ranks=24)
    np.testing.assert_allclose(total(more.cryptomatte["object"]), more.alpha, atol=EXACT)
    np.testing.assert_array_equal(more.cryptomatte["object"].coverage[:, :, :6], matte.coverage)


def test_overscan_and_crops_have_the_mattes_of_the_picture(tmp_path: Path) -> None:
    made, camera = scene(), CAMERAS["distorted"]
    plain = drawn(made, camera)
    around = drawn(made, camera, overscan=8)
    assert around.cryptomatte["object"].ids.shape[:2] == (SIZE[1] + 16, SIZE[0] + 16)
    assert around.without_overscan().cryptomatte == plain.cryptomatte
    for i, crop in enumerate(((0, 0, 20, 32), (20, 0, 48, 32))):
        drawn(made, camera, crop=crop).save(tmp_path / f"{i}.exr")
    whole = tmp_path / "whole.exr"
    files = [str(tmp_path / f"{i}.exr") for i in range(2)]
    assert main(["merge", *files, "-o", str(whole), "-q"]) == 0
    assert dg.load_frame(whole).cryptomatte == plain.cryptomatte


def test_what_is_no_layer_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(dg.UsageError, match="cryptomatte: wanted some of object, material, asset"):
        dg.RenderSettings.of(cryptomatte="objects")
    with pytest.raises(dg.UsageError, match=r"cryptomatte_ranks: wanted .*1 .*64"):
        dg.RenderSettings.of(cryptomatte_ranks=0)
    assert dg.RenderSettings.of(cryptomatte=["asset", "object"]).film.cryptomatte == (
        "object",
        "asset",
    )
    assert main(["render", "none.glb", "--cryptomatte", "things", "-o", "a.exr"]) == 2
    assert "--cryptomatte: wanted some of object" in capsys.readouterr().err
