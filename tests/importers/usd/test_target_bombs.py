"""Very many targets, and targets that lead on to others in very many ways, in 1 MB at most."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import daguerre as dg
from daguerre.apart.process import Process

TRIANGLE = """int[] faceVertexCounts = [3]
int[] faceVertexIndices = [0, 1, 2]
point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
"""
BINDS = 'prepend apiSchemas = ["MaterialBindingAPI"]'
SKEL = 'prepend apiSchemas = ["SkelBindingAPI"]'
MANY = 60_000


def _prim(kind: str, name: str, body: str, head: str = "") -> str:
    return f'def {kind} "{name}" (\n{head}\n) {{\n{body}}}\n'


def _mesh(more: str, head: str = BINDS) -> str:
    return _prim("Mesh", "m", f"{TRIANGLE}{more}\n", head)


def _targets(names: Iterator[str] | list[str]) -> str:
    return f"[{', '.join(f'<{name}>' for name in names)}]"


def _many(count: int = MANY) -> str:
    return _targets([f"/p/a{i}" for i in range(count)])


def _collection(more: str) -> str:
    """Meshes with a material of a collection."""
    head = 'prepend apiSchemas = ["CollectionAPI:c", "MaterialBindingAPI"]'
    bound = "rel material:binding:collection:c = [</w.collection:c>, </mat>]\n"
    meshes = "".join(_prim("Mesh", f"m{i}", TRIANGLE) for i in range(300))
    return _prim("Xform", "w", f"{more}\n{bound}{meshes}", head) + _prim("Material", "mat", "")


def _collections(before: int, after: int) -> str:
    """Collections, each in many others; with ``before``, also in those that it includes."""
    count, body = 150, ""
    for i in range(count):
        inside = [j for j in range(i - before, i + after + 1) if j != i and 0 <= j < count]
        body += (
            f"rel collection:c{i}:includes = {_targets([f'/c.collection:c{j}' for j in inside])}\n"
        )
    names = ", ".join(f'"CollectionAPI:c{i}"' for i in range(count))
    bound = "rel material:binding:collection:x = [</c.collection:c0>, </mat>]"
    return _prim("Scope", "c", body, f"prepend apiSchemas = [{names}]") + _mesh(bound)


def _forwarded(last: str, levels: int = 12, wide: int = 10) -> str:
    """Relationships that lead to all of the next level."""
    body = ""
    for level in range(levels + 1):
        next_ones = _targets([f"/f{level + 1}.r{j}" for j in range(wide)])
        inside = last if level == levels else next_ones
        body += _prim("Scope", f"f{level}", "".join(f"rel r{i} = {inside}\n" for i in range(wide)))
    return body


def _material(inside: str, first: str) -> str:
    shader = f"""uniform token info:id = "UsdPreviewSurface"
color3f inputs:diffuseColor.connect = {first}
token outputs:surface
"""
    body = "token outputs:surface.connect = </mat/s.outputs:surface>\n"
    body += _prim("Shader", "s", shader)
    return _mesh("rel material:binding = </mat>") + _prim("Material", "mat", body + inside)


def _ports(kind: str, port: str, levels: int = 20, wide: int = 10) -> str:
    """Ports that are connected to all of the next level."""
    body = ""
    for level in range(levels + 1):
        to = _targets([f"/mat/n{level + 1}.{port}:p{j}" for j in range(wide)])
        value = " = (1, 0, 0)" if level == levels else f".connect = {to}"
        lines = "".join(f"color3f {port}:p{i}{value}\n" for i in range(wide))
        body += _prim(kind, f"n{level}", lines)
    return body


def _products(count: int) -> str:
    """Products of MaterialX, each of the next one with itself."""
    body = ""
    for k in range(count):
        after = f"</mat/n{k + 1}.outputs:out>"
        nodes = "".join(f"color3f inputs:in{i}.connect = {after}\n" for i in (1, 2))
        kind = 'uniform token info:id = "ND_multiply_color3"\n'
        body += _prim("Shader", f"n{k}", f"{kind}{nodes}color3f outputs:out\n")
    surface = """uniform token info:id = "ND_standard_surface_surfaceshader"
