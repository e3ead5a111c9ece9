# The compiled loops take plain arrays and numbers, which numba types itself.
# pyright: reportMissingParameterType=false, reportUnknownParameterType=false
"""Balance by feedback: which forces the soles have to give, and the torques with which the legs make them.

The centre of mass c over the floor's pressure p is a pendulum, ``c̈ = ω² (c − p)``, ``ω² = g / z``. Its diverging part,
the capture point ``ξ = c + ċ / ω``, is brought back to where it is meant to be by moving the pressure,

    p = p* + (1 + k / ω) (ξ − ξ*)        (Englsberger et al. 2011; Kajita et al. 2010),

which is a force ``−m (ω k e + (ω + k) ė)`` on the error e of the centre: poles at −ω and −k. The root's tilt gets a
moment, its height a force, each as a critically damped spring. Force and moment together are a point of pressure; that
is kept inside the soles by a margin, so that no sole tips, and the level force is what it then can be. The corners of
the soles that are meant to touch share the force so that the sum of their squares is least and none pulls (Ott et al.
2011), and the legs' torques are

    τ = τ* − Σ J_iᵀ f_i

with τ* the torques that the dance would need in the air. All gains come from the robot's mass, height and soles.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from onbeat._shapes import Array
from onbeat.robots.model import Robot
from onbeat.robots.simulation.reference import SIDES, Reference

GRAVITY = 9.81
PULLING = 1.5
"""The pole k of the capture point, in ω."""
TILTING = 2.5
"""The natural frequency of the root's tilt, in ω."""
LIFTING = 5.0
"""The natural frequency of the height, in ω."""
MARGIN = 0.15
"""Part of a sole's half width that the pressure stays inside its edges."""
GRIP = 0.5
"""Friction that the controller counts on."""
LIGHT, HEAVY = 0.3, 2.0
"""In weights, the least and most that the floor is asked to carry."""


class Law(NamedTuple):
    """The numbers of the feedback for one robot: 1/s² and 1/s, kg·m², metres."""

    mass: float
    centre: Array
    """(3, 2) stiffness and damping of the centre of mass along x, y, z, over the mass."""
    tilt: Array
    """(3, 2) those of the root's tilt about x, y, z, over the inertia."""
    inertia: Array
    """(3,) of the whole robot about its centre of mass."""
    soles: Array
    """(2, 4, 3) the corners in the feet's frames."""
    inner: Array
    """(2, 4, 3) the corners moved inwards by the margin."""


class Sensed(NamedTuple):
    """Where the robot is, in any frame whose z is up: views that MuJoCo fills."""

    root: Array
    """(9,) orientation of the root."""
    qvel: Array
    """(6 + n,)."""
    centre: Array
    velocity: Array
    feet: Array
    """(2, 3) places of the feet's frames."""
    turns: Array
    """(2, 9) their orientations."""
    jacobians: Array
    """(2, 6, 6 + n) of their places and turns."""


def law_of(robot: Robot, told: Reference, body_inertia: Array) -> Law:
    """The law for a robot and a dance; ``body_inertia`` (3,) kg·m² about the centre of mass."""
    floor = told.corners[0, ..., 2].min()
    omega = float(np.sqrt(GRAVITY / max(told.centre[:, 2].mean() - floor, 0.05)))
    pull, lift, tilt = PULLING * omega, LIFTING * omega, TILTING * omega
    sway = (omega * pull, omega + pull)
    soles = np.stack([robot.feet[side].corners for side in SIDES])
    return Law(
        robot.mass,
        np.array([sway, sway, (lift**2, 2 * lift)]),
        np.tile([tilt**2, 2 * tilt], (3, 1)),
        body_inertia,
        soles,
        inset(soles, MARGIN * float(np.ptp(soles[0, :, 1])) / 2),
    )


def inset(soles: Array, margin: float) -> Array:
    """Corners (2, 4, 3) moved towards the middle of their sole by metres along and across it.

    Examples
    --------
    >>> sole = np.array([[[1.0, 1, 0], [1, -1, 0], [-1, -1, 0], [-1, 1, 0]]])
    >>> inset(sole, 0.25)[0, 0].tolist()
    [0.75, 0.75, 0.0]
    """
    middle = soles.mean(axis=1, keepdims=True)
    away = soles - middle
    away[..., :2] -= np.sign(away[..., :2]) * np.minimum(margin, np.abs(away[..., :2]) / 2)
    return middle + away


