# Names of the package, imported on first use (lazy_imports.py).
from .scene import Scene as Scene