color3f inputs:base_color.connect = </mat/n0.outputs:out>
token outputs:out
"""
    head = "token outputs:mtlx:surface.connect = </mat/s.outputs:out>\n"
    return _mesh("rel material:binding = </mat>") + _prim(
        "Material", "mat", head + _prim("Shader", "s", surface) + body
    )


def _classes(arc: str, levels: int, wide: int) -> str:
    """Classes that each take up all of the next level."""
    body = ""
    for level in range(levels):
        names = [f"/c{level + 1}_{j}" for j in range(wide)]
        head = f"{arc} = {_targets(names)}" if level + 1 < levels else ""
        body += "".join(_prim("Scope", f"c{level}_{i}", "", head) for i in range(wide))
    return body + _prim("Xform", "u", "", f"{arc} = </c0_0>")


def _variant_tree(depth: int) -> str:
    """Sets of variants in variants of others."""
    if depth == 0:
        return ""
    head = f'prepend variantSets = ["s{depth - 1}_0", "s{depth - 1}_1"]'
    choices = "".join(f'"{one}" (\n{head}\n) {{\n{_variant_tree(depth - 1)}}}\n' for one in "xy")
    return "".join(f'variantSet "s{depth}_{i}" = {{\n{choices}}}\n' for i in range(2))


def _variants(sets: int, choices: int) -> str:
    names = ", ".join(f'"s{i}"' for i in range(sets))
    inside = "".join(f'"x{j}" {{\n}}\n' for j in range(choices))
    body = "".join(f'variantSet "s{i}" = {{\n{inside}}}\n' for i in range(sets))
    return _prim("Scope", "v", body, f"prepend variantSets = [{names}]")


def _instancer(prototypes: str) -> str:
    body = f"rel prototypes = {prototypes}\nint[] protoIndices = [0]\n"
    return _prim("PointInstancer", "i", f"{body}point3f[] positions = [(0, 0, 0)]\n")


def _chain(count: int) -> str:
    """A relationship that leads to the end of a long chain."""
    lines = "".join(f"rel r{i} = </f.r{i + 1}>\n" for i in range(count))
    return _mesh("rel material:binding = </f.r0>") + _prim("Scope", "f", lines)


BOMBS = {
    "binding": lambda: _mesh(f"rel material:binding = {_many()}"),
    "collection binding": lambda: _mesh(f"rel material:binding:collection:x = {_many()}"),
    "includes": lambda: _collection(f"rel collection:c:includes = {_many(MANY // 2)}"),
    "excludes": lambda: _collection(f"rel collection:c:excludes = {_many(MANY // 2)}"),
    "collections in collections": lambda: _collections(0, 10),
    "collections in a circle": lambda: _collections(6, 6),
    "prototypes": lambda: _instancer(_many()),
    "skeletons": lambda: _prim("SkelRoot", "r", _mesh(f"rel skel:skeleton = {_many()}", SKEL)),
    "blend shapes": lambda: _prim(
        "SkelRoot", "r", _mesh(f"rel skel:blendShapeTargets = {_many()}", SKEL)
    ),
    "linked lights": lambda: _prim(
        "SphereLight", "l", f"rel collection:lightLink:includes = {_many()}\n"
    ),
    "light filters": lambda: _prim("SphereLight", "l", f"rel light:filters = {_many()}\n"),
    "forwarded bindings": lambda: _mesh("rel material:binding = </f0.r0>") + _forwarded("</mat>"),
    "forwarded prototypes": lambda: _instancer("</f0.r0>") + _forwarded("</m>") + _mesh(""),
    "forwarded includes": lambda: (
        _collection("rel collection:c:includes = </f0.r0>") + _forwarded("</w>")
    ),
    "a long chain of bindings": lambda: _chain(30_000),
    "connected inputs": lambda: _material(_ports("NodeGraph", "inputs"), "</mat/n0.inputs:p0>"),
    "connected outputs": lambda: _material(_ports("NodeGraph", "outputs"), "</mat/n0.outputs:p0>"),
    "connected shaders": lambda: _material(_ports("Shader", "outputs"), "</mat/n0.outputs:p0>"),
    "many connections": lambda: _material("", _many()),
    "products": lambda: _products(2000),
    "inherited diamonds": lambda: _classes("inherits", 20, 2),
    "specialized diamonds": lambda: _classes("specializes", 20, 2),
    "referenced diamonds": lambda: _classes("references", 17, 2),
    "sets of variants": lambda: _variants(2000, 10),
    "variants": lambda: _variants(1, 30_000),
    "variants in variants": lambda: _prim(
        "Scope", "v", _variant_tree(5), 'prepend variantSets = ["s5_0", "s5_1"]'
    ),
}


@pytest.mark.behind_wall
@pytest.mark.parametrize("name", BOMBS)
def test_a_bomb_of_targets_is_a_scene_or_one_error(
    tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    stage, peak, judge = tmp_path / "s.usda", [0.0], Process.judge
    stage.write_text(f"#usda 1.0\n(\nmetersPerUnit = 1\n)\n{BOMBS[name]()}")
    assert stage.stat().st_size < 1e6

    def watch(self: Process) -> None:
        peak[0] = max(peak[0], self.resident)
        judge(self)

    monkeypatch.setattr(Process, "judge", watch)
    try:
        dg.load(stage)
        told = f"{stage}: "
    except dg.InputError as error:
        told = str(error)
    assert told.startswith(f"{stage}: ")
    assert "took longer" not in told  # none of them is as slow as the limit of 10 s allows
    assert 0 < peak[0] < 1.5e9


@pytest.mark.parametrize("name", ["collections in collections", "collections in a circle"])
def test_collections_that_multiply_are_refused_before_usd_follows_them(
    tmp_path: Path, name: str
) -> None:
    stage = tmp_path / "s.usda"
    stage.write_text(f"#usda 1.0\n(\nmetersPerUnit = 1\n)\n{BOMBS[name]()}")
    begin = time.process_time()
    with pytest.raises(dg.InputError, match="targets of collections, got more: they include one"):
        dg.load(stage, in_process=True)
    assert time.process_time() - begin < 10
