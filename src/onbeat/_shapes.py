"""Names for the array shapes used everywhere.

F frames, J joints, N points; the last axis is written out. All arrays are frames first.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Any float64 array."""
Float32 = NDArray[np.float32]
"""Any float32 array (stored features, audio)."""
Ints = NDArray[np.int64]
"""Any int64 array."""
Bools = NDArray[np.bool_]
"""Any boolean array."""
Positions = NDArray[np.float64]
"""(..., 3) metres, right-handed, Z up."""
Rotations = NDArray[np.float64]
"""(..., 4) unit quaternions, wxyz."""
Times = NDArray[np.float64]
"""(N,) seconds, increasing."""


def frozen(values: object, dtype: type = np.float64) -> np.ndarray:
    """An array that nobody else can change: the given one where it is read-only and owns its data, else a copy."""
    if isinstance(values, np.ndarray) and values.dtype == dtype and values.base is None and not values.flags.writeable:
        return values
    array = np.array(values, dtype=dtype)
    array.setflags(write=False)
    return array
