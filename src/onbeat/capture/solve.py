"""Poses of all frames at once: the least squares of markers and habits, by Levenberg and Marquardt."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from onbeat._shapes import Array, Ints, Positions
from onbeat.capture.model import MARKER_SIGMA, Model, Placed, Pose
from onbeat.capture.pose import is_seen

CHUNK_BYTES = 30e6
"""Size of the largest array at work; a few of them are held at a time."""
_CALM = 2e-5
"""Radians and metres below which a step is the last."""


def settle(
    model: Model,
    pose: Pose,
    seen: Positions,
    weights: Array,
    reference: Pose,
    outlier_m: float = 0.1,
    rounds: int = 12,
    progress: Callable[[float], None] | None = None,
) -> Pose:
    """The likeliest poses, frame by frame: Levenberg-Marquardt on batches of frames, each with its own damping.

    Minimises ``Σ w ρ(|m − model|) / σ² + habits`` with ``ρ(r) = ½ r² s² / (s² + r²)`` (Geman and McClure 1987, s =
    ``outlier_m``), by iterated reweighting.

    Parameters
    ----------
    pose : where to begin, F frames.
    seen : (F, M, 3) metres; NaN where a marker is not seen.
    weights : (F, M) how much each counts.
    reference : to what joints hold that no marker tells.
    rounds : steps at most.
    progress : is told the part done, 0…1.
    """
    width = 3 * len(model.segments) * (3 + 3 * len(model.moving)) * 8
    size = max(1, int(CHUNK_BYTES / width))
    parts: list[Pose] = []
    for first in range(0, len(seen), size):
        chunk = slice(first, first + size)
        problem = _Problem(model, seen[chunk], weights[chunk], reference.chosen(chunk), outlier_m)
        parts.append(_descend(problem, pose.chosen(chunk), rounds))
        if progress:
            progress(min(1.0, (first + size) / len(seen)))
    return Pose(np.concatenate([p.rotations for p in parts]), np.concatenate([p.root for p in parts]))


class _Problem:
    """The least squares of some frames."""

    def __init__(self, model: Model, seen: Positions, weights: Array, reference: Pose, outlier_m: float) -> None:
        known = is_seen(seen)
        self.model, self.reference, self.outlier_m = model, reference, outlier_m
        self.seen = np.where(known[..., None], seen, 0.0)
        self.weights = np.where(known, weights, 0.0) / MARKER_SIGMA**2

    def chosen(self, frames: Ints) -> _Problem:
        """Some of the frames."""
        part = object.__new__(_Problem)
        part.model, part.outlier_m = self.model, self.outlier_m
        part.seen, part.weights, part.reference = self.seen[frames], self.weights[frames], self.reference.chosen(frames)
        return part

    def cost(self, pose: Pose, placed: Placed) -> Array:
        """(F,) what is minimised."""
        far = np.sum((placed.markers - self.seen) ** 2, axis=-1)
        data = 0.5 * np.sum(self.weights * far / (1 + far / self.outlier_m**2), axis=1)
        return data + self.model.habits(pose, placed, self.reference)[0]

    def normal(self, pose: Pose, placed: Placed) -> tuple[Array, Array]:
        """Hessian (F, D, D), as Gauss and Newton take it, and gradient (F, D)."""
        off = placed.markers - self.seen
        weights = self.weights / (1 + np.sum(off**2, axis=-1) / self.outlier_m**2) ** 2
        jacobian = self.model.jacobian(placed)
        _, gradient, blocks = self.model.habits(pose, placed, self.reference)
        pull = (off * weights[..., None]).reshape(len(off), -1, 1)
        gradient = gradient + (jacobian.transpose(0, 2, 1) @ pull)[..., 0]
        jacobian *= np.repeat(np.sqrt(weights), 3, axis=1)[..., None]
        hessian = jacobian.transpose(0, 2, 1) @ jacobian
        return add_blocks(hessian, blocks), gradient


def add_blocks(hessian: Array, blocks: Array) -> Array:
    """The habits' 3×3 blocks added on the diagonal, and 1 per m² for the root's place."""
    hessian[:, [0, 1, 2], [0, 1, 2]] += 1.0
    for k in range(blocks.shape[1]):
        hessian[:, 3 + 3 * k : 6 + 3 * k, 3 + 3 * k : 6 + 3 * k] += blocks[:, k]
    return hessian


def _descend(problem: _Problem, pose: Pose, rounds: int) -> Pose:
    model = problem.model
    rotations, root = pose.rotations.copy(), pose.root.copy()
    damping = np.full(len(root), 1e-4)
    placed = model.placed(pose)
    cost = problem.cost(pose, placed)
    active = np.arange(len(root))
    for _ in range(rounds):
        part, here = problem.chosen(active), Pose(rotations[active], root[active])
        placed = model.placed(here)
        hessian, gradient = part.normal(here, placed)
        diagonal = np.arange(hessian.shape[1])
        hessian[:, diagonal, diagonal] *= 1 + damping[active, None]
        step = -np.linalg.solve(hessian, gradient[..., None])[..., 0]
        step *= np.minimum(1.0, 1.0 / np.maximum(np.abs(step).max(axis=1, keepdims=True), 1e-12))
        trial = model.turned(here, placed, step)
        new = part.cost(trial, model.placed(trial))
        better = new <= cost[active]
        damping[active] = np.where(better, damping[active] * 0.1, np.maximum(damping[active], 1e-3) * 10)
        won = active[better]
        rotations[won], root[won], cost[won] = trial.rotations[better], trial.root[better], new[better]
        stuck = ~better & (damping[active] > 1e6)
        active = active[~(better & (np.abs(step).max(axis=1) < _CALM)) & ~stuck]
        if not len(active):
            break
    return Pose(rotations, root)
