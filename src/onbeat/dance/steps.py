"""When each foot rests in a dance, and where it has to take a small step to get from one clip to the next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, Rotations, Times
from onbeat.dance.blend import Windows
from onbeat.motion.contacts import twist

FARTHEST, MOST_TURNED = 0.12, 0.6
"""Metres and radians: a foot that the clips have strayed farther than this from where it rests has to step."""
PARTED = 0.8
"""Part of a window in whose middle a foot is in the air if it cannot rest through the join."""
LIFT, HIGHEST = 0.3, 0.05
"""A step is lifted by this part of its length, up to so many metres."""


@dataclass(frozen=True)
class Steps:
    """Contacts and steps of F frames.

    Parameters
    ----------
    contacts : (F, 2) true where the left, right foot rests on the floor.
    lifts : (F, 2) metres by which the foot is lifted for a step that neither clip makes.
    """

    contacts: Bools
    lifts: Array


def steps_between(
    contacts: Bools,
    soles: Positions,
    turns: Rotations,
    moves: Ints,
    windows: Windows,
    times: Times,
    strayed: Array | None = None,
) -> Steps:
    """The clips' contacts, less the middle of windows through which a foot cannot rest.

    It cannot where it rests on one side of the join only (it must have left the floor before, or come to it after, not
    at a stroke), or where the clips rest it too far from where it came down; then it is lifted across.

    Parameters
    ----------
    contacts : (F, 2) true where the left, right foot rests in the clip each frame shows.
    soles : (F, 2, 3) metres, where those clips have the feet.
    turns : (F, 2, 4) wxyz, how they have them turned.
    moves : (F,) the move each frame shows.
    windows : of the joins.
    times : (F,) seconds.
    strayed : (2, 3) how far the first frame's clip has strayed already from where each foot came down: x, y and yaw.
    """
    out, lifts = contacts.copy(), np.zeros(contacts.shape)
    strayed, landed = np.zeros((2, 3)) if strayed is None else strayed.copy(), np.zeros(2, np.int64)
    for frame in (np.flatnonzero(np.diff(moves)) + 1).tolist():
        join = int(moves[frame - 1])
        half = PARTED * windows.spans[join] / 2
        near = slice(*np.searchsorted(times, windows.centres[join] + np.array([-half, half])))
        part = (times[near] - windows.centres[join]) / half  # -1 to 1
        for foot in np.flatnonzero(contacts[frame - 1] | contacts[frame]).tolist():
            if not out[landed[foot] : frame, foot].all():
                strayed[foot] = 0.0
            gap = soles[frame, foot] - soles[frame - 1, foot]
            strayed[foot] += (gap[0], gap[1], twist(turns[frame - 1, foot], turns[frame, foot]))
            landed[foot] = frame
            apart = float(np.hypot(strayed[foot, 0], strayed[foot, 1]))
            if not (contacts[frame - 1, foot] and contacts[frame, foot]):
                out[near, foot] = False
            elif apart > FARTHEST or abs(strayed[foot, 2]) > MOST_TURNED:
                out[near, foot] = False
                lifts[near, foot] = (1 - part**2) ** 2 * min(LIFT * max(apart, FARTHEST), HIGHEST)
    return Steps(out, lifts)
