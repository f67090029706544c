"""Loader of Mitsuba's files: parameters, includes, references, transforms, versions, accounts."""

from __future__ import annotations

import math
import time
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import daguerre as dg
from daguerre.importers.mitsuba.ledger import Entry
from daguerre.importers.mitsuba.parameters import Parameters
from daguerre.importers.mitsuba.reader import read_all
from daguerre.importers.mitsuba.upgrade import underscored

from .scene_files import RICH, loaded, written

BALL = '<shape type="sphere" id="ball">{}</shape>'


def _place(scene: dg.Scene) -> np.ndarray:
    (index,) = scene.nodes["ball"]
    return scene.instances[index].transform


def _turned(*steps: str) -> str:
    return BALL.format('<transform name="to_world">' + "".join(steps) + "</transform>")


def test_parameters_have_defaults_and_values_of_the_caller(tmp_path: Path) -> None:
    parts = (
        '<default name="r" value="2"/>',
        '<default name="radius" value="3"/>',
        BALL.format('<float name="radius" value="$radius"/>'),
    )
    assert _place(loaded(tmp_path, *parts))[0, 0] == 3  # not the value of $r, and "adius"
    assert _place(loaded(tmp_path, *parts, define=("radius=7",)))[0, 0] == 7
    assert _place(loaded(tmp_path, *parts, define={"radius": 8}))[0, 0] == 8
    with pytest.raises(dg.UsageError, match=r"define: size: the file has no parameter \$size"):
        loaded(tmp_path, *parts, define=("size=7",))
    with pytest.raises(dg.UsageError, match="wanted name=value"):
        loaded(tmp_path, *parts, define=("radius",))


def test_a_parameter_without_a_value_is_an_error_and_a_dollar_can_be_escaped(
    tmp_path: Path,
) -> None:
    with pytest.raises(
        dg.InputError, match=r"line 2, column \d+: <sampler .*the parameter \$spp has no value"
    ):
        loaded(tmp_path, '<sampler type="$spp"/>')
    scene = loaded(tmp_path, r'<shape type="sphere" id="\$5"/>')
    assert set(scene.nodes) == {"$5"}


def test_parameters_cannot_grow_without_end(tmp_path: Path) -> None:
    doubled = "".join(f'<default name="p{i + 1}" value="$p{i}$p{i}"/>' for i in range(1, 60))
    with pytest.raises(dg.InputError, match="too long: the limit is 1048576 characters"):
        loaded(tmp_path, '<default name="p1" value="xxxxxxxxxx"/>', doubled)


