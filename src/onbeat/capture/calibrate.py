"""One body for all frames: bone lengths and where the markers sit, found together with the poses of chosen frames."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Positions
from onbeat.capture.body import Template
from onbeat.capture.model import MARKER_SIGMA, Model, Placed, Pose
from onbeat.capture.pose import is_seen
from onbeat.capture.solve import add_blocks

INDEPENDENT = 20.0
"""Frames may be many, but what is wrong in one is wrong in its neighbours: they count as so many together."""
SCALE_SIGMA = 0.08
"""Part by which a bone may well differ from the first guess."""


class Calibration(NamedTuple):
    """A body as it is refined.

    Parameters
    ----------
    scales : (groups,) of the bones.
    places : (M, 3) metres, the markers' offsets in their segments.
    pose : of the chosen frames.
    """

    scales: Array
    places: Array
    pose: Pose


class Prior(NamedTuple):
    """What is believed of a body before: scales and places, and how surely.

    Parameters
    ----------
    scales, scale_sigma : (groups,).
    places, spread : (M, 3) metres.
    """

    scales: Array
    scale_sigma: Array
    places: Array
    spread: Array


def calibrate(
    body: Template, offsets: Array, model: Model, prior: Prior, seen: Positions, pose: Pose, rounds: int = 20
) -> Calibration:
    """Bone lengths and marker places that suit the chosen frames best.

    All is solved at once, as in a bundle adjustment: with the poses' blocks A, the shape's block C and B between them
    each step solves ``(C − Σ Bᵀ A⁻¹ B) ds = −(g_s − Σ Bᵀ A⁻¹ g_p)`` and then each frame's ``A dp = −g_p − B ds``.

    Parameters
    ----------
    body, offsets : the template and (J, 3) metres, its bones before they are scaled.
    model : which marker is on which segment; its skeleton and offsets are not used.
    seen : (F, M, 3) metres of the chosen frames, NaN where unseen.
    pose : their first guess.
    """
    state = Calibration(prior.scales, prior.places, pose)
    damping = 1e-3
    bundle = _Bundle(body, offsets, model, prior, seen, pose)
    cost = bundle.cost(state)
    for _ in range(rounds):
        trial, step = bundle.step(state, damping)
        new = bundle.cost(trial)
        if new <= cost:
            state, damping = trial, damping * 0.2
            if cost - new < 1e-5 * cost or step < 1e-5:
                break
            cost = new
        else:
            damping *= 10
    return state


class _Bundle:
    """Poses and shape of the chosen frames as one problem."""

    def __init__(
        self, body: Template, offsets: Array, model: Model, prior: Prior, seen: Positions, reference: Pose
    ) -> None:
        self.body, self.offsets, self.like, self.prior = body, offsets, model, prior
        known = is_seen(seen)
        self.seen = np.where(known[..., None], seen, 0.0)
        self.weights = known / MARKER_SIGMA**2
        rest = np.zeros_like(reference.rotations)
        rest[..., 0] = 1.0
        self.reference = Pose(rest, reference.root)
        self.emphasis = len(seen) / INDEPENDENT

    def model(self, state: Calibration) -> Model:
        """The model of a shape."""
        skeleton = self.body.scaled(state.scales, self.offsets)
        return Model(skeleton, self.like.segments, self.like.anchors, state.places)

    def cost(self, state: Calibration) -> float:
        """What is minimised."""
        model = self.model(state)
        placed = model.placed(state.pose)
        far = np.sum((placed.markers - self.seen) ** 2, axis=-1)
        data = 0.5 * np.sum(self.weights * far / (1 + far / _OUTLIER_M**2))
        shape = np.sum(((state.scales - self.prior.scales) / self.prior.scale_sigma) ** 2)
        shape += np.sum(((state.places - self.prior.places) / self.prior.spread) ** 2)
        return float(data + model.habits(state.pose, placed, self.reference)[0].sum() + 0.5 * self.emphasis * shape)

    def step(self, state: Calibration, damping: float) -> tuple[Calibration, float]:
        """The state after a step, and the size of the step."""
        model = self.model(state)
        placed = model.placed(state.pose)
        off = placed.markers - self.seen
        root = np.sqrt(self.weights) / (1 + np.sum(off**2, axis=-1) / _OUTLIER_M**2)
        rows = np.repeat(root, 3, axis=1)[..., None]
        moves, shapes = model.jacobian(placed) * rows, self.shape_jacobian(model, placed) * rows
        error = off.reshape(len(off), -1, 1) * rows
        _, habits, blocks = model.habits(state.pose, placed, self.reference)
        a = add_blocks(moves.transpose(0, 2, 1) @ moves, blocks)
        diagonal = np.arange(a.shape[1])
        a[:, diagonal, diagonal] *= 1 + damping
        b, gp = moves.transpose(0, 2, 1) @ shapes, (moves.transpose(0, 2, 1) @ error)[..., 0] + habits
        ds, solved = self._shape_step(state, shapes, error, a, b, gp, damping)
        dp = -solved[..., 0] - solved[..., 1:] @ ds
        size = max(float(np.abs(dp).max()), float(np.abs(ds).max()))
        dp *= np.minimum(1.0, 0.7 / np.maximum(np.abs(dp).max(axis=1, keepdims=True), 1e-12))
        groups = len(state.scales)
        scales = np.clip(state.scales + ds[:groups], 0.2, 3.0)
        places = state.places + ds[groups:].reshape(-1, 3)
        return Calibration(scales, places, model.turned(state.pose, placed, dp)), size

    def _shape_step(
        self, state: Calibration, shapes: Array, error: Array, a: Array, b: Array, gp: Array, damping: float
    ) -> tuple[Array, Array]:
        """The shape's step, and A⁻¹ [g_p, B] of each frame."""
        precision = np.concatenate((self.prior.scale_sigma**-2, (self.prior.spread**-2).ravel())) * self.emphasis
        away = np.concatenate((state.scales - self.prior.scales, (state.places - self.prior.places).ravel()))
        solved = np.linalg.solve(a, np.concatenate((gp[..., None], b), axis=-1)).astype(np.float64)
        c = np.einsum("fri,frj->ij", shapes, shapes, optimize=True) + np.diag(precision)
        c -= np.einsum("fdi,fdj->ij", b, solved[..., 1:], optimize=True)
        g = np.einsum("fri,fr->i", shapes, error[..., 0]).astype(np.float64) + precision * away
        g -= np.einsum("fdi,fd->i", b, solved[..., 0])
        c[np.diag_indices(len(c))] *= 1 + damping
        return -np.linalg.solve(c, g), solved

    def shape_jacobian(self, model: Model, placed: Placed) -> Array:
        """(F, 3M, groups + 3M) how the markers move with the scales and with their own places."""
        frames, count = placed.markers.shape[:2]
        groups = len(self.body.groups)
        j = np.zeros((frames, count, 3, groups + 3 * count))
        parents = model.skeleton.parents
        bones = np.einsum("fjab,jb->fja", placed.turns[:, parents[1:]], self.offsets[1:])
        for joint in range(1, len(parents)):
            moved = np.flatnonzero(model.above[model.anchors, joint])
            j[:, moved, :, self.body.group[joint]] += bones[:, joint - 1, :][None]
        for marker in range(count):
            at = groups + 3 * marker
            j[:, marker, :, at : at + 3] = placed.turns[:, model.segments[marker]]
        return j.reshape(frames, 3 * count, -1)


_OUTLIER_M = 0.1
