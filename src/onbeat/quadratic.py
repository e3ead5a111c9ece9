"""Convex quadratic programmes with sparse matrices, solved by PIQP's interior-point method.

PIQP takes matrices by columns with their row indices in order, and does not look whether they are: what SciPy's
products return often is not, and is then solved as another programme. All programmes go through here for that reason.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import piqp
from scipy.sparse import csc_matrix, triu

from onbeat._shapes import Array

TOLERANCE = 1e-9


def minimise(
    cost: Any,
    linear: Array,
    rows: Any,
    bounds: tuple[Array, Array],
    *,
    equal: tuple[Any, Array] | None = None,
    box: tuple[Array, Array] | None = None,
    tolerance: float = TOLERANCE,
    gap: float | None = None,
    iterations: int = 250,
    creeping: bool = False,
) -> Array | None:
    """The x (n,) that minimises ``½ xᵀ cost x + linear·x`` with ``low ≤ rows x ≤ high``; None where there is none.

    Parameters
    ----------
    cost : (n, n) sparse, symmetric, or its upper triangle alone.
    linear : (n,).
    rows : (m, n) sparse.
    bounds : (m,) and (m,), infinite where there is none.
    equal : a sparse matrix and what it times x has to be.
    box : (n,) and (n,) bounds of x itself.
    tolerance : absolute, of rows and of the gradient; scale the programme to about 1.
    gap : absolute, of the cost; the tolerance where it is not given.
    iterations : at most.
    creeping : whether an x inside all bounds will do that is not yet the best when the iterations are over.

    Examples
    --------
    >>> from scipy.sparse import eye_array
    >>> x = minimise(eye_array(2), np.array([-3.0, 0.0]), eye_array(2), (np.array([-1.0, -1]), np.array([2.0, 2])))
    >>> x.round(6).tolist()
    [2.0, 0.0]
    """
    solver = piqp.SparseSolver()
    solver.settings.eps_abs = tolerance
    solver.settings.eps_rel = 0.0
    solver.settings.eps_duality_gap_abs = tolerance if gap is None else gap
    solver.settings.eps_duality_gap_rel = 0.0
    solver.settings.max_iter = iterations
    held, value = (None, None) if equal is None else (_sorted(equal[0]), equal[1])
    lower, upper = (None, None) if box is None else box
    solver.setup(_sorted(triu(cost)), linear, held, value, _sorted(rows), *bounds, lower, upper)
    status = solver.solve()
    late = creeping and status == piqp.PIQP_MAX_ITER_REACHED and solver.result.info.primal_res < tolerance
    return np.array(solver.result.x) if status == piqp.PIQP_SOLVED or late else None


def _sorted(matrix: Any) -> csc_matrix:
    out = csc_matrix(matrix)
    if not out.has_canonical_format:
        out = out.copy()
        out.sum_duplicates()
    return out
