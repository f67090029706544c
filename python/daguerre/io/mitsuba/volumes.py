"""Grids of numbers in files: ``.vol`` of Mitsuba."""

from __future__ import annotations
import numpy as np


def read_grid(node, document):
    data = document.files_of(node).read(node.text("filename"), node.entry)
    kind, x, y, z, c = np.frombuffer(data, "<i4", 5, 4)
    box = np.frombuffer(data, "<f4", 6, 24).astype(float).reshape(2, 3)
    v = np.frombuffer(data, "<f4", x * y * z * c, 48).reshape(z, y, x, c)
    return v, box
