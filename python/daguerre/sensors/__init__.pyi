# Names of the package, imported on first use (lazy_imports.py).
from .curve import Curve as Curve
from .data import DarkCurrent as DarkCurrent
from .data import DualGain as DualGain
from .data import HotPixels as HotPixels
from .ideal_sensor import ideal as ideal
from .library import load as load
from .library import names as names
from .mosaic import PATTERNS as PATTERNS
from .mosaic import Mosaic as Mosaic
from .reader import read as read
from .sensor import Sensor as Sensor