def test_files_include_files_of_their_folder(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    written(tmp_path / "parts", '<include filename="inner.xml"/>', name="outer.xml")
    ball = BALL.format('<float name="radius" value="$size"/>')
    written(tmp_path / "parts", ball, name="inner.xml")
    bsdf = tmp_path / "parts" / "red.xml"
    bsdf.write_text('<bsdf type="diffuse" version="3.0.0" id="red"/>')
    scene = loaded(
        tmp_path,
        '<default name="size" value="4"/>',
        '<include filename="parts/outer.xml"/>',
        '<include filename="parts/red.xml"/>',
        '<shape type="cube" id="box"><ref id="red"/></shape>',
    )
    assert _place(scene)[0, 0] == 4
    assert [material.name for material in scene.materials] == ["", "red"]


def test_files_that_include_themselves_are_an_error(tmp_path: Path) -> None:
    written(tmp_path, '<include filename="b.xml"/>', name="a.xml")
    written(tmp_path, '<include filename="a.xml"/>', name="b.xml")
    with pytest.raises(dg.InputError, match="too many nested includes: the limit is 15"):
        dg.load(tmp_path / "a.xml")


def test_files_outside_of_the_folder_are_refused_unless_allowed(tmp_path: Path) -> None:
    (tmp_path / "common").mkdir()
    written(tmp_path / "common", BALL.format(""), name="ball.xml")
    inner = tmp_path / "scenes"
    inner.mkdir()
    for parts in (
        ('<path value="../common"/>', '<include filename="ball.xml"/>'),
        ('<include filename="../common/ball.xml"/>',),
        (f'<include filename="{tmp_path}/common/ball.xml"/>',),
    ):
        with pytest.raises(dg.InputError, match=r"line 2, column \d+: .*leaves the scene's folder"):
            loaded(inner, *parts)
        assert "ball" in loaded(inner, *parts, allow_dirs=(tmp_path / "common",)).nodes


def test_references_and_aliases(tmp_path: Path) -> None:
    material = '<bsdf type="diffuse" id="m"><rgb name="reflectance" value="0.1 0.2 0.3"/></bsdf>'
    alias = '<alias id="m" as="n"/>'
    scene = loaded(tmp_path, BALL.format('<ref id="n"/>'), material, alias)
    assert scene.materials[0].kind == dg.Diffuse((0.1, 0.2, 0.3))
    for parts, wrong in {
        (
            BALL.format('<ref id="n"/>'),
            material,
        ): r"line 2, column \d+: <ref id='n'>: no object has the id",
        (material, material): r"line 3, column \d+: .*the id 'm' appears twice",
        (alias, material): r"line 2, column \d+: <alias id='m'>: no object has the id",
        ('<bsdf type="twosided" id="a"><ref id="a"/></bsdf>',): "references form a cycle",
    }.items():
        with pytest.raises(dg.InputError, match=wrong):
            loaded(tmp_path, *parts)


def test_references_cannot_be_too_deep_or_explode(tmp_path: Path) -> None:
    chain = [f'<bsdf type="twosided" id="m{i}"><ref id="m{i + 1}"/></bsdf>' for i in range(70)]
    end = '<bsdf type="diffuse" id="m{}"/>'
    with pytest.raises(dg.InputError, match="nested too deeply: the limit is 64 objects"):
        loaded(tmp_path, *chain, end.format(70))
    twice = [
        f'<bsdf type="blendbsdf" id="m{i}"><ref id="m{i + 1}"/><ref id="m{i + 1}"/></bsdf>'
        for i in range(50)
    ]
    scene = loaded(tmp_path, *twice, end.format(50), BALL.format('<ref id="m0"/>'))
    assert len(scene.materials) <= 51


def test_transforms_act_one_after_the_other(tmp_path: Path) -> None:
    place = _place(
        loaded(
            tmp_path,
            _turned(
                '<translate x="1"/>',
                '<scale value="2"/>',
                '<rotate z="1" angle="90"/>',
                '<matrix value="1 0 0 5  0 1 0 0  0 0 1 0  0 0 0 1"/>',
            ),
        )
    )
    assert np.allclose(place @ (0, 0, 0, 1), (5, 2, 0, 1))
    assert np.allclose(place @ (1, 0, 0, 1), (5, 4, 0, 1))
    turned = _place(loaded(tmp_path, _turned('<rotate value="1, 1, 1" angle="120"/>')))
    assert np.allclose(turned @ (1, 0, 0, 1), (0, 1, 0, 1))
    small = _place(loaded(tmp_path, _turned('<matrix value="0 0 2 0 2 0 2 0 0"/>')))
    assert np.allclose(small @ (1, 0, 0, 1), (0, 0, 2, 1))


def test_look_at_has_the_target_along_z_and_the_left_along_x(tmp_path: Path) -> None:
    look = '<lookat origin="1,2,3" target="1,2,13" up="0,1,0"/>'
    place = _place(loaded(tmp_path, _turned(look)))
    assert np.allclose(place[:3, 3], (1, 2, 3))
    assert np.allclose(place[:3, :3], np.eye(3))
    free = _place(loaded(tmp_path, _turned('<lookat origin="0,0,0" target="1,2,2"/>')))
    assert np.allclose(free[:3, 2], np.array((1, 2, 2)) / 3)
    assert np.allclose(free[:3, :3].T @ free[:3, :3], np.eye(3))
    assert math.isclose(np.linalg.det(free[:3, :3]), 1)


def test_old_names(tmp_path: Path) -> None:
    assert underscored("toWorld") == "to_world"
    assert underscored("intIOR") == "int_ior"
    assert underscored("filename") == "filename"
    old = (
        BALL.format(
            '<transform name="toWorld"><translate x="2"/></transform>'
            '<bsdf type="diffuse"><srgb name="diffuseReflectance" value="#ff8000"/></bsdf>'
        ),
    )
    scene = loaded(tmp_path, *old, version="0.6.0")
    assert _place(scene)[0, 3] == 2
    kind = scene.materials[0].kind
    assert isinstance(kind, dg.Diffuse)
    assert kind.reflectance == pytest.approx((1, 0.2158605, 0), abs=1e-6)
    new = loaded(tmp_path, *old, version="2.0.0")
    assert _place(new)[0, 3] == 0
    assert any("'toWorld' is not supported" in note for note in new.warnings)


@pytest.mark.parametrize(
    ("part", "wrong"),
    [
        (
            '<float name="x" value="1e"/>',
            r"line 2, column \d+: <float name='x'>: wanted a number, got '1e'",
        ),
        ('<float name="x" value="1_000"/>', "wanted a number"),
        ('<float name="x" value="nan"/>', "wanted a number"),
        ('<float name="x" value="1 2"/>', "wanted 1 numbers, got 2"),
        ('<float name="x"/>', "the attribute 'value' is missing"),
        ('<float name="x" value="1" unit="m"/>', "wanted attributes name, value, got 'unit'"),
        ('<integer name="x" value="1.5"/>', "wanted a whole number, got '1.5'"),
        ('<boolean name="x" value="yes"/>', "wanted true or false"),
        ('<rgb name="x" value="1 2"/>', "wanted 1 or 3 numbers, got 2"),
        ('<vector name="x" x="1" value="1"/>', "set either value or x, y and z"),
        ('<spectrum name="x" value="1" filename="a"/>', "got both or none"),
        ('<bogus name="x"/>', "not an element of Mitsuba's scene format"),
        ('<scale value="2"/>', "not an element of Mitsuba's scene format"),
        ('<bsdf id="a"/>', "the attribute 'type' is missing"),
        (
            '<float name="x" value="1"><float name="y" value="1"/></float>',
            "no element is allowed inside",
        ),
        (
            '<string name="x" value="a"/><string name="x" value="b"/>',
            "the property 'x' appears twice",
        ),
        (_turned('<rotate x="1"/>'), "the attribute 'angle' is missing"),
        (_turned('<rotate angle="3"/>'), "the axis must not have zero length"),
        (_turned('<matrix value="1 2 3"/>'), "wanted 9 or 16 numbers, got 3"),
        (
            _turned('<lookat origin="0 0 0" target="0 0 0"/>'),
            "the target must differ from the origin",
        ),
        (_turned('<lookat origin="0 0 0" target="0 1 0" up="0 1 0"/>'), "up must not be parallel"),
        (_turned('<scale value="1e300"/>' * 2), "numbers of a transform must be finite"),
        (_turned('<shear x="1"/>'), "wanted one of translate, "),
    ],
)
def test_wrong_values_are_one_error_with_their_line(part: str, wrong: str, tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match=wrong) as caught:
        loaded(tmp_path, part)
    assert str(caught.value).startswith(f"{tmp_path / 'scene.xml'}: line 2, column ")
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("", "XML"),
        ("<scene/>", "wanted a version"),
        ('<scene version="x"/>', "wanted a version"),
        ('<scene version="4.0.0"/>', "wanted a version of at most 3"),
        ('<bsdf type="diffuse" version="3.0.0"/>', "the root element must be <scene>"),
        ('<mesh version="3.0.0"/>', "not an object of Mitsuba"),
        (
            '<!DOCTYPE a [<!ENTITY b "c">]><scene version="3.0.0"/>',
            "document types and entities are not supported",
        ),
        ('<scene version="3.0.0">' + '<bsdf type="mask">' * 70, "XML"),
    ],
)
def test_what_is_no_scene_is_refused(text: str, wrong: str, tmp_path: Path) -> None:
    path = tmp_path / "scene.xml"
    path.write_text(text)
    with pytest.raises(dg.InputError, match=wrong):
        dg.load(path)


