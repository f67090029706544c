"""Keeps one helper process for each process of ours: started on first use, ended when idle."""

from __future__ import annotations

import atexit
import contextlib
import os
import threading
import time
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NoReturn

from daguerre.errors import InputError
from daguerre.files.packing import Make, unpack

from .limits import Limits, too_much
from .link import ANSWER, ERROR, FAULT, HEARD, READY, TASK, TOLD, DamagedError
from .process import EndedError, Process
from .serving import ERRORS, packed

#: Time without a task after which a helper ends, s.
IDLE = 20.0
#: Resident memory from which a helper is replaced before its next task, bytes.
_WORN = 6e8
#: Most characters of a text from a helper.
_LONGEST = 1 << 16
#: Receives a text that a helper sends while it works; returns the limits from then on.
Heard = Callable[[str], Limits]
_all: weakref.WeakSet[Helper] = weakref.WeakSet()


class NoHelperError(InputError):
    """No helper process can be started here."""


@dataclass(frozen=True)
class Answer:
    """Answer of a task, in a stranger's bytes.

    Attributes:
        blocks: A packed value, and its large arrays.
        where: File, for messages.
    """

    blocks: list[Any]
    where: str

    @property
    def size(self) -> int:
        """Its bytes."""
        return sum(map(len, self.blocks))

    def value(self, make: Make | None = None) -> Any:
        """Unpacks it; large arrays are read-only.

        Args:
            make: Makes values of classes, with checks; default: none may come.

        Raises:
            InputError: The answer is damaged.
        """
        if not self.blocks:
            raise InputError(f"{self.where}: cannot read: the helper process sent nothing")
        head, large = bytes(self.blocks[0]), self.blocks[1:]
        try:
            return unpack(head, lambda name: large[int(name) - 1], make or _no_class)
        except InputError as error:
            raise InputError(f"{self.where}: cannot read: {error}") from None


