# The compiled functions take plain arrays and numbers, which numba types itself.
# pyright: reportMissingParameterType=false, reportUnknownParameterType=false
"""What a robot knows of itself: joint encoders and an inertial sensor in its pelvis, late and noisy.

The orientation is the gyroscope's, integrated, and turned slowly to where the accelerometer says that up is (Mahony et
al. 2008, with the acceleration that the dance itself has taken away):

    Ṙ = R [ω − b + k (u × Rᵀ z)]ₓ,   ḃ = −k² / 4 (u × Rᵀ z)

with u the measured up. Where the robot is, and which way it faces, it does not know, and need not.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from onbeat._shapes import Array
from onbeat.errors import BodyError
from onbeat.robots.simulation.reference import Reference

GRAVITY = 9.81
SLOW = 0.5
"""1/s, the gain k of the accelerometer: a second or two of wrong accelerations turn the estimate little."""


@dataclass(frozen=True)
class Noise:
    """Errors of the sensors, each one's standard deviation; those of one reading, or of a whole trial.

    Parameters
    ----------
    gyro : rad/s of a reading.
    gyro_bias : rad/s of a trial.
    acceleration : m/s² of a reading.
    acceleration_bias : m/s² of a trial; a tenth tilts the robot by 0.6°.
    step : radians between two numbers of an encoder.
    smoothing : Hz, the corner of the low-pass filter behind the differences of the encoders.
    """

    gyro: float = 0.005
    gyro_bias: float = 0.005
    acceleration: float = 0.1
    acceleration_bias: float = 0.05
    step: float = 2 * np.pi / 2**14
    smoothing: float = 40.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not 0 <= value < 1e3:
                raise BodyError(f"sensors with {name} = {value:g} cannot be; a number from 0 on is expected")
        if self.smoothing <= 0:
            raise BodyError("a low-pass filter at 0 Hz lets nothing through; a frequency above zero is expected")


class State(NamedTuple):
    """Configuration (7 + n) and velocity (6 + n) as the controller takes them to be."""

    qpos: Array
    qvel: Array


def brought_on(state: State, told: Reference, then: int, now: int) -> State:
    """A state as it was at one tick, and since then moved as the dance moves: what is known late is not taken for now.

    Examples
    --------
    >>> told = np.array([[0.0, 0, 1, 1, 0, 0, 0, 0.1], [0.0, 0, 1, 1, 0, 0, 0, 0.3]]), np.zeros((2, 7))
    >>> early = State(np.array([0.0, 0, 1, 1, 0, 0, 0, 0.05]), np.zeros(7))
    >>> brought_on(early, Reference(*told, *[told[0]] * 10), 0, 1).qpos[7].round(6).item()
    0.25
    """
    if then == now:
        return state
    rest = state.qpos + told.qpos[now] - told.qpos[then]
    _turned_on(state.qpos[3:7], told.qpos[then, 3:7], told.qpos[now, 3:7], rest[3:7])
    return State(rest, state.qvel + told.qvel[now] - told.qvel[then])


class Truth:
    """The robot's state as it is, or as it was some ticks ago."""

    def __init__(self, told: Reference, late: int) -> None:
        self.told, self._late = told, late
        self._line = deque[State](maxlen=late + 1)

    def state(self, data: Any, tick: int) -> State:
        """The oldest state in the line, brought on to this tick."""
        self._line.append(State(data.qpos.copy(), data.qvel.copy()))
        return brought_on(self._line[0], self.told, max(tick - self._late, 0), tick)


class _Reading(NamedTuple):
    gyro: Array
    acceleration: Array
    angles: Array


