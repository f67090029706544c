"""Sources of values: a JSON, YAML or XML file that names the place of each complaint."""

from __future__ import annotations

import os
from typing import Any

Source = str | os.PathLike[str] | dict[str, Any]
