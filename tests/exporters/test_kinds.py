"""Every kind of material and medium on its way out: syntax, values, notes; Mitsuba draws them."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
import daguerre.exporters.mitsuba.writer as mitsuba_writer
import daguerre.exporters.pbrt.writer as pbrt_writer
from daguerre.exporters.mitsuba.rough_plastic import Loss
from daguerre.exporters.record import ExportedView, Outgoing
from daguerre.scene.media import DensityGrid, Medium
from daguerre.scene.spectrum import Spectrum
from tests.support.formats import mitsuba_pictures, pbrt_syntax
from tests.support.scene import outgoing_scenes

GOLD = Spectrum((450.0, 550.0, 650.0), (1.5, 0.4, 0.15))
GOLD_K = Spectrum((450.0, 550.0, 650.0), (1.9, 2.5, 3.6))
SMOKE = Medium((0.1, 0.2, 0.3), (1.0, 0.8, 0.6), ((0.5, 3.0), (-0.3, 1.0)))


def kinds(scene: dg.Scene) -> dict[str, dg.Material]:
    """Materials by name, those of a mixture last."""
    texture = dg.TextureSlot(scene.add_texture(outgoing_scenes.checks(), srgb=True))
    grey = dg.TextureSlot(scene.add_texture(np.full((2, 2, 1), 128, np.uint8)))
    return {
        "diffuse": dg.Material(dg.Diffuse((0.5, 0.6, 0.7), texture)),
        "through": dg.Material(dg.Diffuse((0.3, 0.3, 0.3), transmittance=(0.4, 0.3, 0.2))),
        "spectral": dg.Material(dg.Diffuse(Spectrum((400.0, 700.0), (0.2, 0.8)))),
        "gold": dg.Material(dg.Conductor(alpha=0.2, eta=GOLD, k=GOLD_K)),
        "brushed": dg.Material(
            dg.Conductor((0.9, 0.8, 0.7), 0.3, alpha_v=0.1, distribution="beckmann")
        ),
        "textured": dg.Material(dg.Conductor(alpha=0.4, alpha_texture=grey)),
        "plastic": dg.Material(dg.Coated(dg.Diffuse((0.3, 0.5, 0.7)), alpha=0.2)),
        "linear": dg.Material(dg.Coated(dg.Diffuse((0.3, 0.5, 0.7)), nonlinear=False)),
        "varnish": dg.Material(dg.Coated(dg.Conductor(alpha=0.2, eta=GOLD, k=GOLD_K))),
        "pane": dg.Material(dg.Dielectric(1.5, thin=True, reflection_tint=(1, 0.9, 0.8))),
        "flint": dg.Material(dg.Dielectric(Spectrum((400.0, 700.0), (1.66, 1.6)))),
        "frosted": dg.Material(dg.Dielectric(alpha=0.2, energy_compensation=True)),
        "smoke": dg.Material(dg.Boundary(), interior=SMOKE),
        "masked": dg.Material(dg.Diffuse(), opacity=0.7, opacity_texture=grey),
        "bumpy": dg.Material(dg.Diffuse(), normal_texture=texture, normal_scale=0.1),
        "front": dg.Material(dg.Diffuse(), two_sided=False),
        "lamp": dg.Material(dg.Diffuse(), emission=(2, 3, 4), emission_texture=texture),
        "mixed": dg.Material(dg.Mix(0, 3, 0.3, grey)),
    }


def gallery() -> dg.Scene:
    """A ball of each material, in fog."""
    scene = dg.Scene()
    ball = outgoing_scenes.ball(scene, 12)
    for i, material in enumerate(kinds(scene).values()):
        place = outgoing_scenes.placed(i % 6 - 2.5, 1 - i // 6, 0, 0.4)
        scene.add_instance(ball, scene.add_material(material), place)
    scene.set_environment(color=(1, 1, 1))
    scene.set_fog(Medium((0.001, 0.001, 0.001), (0.002, 0.002, 0.002)))
    return scene


def outgoing(scene: dg.Scene) -> Outgoing:
    """The scene with a camera that sees all of it."""
    view = ExportedView(dg.look_at((0, 0, 12), (0, 0, 0)), (36.0, 24.0), film_distance_mm=60.0)
    return Outgoing(scene, view, (48, 32), 16, 16)


def test_pbrt_has_each_of_them(tmp_path: Path) -> None:
    made = outgoing(gallery())
    file = tmp_path / "a.pbrt"
    pbrt_writer.write(file, made)
    found = pbrt_syntax.read(file.read_text())
    materials = {
        one.words[0]: one for one in found if one.name == "MakeNamedMaterial"
    }  # by "material-" and index
    types = [materials[f"material-{i}"].text("type") for i in range(18)]
    assert types == [
        "diffuse", "diffusetransmission", "diffuse", "conductor", "conductor", "conductor",
        "coateddiffuse", "coateddiffuse", "coatedconductor", "thindielectric", "dielectric",
        "dielectric", "interface", "diffuse", "diffuse", "diffuse", "diffuse", "mix",
    ]  # fmt: skip
    eta = materials["material-3"].values("eta")
    at_550 = np.interp(550, eta[::2], eta[1::2])
    assert at_550 == pytest.approx(0.4)
    assert eta[0] <= 360 <= 830 <= eta[-2]  # pbrt has 0 beyond the ends
    saturated = materials["material-6"].values("reflectance")
    assert saturated == [0.3, 0.5, 0.7]
    assert materials["material-7"].values("reflectance")[0] > 0.3
    assert materials["material-4"].values("vroughness") == [0.1]
    (smoke,) = [one for one in found if one.name == "MakeNamedMedium" and one.words[0] != "fog"]
    assert smoke.values("sigma_s") == [1.0, 0.8, 0.6]
    assert smoke.values("g") == [pytest.approx((0.5 * 3 - 0.3) / 4)]
    notes = " ".join(made.notes.sentences())
    for words in (
        "several lobes",
        "energy compensation",
        "colour of glass",
        "single-sided surface is visible",
        "distribution of facets",
    ):
        assert words in notes


def test_mitsuba_has_each_of_them(tmp_path: Path) -> None:
    made = outgoing(gallery())
    file = tmp_path / "a.xml"
    mitsuba_writer.write(file, made)
    root = ElementTree.fromstring(file.read_text())
    assert root.find("integrator").get("type") == "volpath"  # type: ignore[union-attr]
    names = {one.get("id"): one for one in root.iter("bsdf") if one.get("id")}
    assert len(names) == 18
    inner = [[one.get("type") for one in names[f"material-{i}"].iter("bsdf")] for i in range(18)]
    assert inner[3] == ["twosided", "roughconductor"]
    assert inner[9] == ["thindielectric"]
    spread = [
        one.get("value")
        for i in (3, 4)
        for one in names[f"material-{i}"].iter("string")
        if one.get("name") == "distribution"
    ]
    assert spread == ["ggx", "beckmann"]
    assert inner[12] == ["null"]
    assert inner[13] == ["mask", "twosided", "diffuse"]
    assert inner[15] == ["diffuse"]
    assert inner[17] == ["twosided", "blendbsdf", "diffuse", "roughconductor"]
    fog = [one for one in root.iter("ref") if one.get("id") == "fog"]
    assert {one.get("name") for one in fog} == {"medium", "exterior"}
    notes = " ".join(made.notes.sentences())
    for words in ("coat of a metal", "diffuse transmission", "dispersion of glass"):
        assert words in notes


def test_rough_coats_go_to_mitsuba_with_bases_that_make_up_for_its_loss(tmp_path: Path) -> None:
    """One base is so bright that Mitsuba's own is above 1, which our reader counts as 1."""
    scene, made = dg.Scene(), []
    for nonlinear in (True, False):
        for alpha, shade, name in ((0.1, 0.6, "ggx"), (0.2, 0.9, "ggx"), (0.2, 0.3, "beckmann")):
            base, facets = dg.Diffuse((shade, 0.3, 0.0)), {"distribution": name}
            made.append(dg.Coated(base, alpha=alpha, nonlinear=nonlinear, **facets))
    for kind in made:
        scene.add_instance(outgoing_scenes.card(scene), kind)
    scene.add_camera("a", outgoing_scenes.camera())
    dg.export_scene(scene, tmp_path / "a.xml")
    again = dg.load(tmp_path / "a.xml")
    for kind, one in zip(made, (again.materials[each.material].kind for each in again.instances),
                         strict=True):  # fmt: skip
        assert isinstance(one, dg.Coated)
        loss = Loss(kind.ior, kind.alpha, kind.distribution, kind.nonlinear)
        wanted = np.minimum(loss.shade(np.asarray(kind.base.reflectance)), 1)
        assert one.base.reflectance == pytest.approx(wanted, abs=1e-6)
        assert one == replace(kind, base=one.base, energy_compensation=False)


