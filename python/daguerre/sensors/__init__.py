"""Image sensors: the library, files of the schema ``daguerre-sensor/0.1``, and ``Sensor``."""

from daguerre.lazy_imports import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