class Helper:
    """A helper process for tasks of one kind; threads take turns, and a fork starts a new helper.

    A task is a function in the helper: ``task(request, tell)``. It takes plain values, and a
    function that sends a text to the parent. It returns plain values, arrays and, if the caller
    makes them, values of classes.
    """

    def __init__(self) -> None:
        self._process: Process | None = None
        self._lock = threading.Lock()
        self._used = threading.Event()
        self._watch: threading.Thread | None = None
        _all.add(self)

    def ask(
        self, task: str, request: object, limits: Limits, *, where: str, heard: Heard | None = None
    ) -> Any:
        """Runs a task in the helper that answers with plain values; see :meth:`answer`.

        Returns:
            Its result; large arrays are read-only.
        """
        return self.answer(task, request, limits, where=where, heard=heard).value()

    def answer(
        self, task: str, request: object, limits: Limits, *, where: str, heard: Heard | None = None
    ) -> Answer:
        """Runs a task in the helper.

        Args:
            task: Function, as ``module:function``.
            request: Plain values.
            limits: Limits of the task.
            where: File, for messages.
            heard: Receives the texts of the task, and returns new limits.

        Raises:
            InputError: The helper ended, sent an invalid message, or met a fault.
            NoHelperError: The helper cannot be started.
            DaguerreError: The error of the task, with the same class and text.
        """
        blocks = packed((task, request))
        with self._lock:
            kind, answer = self._exchange(blocks, limits, where, heard)
            self._await_idle()
        if kind == ANSWER:
            return Answer(answer, where)
        _raise(kind, answer, where, limits)

    def end(self) -> None:
        """Ends a running process, also during a task; a later task starts another."""
        process = self._process
        if self._lock.acquire(blocking=False):
            try:
                self._stop()
            finally:
                self._lock.release()
        elif process is not None:
            process.kill()

    def _exchange(
        self, blocks: list[Any], limits: Limits, where: str, heard: Heard | None
    ) -> tuple[bytes, list[Any]]:
        process = self._started(where)
        try:
            with process.watched():
                process.limit(limits)
                process.link.send(TASK, blocks)
                while True:
                    kind, answer = process.link.receive(lambda: float(process.limits.memory))
                    if kind != TOLD:
                        return kind, answer
                    process.judge()
                    if heard is not None:
                        process.limit(heard(_text(answer, 0)), anew=False)
                    process.link.send(HEARD, [])
        except EndedError as error:
            raise InputError(f"{where}: cannot read: {error}") from None
        finally:
            if not process.alive:
                self._process = None

    def _started(self, where: str) -> Process:
        process = self._process
        if process is not None and (not process.alive or _is_worn(process)):
            self._stop()
        if self._process is None:
            try:
                process = Process()
                with process.watched():
                    kind, _ = process.link.receive(lambda: 1 << 10)
                    if kind != READY:
                        raise DamagedError("no greeting")
            except (OSError, ValueError, EndedError) as error:
                raise NoHelperError(f"{where}: cannot read: no helper process: {error}") from None
            self._process = process
        return self._process

    def _stop(self) -> None:
        if self._process is not None:
            self._process.end()
            self._process = None
        self._used.set()

    def _await_idle(self) -> None:
        """Lets a thread end the process after a while without tasks."""
        self._used.set()
        if self._process is not None and self._watch is None:
            self._watch = threading.Thread(
                target=self._end_idle, name="daguerre helper", daemon=True
            )
            self._watch.start()

    def _end_idle(self) -> None:
        while self._watch is threading.current_thread():
            self._used.clear()
            if self._used.wait(IDLE) or not self._lock.acquire(blocking=False):
                continue
            try:
                if not self._used.is_set():
                    self._stop()
                if self._process is None:
                    self._watch = None
                    return
            finally:
                self._lock.release()

    def before_fork(self) -> None:
        """Ends the thread, which a fork would lose."""
        watch, self._watch = self._watch, None
        if watch is not None and watch is not threading.current_thread():
            self._used.set()
            watch.join()

    def after_fork(self) -> None:
        """Begins the thread again."""
        if self._process is not None and self._lock.acquire(blocking=False):
            try:
                self._await_idle()
            finally:
                self._lock.release()

    def forked(self) -> None:
        """Forgets the parent's process in a forked child."""
        self._lock, self._used, self._watch = threading.Lock(), threading.Event(), None
        process, self._process = self._process, None
        if process is not None:
            with contextlib.suppress(OSError):
                process.forget()


def _is_worn(process: Process) -> bool:
    """Whether a helper keeps much memory; the memory of the last task may take a while to free."""
    for _ in range(20):
        if process.resident <= _WORN:
            return False
        time.sleep(0.02)
    return True


def _no_class(name: object, state: object) -> NoReturn:
    raise ValueError("a value of a class")


def _raise(kind: bytes, answer: list[Any], where: str, limits: Limits) -> NoReturn:
    """Raises the error of a task."""
    name, text = _text(answer, 0), _text(answer, 1)
    if kind == ERROR:
        raise ERRORS.get(name, InputError)(text)
    if kind != FAULT:
        raise InputError(f"{where}: cannot read: the helper process sent an unknown message")
    if name == "MemoryError":
        raise InputError(f"{where}: cannot read: {too_much(limits)}")
    error = InputError(f"{where}: cannot read: {name}: {text[:200]}")
    raise error from RuntimeError(_text(answer, 2))  # with the helper's traceback


def _text(answer: list[Any], place: int) -> str:
    """Text of a message; empty: missing."""
    if place >= len(answer):
        return ""
    return bytes(answer[place])[:_LONGEST].decode("utf-8", "surrogateescape")


def _each(method: str) -> None:
    for helper in list(_all):
        getattr(helper, method)()


os.register_at_fork(
    before=lambda: _each("before_fork"),
    after_in_parent=lambda: _each("after_fork"),
    after_in_child=lambda: _each("forked"),
)
atexit.register(lambda: _each("end"))
