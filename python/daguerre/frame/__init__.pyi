# Names of the package, imported on first use (lazy_imports.py).
from .frame import Frame as Frame
from .picture import Picture as Picture
from .raw import Raw as Raw
