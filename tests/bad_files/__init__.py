"""A catalogue of bad files, by theme, and of odd ones that are drawn all the same.

``script/make-bad-files DIR`` writes them; ``tests/cli/test_bad_files.py`` runs them.
"""

from __future__ import annotations

from . import (
    accessors,
    animations,
    cameras,
    containers,
    environments,
    exr_files,
    extensions,
    images,
    lens_files,
    lens_imports,
    materials,
    meshes,
    nodes,
    pass_files,
    uris,
)
from .case import Case, unique

_THEMES = (
    containers,
    nodes,
    accessors,
    meshes,
    materials,
    images,
    cameras,
    animations,
    extensions,
    uris,
    environments,
    exr_files,
    lens_files,
    lens_imports,
    pass_files,
)
CASES: list[Case] = unique(case for theme in _THEMES for case in theme.CASES)