class Estimate:
    """The robot's state as it can be known from its sensors.

    Parameters
    ----------
    told : what the robot does; it begins in the first pose.
    rate : readings a second.
    late : ticks between a reading and its use.
    noise : the sensors' errors.
    rng : where they are drawn from.
    """

    def __init__(self, told: Reference, rate: float, late: int, noise: Noise, rng: np.random.Generator) -> None:
        self.told, self._rate, self._noise, self._rng = told, rate, noise, rng
        self._line = deque[_Reading](maxlen=late + 1)
        self._gyro_bias = rng.normal(0, noise.gyro_bias, 3)
        self._acceleration_bias = rng.normal(0, noise.acceleration_bias, 3)
        self._turn, self._bias = told.qpos[0, 3:7].copy(), np.zeros(3)
        self._angles, self._speeds = told.qpos[0, 7:].copy(), np.zeros(told.torque.shape[1])
        self._passed = 1 - np.exp(-2 * np.pi * noise.smoothing / rate)
        self._late = late

    def state(self, data: Any, tick: int) -> State:
        """Read the sensors, and tell the state from what has come through; at the origin, whose speed is not known."""
        self._line.append(self._read(data))
        reading = self._line[0]
        then = max(tick - self._late, 0)
        spin = self._turned(reading, then)
        self._speeds += self._passed * ((reading.angles - self._angles) * self._rate - self._speeds)
        self._angles = reading.angles
        still = np.zeros(3)
        known = State(np.concatenate((still, self._turn, self._angles)), np.concatenate((still, spin, self._speeds)))
        return brought_on(known, self.told, then, tick)

    def _read(self, data: Any) -> _Reading:
        noise, specific, up = self._noise, np.empty(3), np.array([0, 0, GRAVITY])
        _seen_from(data.qpos[3:7], data.qacc[:3] + up, specific)
        step = max(noise.step, 1e-12)
        return _Reading(
            data.qvel[3:6] + self._gyro_bias + self._rng.normal(0, noise.gyro, 3),
            specific + self._acceleration_bias + self._rng.normal(0, noise.acceleration, 3),
            np.round(data.qpos[7:] / step) * step,
        )

    def _turned(self, reading: _Reading, tick: int) -> Array:
        """Turn the estimate by one reading; the angular velocity (3,) in the root's frame."""
        told, spin = self.told.qvel, np.empty(3)
        before, after = max(tick - 1, 0), min(tick + 1, len(told) - 1)
        meant = (told[after, :3] - told[before, :3]) * self._rate / max(after - before, 1)
        _filtered(self._turn, self._bias, reading.gyro, reading.acceleration, meant, 1 / self._rate, spin)
        return spin


@njit(cache=True, nogil=True)
def _product(a, b, sign, out):
    """Hamilton's product of a, its vector times sign (−1 for the inverse), and b."""
    aw, ax, ay, az = a[0], sign * a[1], sign * a[2], sign * a[3]
    bw, bx, by, bz = b[0], b[1], b[2], b[3]
    out[0] = aw * bw - ax * bx - ay * by - az * bz
    out[1] = aw * bx + ax * bw + ay * bz - az * by
    out[2] = aw * by - ax * bz + ay * bw + az * bx
    out[3] = aw * bz + ax * by - ay * bx + az * bw


@njit(cache=True, nogil=True)
def _turned_on(turn, before, after, out):
    step = np.empty(4)
    _product(before, after, -1.0, step)
    _product(turn, step, 1.0, out)


@njit(cache=True, nogil=True)
def _seen_from(turn, vector, out):
    """A vector of the world in a frame that is turned so."""
    u = -turn[1:]
    t = 2.0 * np.cross(u, vector)
    out[:] = vector + turn[0] * t + np.cross(u, t)


@njit(cache=True, nogil=True)
def _filtered(turn, bias, gyro, acceleration, meant, seconds, spin):
    """One step of the filter: ``turn`` (4,) and ``bias`` (3,) go on, ``spin`` (3,) is what is left of the reading."""
    moved, up = np.empty(3), np.empty(3)
    _seen_from(turn, meant, moved)
    _seen_from(turn, np.array([0.0, 0.0, 1.0]), up)
    felt = acceleration - moved
    wrong = np.cross(felt / max(np.sqrt(np.sum(felt**2)), 1e-6), up)
    bias -= SLOW**2 / 4 * wrong * seconds
    spin[:] = gyro - bias
    step, half = np.empty(4), 0.5 * seconds * (spin + SLOW * wrong)
    angle = np.sqrt(np.sum(half**2))
    step[0] = np.cos(angle)
    step[1:] = half * (np.sin(angle) / angle if angle > 1e-12 else 1.0)
    out = np.empty(4)
    _product(turn, step, 1.0, out)
    turn[:] = out / np.sqrt(np.sum(out**2))
