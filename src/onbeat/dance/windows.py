"""How long each join takes: the shortest window in which no link turns faster than it ever does in the data."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, Times
from onbeat.dance.blend import Blend, Windows
from onbeat.dance.sources import Sources
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.skeleton import Skeleton

SHORTEST, LONGEST = 0.35, 0.5
"""Seconds a window lasts at least and at most, where the moves beside it are long enough."""
ROOM = 0.9
"""Part of the shorter of the two moves beside it that a window may fill."""
GRID = 0.05
"""Seconds between the spans tried."""
SAMPLES = 13
"""Times in a window at which the speed of links is looked at."""


def fitted_windows(sources: Sources, blend: Blend, peaks: Array, settled: Array | None = None) -> Windows:
    """A window for each join, bounded to ``SHORTEST``…``LONGEST`` and to less than the moves beside it.

    Shiratori 2006, Sec. IV-B: the duration follows from the angular distance of the poses and the greatest angular
    velocities ``peaks`` in rad/s of the links in the data, (J,) or (K, J) for each join. Spans are tried from the
    shortest up. Where ``settled`` (K,) is not NaN the window lasts so long.
    """
    peaks = np.broadcast_to(peaks, (len(sources.joins), len(sources.skeleton)))
    lengths = np.diff(np.concatenate((sources.starts, [sources.plan.duration])))
    room = ROOM * np.minimum(lengths[:-1], lengths[1:])
    spans = np.minimum(SHORTEST, room)
    waiting = np.flatnonzero(room > SHORTEST)
    for span in np.arange(SHORTEST, LONGEST + GRID / 2, GRID):
        if not len(waiting):
            break
        spans[waiting] = np.minimum(span, room[waiting])
        too_fast = _too_fast(sources, Windows(sources.joins, spans), waiting, blend, peaks)
        waiting = waiting[too_fast & (room[waiting] > span)]
    if settled is not None:
        spans = np.where(np.isfinite(settled), settled, spans)
    return Windows(sources.joins, spans)


def link_speeds(skeleton: Skeleton, positions: Positions, times: Times) -> Array:
    """(..., N-1, J) rad/s at which each joint's bone turns between poses (..., N, J, 3) at ``times`` (..., N)."""
    bones = positions[..., 1:, :] - positions[..., skeleton.parents[1:], :]
    lengths = np.linalg.norm(bones, axis=-1, keepdims=True)
    units = np.where(lengths > 1e-6, bones / np.maximum(lengths, 1e-6), 0.0)
    chord = np.linalg.norm(np.diff(units, axis=-3), axis=-1)
    speeds = np.zeros((*chord.shape[:-1], len(skeleton)))
    speeds[..., 1:] = 2 * np.arcsin(np.clip(chord / 2, 0.0, 1.0)) / np.diff(times, axis=-1)[..., None]
    return speeds


def _too_fast(sources: Sources, windows: Windows, joins: Ints, blend: Blend, peaks: Array) -> Bools:
    inside = np.linspace(0.001, 0.999, SAMPLES)
    times = windows.starts[joins][:, None] + windows.spans[joins][:, None] * inside
    pose = blend(sources, windows, np.repeat(joins, SAMPLES), times.ravel())
    _, positions = forward_kinematics(sources.skeleton, pose.rotations, pose.roots)
    speeds = link_speeds(sources.skeleton, positions.reshape(len(joins), SAMPLES, -1, 3), times)
    return np.any(speeds > peaks[joins][:, None], axis=(1, 2))
