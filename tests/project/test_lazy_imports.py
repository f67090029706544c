"""Packages show the names of their stubs, each imported on first use."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path

import pytest

import daguerre
from daguerre.lazy_imports import lazy_names

ROOT = Path(daguerre.__file__).parent
STUBS = sorted(ROOT.rglob("__init__.pyi"))


@pytest.mark.parametrize("stub", STUBS, ids=lambda stub: stub.parent.name)
def test_every_line_of_a_stub_is_a_name(stub: Path) -> None:
    package = ".".join(stub.parent.relative_to(ROOT.parent).parts)
    shown = importlib.import_module(package)
    imports = [line for line in stub.read_text().splitlines() if not line.startswith("#") and line]
    assert len(imports) == len(shown.__all__) > 0
    for name in shown.__all__:
        value = getattr(shown, name)
        assert value is not None
        assert getattr(shown, name) is value
    assert dir(shown) == shown.__all__ == sorted(shown.__all__)


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match=r"'daguerre.lenses' has no attribute 'lense'"):
        daguerre.lenses.lense  # noqa: B018  # type: ignore[attr-defined]


def test_names_are_imported_on_first_use() -> None:
    code = (
        "import sys, daguerre, daguerre.analysis\n"
        "assert 'daguerre.scene.scene' not in sys.modules\n"
        "assert 'daguerre.analysis.psf' not in sys.modules\n"
        "daguerre.Scene, daguerre.analysis.Psf\n"
        "assert 'daguerre.scene.scene' in sys.modules\n"
        "assert 'daguerre.analysis.psf' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_module_of_the_package_is_a_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "shown_package"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "inner.py").write_text("value = 3")
    (package / "__init__.pyi").write_text(
        "from . import inner as inner\nfrom .inner import value as value\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    importlib.import_module("shown_package")
    get, listed, names = lazy_names("shown_package", str(package / "__init__.py"))
    assert names == listed() == ["inner", "value"]
    assert get("value") == get("inner").value == 3
