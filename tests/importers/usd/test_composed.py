"""A stage that would compose too many prims is refused before USD composes any."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from pxr import Sdf, Tf, Usd, UsdUtils

import daguerre as dg
from daguerre.importers.usd import composed
from daguerre.importers.usd.assets import Assets
from daguerre.importers.usd.layers import Layers
from tests.importers.usd.random_stages import write_stage

_TEN = range(10)


def _stage(path: Path, body: str, header: str = "") -> Path:
    path.write_text(f"#usda 1.0\n(\nmetersPerUnit = 1\n{header}\n)\n{body}")
    return path


def _prim(name: str, arcs: str = "", inside: str = "", word: str = "def") -> str:
    return f'{word} "{name}" (\n{arcs}\n) {{\n{inside}\n}}\n'


def _levels(arc: str, more: str = "") -> str:
    """Nine levels, each with ten children that refer to the level below."""
    body = 'def "L0" { def Cube "c" {\n}\n}\n'
    for level in range(1, 10):
        below = f"{arc} = </L{level - 1}>\n{more}"
        body += _prim(f"L{level}", "", "".join(_prim(f"r{i}", below) for i in _TEN))
    return body


def _in_layers(folder: Path) -> Path:
    for level in range(9):
        arcs = f"references = @{level + 1}.usda@</a>"
        _stage(
            folder / f"{level}.usda", _prim("a", "", "".join(_prim(f"r{i}", arcs) for i in _TEN))
        )
    return _stage(folder / "9.usda", _prim("a")).with_name("0.usda")


def _in_variants(folder: Path) -> Path:
    body = _prim("L0")
    for level in range(1, 10):
        inside = "".join(_prim(f"r{i}", f"references = </L{level - 1}>") for i in _TEN)
        arcs = 'variants = { string v = "x"\n}\nprepend variantSets = "v"'
        body += _prim(f"L{level}", arcs, f'variantSet "v" = {{\n"x" {{\n{inside}\n}}\n}}')
    return _stage(folder / "s.usda", body)


def _below_targets(folder: Path) -> Path:
    """References to prims that exist by references above them alone."""
    body = 'def "L0" { def "x" { def "y" {\n}\n}\n}\n'
    for level in range(1, 10):
        inside = "".join(_prim(f"r{i}", f"references = </L{level - 1}/x>") for i in _TEN)
        body += _prim(f"L{level}", f"references = </L{level - 1}>", _prim("x", "", inside, "over"))
    return _stage(folder / "s.usda", body)


def _by_implied_classes(folder: Path) -> Path:
    """Classes of a layer that stand for more in the layer that refers to it."""
    users = "".join(_prim(f"n{i}", "inherits = </T/_c>") for i in _TEN)
    _stage(folder / "t.usda", _prim("T", "", _prim("_c", "", "", "class") + users))
    body = _prim("P0")
    for level in range(1, 10):
        own = _prim("_c", "", _prim("x", f"references = </P{level - 1}>"), "over")
        body += _prim(f"P{level}", "references = @t.usda@</T>", own)
    return _stage(folder / "s.usda", body)


def _loops(folder: Path) -> Path:
    """Every prim refers to every other one."""
    names = [f"p{i}" for i in range(12)]
    body = "".join(
        _prim(a, f"references = [{', '.join(f'</{b}>' for b in names if b != a)}]") for a in names
    )
    return _stage(folder / "s.usda", body)


BOMBS: dict[str, Callable[[Path], Path]] = {
    "references": lambda f: _stage(f / "s.usda", _levels("references")),
    "instances": lambda f: _stage(f / "s.usda", _levels("references", "instanceable = true")),
    "payloads": lambda f: _stage(f / "s.usda", _levels("payload")),
    "inherits": lambda f: _stage(f / "s.usda", _levels("inherits")),
    "specializes": lambda f: _stage(f / "s.usda", _levels("specializes")),
    "layers": _in_layers,
    "variants": _in_variants,
    "prims below targets": _below_targets,
    "implied classes": _by_implied_classes,
    "loops": _loops,
}


@pytest.mark.parametrize("name", BOMBS)
def test_stages_of_too_many_prims_are_refused_at_once(tmp_path: Path, name: str) -> None:
    stage = BOMBS[name](tmp_path)
    begin = time.process_time()
    with pytest.raises(dg.InputError, match=r"too many prims: wanted|form too many loops"):
        dg.load(stage, in_process=True)
    assert time.process_time() - begin < 10


def _diamonds(levels: int) -> str:
    """Classes that each refer to five of the next level, and a prim that refers to the first."""
    body = _prim("top", f"references = [{', '.join(f'</d1_{i}>' for i in range(5))}]")
    for level in range(1, levels + 1):
        below = ", ".join(f"</d{level + 1}_{i}>" for i in range(5))
        head = "" if level == levels else f"references = [{below}]"
        body += "".join(_prim(f"d{level}_{i}", head, "", "class") for i in range(5))
    return body


@pytest.mark.parametrize("levels", [7, 9, 100])
def test_diamonds_of_references_are_refused_at_once(tmp_path: Path, levels: int) -> None:
    stage = _stage(tmp_path / "s.usda", _diamonds(levels))
    begin = time.process_time()
    told = r"/\w+: too many references to references: wanted at most 65535, got 97656$"
    with pytest.raises(dg.InputError, match=told):
        dg.load(stage, in_process=True)
    assert time.process_time() - begin < 2


def test_the_specs_of_a_prim_are_those_that_usd_finds(tmp_path: Path) -> None:
    path = _stage(tmp_path / "s.usda", _diamonds(4))
    layers = Layers(path, Assets(path, ()))
    count = composed._run(composed._Composed("s").specs(layers.root, Sdf.Path("/top")))
    stage = Usd.Stage.Open(str(path))
    assert count.own == len(stage.GetPrimAtPath("/top").GetPrimStack()) == 781


def test_a_long_chain_of_references_is_refused(tmp_path: Path) -> None:
    body = _prim("p0") + "".join(_prim(f"p{i + 1}", f"references = </p{i}>") for i in range(1000))
    with pytest.raises(dg.InputError, match="references are nested too deeply: the limit is 128"):
        dg.load(_stage(tmp_path / "s.usda", body))


def test_deep_prims_of_references_are_refused(tmp_path: Path) -> None:
    deep = "".join(f'def "c{i}" {{\n' for i in range(500)) + "}\n" * 500
    body = f'def "q0" {{\n{deep}}}\n'
    overs = "".join(f'over "c{k}" {{\n' for k in range(499))
    for i in range(1, 6):
        tip = f'over "c499" (references = </q{i - 1}>) {{\n}}\n'
        body += f'def "q{i}" (references = </q0>) {{\n{overs}{tip}' + "}\n" * 500
    with pytest.raises(dg.InputError, match="nested too deeply: the limit is 2000"):
        dg.load(_stage(tmp_path / "s.usda", body))


def test_the_largest_variant_counts_and_not_all(tmp_path: Path) -> None:
    inside = "".join(
        f'"v{i}" {{\n' + "".join(_prim(f"c{k}") for k in range(i)) + "}\n" for i in range(1, 8)
    )
    body = _prim("a", 'prepend variantSets = "v"', f'variantSet "v" = {{\n{inside}\n}}')
    path = _stage(tmp_path / "s.usda", body)
    assert _bound(path).prims == 1 + 1 + 7  # the root of all, too


def _nested_without_end(folder: Path) -> Path:
    """USD nests ``/p4/c2/c2/c2/...``: ``c2`` inherits ``/p3/c2``, which is ``/p4/c2/c2/c2``."""
    chosen = 'variants = { string v = "x"\n}\nprepend variantSets = "v"'
    inside = f'variantSet "v" = {{\n"x" {{\n{_prim("c0", "inherits = </p4/c2>")}}}\n}}\n'
    _stage(
        folder / "1.usda", _prim("p2", "", _prim("c1", chosen, inside)), "subLayers = [@2.usda@]"
    )
    inherits = _prim("c0", "", _prim("c1", "inherits = </p3/c2>"))
    body = _prim("p0", "", _prim("c2", "", _prim("c2", "references = </p1/c0/c1>")))
    body += _prim("p1", "payload = </p2/c1>", inherits)
    body += _prim("p2", "", _prim("c1", "", _prim("c1", "payload = </p3/c0>")))
    body += _prim("p3", "payload = </p4/c2/c2>")
    _stage(folder / "2.usda", body)
    head = "subLayers = [@2.usda@]"
    return _stage(folder / "0.usda", _prim("p4", "references = @1.usda@</p0>"), head)


def test_loops_of_implied_classes_that_usd_does_not_end_are_refused_at_once(tmp_path: Path) -> None:
    stages = [_nested_without_end(tmp_path)]
    for seed in (42, 261):  # of random stages; USD ends with neither
        folder = tmp_path / str(seed)
        folder.mkdir()
        stages.append(write_stage(folder, seed))
    for stage in stages:
        begin = time.process_time()
        with pytest.raises(dg.InputError, match="leads below itself, through an inherited class"):
            dg.load(stage, in_process=True)
        assert time.process_time() - begin < 2


def _bound(path: Path) -> composed._Sum:
    layers = Layers(path, Assets(path, ()))
    count = composed._Composed(str(path))
    return composed._run(count.specs(layers.root, Sdf.Path.absoluteRootPath))


def _compare(path: Path) -> None:
    bound = _bound(path)
    if bound.prims > 3000:
        return
    stage = Usd.Stage.Open(str(path), Usd.Stage.LoadAll)
    found = list(Usd.PrimRange(stage.GetPseudoRoot(), Usd.PrimAllPrimsPredicate))
    assert len(found) <= bound.prims
    assert max(prim.GetPath().pathElementCount for prim in found) < bound.depth


def test_the_count_is_a_bound_on_what_usd_composes(tmp_path: Path) -> None:
    """A process for each stage, as USD does not come to an end with a few of them."""
    ended = 0
    for seed in range(40):
        path = write_stage(tmp_path, seed)
        child = os.fork()
        if not child:
            signal.alarm(10)
            delegate = UsdUtils.CoalescingDiagnosticDelegate()
            try:
                _compare(path)
            except AssertionError:
                os._exit(1)
            except (Tf.ErrorException, dg.InputError):  # a fault of USD, or a loop
                os._exit(2)
            del delegate
            os._exit(0)
        _, status = os.waitpid(child, 0)
        assert not os.WIFEXITED(status) or os.WEXITSTATUS(status) != 1, seed
        ended += status == 0
    assert ended >= 28
