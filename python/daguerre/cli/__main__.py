"""``python -m daguerre.cli``."""

import sys

from . import main

sys.exit(main())
