"""The one array type of the package."""

from math import isfinite
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Index: TypeAlias = npt.NDArray[np.intp]
ArrayLike: TypeAlias = npt.ArrayLike

TINY = 1e-150  # keeps 0 / 0 away where a length is zero


def frozen(values: ArrayLike, dtype: Any = float) -> Any:
    """Copy `values` into an array that cannot be written to."""
    array = np.array(values, dtype=dtype)
    array.setflags(write=False)
    return array


def finite(values: Array) -> bool:
    """Check that no number is infinite or NaN."""
    # One product tells of most arrays; only where it is not finite must each number be looked at.
    return isfinite(np.vdot(values, values)) or bool(np.isfinite(values).all())
