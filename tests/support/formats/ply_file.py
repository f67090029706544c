"""Reads binary PLY files of triangles, for tests alone."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass
class Ply:
    """A mesh: columns of its vertices by name, and triangles."""

    vertices: dict[str, np.ndarray]
    triangles: np.ndarray

    def columns(self, names: str) -> np.ndarray:
        """Columns side by side."""
        return np.stack([self.vertices[name] for name in names.split()], axis=1)


def read(path: Path) -> Ply:
    """Reads a file; asserts that its header counts all of its bytes."""
    head, _, body = path.read_bytes().partition(b"end_header\n")
    lines = head.decode("ascii").splitlines()
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"]
    counts = {line.split()[1]: int(line.split()[2]) for line in lines if line.startswith("element")}
    names = [line.split()[2] for line in lines if line.startswith("property float")]
    assert "property list uchar int vertex_indices" in lines
    width = 4 * len(names)
    cut = width * counts["vertex"]
    assert len(body) == cut + 13 * counts["face"]
    rows = np.frombuffer(body[:cut], "<f4").reshape(-1, len(names))
    faces = np.frombuffer(body[cut:], [("count", "u1"), ("corners", "<i4", 3)])
    assert (faces["count"] == 3).all()
    return Ply({name: rows[:, i] for i, name in enumerate(names)}, faces["corners"])