def test_rougher_coats_are_blended_with_a_diffuse_surface(tmp_path: Path) -> None:
    """All of the coat and all of the base, in the parts of the blend together."""
    scene = dg.Scene()
    kind = dg.Coated(dg.Diffuse((0.6, 0.6, 0.6)), alpha=0.5, nonlinear=True)
    scene.add_instance(outgoing_scenes.card(scene), kind)
    scene.add_camera("a", outgoing_scenes.camera())
    notes = dg.export_scene(scene, tmp_path / "a.xml")
    assert any("blend of Mitsuba's roughplastic and diffuse" in note for note in notes)
    root = ElementTree.fromstring((tmp_path / "a.xml").read_text())
    values = {one.get("name"): one.get("value", "") for one in root.iter() if one.get("name")}
    weight = float(values["weight"])
    gloss = root.find(".//spectrum[@name='specular_reflectance']/rgb")
    assert gloss is not None
    assert float(gloss.get("value", "").split(",")[0]) * (1 - weight) == pytest.approx(1)
    loss = Loss(1.5, 0.5, "ggx", nonlinear=True)
    below, beside = (float(values[n].split(",")[0]) for n in ("diffuse_reflectance", "reflectance"))
    assert below == pytest.approx(float(loss.shade(np.asarray(0.6))))
    assert beside == pytest.approx(float(loss.bare(np.asarray(0.6))))


def test_a_grid_is_noted(tmp_path: Path) -> None:
    scene = gallery()
    scene.set_fog(Medium(scattering=(1, 1, 1), density=DensityGrid(np.ones((2, 2, 2)))))
    for write, suffix in ((pbrt_writer.write, "pbrt"), (mitsuba_writer.write, "xml")):
        made = outgoing(scene)
        write(tmp_path / f"a.{suffix}", made)
        assert any("density grid" in text for text in made.notes.sentences())


@pytest.mark.skipif(not mitsuba_pictures.installed(), reason="needs mitsuba, a test extra")
def test_mitsuba_draws_them(tmp_path: Path) -> None:
    file = tmp_path / "a.xml"
    scene = gallery()
    scene.set_fog(None)  # it has no end, so no light of the sky gets through
    mitsuba_writer.write(file, outgoing(scene))
    picture = mitsuba_pictures.draw(file)
    assert np.isfinite(picture).all()
    assert picture.mean() == pytest.approx(1, abs=0.3)  # a white world, little of which is dark
