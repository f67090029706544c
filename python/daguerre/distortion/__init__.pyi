# Names of the package, imported on first use (lazy_imports.py).
from .model import Distortion as Distortion
from .model import Radial as Radial
from .opencv import BrownConrady as BrownConrady
from .opencv import OpenCV as OpenCV
from .opencv import OpenCVFisheye as OpenCVFisheye
from .projections import Division as Division
from .projections import Equidistant as Equidistant
from .projections import Equisolid as Equisolid
from .projections import Orthographic as Orthographic
from .projections import Stereographic as Stereographic
