"""Tables of numbers as text, many at a time.

Printing a number in Python takes longer than all the rest of writing a motion file; digits of a whole table are made
by a few integer divisions on arrays instead.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array

_LARGEST = 1e15
"""Scaled numbers beyond this are no longer exact integers in a float64; Python prints them one by one."""


def decimal_rows(table: Array, places: int = 6, between: str = " ") -> bytes:
    """Rows (n, k) of numbers with so many decimal places, one line each; zero has no sign.

    Rounding is to the nearest, halves as they are in binary: what was read from so many places is printed the same.

    Examples
    --------
    >>> decimal_rows(np.array([[1.5, -20.25], [-0.0, 1e-9]]), 3).split()
    [b'1.500', b'-20.250', b'0.000', b'0.000']
    """
    scaled = np.rint(np.abs(table) * 10.0**places)
    if not table.size or scaled.max() >= _LARGEST:
        row = between.join([f"%.{places}f"] * table.shape[1]) + "\n"
        return "".join(row % tuple(values) for values in (table + 0.0).tolist()).encode()
    digits = len(str(int(scaled.max()) // 10**places))
    text = np.empty((*table.shape, 1 + digits + 1 + places + 1), np.uint8)
    kept = np.ones(text.shape, bool)
    whole, part = np.divmod(scaled.astype(np.int64), 10**places)
    for left, at, count in ((part.astype(np.int32), 2 + digits, places), (whole.astype(np.int32), 1, digits)):
        for column in range(at + count - 1, at - 1, -1):
            left, digit = np.divmod(left, 10)
            text[..., column] = digit + ord("0")
    for column in range(1, digits):
        kept[..., column] = whole >= 10 ** (digits - column)
    text[..., 0] = ord("-")
    kept[..., 0] = (table < 0) & (scaled > 0)
    text[..., 1 + digits] = ord(".")
    text[..., -1] = ord(between)
    text[:, -1, -1] = ord("\n")
    return text[kept].tobytes()
