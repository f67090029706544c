"""Workflows of GitHub: valid, with few rights, pinned, and with scripts that exist.

They cannot run here. GitHub's own rules come from the schemas that the package check-jsonschema
brings; the others are good practice that a schema does not know.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / ".github"
WORKFLOWS = {path.stem: path.read_text() for path in sorted(FOLDER.glob("workflows/*.yml"))}
PINNED = re.compile(r"actions/[\w-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+")
#: Rights beyond reading the repository, by workflow and job.
RIGHTS = {("release", "draft"): {"attestations": "write", "contents": "write", "id-token": "write"}}
#: Events that run code of strangers with rights of ours.
UNSAFE = {"pull_request_target", "workflow_run", "issue_comment"}


def schema_faults(schema: str, *paths: Path) -> str:
    """Report on files that break a schema of check-jsonschema, or nothing."""
    pytest.importorskip("check_jsonschema", reason="needs check-jsonschema, of the extra test")
    words = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", f"vendor.{schema}"]
    found = subprocess.run([*words, *map(str, paths)], capture_output=True, text=True, check=False)
    return found.stdout + found.stderr if found.returncode else ""


@pytest.mark.parametrize(
    ("schema", "names"),
    [
        ("github-workflows", ".github/workflows/*.yml"),
        ("github-issue-forms", ".github/ISSUE_TEMPLATE/[!c]*.yml"),
        ("github-issue-config", ".github/ISSUE_TEMPLATE/config.yml"),
        ("dependabot", ".github/dependabot.yml"),
        ("citation-file-format", "CITATION.cff"),
    ],
)
def test_files_follow_their_schemas(schema: str, names: str) -> None:
    paths = sorted(ROOT.glob(names))
    assert paths
    assert schema_faults(schema, *paths) == ""


def test_the_schema_refuses_a_wrong_key(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.yml"
    wrong.write_text(WORKFLOWS["ci"].replace("timeout-minutes", "timeout-minute"))
    assert "timeout-minute" in schema_faults("github-workflows", wrong)


def step_faults(step: dict[str, Any]) -> Iterator[str]:
    """Faults of one step of a job."""
    action, command, given = step.get("uses", ""), step.get("run", ""), step.get("with", {})
    if action.startswith("actions/checkout@") and given.get("persist-credentials", True):
        yield "checkout keeps its credentials"
    if "${{" in command:
        yield "an expression within a command: text of an event could become code"
    if "twine upload" in command:
        yield "an upload, which is left to maintainers"
    for name in re.findall(r"(?<![\w/.])(?:script|\.ci)/[\w-]+", command):
        if not os.access(ROOT / name, os.X_OK):
            yield f"{name}: no such script"
    checked = subprocess.run(["bash", "-n"], input=command, capture_output=True, text=True)
    if checked.returncode:
        yield f"bash: {checked.stderr.strip()}"


def job_faults(workflow: str, name: str, job: dict[str, Any], names: set[str]) -> Iterator[str]:
    """Faults of one job, beside those of its steps."""
    if not 0 < job.get("timeout-minutes", 0) <= 300:
        yield "wanted a limit of time, at most 300 minutes"
    needs = job.get("needs", [])
    for needed in [needs] if isinstance(needs, str) else needs:
        if needed not in names - {name}:
            yield f"needs {needed}: no such job"
    if job.get("permissions", {}) != RIGHTS.get((workflow, name), {}):
        yield f"permissions: {job.get('permissions')}"
    if not job.get("runs-on", "").startswith("ubuntu-2"):
        yield "runs-on: wanted a system with its version"


def faults(name: str, text: str) -> list[str]:
    """Everything wrong with a workflow, by name and text."""
    workflow = yaml.safe_load(text)
    found = []
    if "not run yet" not in text.partition("\n")[0]:
        found.append("head: wanted a comment that says that it has not run yet")
    if workflow.get("permissions") != {"contents": "read"}:
        found.append(f"permissions: {workflow.get('permissions')}")
    found += [f"{word}: none" for word in ("concurrency", "defaults") if word not in workflow]
    for use in re.findall("uses: (.*)", text):
        if not PINNED.fullmatch(use):
            found.append(f"{use}: wanted GitHub's own action, a commit, its version as a comment")
    # YAML 1.1 reads the key `on` as true.
    found += [f"event: {event}" for event in UNSAFE & set(workflow[True])]
    jobs = workflow["jobs"]
    for job_name, job in jobs.items():
        found += [f"{job_name}: {one}" for one in job_faults(name, job_name, job, set(jobs))]
        for step in job["steps"]:
            found += [f"{job_name}: {one}" for one in step_faults(step)]
    return found


@pytest.mark.parametrize("name", WORKFLOWS)
def test_a_workflow_has_no_fault(name: str) -> None:
    assert faults(name, WORKFLOWS[name]) == []


def test_all_workflows_pin_the_same_versions() -> None:
    uses = {use for text in WORKFLOWS.values() for use in re.findall("uses: (.*)", text)}
    actions = [use.partition("@")[0] for use in uses]
    assert sorted(actions) == sorted(set(actions))


def test_each_script_that_decides_is_run() -> None:
    commands = "\n".join(WORKFLOWS.values())
    for name in ("test", "test-all", "fuzz", "make-wheels", "test-wheels"):
        assert f"run: script/{name}" in commands


@pytest.mark.parametrize(
    ("name", "old", "new", "says"),
    [
        ("ci", "not run yet", "run daily", "not run yet"),
        ("ci", "contents: read", "contents: write", "permissions: {'contents': 'write'}"),
        ("ci", "concurrency:", "env:", "concurrency: none"),
        ("ci", "  pull_request:", "  pull_request_target:", "event: pull_request_target"),
        ("ci", "    timeout-minutes: 60\n", "", "test: wanted a limit of time"),
        ("ci", "ubuntu-24.04", "ubuntu-latest", "test: runs-on"),
        ("ci", "run: script/test", "run: script/tests", "test: script/tests: no such script"),
        ("ci", "run: script/test", "run: script/test ${{ github.head_ref }}", "expression"),
        ("ci", "run: script/test", "run: if script/test", "bash: "),
        ("ci", "persist-credentials: false", "fetch-depth: 0", "keeps its credentials"),
        ("ci", " # v7.0.1", "", "its version as a comment"),
        ("nightly", "actions/cache@27d5ce7f10", "actions/cache@v5#", "a commit"),
        ("nightly", "uses: actions/upload", "uses: others/upload", "GitHub's own action"),
        ("release", "needs: [build, test]", "needs: [built, test]", "draft: needs built: no such"),
        ("release", "needs: build", "needs: test", "test: needs test: no such job"),
        ("release", "attestations: write", "packages: write", "draft: permissions"),
        ("release", "run: script/make-wheels", "run: twine upload", "left to maintainers"),
    ],
)  # fmt: skip
def test_faults_are_found(name: str, old: str, new: str, says: str) -> None:
    text = WORKFLOWS[name]
    assert old in text
    assert any(says in fault for fault in faults(name, text.replace(old, new, 1)))
