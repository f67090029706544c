"""Rendering for any front end: settings, sessions, jobs with checkpoints, passes and merging."""

from daguerre._core import Cancelled, CancelToken

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