def test_all_elements_are_used_or_noted(tmp_path: Path) -> None:
    path = written(tmp_path, *RICH)
    scene, _, ledger = read_all(path)
    used, noted, rest = ledger.counts()
    assert used + noted == len(list(ElementTree.parse(path).iter()))
    assert rest == 0
    # hide_emitters, odd, the hair with its beta, idle with its colour, sdfgrid with two inside,
    # sunsky with its turbidity
    assert noted == 11
    notes = "\n".join(scene.warnings)
    for said in (
        "integrator 'path': 'hide_emitters' is not supported (1 use)",
        "bsdf 'roughplastic': 'odd' is not supported (1 use)",
        "a material 'hair' is grey",
        "a bsdf of type 'diffuse' is unused and left out (1 use)",
        "a shape 'sdfgrid' is left out (1 use)",
        "an emitter 'sunsky' is left out (1 use)",
    ):
        assert said in notes


def test_elements_of_included_files_count(tmp_path: Path) -> None:
    inner = written(tmp_path, *RICH[:3], name="inner.xml")
    path = written(tmp_path, '<include filename="inner.xml"/>', *RICH[3:])
    _, _, ledger = read_all(path)
    used, noted, rest = ledger.counts()
    assert rest == 0
    assert used + noted == sum(len(list(ElementTree.parse(p).iter())) for p in (path, inner))


