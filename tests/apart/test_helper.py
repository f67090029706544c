"""Helper processes: whatever ends one is one error here, and the next task is done again."""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daguerre.apart import helper as helpers
from daguerre.apart.helper import Answer, Helper, NoHelperError
from daguerre.apart.limits import Limits
from daguerre.errors import InputError, UsageError

ROOT = Path(__file__).resolve().parents[2]
ENOUGH = Limits(60.0, 1 << 30)
SHORT = Limits(0.5, 1 << 30)
SMALL = Limits(60.0, 300_000_000)


@pytest.fixture
def helper() -> Iterator[Helper]:
    made = Helper()
    yield made
    made.end()


def ask(
    helper: Helper, task: str, request: Any = None, limits: Limits = ENOUGH, **more: Any
) -> Any:
    """Result of a task of ``tasks.py``."""
    return answer(helper, task, request, limits, **more).value()


def answer(helper: Helper, task: str, request: Any, limits: Limits = ENOUGH, **more: Any) -> Answer:
    """Answer of a task of ``tasks.py``."""
    return helper.answer(f"tests.apart.tasks:{task}", request, limits, where="f.usd", **more)


def gone(number: int) -> bool:
    """Whether a process ends within some seconds."""
    for _ in range(200):
        try:
            state = Path(f"/proc/{number}/stat").read_text().rsplit(")", 1)[1].split()[0]
        except OSError:
            return True
        if state == "Z":
            return True
        time.sleep(0.05)
    return False


def test_values_cross(helper: Helper) -> None:
    given = {"a": [1, 2.5, (None, True)], "b": float("inf"), "few": np.arange(5.0)}
    found = ask(helper, "echo", given)
    assert found["a"] == given["a"]
    assert found["b"] == given["b"]
    assert np.array_equal(found["few"], given["few"])


def test_large_arrays_cross_and_are_read_only(helper: Helper) -> None:
    many = np.arange(3_000_000.0).reshape(-1, 3)
    found = ask(helper, "echo", [many, many, many[:, ::-1]])
    assert found[0] is found[1]
    assert np.array_equal(found[0], many)
    assert np.array_equal(found[2], many[:, ::-1])
    assert not found[0].flags.writeable
    assert not found[0].base.flags.writeable


@pytest.mark.parametrize(
    ("task", "limits", "words"),
    [
        ("crash", ENOUGH, "the helper process ended by SIGSEGV"),
        ("abort", ENOUGH, "the helper process ended by SIGABRT"),
        ("leave", ENOUGH, "the helper process ended with exit code 7"),
        ("sleep", SHORT, "the helper process took longer than 0.5 s"),
        ("hold", SHORT, "the helper process took longer than 0.5 s"),
        ("chatter", SHORT, "the helper process took longer than 0.5 s"),
        ("shout", SHORT, "the helper process took longer than 0.5 s"),
        ("fill", SMALL, "the helper process took more than 300 MB of memory"),
        ("leap", SMALL, "the helper process took more than 300 MB of memory"),
        ("divide", ENOUGH, "ZeroDivisionError: division by zero"),
    ],
)
def test_each_end_is_one_error(helper: Helper, task: str, limits: Limits, words: str) -> None:
    request = {"leave": 7, "sleep": 60, "hold": 60, "leap": 1 << 33}.get(task)
    with pytest.raises(InputError) as error:
        ask(helper, task, request, limits)
    assert str(error.value) == f"f.usd: cannot read: {words}"
    assert ask(helper, "echo", 5) == 5


def test_errors_keep_class_and_text(helper: Helper) -> None:
    before = ask(helper, "process")
    with pytest.raises(UsageError, match=r"^variant: no \u00e9t\u00e9\udcff$"):
        ask(helper, "refuse", "variant: no \u00e9t\u00e9\udcff")
    assert ask(helper, "process") == before


def test_a_task_goes_on_once_its_limits_have_grown(helper: Helper) -> None:
    """However late they are heard."""

    def heard(text: str) -> Limits:
        time.sleep(0.5)
        return Limits(60.0, 2 << 30)

    assert ask(helper, "ask_and_take", 1_000_000_000, limits=SMALL, heard=heard) == 1_000_000_000


def test_limits_grow_with_what_a_task_tells(helper: Helper) -> None:
    told: list[str] = []

    def heard(text: str) -> Limits:
        told.append(text)
        return ENOUGH

    assert ask(helper, "report", ["a", "b"], heard=heard) == 1
    assert told == ["a", "b"]

    def refuses(text: str) -> Limits:
        raise InputError(f"refused {text}")

    with pytest.raises(InputError, match=r"^refused a$"):
        ask(helper, "report", ["a", "b"], heard=refuses)
    assert ask(helper, "echo", 5) == 5


