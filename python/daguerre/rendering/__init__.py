"""Rendering for any front end: settings, sessions, jobs with checkpoints, passes and merging."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre._core import Cancelled, CancelToken
from daguerre.lazy_imports import lazy_attributes

if TYPE_CHECKING:
    from .checkpoint import Checkpoint
    from .job import Job
    from .output import Output
    from .photograph import Photograph
    from .picture import Picture, View, in_order
    from .progress import Status
    from .reporter import Control, Finished, Reporter, Stopped
    from .settings import RenderSettings

__all__ = [
    "CancelToken",
    "Cancelled",
    "Checkpoint",
    "Control",
    "Finished",
    "Job",
    "Output",
    "Photograph",
    "Picture",
    "RenderSettings",
    "Reporter",
    "Status",
    "Stopped",
    "View",
    "in_order",
]

if not TYPE_CHECKING:  # type checkers use the imports above, and report other names
    __getattr__, __dir__ = lazy_attributes(
        __name__,
        {
            "Checkpoint": "checkpoint",
            "Control": "reporter",
            "Finished": "reporter",
            "Job": "job",
            "Output": "output",
            "Photograph": "photograph",
            "Picture": "picture",
            "RenderSettings": "settings",
            "Reporter": "reporter",
            "Status": "progress",
            "Stopped": "reporter",
            "View": "picture",
            "in_order": "picture",
        },
    )
