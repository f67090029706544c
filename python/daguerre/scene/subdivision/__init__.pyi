# Names of the package, imported on first use (lazy_imports.py).
from .refiner import Refiner as Refiner
from .rules import Rules as Rules
from .rules import Subdivision as Subdivision
from .rules import edges_of_chains as edges_of_chains
