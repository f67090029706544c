# Names of the package, imported on first use (lazy_imports.py).
from .camera import Camera as Camera
from .projection import Projection as Projection
from .rolling_shutter import RollingShutter as RollingShutter