def test_many_parameters_take_little_time(tmp_path: Path) -> None:
    names = [f"a{i}" for i in range(20_000)]
    parts = [f'<default name="{name}" value="1"/>' for name in names]
    parts += [sphere(f"${name}") for name in names[:100]]
    start = time.process_time()
    dg.load(written(tmp_path, *parts))
    assert time.process_time() - start < 6  # a pattern of all names, made anew each time: 10 x


def test_parameters_have_the_longest_name_that_is_known(tmp_path: Path) -> None:
    values = {"a": "1", "ab": "2"}
    entry = Entry("scene.xml", 1, 1, "<float>")
    filled = Parameters(values)
    assert filled.fill(r"$a $abc $ab\$a \$", entry) == "1 2c 2$a $"
    with pytest.raises(dg.errors.InputError, match=r"the parameter \$x has no value"):
        filled.fill("$x y", entry)


def test_a_reference_without_a_use_is_noted(tmp_path: Path) -> None:
    path = written(
        tmp_path,
        '<shape type="sphere" id="one"/>',
        '<shape type="sphere"><ref id="one"/></shape>',
    )
    assert "a reference to a shape of type 'sphere' is not supported" in str(dg.load(path).warnings)


def test_spheres_share_a_mesh(tmp_path: Path) -> None:
    turned = '<shape type="sphere"><boolean name="flip_normals" value="true"/></shape>'
    scene = dg.load(written(tmp_path, sphere("1"), sphere("2"), turned, turned))
    assert len(scene.meshes) == 2
    assert len(scene.instances) == 4


def test_digits_are_those_of_ascii(tmp_path: Path) -> None:
    with pytest.raises(dg.errors.InputError, match="wanted a number"):
        dg.load(written(tmp_path, sphere("\u0661")))


def test_a_lens_that_is_too_large_has_a_place(tmp_path: Path) -> None:
    lens = '<sensor type="thinlens"><float name="aperture_radius" value="1e29"/></sensor>'
    with pytest.raises(dg.errors.InputError, match=r"line 2, column \d+: <sensor"):
        dg.load(written(tmp_path, lens))


def sphere(radius: str) -> str:
    """A sphere."""
    return f'<shape type="sphere"><float name="radius" value="{radius}"/></shape>'


def test_errors_have_the_column_of_their_element(tmp_path: Path) -> None:
    (tmp_path / "scene.xml").write_text(
        '<scene version="3.0.0">\n'
        '  <shape type="sphere"><float name="radius" value="-1"/></shape>\n</scene>'
    )
    with pytest.raises(dg.InputError, match=r"line 2, column 24: <float name='radius'>: wanted"):
        dg.load(tmp_path / "scene.xml")


def test_the_file_itself_is_named_if_it_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match=r"none\.xml: no such file"):
        dg.load(tmp_path / "none.xml")
    (tmp_path / "folder.xml").mkdir()
    with pytest.raises(dg.InputError, match=r"folder\.xml: wanted a file, got a folder"):
        dg.load(tmp_path / "folder.xml")


def test_an_index_out_of_range_has_a_place(tmp_path: Path) -> None:
    glass = '<bsdf type="dielectric"><float name="int_ior" value="1e-9"/></bsdf>'
    with pytest.raises(dg.InputError, match=r"line 2, column \d+: <bsdf .*int_ior: wanted 0.1 to"):
        dg.load(written(tmp_path, f'<shape type="sphere">{glass}</shape>'))


def test_shapes_that_are_scaled_to_nothing_are_left_out(tmp_path: Path) -> None:
    flat = '<transform name="to_world"><scale x="0"/></transform>'
    scene = dg.load(written(tmp_path, f'<shape type="cube">{flat}</shape>', sphere("1e-30")))
    assert not scene.instances
    assert "a shape that is scaled to zero or sheared flat is left out (2 uses)" in scene.warnings


def test_a_few_files_cannot_ask_for_files_without_end(tmp_path: Path) -> None:
    for i in range(12):
        written(tmp_path, f'<include filename="f{i + 1}.xml"/>' * 3, name=f"f{i}.xml")
    written(tmp_path, name="f12.xml")
    begun = time.process_time()
    with pytest.raises(dg.InputError, match=r"too many files are included again: .* 10000"):
        loaded(tmp_path, '<include filename="f0.xml"/>')
    assert time.process_time() - begun < 60
    (tmp_path / "long.xml").write_bytes(b"<!--" + b"a" * (8 << 20) + b'--><scene version="3.0.0"/>')
    with pytest.raises(dg.InputError, match=r"included again: wanted at most 67108864 bytes"):
        loaded(tmp_path, '<include filename="long.xml"/>' * 12)
