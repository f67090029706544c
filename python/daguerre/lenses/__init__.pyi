# Names of the package, imported on first use (lazy_imports.py).
from .configurations import Configuration as Configuration
from .errors import LensError as LensError
from .focus import Focused as Focused
from .index import Entry as Entry
from .index import names as names
from .lens import FirstOrder as FirstOrder
from .lens import Lens as Lens
from .lens import Nominal as Nominal
from .lens import Pupil as Pupil
from .library import load as load
from .product import Product as Product
from .reader import read as read
from .search import find as find
from .setting import LensSetting as LensSetting
from .surface import LensSurface as LensSurface
