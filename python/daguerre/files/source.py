"""Sources of parsed values: JSON, YAML or XML files that can name the place of an error."""

from __future__ import annotations

import os
from typing import Any

Source = str | os.PathLike[str] | dict[str, Any]
