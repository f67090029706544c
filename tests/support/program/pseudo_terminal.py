"""Pseudo-terminals, which some containers and chroots lack."""

from __future__ import annotations

import os

import pytest


def open_terminal() -> tuple[int, int]:
    """Opens a pseudo-terminal, or skips the test where there is none.

    Returns:
        File descriptors of the leader and the follower.
    """
    pty = pytest.importorskip("pty")
    try:
        leader, follower = pty.openpty()
    except OSError as error:
        pytest.skip(f"no pseudo-terminal here: {error}")
    return leader, follower


def need_terminal() -> None:
    """Skips the test where there is no pseudo-terminal."""
    for descriptor in open_terminal():
        os.close(descriptor)
