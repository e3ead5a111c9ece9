"""The decomposition of tensors."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.recognition.hosvd import hosvd, mode_product, unfold


def test_a_mode_product_is_the_sum_over_that_mode():
    rng = np.random.default_rng(0)
    tensor, matrix = rng.normal(size=(4, 3, 5)), rng.normal(size=(2, 3))
    assert np.allclose(mode_product(tensor, matrix, 1), np.einsum("ijk,mj->imk", tensor, matrix))
    assert np.allclose(unfold(mode_product(tensor, matrix, 1), 1), matrix @ unfold(tensor, 1))


def test_the_core_is_all_orthogonal_and_ordered():
    core = hosvd(np.random.default_rng(1).normal(size=(6, 4, 5))).core
    for mode in range(3):
        gram = unfold(core, mode) @ unfold(core, mode).T
        assert np.allclose(gram, np.diag(np.diag(gram)), atol=1e-9)
        assert (np.diff(np.diag(gram)) <= 1e-9).all()


def test_a_tensor_of_low_rank_needs_no_more():
    rng = np.random.default_rng(2)
    tensor = np.einsum("abc,ia,jb,kc->ijk", *(rng.normal(size=s) for s in ((2, 1, 2), (9, 2), (4, 1), (5, 2))))
    assert np.allclose(hosvd(tensor, (2, 1, 2)).tensor(), tensor)
    assert not np.allclose(hosvd(tensor, (1, 1, 2)).tensor(), tensor)


def test_the_error_of_a_cut_is_near_the_least():
    tensor = np.random.default_rng(3).normal(size=(8, 6, 5))
    cut = hosvd(tensor, (4, 3, 3))
    error = np.linalg.norm(cut.tensor() - tensor)
    lost = sum(np.sum(np.linalg.svd(unfold(tensor, m), compute_uv=False)[r:] ** 2) for m, r in enumerate((4, 3, 3)))
    least = max(np.sum(np.linalg.svd(unfold(tensor, m), compute_uv=False)[r:] ** 2) for m, r in enumerate((4, 3, 3)))
    assert np.sqrt(least) - 1e-9 <= error <= np.sqrt(lost) + 1e-9


def test_signs_are_the_same_whatever_library_computes_them():
    for factor in hosvd(np.random.default_rng(5).normal(size=(6, 4, 5))).factors:
        largest = factor[np.abs(factor).argmax(axis=0), np.arange(factor.shape[1])]
        assert (largest > 0).all()


def test_columns_that_nothing_needs_are_not_kept():
    rng = np.random.default_rng(4)
    tensor = np.einsum("i,j,k->ijk", *(rng.normal(size=n) for n in (9, 4, 5)))
    assert hosvd(tensor).core.shape == hosvd(tensor, (5, 3, 2)).core.shape == (1, 1, 1)


def test_huge_tiny_and_zero_tensors_come_back():
    for size in (0.0, 1e-200, 1e150):
        tensor = size * np.ones((3, 2, 2))
        assert np.allclose(hosvd(tensor).tensor(), tensor, rtol=1e-10, atol=0)


@pytest.mark.parametrize(
    ("tensor", "ranks", "says"),
    [
        (np.zeros((2, 0, 3)), None, r"shape \(2, 0, 3\)"),
        (np.array(1.0), None, "all numbers"),
        (np.full((2, 2), np.nan), None, "fill missing cells"),
        (np.ones((2, 2)), (1,), "ranks"),
        (np.ones((2, 2)), (0, 1), "1 or more"),
    ],
)
def test_what_cannot_be_decomposed_is_refused(tensor: np.ndarray, ranks: tuple[int, ...] | None, says: str):
    with pytest.raises(MetricError, match=says):
        hosvd(tensor, ranks)
