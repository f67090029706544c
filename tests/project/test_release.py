"""script/release: its check changes nothing, bad input is one error, and a failure leaves no trace.

Each test has a small repository of its own. The packages ``build`` and ``twine`` are stand-ins:
they write a file, say that they ran, or fail.
"""

from __future__ import annotations

import datetime
import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(shutil.which("git") is None, reason="needs git")

ROOT = Path(__file__).resolve().parents[2]
FILES = (
    *("core/version.h", "CHANGELOG.md", "CITATION.cff", "packaging/conda-recipe.yaml"),
    *("script/release", ".gitignore"),
)
VERSION = re.findall(r'DG_VERSION "(.*)"', (ROOT / "core" / "version.h").read_text())[0]
NEXT = "7.8.9rc1"
BUILD = """
import os, pathlib, sys
folder = pathlib.Path(sys.argv[sys.argv.index("--outdir") + 1])
folder.mkdir(parents=True)
version = os.environ.get("BUILDS", pathlib.Path("core/version.h").read_text().split('"')[1])
(folder / f"daguerre-{version}.tar.gz").write_text("")
"""
TWINE = "import os, sys\nprint('twine', *sys.argv[1:])\nsys.exit(int(os.environ.get('TWINE', 0)))"


def git(repository: Path, *words: str) -> str:
    who = ("-c", "user.name=Test", "-c", "user.email=test@example.org")
    command = ["git", "-C", str(repository), *who, *words]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A clone in small whose CHANGELOG is ready for the next version."""
    found = tmp_path / "clone"
    for name in FILES:
        (found / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, found / name)
    text = (found / "CHANGELOG.md").read_text()
    ready = re.sub(r"^## .*$", f"## {NEXT} (not yet released)", text, count=1, flags=re.MULTILINE)
    (found / "CHANGELOG.md").write_text(ready)
    git(found, "init", "--quiet")
    git(found, "add", ".")
    git(found, "commit", "--quiet", "--message", "all")
    tools = tmp_path / "tools"
    tools.mkdir()
    (tools / "build.py").write_text(BUILD)
    (tools / "twine.py").write_text(TWINE)
    return found


def release(repository: Path, *words: str, **variables: str) -> tuple[int, str, str]:
    named = {
        f"GIT_{role}_{what}": "a@b.org"
        for role in ("AUTHOR", "COMMITTER")
        for what in ("NAME", "EMAIL")
    }
    tools = {"PYTHONPATH": str(repository.parent / "tools")}
    found = subprocess.run(
        [sys.executable, str(repository / "script" / "release"), *words],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | named | tools | variables,
    )
    return found.returncode, found.stdout, found.stderr


def state(repository: Path) -> tuple[str, str, list[str]]:
    """Commit, changes and files of a repository."""
    files = sorted(str(p) for p in repository.rglob("*") if ".git" not in p.parts)
    return git(repository, "rev-parse", "HEAD"), git(repository, "status", "--porcelain"), files


def test_check_says_what_would_be_done_and_changes_nothing(repository: Path) -> None:
    before = state(repository)
    code, said, errors = release(repository, NEXT, "--check")
    assert (code, errors) == (0, "")
    assert f"core/version.h: {NEXT}" in said
    assert "python -m build --sdist" in said
    assert "no wheels" in said
    assert said.endswith("nothing is in the way\n")
    assert state(repository) == before


def test_a_release_sets_four_files_builds_and_commits(repository: Path) -> None:
    code, said, errors = release(repository, NEXT)
    assert (code, errors) == (0, "")
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    assert f'#define DG_VERSION "{NEXT}"' in (repository / "core" / "version.h").read_text()
    assert f"\n## {NEXT} ({today})\n" in (repository / "CHANGELOG.md").read_text()
    cited = (repository / "CITATION.cff").read_text()
    assert f"\nversion: {NEXT}\ndate-released: {today}\n" in cited
    assert f"twine check --strict dist/{NEXT}/daguerre-{NEXT}.tar.gz" in said
    assert git(repository, "status", "--porcelain") == ""
    assert git(repository, "log", "-1", "--format=%s") == f"build: release {NEXT}\n"
    assert git(repository, "tag") == ""
    for command in (
        f"git tag --annotate v{NEXT}",
        f"git push origin HEAD v{NEXT}",
        f"gh release download v{NEXT} --dir dist/{NEXT} --clobber",
        f"twine upload dist/{NEXT}/*",
    ):
        assert command in said


def test_wheels_are_made_where_there_is_a_script(repository: Path) -> None:
    script = repository / "script" / "make-wheels"
    script.write_text(f'#!/bin/sh\ntouch "$2/daguerre-{NEXT}-cp311-abi3-linux_x86_64.whl"\n')
    script.chmod(0o755)
    git(repository, "add", ".")
    git(repository, "commit", "--quiet", "--message", "wheels")
    code, said, _ = release(repository, NEXT)
    assert code == 0
    assert f"dist/{NEXT}/daguerre-{NEXT}-cp311-abi3-linux_x86_64.whl" in said


@pytest.mark.parametrize(
    ("variables", "says"),
    [({"TWINE": "1"}, "wanted exit code 0, got 1"), ({"BUILDS": "0.1.0"}, "daguerre-0.1.0.tar.gz")],
)
def test_a_failure_leaves_no_trace(repository: Path, variables: dict[str, str], says: str) -> None:
    before = state(repository)
    code, _, errors = release(repository, NEXT, **variables)
    assert code == 1
    assert says in errors
    assert "are as they were" in errors
    assert state(repository)[:2] == before[:2]
    assert not (repository / "dist" / NEXT).exists()


@pytest.mark.parametrize("version", ["1.0", "v1.0.0", "1.0.0-rc1", "1.0.0rc0", "1.0.0.dev1", ""])
def test_a_version_of_another_form_is_refused(repository: Path, version: str) -> None:
    code, said, errors = release(repository, version)
    assert (code, said) == (2, "")
    assert errors == (
        f"release: error: VERSION: wanted numbers like 1.0.0 or 1.0.0rc1, got {version!r}\n"
    )


def dirty(repository: Path) -> None:
    (repository / "CITATION.cff").write_text("version: 1\n")


def tagged(repository: Path) -> None:
    git(repository, "tag", f"v{NEXT}")


def built(repository: Path) -> None:
    (repository / "dist" / NEXT).mkdir(parents=True)


@pytest.mark.parametrize(
    ("version", "spoil", "says"),
    [
        (NEXT, dirty, "working tree: wanted no changes that are not committed, got CITATION.cff"),
        (NEXT, tagged, f"tag: wanted a version that has none, got v{NEXT}"),
        (NEXT, built, f"dist/{NEXT}: wanted no such folder, got one: remove it"),
        (
            "7.8.9",
            None,
            "CHANGELOG.md: wanted the first section '7.8.9 (not yet released)', "
            f"got '{NEXT} (not yet released)'",
        ),
        ("0.9.0", None, f"version: wanted {VERSION} or later, got 0.9.0"),
    ],
)
def test_it_names_what_is_in_the_way(
    repository: Path, version: str, spoil: object, says: str
) -> None:
    if callable(spoil):
        spoil(repository)
    before = state(repository)
    code, said, errors = release(repository, version)
    assert (code, said, errors) == (2, "", f"release: error: {says}\n")
    code, said, _ = release(repository, version, "--check")
    assert code == 2
    assert f"wrong       {says}\n" in said
    assert state(repository) == before


@pytest.mark.skipif(find_spec("twine") is not None, reason="twine is installed")
def test_a_missing_tool_is_named(repository: Path) -> None:
    (repository.parent / "tools" / "twine.py").unlink()
    code, _, errors = release(repository, NEXT)
    assert code == 2
    assert "wanted the packages build and twine, got no twine: pip install twine" in errors


def test_no_version_is_a_wrong_command_line(repository: Path) -> None:
    assert release(repository)[0] == 2
