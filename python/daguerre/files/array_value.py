"""Values that NumPy takes as one array: ``np.asarray(frame)`` is ``frame.rgb``."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import DTypeLike, NDArray


class ArrayValue:
    """Base of values with one main array: ``class Frame(ArrayValue, array="rgb")``."""

    _array: ClassVar[str]

    def __init_subclass__(cls, *, array: str = "", **more: object) -> None:
        super().__init_subclass__(**more)
        cls._array = array or cls._array

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        """Returns the array; NumPy 1 passes no ``copy``, NumPy 2 True, False or None.

        Args:
            dtype: Type of the elements; None: unchanged.
            copy: Whether to copy; None: only where another type needs it.

        Raises:
            ValueError: ``copy`` is False, and another type needs a copy.
        """
        held: NDArray[Any] = getattr(self, self._array)
        if copy or not (dtype is None or np.dtype(dtype) == held.dtype):
            if copy is False:
                raise ValueError(
                    f"{type(self).__name__}: {self._array}: wanted {held.dtype} without a copy, "
                    f"got {np.dtype(dtype)}"
                )
            return held.astype(dtype or held.dtype)
        return held
