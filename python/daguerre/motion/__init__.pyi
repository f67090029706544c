# Names of the package, imported on first use (lazy_imports.py).
from .values import Keys as Keys
from .values import Spin as Spin
from .values import keys as keys
from .values import spin as spin