def test_no_class_comes_unless_it_is_made(helper: Helper) -> None:
    with pytest.raises(InputError, match="a value of a class"):
        ask(helper, "echo", ENOUGH)
    found = answer(helper, "echo", ENOUGH).value(lambda name, state: (name, state))
    assert found[0] == "daguerre.apart.limits:Limits"


def test_an_answer_larger_than_the_memory_is_refused(helper: Helper) -> None:
    asked = Limits(60.0, 200_000_000)
    with pytest.raises(InputError, match=r"took more than 200 MB|a message of"):
        ask(helper, "ones", 250_000_000, asked)


def test_temporary_files_go_with_the_helper(helper: Helper) -> None:
    assert ask(helper, "passing") == 0o700
    file = Path(ask(helper, "folder"))
    assert file.parent.parent == Path(tempfile.gettempdir())
    with pytest.raises(InputError):
        ask(helper, "abort")
    assert not file.parent.exists()


def test_threads_take_turns(helper: Helper) -> None:
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda k: ask(helper, "echo", k), range(40)))
    assert found == list(range(40))


def test_it_ends_when_idle(helper: Helper, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helpers, "IDLE", 0.2)
    number, parent, session = ask(helper, "process")
    assert parent == os.getpid()
    assert session == number
    assert gone(number)
    assert ask(helper, "process")[0] != number


def test_it_does_not_end_within_a_task(helper: Helper, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helpers, "IDLE", 0.1)
    before = ask(helper, "process")
    assert ask(helper, "sleep", 0.6) == 0.6
    assert ask(helper, "process") == before


def test_ctrl_c_ends_it(helper: Helper) -> None:
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it
    number = ask(helper, "process")[0]
    main = threading.main_thread().ident
    assert main is not None
    timer = threading.Timer(0.3, lambda: signal.pthread_kill(main, signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        ask(helper, "sleep", 60)
    assert gone(number)
    assert ask(helper, "echo", 5) == 5


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
def test_a_forked_process_begins_its_own(helper: Helper) -> None:
    before = ask(helper, "process")
    read, write = os.pipe()
    child = os.fork()
    if not child:
        with contextlib.suppress(BaseException):
            os.write(write, pickle.dumps(ask(helper, "process")))
            helper.end()
        os._exit(0)
    os.waitpid(child, 0)
    number, parent, _ = pickle.loads(os.read(read, 1000))
    assert parent == child
    assert number != before[0]
    assert ask(helper, "process") == before
    helper.end()
    assert gone(before[0])


PROGRAM = """
import os, sys, threading, time
from daguerre.apart.helper import Helper
from daguerre.apart.limits import Limits
helper = Helper()
limits = Limits(60.0, 1 << 30)
print(helper.ask("tests.apart.tasks:process", None, limits, where="f")[0], flush=True)
heard = lambda text: print(text, flush=True) or limits
"""


@pytest.mark.parametrize(
    "end",
    ["", "sys.exit(3)", "os.kill(os.getpid(), 9)", "os._exit(0)"],
    ids=["end", "exit", "killed", "left"],
)
def test_it_ends_with_its_parent(end: str, tmp_path: Path) -> None:
    environment = {**os.environ, "TMPDIR": str(tmp_path), "PYTHONPATH": os.pathsep.join(sys.path)}
    words = [sys.executable, "-c", PROGRAM + end]
    done = subprocess.run(
        words, cwd=ROOT, env=environment, stdout=subprocess.PIPE, check=False, timeout=60
    )
    assert gone(int(done.stdout))
    assert not list(tmp_path.iterdir())


def test_it_ends_with_its_parent_while_a_library_holds_it(tmp_path: Path) -> None:
    """The task before has used temporary files; no folder stays."""
    code = (
        PROGRAM
        + """
helper.ask("tests.apart.tasks:passing", None, limits, where="f")
helper.ask("tests.apart.tasks:hold", 60, limits, where="f", heard=heard)
"""
    )
    environment = {**os.environ, "TMPDIR": str(tmp_path), "PYTHONPATH": os.pathsep.join(sys.path)}
    with subprocess.Popen(
        [sys.executable, "-c", code], cwd=ROOT, env=environment, stdout=subprocess.PIPE
    ) as program:
        assert program.stdout is not None
        number = int(program.stdout.readline())
        assert program.stdout.readline() == b"holds\n"
        program.kill()
    assert gone(number)
    assert not list(tmp_path.iterdir())


def test_without_a_python_there_is_none(
    helper: Helper, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for program in ("", str(tmp_path / "none")):
        monkeypatch.setattr(sys, "executable", program)
        with pytest.raises(NoHelperError, match=r"^f.usd: cannot read: no helper process: "):
            ask(helper, "echo")
