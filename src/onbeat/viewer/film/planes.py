"""Pictures as video has them: a plane of brightness and two of colour at half the size, compiled.

By hand, as the usual converter rounds differently with where in memory a picture happens to lie.
"""

from __future__ import annotations

import numba
import numpy as np


@numba.njit(cache=True, nogil=True)
def yuv420(picture: np.ndarray) -> np.ndarray:
    """(H * 3 / 2, W) uint8 planes Y, U, V one below the other, of a picture (H, W, 3) uint8 of even size.

    ITU-R BT.709, limited range, in whole numbers; a colour is the mean of its four pixels.

    Examples
    --------
    >>> yuv420(np.full((2, 2, 3), 255, np.uint8)).tolist()
    [[235, 235], [235, 235], [128, 128]]
    """
    height, width = picture.shape[0], picture.shape[1]
    planes = np.empty((height + height // 2, width), np.uint8)
    flat = planes.reshape(-1)
    first_u = height * width
    first_v = first_u + height * width // 4
    for row in range(0, height, 2):
        for column in range(0, width, 2):
            red, green, blue = 0, 0, 0
            for point in range(4):
                i, j = row + (point >> 1), column + (point & 1)
                r, g, b = int(picture[i, j, 0]), int(picture[i, j, 1]), int(picture[i, j, 2])
                planes[i, j] = 16 + ((11966 * r + 40254 * g + 4064 * b + 32768) >> 16)
                red += r
                green += g
                blue += b
            at = (row >> 1) * (width >> 1) + (column >> 1)
            flat[first_u + at] = 128 + ((-6596 * red - 22189 * green + 28785 * blue + 131072) >> 18)
            flat[first_v + at] = 128 + ((28785 * red - 26145 * green - 2640 * blue + 131072) >> 18)
    return planes
