"""The smallest smooth shift of the hips that brings the zero-moment point inside: one convex programme.

A shift Δ of the root along the floor, the feet staying, moves link i by a share g_i Δ, and so the zero-moment point by

    δ = (g Σ m_i g_i Δ − Σ m_i z_i g_i Δ̈) / f_z,

the linear relation of centre of mass and zero-moment point (Kajita et al. 2003) with the model's own figures.
Compensation usually asks δ to make up for what is missing, an equation, and grows without bound. Here the point has
only to be inside the polygon, and Δ is bounded:

    minimise ‖Δ‖² + ‖jerk‖² + w Σ s_f  over  n_e · (zmp_f + δ_f) ≤ b_e − aim_f + s_f,  |Δ| ≤ bound,  |Δ̇| ≤ speed,

and the legs' hinges, linear in Δ too, inside their limits.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.ndimage import minimum_filter1d
from scipy.sparse import block_array, csr_array, diags_array, eye_array, vstack
from scipy.sparse.linalg import spsolve

from onbeat._shapes import Array, Bools, Positions, Rotations
from onbeat.quadratic import minimise
from onbeat.robots.gentle import Grid
from onbeat.robots.legs.contacts import support
from onbeat.robots.legs.ik import Legs
from onbeat.robots.model import Robot
from onbeat.robots.polygon import Polygons
from onbeat.robots.state import derivatives
from onbeat.robots.zmp import GRAVITY, floor_wrench, link_centres, points

MARGIN = 0.04
"""Metres inside the polygon that are aimed at."""
NARROW = 0.5
"""Part of the way to the middle of a small polygon that is aimed at, where that is less than the margin."""
UNLOADED = 0.02
"""Seconds for which a foot carries nothing before it leaves and after it has come."""
SPEED = 1.0
"""m/s at which the root is shifted at most."""
GUARD = 0.01
"""Radians by which the legs' hinges are to stay inside their limits."""
PROBE = 0.002
"""Metres by which the root is shifted to see what moves with it."""
LIGHTEST = 0.3
"""Part of the weight that presses on the floor at least, in the linear relation."""
PRICE = 1e4
"""Of a metre that the point is outside, against the mean square of the shift in units of the bound."""


@dataclass(frozen=True, eq=False)
class Feet:
    """Where the feet are, what they span, and how far inside to aim, (F,) metres."""

    places: Positions
    turns: Rotations
    polygons: Polygons
    aim: Array

    @classmethod
    def of(cls, legs: Legs, qpos: Array, standing: Bools, fps: float) -> Feet:
        """The feet of configurations (F, 7 + n), those that stand (F, 2) carrying."""
        # A foot that is about to leave, or has just come, does not carry: the point is elsewhere by then.
        around = 2 * round(UNLOADED * fps) + 1
        carrying = minimum_filter1d(standing.astype(np.uint8), around, axis=0, mode="nearest") > 0
        carrying = carrying | (standing & ~carrying.any(axis=1, keepdims=True))
        polygons = support(legs, qpos, carrying)
        widest = polygons.margins(polygons.starts.mean(axis=1))
        return cls(*legs.feet(qpos), polygons, np.minimum(MARGIN, NARROW * widest))


@dataclass(frozen=True, eq=False)
class State:
    """Configurations, the weight (F,) N on the floor, the zero-moment point (F, 2) and its margin (F,) in metres."""

    qpos: Array
    up: Array
    zmp: Array
    margin: Array

    @classmethod
    def of(cls, robot: Robot, qpos: Array, feet: Feet, fps: float) -> State:
        """By inverse dynamics on the whole model."""
        force, moment = floor_wrench(robot, qpos, *derivatives(robot, qpos, fps))
        zmp = points(robot, qpos[:, :3], force, moment)
        return cls(qpos, force[:, 2], zmp, feet.polygons.margins(zmp))


