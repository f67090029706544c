"""Functions that take rows of a table as keywords: one row says it all."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, get_type_hints

import pytest

from daguerre.analysis.calibrate import (
    CalibrateKeywords,
    SeenKeywords,
    calibrate,
    calibrate_all,
)
from daguerre.camera.parameters.bench import CALIBRATE, SEEN
from daguerre.development import develop
from daguerre.development.parameters import DEVELOP, RecipeKeywords
from daguerre.development.recipe import Recipe
from daguerre.errors import UsageError
from daguerre.parameters.keywords import takes
from daguerre.parameters.table import Table
from daguerre.polynomial import fit, from_lens
from daguerre.polynomial.parameters import EXPANSION, FIT, ExpansionKeywords, FitKeywords
from daguerre.scene.mesh import MESH, MeshKeywords
from daguerre.scene.scene import Scene

#: Tables and keywords of functions.
FACES: dict[Callable[..., Any], tuple[Table, Any]] = {
    calibrate: (CALIBRATE, CalibrateKeywords),
    calibrate_all: (SEEN, SeenKeywords),
    develop: (DEVELOP, RecipeKeywords),
    fit: (FIT, FitKeywords),
    from_lens: (EXPANSION, ExpansionKeywords),
    Scene.add_mesh: (MESH, MeshKeywords),
}
#: Keywords that must be given stand in the function itself.
OWN = {"resolution"}


@pytest.mark.parametrize("face", FACES)
def test_signatures_and_docstrings_show_every_row(face: Callable[..., Any]) -> None:
    table, keywords = FACES[face]
    assert set(keywords.__annotations__) == {row.name for row in table} - OWN
    shown = inspect.signature(face).parameters
    assert not [p for p in shown.values() if p.kind is p.VAR_KEYWORD]
    for row in table:
        default = inspect.Parameter.empty if row.required else row.default
        assert shown[row.name].default == default
        assert "Args: those of" in (face.__doc__ or "") or f"    {row.name}: " in face.__doc__


def test_records_have_the_types_of_the_keywords() -> None:
    assert get_type_hints(Recipe) == get_type_hints(RecipeKeywords)


def test_keywords_are_filled_up_and_checked() -> None:
    assert DEVELOP.filled({}, "develop") == DEVELOP.defaults()
    assert DEVELOP.filled({"grain": 2}, "develop")["grain"] == 2
    with pytest.raises(TypeError, match=r"develop\(\) got an unexpected keyword argument 'gran'"):
        DEVELOP.filled({"gran": 2}, "develop")
    for wrong in (None, -1, "2"):
        with pytest.raises(UsageError, match=r"develop: grain: wanted a number of at least 0"):
            DEVELOP.filled({"grain": wrong}, "develop")
    DEVELOP.filled({"wb": None}, "develop")


def test_a_docstring_without_a_place_stays() -> None:
    @takes(DEVELOP, RecipeKeywords)
    def plain(**keywords: Any) -> None:
        """Does nothing."""

    assert plain.__doc__ == "Does nothing."
    assert list(inspect.signature(plain).parameters) == list(RecipeKeywords.__annotations__)
