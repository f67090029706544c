"""Flags that set a lens on the bench: the camera's, where they say the same of a lens alone."""

from dataclasses import replace

from daguerre.camera.parameters import CAMERA
from daguerre.lenses.setting import By
from daguerre.parameters.parameter import Parameter

from .from_table import TableFlags

#: Part of a help that shows what is done with the lens.
BENCH = "On the bench"
ZOOM = replace(CAMERA["zoom"], meaning="Focal length of a zoom, mm", panel=None)
FOCUS = replace(
    CAMERA["focus_distance"],
    meaning="Focus distance, m from the pupil",
    default_words="inf",
    panel=None,
)
F_STOP = replace(
    CAMERA["f_stop"],
    meaning="F-stop as engraved",
    default_words="wide open",
    flags=("--f-stop",),
    panel=None,
)


def focus_by(meaning: str, first: str) -> Parameter:
    """``--focus-by`` with a meaning and a default of its own."""
    row = CAMERA["focus_by"]
    choices = tuple(sorted(row.choices, key=lambda choice: choice != first))
    return replace(row, meaning=meaning, choices=choices, default=first, panel=None)


class BenchFlags(TableFlags):
    """How a lens is set; without flags wide open and focused at infinity."""

    focus_by: By | None

    def check(self) -> None:
        """Refuses ways to focus that there are not."""
        self.table["focus_by"].check(self.focus_by, "--focus-by")
