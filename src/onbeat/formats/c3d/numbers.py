"""The numbers of C3D files: Intel, DEC and MIPS.

All three have 16-bit integers and 32-bit floats. Intel's bytes run from low to high, MIPS's from high to low, both
with IEEE floats. DEC's integers are Intel's; its floats are VAX F: two 16-bit words, the one with the sign first,
``(−1)^s · 0.1f · 2^(e − 128)``, which is a quarter of what IEEE makes of the same bits. Exponent 0 is zero, with the
sign set it is no number.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from onbeat._shapes import Float32


class Numbers(NamedTuple):
    """How one kind of processor writes its numbers.

    Examples
    --------
    >>> NUMBERS[86].words(bytes([1, 2])).tolist(), NUMBERS[85].floats(bytes([0x80, 0x40, 0, 0])).tolist()
    ([258], [1.0])
    """

    name: str
    order: str
    vax: bool = False

    @property
    def word(self) -> np.dtype[np.int16]:
        """The type of a signed 16-bit integer."""
        return np.dtype(f"{self.order}i2")

    @property
    def float_bits(self) -> np.dtype[np.uint32]:
        """The type of the bits of a float; :meth:`decoded` makes numbers of them."""
        return np.dtype(f"{self.order}u4")

    def words(self, data: bytes) -> NDArray[np.int64]:
        """Whole 16-bit integers without sign."""
        return np.frombuffer(data[: len(data) // 2 * 2], f"{self.order}u2").astype(np.int64)

    def floats(self, data: bytes) -> Float32:
        """32-bit floats, in the order of the file."""
        return self.decoded(np.frombuffer(data[: len(data) // 4 * 4], self.float_bits))

    def decoded(self, bits: NDArray[np.uint32]) -> Float32:
        """Numbers of any shape from the bits of the file."""
        native = bits.astype(np.uint32)
        return _from_vax(native) if self.vax else native.view(np.float32)


NUMBERS = {84: Numbers("Intel", "<"), 85: Numbers("DEC", "<", True), 86: Numbers("MIPS", ">")}
"""By the fourth byte of a parameter section."""


def _from_vax(bits: NDArray[np.uint32]) -> Float32:
    """IEEE floats from VAX F, exact but for the very smallest."""
    bits = (bits << np.uint32(16)) | (bits >> np.uint32(16))
    exponent = (bits >> np.uint32(23)) & np.uint32(0xFF)
    sign = bits >> np.uint32(31)
    # Two less in the exponent is a quarter; the largest exponent would otherwise be IEEE's infinity.
    quarter = np.where(exponent > 2, bits - np.uint32(2 << 23), 0).astype(np.uint32).view(np.float32)
    tiny = np.where((exponent > 0) & (exponent <= 2), bits, 0).astype(np.uint32).view(np.float32) * np.float32(0.25)
    return np.where((exponent == 0) & (sign == 1), np.float32(np.nan), quarter + tiny)
