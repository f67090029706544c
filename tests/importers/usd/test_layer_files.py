"""Layers are checked before USD parses them: nesting, packages, values inside of values."""

from __future__ import annotations

import contextlib
import struct
import time
import zipfile
from pathlib import Path
from typing import Any

import pytest
from pxr import Sdf

import daguerre as dg
from daguerre.importers.usd.layer_files import check_file
from daguerre.importers.usd.text_layers import DEEPEST, check_text

_HEAD = b"#usda 1.0\n"
_MANY = 12_000


def _nested(before: str, after: str, count: int, begin: str = "", end: str = "") -> bytes:
    return _HEAD + (begin + before * count + after * count + end).encode()


DEEP = {
    "prims": ('def "a" {\n', "}\n", "", ""),
    "tuples": ("(", ")", 'def "a" {\n double x = ', "\n}\n"),
    "lists": ("[", "]", 'def "a" {\n double[] x = ', "\n}\n"),
    "dictionaries": ("dictionary a = {\n", "}\n", 'def "a" (\n customData = {\n', "}\n) {\n}\n"),
    "variants": ('variantSet "v" = {\n"x" {\n', "}\n}\n", 'def "a" {\n', "}\n"),
    "targets": ("/a.b[", "]", 'def "a" {\n rel x = <', "/a>\n}\n"),
    "path expressions": ("(", ")", 'def "a" {\n pathExpression x = "', '"\n}\n'),
    "predicates": ("(", ")", 'def "a" {\n pathExpression x = \'//{', "}'\n}\n"),
}


@pytest.mark.parametrize("name", DEEP)
def test_text_that_is_nested_too_deeply_is_refused(tmp_path: Path, name: str) -> None:
    before, after, begin, end = DEEP[name]
    path = tmp_path / "s.usda"
    path.write_bytes(_nested(before, after, _MANY, begin, end))
    with pytest.raises(dg.InputError, match="brackets are nested too deeply: the limit is 1000"):
        dg.load(path)
    with zipfile.ZipFile(tmp_path / "s.usdz", "w") as made:
        made.write(path, "a.usda")
    with pytest.raises(dg.InputError, match="brackets are nested too deeply"):
        dg.load(tmp_path / "s.usdz")


@pytest.mark.parametrize(
    ("text", "deep"),
    [
        (b'"%s"', False),
        (b"'%s'", False),
        (b'"""%s"""', False),
        (b"'''\\'''%s'''", False),
        (b"@%s@", False),
        (b"@@@\\@@@%s@@@@@", False),
        (b"# %s", False),
        (b"// %s", False),
        (b"/* %s */", False),
        (b"</a> %s", True),
        (b'"\\"" %s', True),
        (b'"\\\\" %s', True),
        (b"'''a''b\\'''' %s", True),
        (b'"" %s', True),
        (b"@a@ %s", True),
        (b"@@@a@@@ %s", True),
        (b'/* " */ %s', True),
        (b"# ' \r \n %s", True),
        (b'// " \n %s', True),
        (b"/* /* */ %s", True),
    ],
)
def test_brackets_count_where_the_parser_sees_them(text: bytes, deep: bool) -> None:
    data = _HEAD + text.replace(b"%s", b"(" * (DEEPEST + 1))
    if deep:
        with pytest.raises(dg.InputError, match="nested too deeply"):
            check_text(data, "f")
    else:
        check_text(data, "f")
    check_text(_HEAD + text.replace(b"%s", b"(" * DEEPEST), "f")