@njit(cache=True)
def torques(now, told, tick, law, out):
    """Write the hinges' torques (n,) for the robot as it is sensed, and return whether the pressure was held back."""
    touching = told.touching[tick].copy().reshape(8)
    out[:] = told.torque[tick]
    if touching.sum() < 3:
        return False
    corners, inner = np.empty((8, 3)), np.empty((8, 3))
    _placed(now, law.soles, corners)
    _placed(now, law.inner, inner)
    ahead = _heading(now, told, tick, touching)
    force, moment = _wanted(now, told, tick, law, corners, touching, ahead)
    height = now.centre[2] - _mean(corners, touching)[2]
    x = now.centre[0] - (moment[1] + height * force[0]) / force[2]
    y = now.centre[1] + (moment[0] - height * force[1]) / force[2]
    held, px, py = pressed(inner, touching, x, y)
    # Where the pressure is held back, the force is the one that does not turn the robot, not the one that was wanted.
    force[0] = ((now.centre[0] - px) * force[2] - moment[1]) / height
    force[1] = ((now.centre[1] - py) * force[2] + moment[0]) / height
    share = loads(corners, touching, px, py)
    forces = _shared(corners, share, force, moment, now.centre, px, py)
    _through_legs(now, corners, forces, out)
    return held


@njit(cache=True)
def _placed(now, soles, out):
    for foot in range(2):
        turn = now.turns[foot].copy().reshape(3, 3)
        for corner in range(4):
            out[4 * foot + corner] = now.feet[foot] + turn @ soles[foot, corner]


@njit(cache=True)
def _mean(corners, touching):
    total, count = np.zeros(3), 0
    for n in range(8):
        if touching[n]:
            total += corners[n]
            count += 1
    return total / count


@njit(cache=True)
def _heading(now, told, tick, touching):
    """The turn about z (3, 3) of the standing feet from where they are meant to be: no robot knows where north is."""
    sine, cosine = 0.0, 0.0
    for foot in range(2):
        if touching[4 * foot : 4 * foot + 4].any():
            turn = now.turns[foot].copy().reshape(3, 3) @ told.turns[tick, foot].T
            sine += turn[1, 0] - turn[0, 1]
            cosine += turn[0, 0] + turn[1, 1]
    angle = np.arctan2(sine, cosine)
    out = np.eye(3)
    out[0, 0] = out[1, 1] = np.cos(angle)
    out[1, 0] = np.sin(angle)
    out[0, 1] = -out[1, 0]
    return out


@njit(cache=True)
def _floor_speed(now, corners, touching):
    """The mean velocity of the corners that are meant to stand."""
    total, count = np.zeros(3), 0
    for foot in range(2):
        if not touching[4 * foot : 4 * foot + 4].any():
            continue
        moving = now.jacobians[foot] @ now.qvel
        for corner in range(4):
            n = 4 * foot + corner
            if touching[n]:
                total += moving[:3] + np.cross(moving[3:], corners[n] - now.feet[foot])
                count += 1
    return total / count


@njit(cache=True)
def _wanted(now, told, tick, law, corners, touching, ahead):
    """Force, and moment about the centre of mass, that the floor has to give: the dance's, and what brings it back."""
    root = now.root.copy().reshape(3, 3)
    place = now.centre - _mean(corners, touching)
    meant = ahead @ (told.centre[tick] - _mean(told.corners[tick].copy().reshape(8, 3), touching))
    away = place - meant
    drift = now.velocity - _floor_speed(now, corners, touching) - ahead @ told.velocity[tick]
    force = ahead @ told.force[tick] - law.mass * (law.centre[:, 0] * away + law.centre[:, 1] * drift)
    tilt = _rotation_vector(root @ (ahead @ told.root[tick]).T)
    rolling = root @ now.qvel[3:6] - ahead @ told.spin[tick]
    moment = ahead @ told.moment[tick] - law.inertia * (law.tilt[:, 0] * tilt + law.tilt[:, 1] * rolling)
    weight = law.mass * GRAVITY
    force[2] = min(max(force[2], LIGHT * weight), HEAVY * weight)
    return force, moment


