# Names of the package, imported on first use (lazy_imports.py).
from daguerre._core import Iris as Iris

from .elements import place as place
from .elements import propagate as propagate
from .elements import reflect as reflect
from .elements import refract as refract
from .fitting import fit as fit
from .forms import Form as Form
from .forms import asphere as asphere
from .forms import biconic as biconic
from .forms import conic as conic
from .forms import cylinder as cylinder
from .forms import plane as plane
from .forms import sphere as sphere
from .forms import toroid as toroid
from .ghosts import GhostError as GhostError
from .ghosts import GhostPolynomial as GhostPolynomial
from .ghosts import PolynomialGhosts as PolynomialGhosts
from .ghosts import expand_ghost as expand_ghost
from .lens_fit import ErrorZone as ErrorZone
from .lens_fit import LensFit as LensFit
from .lens_fit import SceneRays as SceneRays
from .lens_system import from_lens as from_lens
from .system import System as System
from .terms import SeidelTerms as SeidelTerms
from .wavelengths import wavelength_nodes as wavelength_nodes