@pytest.mark.parametrize(
    "piece", [b'"\\', b"/*", b"<", b"'''", b"@@@", b"@", b"\"'", b"<[", b"@[", b'"""(', b"'\\'"]
)
def test_the_scan_takes_a_time_in_proportion_to_the_text(piece: bytes) -> None:
    data = _HEAD + b"pathExpression" + piece * (1_000_000 // len(piece))
    begin = time.process_time()
    with contextlib.suppress(dg.InputError):
        check_text(data, "f")
    assert time.process_time() - begin < 5


def _binary(path: Path, value: Any) -> Path:
    layer = Sdf.Layer.CreateAnonymous(".usdc")
    Sdf.CreatePrimInLayer(layer, "/a").SetInfo("customData", value)
    assert layer.Export(str(path))
    return path


def test_values_of_binary_layers_that_are_nested_too_deeply_are_refused(tmp_path: Path) -> None:
    value: dict[str, Any] = {"x": 1.5, "file": Sdf.AssetPath("b.png")}
    for _ in range(100):
        value = {"k": value, "more": 3}
    assert check_file(_binary(tmp_path / "a.usdc", value), "f")
    for _ in range(40):
        value = {"k": value}
    with pytest.raises(dg.InputError, match="wanted at most 128 values inside of one another"):
        dg.load(_binary(tmp_path / "b.usdc", value))
    assert not check_file(_binary(tmp_path / "c.usdc", {"x": 1}), "f")


def test_path_expressions_of_binary_layers_are_checked(tmp_path: Path) -> None:
    """All texts of such a layer count, as it does not tell which of them are expressions."""
    layer = Sdf.Layer.CreateAnonymous(".usdc")
    prim = Sdf.CreatePrimInLayer(layer, "/a")
    text = Sdf.AttributeSpec(prim, "t", Sdf.ValueTypeNames.String)
    text.default = "(" * (DEEPEST + 1)
    assert layer.Export(str(tmp_path / "a.usdc"))
    check_file(tmp_path / "a.usdc", "f")
    found = Sdf.AttributeSpec(prim, "x", Sdf.ValueTypeNames.PathExpression)
    found.default = Sdf.PathExpression("/a")
    assert layer.Export(str(tmp_path / "b.usdc"))
    with pytest.raises(dg.InputError, match="brackets are nested too deeply"):
        check_file(tmp_path / "b.usdc", "f")


def _package(path: Path, *, packed: bool = False, name: str = "a.usda") -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED if packed else zipfile.ZIP_STORED) as made:
        made.writestr(name, _HEAD + b'def Sphere "ball" {\n}\n')
        made.writestr("b.txt", b"b" * 100)
    return path


def _cut(data: bytearray) -> None:
    del data[data.index(b"PK\x01\x02") :]


def _encrypted(data: bytearray) -> None:
    data[6] |= 1


def _larger(data: bytearray) -> None:
    struct.pack_into("<2I", data, 18, 1 << 30, 1 << 30)


def _other_size(data: bytearray) -> None:
    first = data.index(b"PK\x01\x02")
    struct.pack_into("<2I", data, first + 20, 5, 5)


DAMAGE = {f.__name__: f for f in (_cut, _encrypted, _larger, _other_size)}


@pytest.mark.parametrize("name", DAMAGE)
def test_packages_that_two_readers_see_differently_are_refused(tmp_path: Path, name: str) -> None:
    data = bytearray(_package(tmp_path / "good.usdz").read_bytes())
    assert len(dg.load(tmp_path / "good.usdz").instances) == 1
    DAMAGE[name](data)
    (tmp_path / "bad.usdz").write_bytes(data)
    with pytest.raises(dg.InputError, match="damaged package: wanted"):
        dg.load(tmp_path / "bad.usdz")
    user = tmp_path / "s.usda"
    user.write_bytes(_HEAD + b'def "a" (\n references = @bad.usdz@\n) {\n}\n')
    with pytest.raises(dg.InputError, match=r"bad\.usdz: damaged package: wanted"):
        dg.load(user)


def test_compressed_packages_and_no_packages_are_refused(tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match="wanted files without compression"):
        dg.load(_package(tmp_path / "a.usdz", packed=True))
    (tmp_path / "b.usdz").write_bytes(b"no package")
    with pytest.raises(dg.InputError, match="damaged package: wanted"):
        dg.load(tmp_path / "b.usdz")


def test_packages_inside_of_packages_are_checked(tmp_path: Path) -> None:
    data = _package(tmp_path / "p0.usdz").read_bytes()
    for i in range(1, 6):
        with zipfile.ZipFile(tmp_path / f"p{i}.usdz", "w") as made:
            made.writestr("a.usda", _HEAD)
            made.writestr("p.usdz", data)
        data = (tmp_path / f"p{i}.usdz").read_bytes()
    check_file(tmp_path / "p3.usdz", "f")
    with pytest.raises(dg.InputError, match="packages are nested too deeply: the limit is 4"):
        check_file(tmp_path / "p5.usdz", "f")
