# Names of the package, imported on first use (lazy_imports.py).
from daguerre._core import Cancelled as Cancelled
from daguerre._core import CancelToken as CancelToken

from .checkpoint import Checkpoint as Checkpoint
from .job import Job as Job
from .output import Output as Output
from .photograph import Photograph as Photograph
from .picture import Picture as Picture
from .picture import View as View
from .picture import in_order as in_order
from .progress import Status as Status
from .reporter import Control as Control
from .reporter import Finished as Finished
from .reporter import Reporter as Reporter
from .reporter import Stopped as Stopped
from .settings import RenderSettings as RenderSettings
