"""Facts of the chosen lens on the camera's panels, and warnings of what does not fit it."""

import json
from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest

import daguerre as dg
from daguerre.lenses.image_circle import stated_half_image
from daguerre.plots.lens_section import section
from daguerre.plots.raster import painted
from tests.support.blender import blender_extension
from tests.support.blender.blender_layout import drawn

bpy = pytest.importorskip("bpy", reason="no bpy in this Python")

PRIME, ZOOM = "double-gauss-50mm-f2", "sony-fe-70-200mm-f2.8"


@pytest.fixture
def extension():
    with blender_extension.registered() as found:
        yield found


def group_of(**values):
    group = bpy.data.cameras[0].daguerre
    for name, value in values.items():
        setattr(group, name, value)
    return group


def shown(extension, panel="lens"):
    context = SimpleNamespace(scene=bpy.context.scene, camera=bpy.data.cameras[0])
    return drawn(getattr(extension.panels, f"DAGUERRE_PT_{panel}"), context)


def warnings(extension, reach_mm=21.6):
    return extension.lens_facts.warnings(bpy.data.cameras[0].daguerre, reach_mm)


def test_a_lens_of_the_library_is_drawn_with_its_facts(extension):
    group_of(lens="asahi-super-takumar-50mm-f1.4")
    layout = shown(extension)
    kinds = [kind for kind, _ in layout.drawn]
    assert kinds.index("operator") < kinds.index("icon") < kinds.index("label")
    facts = dict(zip(layout.texts[::2], layout.texts[1::2], strict=True))
    order = dg.lenses.load("asahi-super-takumar-50mm-f1.4").first_order()
    assert facts == {
        "Year": "1969", "Widest stop": f"f/{order.f_number:.3g}",
        "Focal length": f"{order.efl:.4g} mm", "Image circle": "43.3 mm",
    }  # fmt: skip


def test_the_picture_is_the_section_and_is_painted_once(extension, monkeypatch):
    group, facts_of, room = group_of(lens=PRIME), extension.lens_facts, extension.lens_picture
    room.shown(group, facts_of.of(group))
    (preview,) = room._kept.values()
    lens = dg.lenses.load(PRIME)
    wanted = painted(section(lens, half_image=stated_half_image(lens, lens.first_order())))
    width, height = preview.image_size
    assert (height, width) == wanted.shape[:2]
    found = np.array(preview.image_pixels_float[:], np.float32).reshape(height, width, 4)[::-1]
    np.testing.assert_allclose(found[..., :3], wanted, atol=0.5 / 255 + 1e-6)
    assert (found[..., 3] == 1).all()
    monkeypatch.setattr(room, "painted", lambda drawing: pytest.fail("painted twice"))
    room.shown(group, facts_of.of(group))


def test_few_pictures_are_kept(extension, monkeypatch):
    monkeypatch.setattr(extension.lens_picture, "MOST", 2)
    for lens in (PRIME, ZOOM, "tessar-50mm-f2.8"):
        group = group_of(lens=lens)
        extension.lens_picture.shown(group, extension.lens_facts.of(group))
    assert len(extension.lens_picture._kept) == 1


@pytest.mark.parametrize("lens", ["blender", "thin", "pinhole"])
def test_an_ideal_lens_has_no_picture_and_no_warnings(extension, lens):
    group_of(lens=lens, f_stop=0.5, zoom=7)
    assert not {"icon", "label"} & {kind for kind, _ in shown(extension).drawn}
    assert not warnings(extension, 1e3)


def test_a_bad_file_is_one_line_and_a_mended_one_a_lens(extension, tmp_path):
    group_of(lens="file", lens_file="")
    assert shown(extension).texts == ["Daguerre: lens file: wanted one, got none"]
    path = tmp_path / "lens.json"
    group_of(lens_file=str(path))
    assert "Daguerre: " in shown(extension).texts[0]
    for content in (b"", b"\0\xff" * 99, b'{"format": "daguerre-lens/0.1"}', b"[" * 10_000):
        path.write_bytes(content)
        (text,) = shown(extension).texts
        assert text.startswith(f"Daguerre: {path}"), text
        assert "\n" not in text
        path.unlink()  # so that the next one has another time
        assert len(shown(extension).texts) == 1
    data = dg.lenses.load(PRIME).data
    path.write_text(json.dumps(data))
    layout = shown(extension)
    assert "Year" not in layout.texts
    assert "f/2" in layout.texts
    assert "icon" in [kind for kind, _ in layout.drawn]


