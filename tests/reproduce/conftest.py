"""What all tests of papers that are done again share."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from threadpoolctl import threadpool_limits


@pytest.fixture(autouse=True, scope="module")
def _one_thread() -> Iterator[None]:
    """Products of matrices on one thread, as ``onbeat reproduce`` has them."""
    with threadpool_limits(1, "blas"):
        yield
