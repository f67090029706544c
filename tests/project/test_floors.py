"""The order of floors holds in core/, and the check that says so catches planted faults."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def run_check(core: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, str(ROOT / "script" / "check-floors"), str(core)],
        capture_output=True,
        text=True,
        check=False,
    )


def plant(tmp_path: Path, path: str, include: str) -> Path:
    """A small core/ that is in order but for one line."""
    core = tmp_path / "core"
    for good, line in {
        "math/vec.h": "#include <cmath>",
        "camera/camera.h": '#include "math/vec.h"',
        "material/material.h": '#include "geometry/hit.h"',
        "geometry/embree.cpp": "#include <embree4/rtcore.h>",
    }.items():
        (core / good).parent.mkdir(parents=True, exist_ok=True)
        (core / good).write_text(line + "\n")
    file = core / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(f"// planted\n{include}\n")
    return core


def test_core_is_in_order():
    result = run_check(ROOT / "core")
    assert result.returncode == 0, result.stdout + result.stderr


def test_order_without_fault_passes(tmp_path):
    assert run_check(plant(tmp_path, "film/film.h", '#include "math/vec.h"')).returncode == 0


@pytest.mark.parametrize(
    ("path", "include"),
    [
        ("optics/stray/ghost.h", '#include "optics/aim/pupil.h"'),
        ("camera/inverse/chief.h", '#include "camera/camera.h"'),
        ("optics/trace/trace_test.cpp", '#include "optics/first_order/paraxial.h"'),
    ],
)
def test_lower_folder_may_be_included(tmp_path, path, include):
    assert run_check(plant(tmp_path, path, include)).returncode == 0


@pytest.mark.parametrize(
    ("path", "include", "message"),
    [
        ("math/bad.h", '#include "camera/camera.h"', "points up"),
        ("camera/bad.cpp", '#include "scene/scene.h"', "points up"),
        ("camera/bad.h", '  #  include "render/render.h"', "points up"),
        ("film/bad.h", '#include "optics/lens/glass.h"', "neighbour"),
        ("light/bad.cpp", '#include "camera/camera.h"', "neighbour"),
        ("geometry/bad.h", '#include "material/material.h"', "neighbour"),
        ("render/bad.cpp", "#include <embree4/rtcore.h>", "only geometry/embree"),
        ("optics/lens/bad.h", '#include "camera/camera.h"', "points up"),
        ("optics/lens/bad.h", '#include "optics/trace/trace.h"', "points up"),
        ("optics/trace/bad.cpp", '#include "optics/aim/pupil.h"', "points up"),
        ("optics/aim/bad.h", '#include "optics/expansion/series.h"', "points up"),
        ("optics/expansion/bad.h", '#include "optics/stray/ghost.h"', "points up"),
        ("optics/bad.h", '#include "optics/lens/glass.h"', "table of folders"),
        ("optics/cellar/bad.h", '#include "optics/lens/glass.h"', "table of folders"),
        ("camera/bad.h", '#include "camera/inverse/chief.h"', "points up"),
        ("render/bad.cpp", '#include "render/truth/truth.h"', "points up"),
        ("camera/bad.cpp", '#include "film/film.h"', "knows nothing of"),
        ("scene/bad.h", '#include "camera/camera.h"', "knows nothing of"),
        ("transport/bad.h", '#include "camera/camera.h"', "knows nothing of"),
        ("transport/bad.cpp", '#include "film/film.h"', "knows nothing of"),
        ("transport/bad_test.cpp", '#include "camera/inverse/chief.h"', "knows nothing of"),
        ("transport/bad.h", '#include "render/render.h"', "points up"),
        ("scene/bad.cpp", '#include "transport/path.h"', "points up"),
        ("transport/sharing/bad.h", '#include "transport/walk/walk.h"', "points up"),
        ("transport/media/bad.h", '#include "transport/catcher/two_worlds.h"', "points up"),
        ("transport/catcher/bad.h", '#include "transport/path.h"', "points up"),
        ("render/bad.cpp", "#include <math/vec.h>", "written with quotes"),
        ("cellar/bad.h", '#include "math/vec.h"', "not in the table"),
        ("math/bad.h", '#include "vec.h"', "names its room"),
    ],
)
def test_planted_fault_is_caught(tmp_path, path, include, message):
    result = run_check(plant(tmp_path, path, include))
    assert result.returncode == 1
    assert message in result.stdout
    assert f"core/{path}:2" in result.stdout


def test_empty_folder_is_an_error(tmp_path):
    assert run_check(tmp_path).returncode == 2