def test_a_drawing_that_fails_is_one_line(extension, monkeypatch):
    def broken(lens, half_image=None):
        raise dg.InputError("no rays")

    monkeypatch.setattr(extension.lens_picture, "section", broken)
    group_of(lens="tessar-50mm-f2.8")
    assert shown(extension).texts[0] == "Daguerre: no rays"


def test_a_stop_that_the_lens_lacks_is_told_where_rendering_fails(extension):
    lens, scene = dg.lenses.load(PRIME), blender_extension.scene()
    widest = lens.first_order().f_number
    for name, most in (("f_stop", widest), ("t_stop", lens.t_stop())):
        for share, is_wrong in ((0.9, True), (1.0, False)):
            group_of(lens=PRIME, use_t_stop=name == "t_stop", **{name: share * most})
            assert bool(warnings(extension).get(name)) == is_wrong
            camera = blender_extension.camera(lens=PRIME, **{name: share * most})
            outcome = pytest.raises(dg.InputError) if is_wrong else nullcontext()
            with outcome:
                dg.render(scene, camera, resolution=(4, 4), spp=1)
    group_of(use_t_stop=False, f_stop=1.2)
    assert warnings(extension)["f_stop"] == f"Wider than the lens opens: f/{widest:.3g}"
    layout = shown(extension, "iris")
    assert layout.drawn[layout.drawn.index(("prop", "f_stop")) + 1][0] == "label"


def test_a_zoom_outside_of_its_range_is_told(extension):
    short, long = dg.lenses.load(ZOOM).zoom_range_mm
    for zoom, is_wrong in ((0, False), (short, False), (long, False), (0.9 * short, True)):
        group_of(lens=ZOOM, zoom=zoom)
        assert bool(warnings(extension).get("zoom")) == is_wrong
    assert f"Zoom: wanted {short:.4g} to {long:.4g} mm" in warnings(extension)["zoom"]
    assert warnings(extension)["zoom"] in shown(extension).texts
    group_of(lens=PRIME, zoom=85)
    assert "zoom" in warnings(extension)
    group_of(zoom=long, lens=ZOOM, f_stop=2.8)
    assert extension.lens_facts.of(group_of()).lens.zoom_mm == pytest.approx(long, rel=1e-4)


def test_a_film_beyond_the_image_circle_is_told(extension):
    data = bpy.data.cameras[0]
    group_of(lens=PRIME)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 300, 200
    assert "sensor" not in warnings(
        extension, extension.translation.film_reach_mm(data, scene.render)
    )
    for change in ({"sensor_width": 53.7}, {"sensor_width": 36, "shift_x": 0.2}):
        for name, value in change.items():
            setattr(data, name, value)
        reach = extension.translation.film_reach_mm(data, scene.render)
        assert "sensor" in warnings(extension, reach)
    assert reach == pytest.approx(np.hypot(18 + 7.2, 12))
    (text,) = shown(extension, "body").texts
    assert text == "Needs an image circle of 55.8 mm, the lens has 43.3: dark corners"
    data.shift_x, sensor = 0, "nikon-d5100"
    group_of(sensor=sensor)
    wanted = np.hypot(*dg.sensors.load(sensor).size) / 2
    assert extension.translation.film_reach_mm(data, scene.render) == pytest.approx(wanted)
    group_of(sensor="blender", lens_model="thin")  # has no image circle
    assert not warnings(extension, 1e3)


def test_the_search_shows_year_stop_and_image_circle(extension):
    items = {key: name for key, name, _ in extension.choices.SEARCHED}
    wanted = "Super-Takumar 50 mm f/1.4 (1969), f/1.4, circle 43.3 mm"
    words = "prime, normal, fast, bokeh, fullframe"  # by which the search finds it, too
    assert items["asahi-super-takumar-50mm-f1.4"] == f"{wanted}, {words}"
    assert [key for key, *_ in extension.choices.LENSES] == list(items)
