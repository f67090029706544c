"""`python -m daguerre` is the command `daguerre`."""

import sys

from daguerre.cli import main

if __name__ == "__main__":
    sys.exit(main())