@dataclass(frozen=True, eq=False)
class Programme:
    """What is linear in a shift's control points: the zero-moment point (F, controls), and the legs' hinges.

    Parameters
    ----------
    grid : of the shift's splines.
    bound : metres, the unit of the control points.
    response : sparse, from one axis' control points in metres to the point's way along that axis.
    limits, rooms : sparse rows over both axes' control points in units of the bound, and what they may be at most.
    """

    grid: Grid
    bound: float
    response: Any
    limits: Any
    rooms: Array

    @classmethod
    def of(
        cls, robot: Robot, legs: Legs, state: State, applied: Array, feet: Feet, grid: Grid, bound: float
    ) -> Programme:
        """Linear about a state to which a shift (F, 2) is already applied."""
        weight, lever = _shares(robot, legs, state, feet)
        up = np.maximum(state.up, LIGHTEST * robot.mass * GRAVITY)
        static, dynamic = diags_array(weight * GRAVITY / up), diags_array(lever / up)
        response = csr_array(static @ grid.values() - dynamic @ grid.values(2))
        return cls(grid, bound, response, *_hinge_rows(legs, state, applied, feet, grid, bound))

    def best(self, state: State, applied: Array, feet: Feet) -> Array:
        """The best shift (F, 2) in metres where ``applied`` has already been done; that one where none is found."""
        m, at = self.grid.controls, self.grid.values()
        inside, room = self._inside(state, applied, feet)
        speed = self.grid.differences(1) * (self.bound / SPEED)
        slow = _wide(block_array([[speed, None], [None, speed]]), self.grid.frames)
        rows = vstack((inside, slow, _wide(self.limits, self.grid.frames)))
        free = [-1e4] * len(room), [-1.0] * (2 * m - 2), [-1e4] * len(self.rooms)
        bounds = np.concatenate(free), np.concatenate((room, np.ones(2 * m - 2), self.rooms))
        found = minimise(*self._cost(), rows, bounds, box=self._box(), tolerance=1e-6, iterations=100, creeping=True)
        if found is None:
            return applied
        return np.stack([at @ found[:m], at @ found[m : 2 * m]], axis=1) * self.bound

    def _inside(self, state: State, applied: Array, feet: Feet) -> tuple[Any, Array]:
        """Rows over control points and slacks, one an edge and frame, and what they may be at most."""
        normals = feet.polygons.normals
        frames, edges = normals.shape[:2]
        before = np.stack([self.response @ _controls(self.grid, each) for each in applied.T], axis=1)
        room = feet.polygons.offsets - feet.aim[:, None] - np.einsum("fed,fd->fe", normals, state.zmp - before)
        each = np.arange(frames * edges)
        spread = csr_array((np.ones(len(each)), (each, each // edges)))
        across = [diags_array(normals[..., d].ravel()) @ spread @ self.response * self.bound for d in range(2)]
        return block_array([[*across, -spread]]), room.ravel()

    def _cost(self) -> tuple[Any, Array]:
        form, frames = self.grid.closeness() + self.grid.roughness(), self.grid.frames
        cost = block_array([[form, None, None], [None, form, None], [None, None, eye_array(frames) * 1e-6]])
        return cost, np.concatenate((np.zeros(2 * self.grid.controls), np.full(frames, PRICE / frames)))

    def _box(self) -> tuple[Array, Array]:
        ones, frames = np.ones(2 * self.grid.controls), self.grid.frames
        return np.concatenate((-ones, np.zeros(frames))), np.concatenate((ones, np.full(frames, 1e4)))


def _wide(rows: Any, slacks: int) -> Any:
    return block_array([[rows, csr_array((rows.shape[0], slacks))]])


def _shares(robot: Robot, legs: Legs, state: State, feet: Feet) -> tuple[float, float]:
    """Σ m_i g_i in kg and Σ m_i z_i g_i in kg·m: what moves with the root, on the mean of some frames."""
    some = np.linspace(0, len(state.qpos) - 1, 24).astype(np.int64)
    here, moved = state.qpos[some], state.qpos[some].copy()
    moved[:, :2] += PROBE
    moved = legs.standing(moved, feet.places[some], feet.turns[some])[0]
    before, after = link_centres(robot, here), link_centres(robot, moved)
    share = (after - before)[..., :2].mean(axis=-1) / PROBE
    mass = robot.model.body_mass
    return float((share @ mass).mean()), float(((share * before[..., 2]) @ mass).mean())


def _hinge_rows(legs: Legs, state: State, applied: Array, feet: Feet, grid: Grid, bound: float) -> tuple[Any, Array]:
    """Rows over both axes' control points, in parts of the bound, that keep the legs' hinges inside their limits."""
    angles, slopes, low, high = _slopes(legs, state, feet)
    rows: list[Any] = []
    rooms: list[Array] = []
    reach = bound * np.abs(slopes).sum(axis=-1)
    at = grid.values()
    for sign, limit in ((1.0, high), (-1.0, low)):
        frames, hinges = np.nonzero(sign * (angles - limit) + 2 * reach > 0)
        lean = sign * slopes[frames, hinges]
        room = sign * (limit[hinges] - angles[frames, hinges]) + np.sum(lean * applied[frames], axis=1) - GUARD
        rows.append(block_array([[diags_array(lean[:, d] * bound) @ at[frames] for d in range(2)]]))
        # Unshifted the legs are inside: a shift of nothing must not be refused for what is not linear.
        rooms.append(np.maximum(room, 0.0))
    return vstack(rows), np.concatenate(rooms)


def _slopes(legs: Legs, state: State, feet: Feet) -> tuple[Array, Array, Array, Array]:
    """Both legs' angles (F, k), what a metre of shift does to them (F, k, 2), and their limits (k,)."""
    hinges = np.concatenate([leg.hinges for leg in legs.both])
    slopes = np.empty((len(state.qpos), len(hinges), 2))
    for axis in range(2):
        moved = state.qpos.copy()
        moved[:, axis] += PROBE
        solved = legs.standing(moved, feet.places, feet.turns, warm=True)[0]
        slopes[..., axis] = (solved - state.qpos)[:, 7 + hinges] / PROBE
    low, high = (np.concatenate([getattr(leg, key) for leg in legs.both]) for key in ("low", "high"))
    return state.qpos[:, 7 + hinges], slopes, low, high


def _controls(grid: Grid, values: Array) -> Array:
    """The control points whose spline is nearest to values (F,)."""
    at = grid.values()
    return np.asarray(spsolve((at.T @ at + 1e-9 * eye_array(grid.controls)).tocsc(), at.T @ values))