@njit(cache=True)
def _rotation_vector(m):
    out = np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])
    size = np.sqrt(np.sum(out**2))
    angle = np.arctan2(size, m[0, 0] + m[1, 1] + m[2, 2] - 1)
    return out * (0.5 if size < 1e-12 else angle / size)


@njit(cache=True)
def pressed(corners, touching, x, y):
    """Whether (x, y) is outside the hull of the touching corners, and the nearest point that is not.

    Examples
    --------
    >>> square = np.array([[1.0, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    >>> pressed(square, np.ones(4, np.bool_), 2.0, 0.5)
    (True, 1.0, 0.5)
    """
    count, inside = len(corners), True
    nearest, px, py = np.inf, x, y
    for a in range(count):
        for b in range(count):
            dx, dy = corners[b, 0] - corners[a, 0], corners[b, 1] - corners[a, 1]
            length = dx * dx + dy * dy
            if a == b or not touching[a] or not touching[b] or length < 1e-12:
                continue
            edge = True
            for c in range(count):
                if touching[c] and dx * (corners[c, 1] - corners[a, 1]) - dy * (corners[c, 0] - corners[a, 0]) < -1e-9:
                    edge = False
                    break
            if not edge:
                continue
            if dx * (y - corners[a, 1]) - dy * (x - corners[a, 0]) < 0:
                inside = False
            part = min(max(((x - corners[a, 0]) * dx + (y - corners[a, 1]) * dy) / length, 0.0), 1.0)
            ex, ey = corners[a, 0] + part * dx, corners[a, 1] + part * dy
            away = (x - ex) ** 2 + (y - ey) ** 2
            if away < nearest:
                nearest, px, py = away, ex, ey
    return (False, x, y) if inside else (True, px, py)


@njit(cache=True)
def loads(corners, touching, x, y):
    """(N,) the parts of the force that corners carry: they press at (x, y), sum to 1, none pulls, least squares.

    Examples
    --------
    >>> square = np.array([[1.0, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    >>> loads(square, np.ones(4, np.bool_), 0.5, 0.0).round(6).tolist()
    [0.375, 0.125, 0.125, 0.375]
    """
    count, carrying = len(corners), touching.copy()
    out, goal = np.zeros(count), np.array([1.0, 0.0, 0.0])
    row = np.ones(3)
    for _ in range(count):
        gram = np.eye(3) * 1e-12
        for n in range(count):
            if carrying[n]:
                row[1], row[2] = corners[n, 0] - x, corners[n, 1] - y
                gram += np.outer(row, row)
        price = np.linalg.solve(gram, goal)
        least, lightest = -1e-9, -1
        for n in range(count):
            out[n] = 0.0
            if carrying[n]:
                out[n] = price[0] + price[1] * (corners[n, 0] - x) + price[2] * (corners[n, 1] - y)
                if out[n] < least:
                    least, lightest = out[n], n
        if lightest < 0:
            break
        carrying[lightest] = False
    out = np.maximum(out, 0.0)
    return out / max(out.sum(), 1e-9)


@njit(cache=True)
def _shared(corners, share, force, moment, centre, px, py):
    """(8, 3) the corners' forces by their shares; what is missing of the moment about z they make about (px, py)."""
    across = np.sqrt(force[0] ** 2 + force[1] ** 2)
    grip = min(1.0, GRIP * force[2] / max(across, 1e-9))
    out = share.reshape(8, 1) * force.reshape(1, 3)
    out[:, :2] *= grip
    twist = moment[2] + grip * ((centre[0] - px) * force[1] - (centre[1] - py) * force[0])
    arm = np.sum(share * ((corners[:, 0] - px) ** 2 + (corners[:, 1] - py) ** 2))
    most = GRIP * force[2] * np.sqrt(arm)
    turning = min(max(twist, -most), most) / max(arm, 1e-6)
    out[:, 0] -= turning * share * (corners[:, 1] - py)
    out[:, 1] += turning * share * (corners[:, 0] - px)
    return out


@njit(cache=True)
def _through_legs(now, corners, forces, out):
    for foot in range(2):
        wrench = np.zeros(6)
        for n in range(4 * foot, 4 * foot + 4):
            wrench[:3] += forces[n]
            wrench[3:] += np.cross(corners[n] - now.feet[foot], forces[n])
        out -= (now.jacobians[foot].T @ wrench)[6:]
