"""Runs one case here, with its traceback: ``python -m tests.abuse PATH NUMBER``."""

import sys
import tempfile
from pathlib import Path

from .calls import run
from .world import World

with tempfile.TemporaryDirectory() as folder:
    print(run(sys.argv[1], int(sys.argv[2]), World(Path(folder)), print))
