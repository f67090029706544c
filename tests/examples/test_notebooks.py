"""The notebooks of examples/notebooks run from top to bottom in an empty folder."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))
TUTORIALS = [ROOT / "docs" / "first-picture.md", *(ROOT / "docs" / "tutorials").glob("*.md")]


# In a process of its own, as it leaves sockets open. Without folders of kernels there is the one of
# this interpreter alone.
RUN = """
import sys

import nbformat
from jupyter_client.kernelspec import KernelSpecManager
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient

source, made, folder = sys.argv[1:]
notebook = nbformat.read(source, as_version=4)
here = KernelSpecManager(kernel_dirs=[])
manager = AsyncKernelManager(kernel_name="python3", kernel_spec_manager=here)
where = {"metadata": {"path": folder}}
NotebookClient(notebook, km=manager, timeout=600, resources=where).execute()
nbformat.write(notebook, made)
"""


def run(notebook: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """Runs all cells in a folder, and writes the notebook with its outputs there, as made.ipynb."""
    command = [sys.executable, "-c", RUN, notebook, folder / "made.ipynb", folder]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def kinds_of(cell: Any) -> set[str]:
    """Media types of what a cell shows."""
    return {kind for output in cell["outputs"] for kind in output.get("data", {})}


def test_each_tutorial_has_one() -> None:
    assert {path.stem.replace("_", "-") for path in NOTEBOOKS} == {path.stem for path in TUTORIALS}
    listed = (ROOT / "examples" / "README.md").read_text()
    assert all(f"(notebooks/{path.name})" in listed for path in NOTEBOOKS)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_no_outputs_are_kept(path: Path) -> None:
    """They would grow the repository; a run makes them again."""
    for cell in json.loads(path.read_text())["cells"]:
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            assert cell["execution_count"] is None


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_links_lead_somewhere(path: Path) -> None:
    cells = json.loads(path.read_text())["cells"]
    first = "".join(cells[0]["source"])
    page = first.split("[tutorial](")[1].split(")")[0]
    assert (path.parent / page).resolve() in TUTORIALS


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path: Path, tmp_path: Path) -> None:
    done = run(path, tmp_path)
    assert done.returncode == 0, done.stderr[-3000:]
    cells = json.loads((tmp_path / "made.ipynb").read_text())["cells"]
    shown = [kinds_of(cell) for cell in cells if cell["cell_type"] == "code"]
    assert any({"text/html", "image/png"} & kinds for kinds in shown)


@pytest.mark.slow
def test_a_cell_that_raises_fails(tmp_path: Path) -> None:
    content = json.loads(NOTEBOOKS[0].read_text())
    content["cells"] = [content["cells"][1] | {"source": ["assert 1 == 2"]}]
    (tmp_path / "bad.ipynb").write_text(json.dumps(content))
    done = run(tmp_path / "bad.ipynb", tmp_path)
    assert done.returncode != 0
    assert "AssertionError" in done.stderr
    assert not (tmp_path / "made.ipynb").exists()
